/* Obstacles that move, against closed forms: a row of masses that a floor, a ball, a box or a body
 * carries up, by each way of contact and each integrator; halved steps. Bodies against the shapes
 * that they are nearly, and the real one where it is beside the source tree. */
#include "tests/cloth/contact/bodies.h"
#include "tests/cloth/flow/models.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdlib.h>
#include <unistd.h>

enum { MASSES = 4 };
static const double MASS = 0.1, EA = 40, GAP = 0.5, SPEED = 0.25, G = 9.81;

/* A plane, the top of a ball, and the tops of a box and of a body like it, all at y = 0. */
static const struct contact_shape SHAPES[] = {
    {.kind = 0, .value = {0, 0, 0, 0, 1, 0}},
    {.kind = 1, .value = {0, -0.3, 0, 0.3}},
    {.kind = 2, .value = {0, -0.2, 0, 1, 0.4, 1, 1, 0, 0, 0}},
    {.kind = 5, .body = 1},
};
enum { N_SHAPES = sizeof SHAPES / sizeof *SHAPES };

struct row {
    struct setup setup;
    struct phys_key keys[2];
};

/* The only body of a model, at a place. */
static void body_make(struct model *model, struct mesh *mesh, const struct mesh_transform *place)
{
    bool turned;
    mesh_apply(mesh, place);
    UNIT_FINE(contact_bodies_add(&model->bodies, mesh, &turned, &error));
    mesh_free(mesh);
}

static void box_make(struct model *model)
{
    static struct surface box;
    struct mesh mesh;
    struct mesh_transform place = mesh_identity;
    surface_box(&box, 0.5, 0.2, 0.5);
    surface_mesh(&box, &mesh);
    place.translate[1] = -0.2;
    body_make(model, &mesh, &place);
}

static void free_all(struct setup *setup)
{
    free(setup->model.bodies.memory);
    setup_free(setup);
}

static void row_free(struct row *row)
{
    free_all(&row->setup);
}

/* A row of masses upright on a shape, GAP apart at rest, joined by springs, on no pin. The shape
 * rises with SPEED from time 0 on. */
static void row_make(struct row *row, int shape)
{
    static const double vertices[3 * MASSES] = {0, 0, 0, 0, 0.5, 0, 0, 1, 0, 0, 1.5, 0};
    static const uint32_t edges[] = {0, 1, 1, 2, 2, 3};
    struct setup *s = &row->setup;
    setup_weight(s);
    setup_mesh(s, MASSES, vertices, MASSES - 1, edges, 0, NULL);
    s->cloth.n_pins = 0;
    s->cloth.mass_per_vertex = MASS;
    s->material.ea = EA;
    s->material.damping_stiffness = 0.05;
    row->keys[0] = (struct phys_key){0, {0, 0, 0}, {1, 0, 0, 0}};
    row->keys[1] = (struct phys_key){10, {0, 10 * SPEED, 0}, {1, 0, 0, 0}};
    s->plane = SHAPES[shape];
    if (s->plane.body)
        box_make(&s->model);
    s->plane.n = 2;
    s->model.keys = row->keys;
    s->model.n_keys = 2;
    s->model.n_obstacles = 1;
    s->model.grain = 1;
    s->model.stop = MODEL_STOP_RELATIVE;
    s->model.tolerance = 1e-12;
    s->model.fps = 1 / s->model.h;
}

static double speed_of(const struct record *r, size_t frame, size_t vertex)
{
    const double moved = record_at(r, frame, vertex, 1) - record_at(r, frame - 1, vertex, 1);
    return moved / (r->time[frame] - r->time[frame - 1]);
}

static const struct way {
    enum model_integrator integrator;
    double h;
    double least, max; /* how much of its sinking in a step the lowest spring bears */
} WAYS[] = {{MODEL_IMPLICIT_EULER, 0.01, 1, 1},
            {MODEL_BDF2, 0.01, 1, 1},
            {MODEL_SYMPLECTIC_EULER, 0.001, 0, 0},
            {MODEL_VERLET, 0.001, 0, 1},
            {MODEL_RK4, 0.001, 0, 1}};
