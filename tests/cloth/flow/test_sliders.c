/* Pins to lines and planes against closed forms: where all vertices have the same slider, their
 * centre moves as a free particle under the part of the forces that the slider leaves, whatever is
 * between them; none leaves its slider, at rest, on the move or on the floor. */
#include "tests/cloth/flow/models.h"
#include "tests/support/unit.h"

#include <math.h>

enum { N = 6, VERTICES = N * N, STEPS = 10 };

/* A sheet of which every vertex has the slider, in blocks of eight. */
struct sliding {
    struct setup setup;
    struct model_slider slider;
};

static void setup_sliding(struct sliding *g, int kind, double x, double y, double z)
{
    uint32_t all[VERTICES];
    for (uint32_t v = 0; v < VERTICES; v++)
        all[v] = v;
    setup_sheet(&g->setup, N);
    setup_pin(&g->setup, VERTICES, all);
    g->slider = (struct model_slider){.direction = {x, y, z}};
    g->slider.kind = kind == MODEL_LINE ? MODEL_LINE : MODEL_PLANE;
    g->setup.pin.slider = 1;
    g->setup.model.sliders = &g->slider;
    g->setup.model.n_sliders = 1;
    g->setup.model.tolerance = 1e-13;
}

/* How far a unit of acceleration leads in n steps, in h^2. */
static double way(enum model_integrator integrator, double n)
{
    switch (integrator) {
    case MODEL_EXPLICIT_EULER:
        return n * (n - 1) / 2;
    case MODEL_VERLET:
    case MODEL_RK4:
        return n * n / 2;
    case MODEL_BDF2:
        return n * n / 2 + 0.75 * (1 - pow(3, -n));
    default:
        return n * (n + 1) / 2;
    }
}

/* y = S y of a slider. */
static void filter(const struct model_slider *slider, double y[3])
{
    double dot = 0;
    for (int i = 0; i < 3; i++)
        dot += slider->direction[i] * y[i];
    for (int i = 0; i < 3; i++)
        y[i] = (slider->kind == MODEL_LINE ? 0 : y[i]) +
               (slider->kind == MODEL_LINE ? 1 : -1) * dot * slider->direction[i];
}

/* The centre falls as it should, and every vertex is on its slider, which moved by `shift`. */
static void check_fall(const struct sliding *g, const struct record *r, const double shift[3])
{
    const struct model *model = &g->setup.model;
    double mass[VERTICES] = {0}, centre[3] = {0}, total = 0;
    double due[3] = {0.5 * g->setup.cloth.n_loads, -9.81 + 0.25 * g->setup.cloth.n_loads, 0};
    setup_masses(&g->setup, mass);
    filter(&g->slider, due);
    for (size_t v = 0; v < VERTICES; v++) {
        double moved[3], along[3];
        for (size_t c = 0; c < 3; c++)
            along[c] = moved[c] = record_at(r, STEPS, v, c) - record_at(r, 0, v, c) - shift[c];
        filter(&g->slider, along);
        for (size_t c = 0; c < 3; c++) {
            ck_assert_double_eq_tol(moved[c], along[c], 5e-16);
            centre[c] += mass[v] * along[c];
        }
        total += mass[v];
    }
    for (size_t c = 0; c < 3; c++)
        ck_assert_double_eq_tol(centre[c] / total, due[c] * 1e-6 * way(model->integrator, STEPS),
                                1e-15);
}

/* With a load on a corner, so that something is between them; all preconditioners, one Newton step
 * or several. */
static void fall(int kind)
{
    for (int i = 0; i < MODEL_INTEGRATORS; i++)
        for (int way = 0; way < (model_schemes[i].limit ? 1 : 6); way++) {
            static const double none[3] = {0};
            struct sliding g;
            struct record record = {0};
            setup_sliding(&g, kind, 0.48, 0.64, -0.6);
            g.setup.model.integrator = (enum model_integrator)i;
            g.setup.model.preconditioner = (enum model_preconditioner)(way % 5);
            g.setup.model.newton_steps = way == 5 ? 20 : 1;
            g.setup.model.newton_tolerance = 1e-10;
            setup_load(&g.setup, 5, 0.1, 0.05, 0); /* of 0.2 kg */
            record_fine(&record, &g.setup.model);
            check_fall(&g, &record, none);
            record_free(&record);
            setup_free(&g.setup);
        }
}

UNIT_TEST(falls_along_a_line)
{
    fall(MODEL_LINE);
}

UNIT_TEST(falls_in_a_plane)
{
    fall(MODEL_PLANE);
}