enum { N_WAYS = sizeof WAYS / sizeof *WAYS };

/* When the row has come to rest on the shape, it has its speed: momentum n m v. Spring i carries
 * the weight of the masses above it, and the shape carries n m g. Where the solve does not know of
 * contact, n m g lets the lowest mass sink by s = n g h^2 in each step before it is put back, and
 * the spring above it carries (k + c / h) s more. */
UNIT_LOOP(carries_a_row, 0, N_WAYS *N_SHAPES)
{
    const struct way *way = WAYS + _i / N_SHAPES;
    UNIT_OWNED(row_free) struct row row;
    UNIT_OWNED(record_free) struct record record = {0};
    row_make(&row, _i % N_SHAPES);
    struct model *model = &row.setup.model;
    model->integrator = way->integrator;
    model->h = way->h;
    model->end = 6;
    model->fps = 10;
    record_fine(&record, model);
    const size_t last = record.frames - 1;
    double momentum = 0, weight = 0;
    for (size_t v = MASSES; v-- > 0;) {
        momentum += MASS * speed_of(&record, last, v);
        weight += MASS * G;
        if (v == 0)
            break;
        const double pressed =
            GAP - (record_at(&record, last, v, 1) - record_at(&record, last, v - 1, 1));
        const double sinks = v == 1 ? MASSES * G * way->h * way->h : 0;
        const double more = EA / GAP * (1 + row.setup.material.damping_stiffness / way->h) * sinks;
        const double force = EA / GAP * pressed, slack = 1e-6 * weight;
        ck_assert_double_ge(force, weight + way->least * more - slack);
        ck_assert_double_le(force, weight + way->max * more + slack);
    }
    ck_assert_double_eq_tol(momentum, MASSES * MASS * SPEED, 1e-6);
    /* It lies on the shape, less what a step falls before it is put back. */
    ck_assert_double_eq_tol(record_at(&record, last, 0, 1), SPEED * record.time[last], 1e-9);
    ck_assert_double_eq_tol(record_at(&record, last, 0, 0), 0, 1e-12);
}

/* Without weight and springs the step in which the shape comes gives the lowest mass m v. */
UNIT_LOOP(gives_momentum, 0, N_SHAPES)
{
    UNIT_OWNED(row_free) struct row row;
    UNIT_OWNED(record_free) struct record record = {0};
    row_make(&row, _i);
    struct model *model = &row.setup.model;
    row.setup.material.ea = 1e-12;
    row.setup.material.damping_stiffness = 0;
    model->gravity[1] = 0;
    /* It stands still for 4.5 steps: the velocity of a step is that of its chord. */
    row.keys[0].time = 0.0045;
    row.keys[1].time = 1.0045;
    row.keys[1].translate[1] = SPEED;
    model->end = 0.02;
    record_fine(&record, model);
    ck_assert_double_eq_tol(speed_of(&record, 4, 0), 0, 1e-9);
    ck_assert_double_eq_tol(speed_of(&record, 5, 0), SPEED / 2, 1e-9);
    for (size_t frame = 6; frame < record.frames; frame++)
        ck_assert_double_eq_tol(MASS * speed_of(&record, frame, 0), MASS * SPEED, 1e-9);
    ck_assert_double_eq_tol(speed_of(&record, record.frames - 1, 1), 0, 1e-9);
}

/* A step that is given up and made in parts sees the shape where it is at the end of each part: the
 * mass on it is exactly there at every time. */
UNIT_TEST(halved_steps_see_their_time)
{
    UNIT_OWNED(row_free) struct row row;
    UNIT_OWNED(record_free) struct record record = {0};
    row_make(&row, 0);
    struct model *model = &row.setup.model;
    model->halving = true;
    model->stretch_growth = 0.002;
    setup_load(&row.setup, MASSES - 1, 0, 2, 0);
    model->h = 0.01;
    model->end = 0.2;
    model->fps = 800; /* of parts too */
    record_fine(&record, model);
    ck_assert_uint_gt(record.report.steps_halved, 0);
    for (size_t frame = 0; frame < record.frames; frame++) {
        const double off = record_at(&record, frame, 0, 1) - SPEED * record.time[frame];
        ck_assert_double_eq_tol(off, 0, 1e-12);
    }
}

/* Cloth that rests while a shape has yet to move does not end the run. */
UNIT_TEST(waits_for_a_shape)
{
    UNIT_OWNED(row_free) struct row row;
    UNIT_OWNED(record_free) struct record record = {0};
    row_make(&row, 0);
    struct model *model = &row.setup.model;
    row.keys[0].time = 0.2;
    row.keys[1].time = 0.3;
    row.keys[1].translate[1] = 0.1;
    model->gravity[1] = 0;
    model->end = 3;
    model->fps = 100;
    model->rest.speed = 1e-3;
    model->rest.hold = 0.01;
    row.setup.material.damping_viscous = 1;
    record_fine(&record, model);
    ck_assert_double_gt(record.report.rest_seconds, 0.3);
    ck_assert_double_lt(record.report.rest_seconds, 3);
}

/* A ball goes through where a sheet hangs: no vertex is in it, and the sheet is out of its way. */
UNIT_TEST(pushes_a_sheet)
{
    static struct phys_key keys[2] = {{0, {0, 0, 0}, {1, 0, 0, 0}}, {1, {0, 0, 0.6}, {1, 0, 0, 0}}};
    const double radius = 0.15;
    UNIT_OWNED(free_all) struct setup s;
    UNIT_OWNED(record_free) struct record record = {0};
    setup_sheet(&s, 21); /* in the x-z plane: its weight hangs along x */
    s.model.gravity[0] = -9.81;
    s.model.gravity[1] = 0;
    setup_pin(&s, 2, (const uint32_t[]){20, 440});
    s.material.stretch = 500;
    s.material.shear = 200;
    s.plane = (struct contact_shape){.kind = 1, .value = {0, -0.2, 0, radius}, .n = 2};
    keys[1].translate[1] = 0.5;
    keys[1].translate[2] = 0;
    s.model.keys = keys;
    s.model.n_keys = 2;
    s.model.n_obstacles = 1;
    s.model.h = 0.004;
    s.model.fps = 25;
    s.model.end = 0.8;
    record_fine(&record, &s.model);
    for (size_t frame = 1; frame < record.frames; frame++)
        for (size_t v = 0; v < record.vertices; v++) {
            double square = 0;
            for (size_t c = 0; c < 3; c++) {
                const double centre = c == 1 ? -0.2 + 0.5 * record.time[frame] : 0;
                const double from = record_at(&record, frame, v, c) - centre;
                square += from * from;
            }
            if (sqrt(square) < radius - 1e-9)
                ck_abort_msg("frame %zu: vertex %zu is in the ball", frame, v);
        }
    const size_t middle = 220;
    ck_assert_double_gt(record_at(&record, record.frames - 1, middle, 1), 0.3);
}

/* A sheet of n x n vertices that falls onto something, 0.2 s in 50 steps. */
static void sheet_make(struct setup *s, uint32_t n, const struct contact_shape *shape)
{
    setup_sheet(s, n);
    s->material.stretch = 500;
    s->material.shear = 200;
    s->material.damping_viscous = 1e-3;
    s->plane = *shape;
    s->model.n_obstacles = 1;
    s->model.h = 0.004;
    s->model.fps = 250;
    s->model.end = 0.2;
}

/* A ball of 1,280 triangles is a ball but for what its triangles are less: a sheet lies as on the
 * other, so much nearer to its middle. */