/* Sliders that move by 0.3 m/s across themselves take their vertices along and do not slow them. */
UNIT_TEST(sliders_that_move)
{
    for (int i = 0; i < 2 * MODEL_INTEGRATORS; i++) {
        static struct phys_key keys[] = {{.rotate = {1}},
                                         {.time = 1, .translate = {0.3}, .rotate = {1}}};
        static struct model_motion motion = {.n = 2};
        static const double shift[3] = {0.3 * 0.01};
        struct sliding g;
        struct record record = {0};
        if (i % 2)
            setup_sliding(&g, MODEL_LINE, 0, 1, 0);
        else
            setup_sliding(&g, MODEL_PLANE, 1, 0, 0);
        g.setup.model.integrator = (enum model_integrator)(i / 2);
        g.setup.model.n_motions = 1;
        g.setup.model.motions = &motion;
        g.setup.model.n_keys = 2;
        g.setup.model.keys = keys;
        g.slider.motion = 1;
        record_fine(&record, &g.setup.model);
        check_fall(&g, &record, shift);
        record_free(&record);
        setup_free(&g.setup);
    }
}

/* The side of the sheet that is on the floor cannot go on along its lines, the others do. */
UNIT_TEST(sliders_meet_the_floor)
{
    for (int i = 0; i < MODEL_INTEGRATORS; i++) {
        struct sliding g;
        struct record record = {0};
        setup_sliding(&g, MODEL_LINE, 0.6, -0.8, 0);
        g.setup.model.integrator = (enum model_integrator)i;
        g.setup.model.n_obstacles = 1;
        g.setup.plane = PLANE(0.5, 0, 0, -0.8, 0.6, 0);
        g.setup.cloth.velocity[1] = -1; /* of which the lines leave 0.8 m/s */
        record_fine(&record, &g.setup.model);
        for (size_t v = 0; v < VERTICES; v++) {
            const double dx = record_at(&record, STEPS, v, 0) - record_at(&record, 0, v, 0);
            const double dy = record_at(&record, STEPS, v, 1) - record_at(&record, 0, v, 1);
            const double above = -0.8 * (record_at(&record, STEPS, v, 0) - 0.5) +
                                 0.6 * record_at(&record, STEPS, v, 1);
            ck_assert_double_eq_tol(0.8 * dx + 0.6 * dy, 0, 1e-15);
            if (record_at(&record, 0, v, 0) < 0.4)
                ck_assert_double_gt(dx, 0.003);
            else
                ck_assert_double_eq_tol(above, 0, 1e-15);
        }
        record_free(&record);
        setup_free(&g.setup);
    }
}

/* A weight hangs from two links that mirror each other: their plane, and its upright line, hold
 * nothing that moves. */
static void hang(struct setup *setup, uint32_t links, double mass)
{
    static const double vertices[] = {-1, 1, 0, 0, 0, 0, 1, 1, 0};
    static const uint32_t edges[] = {0, 1, 1, 2};
    setup_weight(setup);
    setup_mesh(setup, links + 1, vertices, links, edges, 0, NULL);
    setup->cloth.mass_per_vertex = mass;
    setup->material.ea = 40;
    setup->model.tolerance = 1e-13;
    setup_pin(setup, 1, (const uint32_t[]){0});
}

/* So half of the weight, held there, moves on one link as all of it on both: if the solve knows
 * that it is held. By every preconditioner. */
UNIT_LOOP(half_of_a_mirrored_weight, 2 * MODEL_PLAIN, 2 * (MODEL_IC0_COARSE + 1))
{
    static uint32_t ends[] = {2, 1};
    UNIT_OWNED(setup_free) struct setup whole, half;
    UNIT_OWNED(record_free) struct record of_whole = {0}, of_half = {0};
    struct model_slider slider = {.kind = _i % 2 ? MODEL_LINE : MODEL_PLANE};
    slider.direction[_i % 2] = 1;
    hang(&whole, 2, 0.1);
    hang(&half, 1, 0.05);
    struct model_pin by_two[] = {whole.pin, whole.pin}, by_one[] = {half.pin, half.pin};
    by_two[1].pick.vertices = ends;
    by_one[1].pick.vertices = ends + 1;
    by_one[1].slider = 1;
    whole.cloth.pins = by_two;
    half.cloth.pins = by_one;
    whole.cloth.n_pins = half.cloth.n_pins = 2;
    half.model.sliders = &slider;
    half.model.n_sliders = 1;
    whole.model.preconditioner = half.model.preconditioner = (enum model_preconditioner)(_i / 2);
    record_fine(&of_whole, &whole.model);
    record_fine(&of_half, &half.model);
    ck_assert_double_lt(record_at(&of_whole, STEPS, 1, 1), -1e-4);
    for (size_t c = 0; c < 3; c++)
        ck_assert_double_eq_tol(record_at(&of_half, STEPS, 1, c), record_at(&of_whole, STEPS, 1, c),
                                1e-15);
}