UNIT_TEST(a_ball_of_triangles)
{
    static struct surface ball;
    const double radius = 0.3, less = 0.003;
    struct record on[2] = {0};
    for (int i = 0; i < 2; i++) {
        const struct contact_shape shape[2] = {{.kind = 1, .value = {0, -0.31, 0, radius}},
                                               {.kind = 5, .body = 1}};
        UNIT_OWNED(free_all) struct setup s;
        sheet_make(&s, 21, shape + i);
        if (i) {
            struct mesh mesh;
            struct mesh_transform place = mesh_identity;
            surface_ball(&ball, radius, 3);
            surface_mesh(&ball, &mesh);
            place.translate[1] = -0.31;
            body_make(&s.model, &mesh, &place);
        }
        record_fine(on + i, &s.model);
    }
    size_t lies = 0;
    double sum = 0;
    for (size_t v = 0; v < on[0].vertices; v++) {
        double far[2], square = 0;
        for (int i = 0; i < 2; i++) {
            double from[3];
            for (size_t c = 0; c < 3; c++)
                from[c] = record_at(on + i, on->frames - 1, v, c) + (c == 1 ? 0.31 : 0);
            far[i] = sqrt(from[0] * from[0] + from[1] * from[1] + from[2] * from[2]);
        }
        for (size_t c = 0; c < 3; c++) {
            const double apart =
                record_at(on, on->frames - 1, v, c) - record_at(on + 1, on->frames - 1, v, c);
            square += apart * apart;
        }
        ck_assert_double_gt(far[1], radius - less);
        ck_assert_double_lt(sqrt(square), 5 * less); /* where it swings */
        sum += sqrt(square);
        lies += far[0] < radius + 1e-9 && far[1] < radius + 1e-9;
    }
    ck_assert_double_lt(sum / (double)on[0].vertices, less);
    ck_assert_uint_gt(lies, 8);
    record_free(on);
    record_free(on + 1);
}

/* Cloth that crumples on the floor is thrown about less where compressed springs resist being
 * turned: it gains less energy, and its systems are easier. */
UNIT_TEST(crumples_by_absolute_slopes)
{
    struct flow_report report[2];
    for (int absolute = 0; absolute < 2; absolute++) {
        UNIT_OWNED(free_all) struct setup s;
        UNIT_OWNED(record_free) struct record record = {0};
        sheet_make(&s, 24, &PLANE(0, 0, 0, 0, 1, 0));
        for (size_t v = 0; v < s.cloth.mesh.n_vertices; v++) {
            double *p = s.cloth.mesh.position + 3 * v, x = p[0];
            p[0] = 0.8 * x;
            p[1] = 0.6 * x + 0.5;
        }
        s.model.preconditioner = MODEL_IC0_COARSE;
        s.material.stretch = s.material.shear = 2000;
        s.material.damping_viscous = 0;
        s.model.h = 0.02;
        s.model.end = 0.4;
        s.model.fps = 50;
        s.model.full_slope = absolute ? PHYS_ABSOLUTE : PHYS_DEFINITE;
        s.model.energy_steps = true;
        record_fine(&record, &s.model);
        report[absolute] = record.report;
    }
    ck_assert_double_lt(2 * report[1].energy_gained, report[0].energy_gained);
    ck_assert_uint_lt(report[1].cg_iterations_total, report[0].cg_iterations_total);
}

/* No vertex of a sheet that falls onto the head and the shoulders of a body is in it after any
 * step. */
UNIT_LOOP(a_real_body, 0, access(real_body_path(), R_OK) == 0)
{
    UNIT_OWNED(free_all) struct setup s;
    UNIT_OWNED(record_free) struct record record = {0};
    struct mesh mesh;
    sheet_make(&s, 41, &(const struct contact_shape){.kind = 5, .body = 1});
    struct mesh_transform place = {{0.1, 0.1, 0.1}, {1, 0, 0, 0}, {0, -0.8, 0}};
    UNIT_FINE(mesh_read_surface(&mesh, real_body_path(), &error));
    body_make(&s.model, &mesh, &place);
    record_fine(&record, &s.model);
    struct contact_pose pose;
    size_t touched = 0;
    contact_pose_over(&s.plane, NULL, &s.model.bodies, 0, 0, &pose);
    for (size_t frame = 1; frame < record.frames; frame++)
        for (size_t v = 0; v < record.vertices; v++) {
            struct contact_hit hit;
            phys_vec x = {0};
            for (size_t c = 0; c < 3; c++)
                x[c] = record_at(&record, frame, v, c);
            contact_closest(&s.plane, &pose, 1, &x, &hit);
            ck_assert_double_gt(hit.gap, -1e-9);
            touched += hit.gap < 1e-7;
        }
    ck_assert_uint_gt(touched, 100);
}
