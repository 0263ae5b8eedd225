/* The states of the bench "cg": a system is that of one whole step, also where the cloth would
 * rather take two of half the length, and a file with the system of another step is refused. States
 * of one motion start alike. A count of iterations is found in few solves. */
#include "bench/cg/cg.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static struct serve_request request = {.text = "make threads=2 scheduler=steal"};

/* A free cloth pressed together to half its size: its linear step would end with more energy than
 * it began with. */
static void plan_hard(struct states_plan *plan)
{
    ck_assert_msg(!states_plan_make(plan, "falling_h20_bend", true), "%s", serve_failure());
    ck_assert_msg(!states_wave(&plan->model), "%s", serve_failure());
    struct model_cloth *cloth = plan->model.cloths;
    for (size_t v = 0; v < cloth->mesh.n_vertices; v++) {
        cloth->start[6 * v] *= 0.5;
        cloth->start[6 * v + 2] *= 0.5;
    }
}

static void setup(void)
{
    char folder[] = "/tmp/duite.states.XXXXXX";
    ck_assert_ptr_nonnull(mkdtemp(folder));
    ck_assert_int_eq(setenv(STATE_FOLDER, folder, 1), 0);
}

static void path_of(const char *name, char *path, size_t size)
{
    snprintf(path, size, "%s/%s", getenv(STATE_FOLDER), name);
}

static void teardown(void)
{
    static const char *const left[] = {"hanging_h20.state", "hanging_h1.state", "crumpled_h1.state",
                                       "hanging_h8_bend.state"};
    char path[300];
    for (int i = 0; i < 4; i++) {
        path_of(left[i], path, sizeof path);
        unlink(path);
    }
    ck_assert_int_eq(rmdir(getenv(STATE_FOLDER)), 0);
}

UNIT_CASES(states, cases)
{
    tcase_add_unchecked_fixture(cases, setup, teardown);
}

/* The cloth's own step, which nobody keeps whole, is halved: the case is one. */
UNIT_TEST(the_step_would_be_halved)
{
    UNIT_OWNED(states_plan_free) struct states_plan plan;
    struct flow_report report = {0};
    plan_hard(&plan);
    ck_assert_msg(!cg_run(&plan.model, &request, NULL, NULL, &report), "%s", serve_failure());
    ck_assert_uint_gt(report.steps_halved, 0);
}

UNIT_TEST(the_step_is_whole)
{
    UNIT_OWNED(states_plan_free) struct states_plan plan;
    UNIT_OWNED(solve_system_free) struct solve_system system = {0};
    plan_hard(&plan);
    ck_assert_msg(!cg_make_system(&plan, &request, &system), "%s", serve_failure());
    ck_assert_double_eq_tol(system.h, 0.02, 1e-12);
}

/* A value that is no number cannot be a step. */
UNIT_TEST(a_step_that_fails_is_told)
{
    UNIT_OWNED(states_plan_free) struct states_plan plan;
    UNIT_OWNED(solve_system_free) struct solve_system system = {0};
    plan_hard(&plan);
    plan.model.cloths->start[3] = 1e200;
    ck_assert_int_ne(cg_make_system(&plan, &request, &system), 0);
    ck_assert_str_ne(serve_failure(), "");
}

UNIT_TEST(another_step_is_refused)
{
    struct state state = {.name = "hanging_h20"}, back;
    ck_assert_int_eq(solve_system_make(&state.system, 2, 1, SOLVE_PAIRS_OF_SPRINGS, NULL), 0);
    state.after = calloc(6, sizeof *state.after);
    state.order = calloc(2, sizeof *state.order);
    state.system.h = 0.02;
    ck_assert_int_eq(state_write(&state), 0);
    ck_assert_msg(!state_read(&back, "hanging_h20"), "%s", serve_failure());
    state_free(&back);
    state.system.h = 0.005;
    ck_assert_int_eq(state_write(&state), 0);
    ck_assert_int_ne(state_read(&back, "hanging_h20"), 0);
    unit_says(serve_failure(), "hanging_h20.state has the system of a step of 5 "
                               "ms, not of one of 20 ms");
    state_free(&state);
}

static void make(struct state *state, const char *name)
{
    char text[100];
    double vertices;
    snprintf(text, sizeof text, "make state=%s quick=1 threads=2 scheduler=steal", name);
    struct serve_request wanted = {.text = text};
    ck_assert_msg(!cg_make_state(NULL, &wanted, &vertices), "%s", serve_failure());
    ck_assert_msg(!state_read(state, name), "%s", serve_failure());
}

static bool start_alike(const struct state *a, const struct state *b)
{
    const size_t bytes = 3 * (size_t)a->system.n * sizeof(double);
    ck_assert_uint_eq(a->system.n, b->system.n);
    return !memcmp(a->system.x, b->system.x, bytes) && !memcmp(a->system.v, b->system.v, bytes);
}

/* Where a motion ended is not forgotten when another one runs. */
UNIT_TEST(states_of_a_motion_start_alike)
{
    UNIT_OWNED(state_free) struct state first, other, second;
    make(&first, "hanging_h1");
    make(&other, "crumpled_h1");
    make(&second, "hanging_h8_bend");
    ck_assert(start_alike(&first, &second));
    ck_assert(!start_alike(&first, &other));
}

/* ---- The search for a count ---- */

struct curve {
    uint32_t least; /* iterations to an error of 0.01 */
    double bends;   /* 1: the logarithm falls evenly */
    uint32_t tried, iterations;
};

static int error_on_curve(void *context, uint32_t count, double *error)
{
    struct curve *curve = context;
    curve->tried++;
    curve->iterations += count;
    *error = pow(0.01, pow((double)count / curve->least, curve->bends));
    return 0;
}

static uint32_t search(struct curve *curve, uint32_t guess)
{
    const struct cg_solver solver = {curve, error_on_curve};
    uint32_t needed = 0;
    curve->tried = curve->iterations = 0;
    ck_assert_int_eq(cg_search(&solver, 0.01, guess, &needed), 0);
    return needed;
}

/* Exact up to a hundred, and to a hundredth beyond; whatever was guessed, however errors fall. */
UNIT_TEST(the_least_count_is_found)
{
    static const uint32_t least[] = {1, 2, 3, 21, 100, 137, 2000}, guess[] = {0, 1, 32, 110, 3000};
    static const double bends[] = {0.5, 1, 3};
    for (int i = 0; i < 7 * 5 * 3; i++) {
        struct curve curve = {.least = least[i % 7], .bends = bends[i / 35]};
        const uint32_t needed = search(&curve, guess[i / 7 % 5]);
        ck_assert_uint_ge(needed, curve.least);
        ck_assert_uint_le(needed, curve.least + curve.least / 100);
        ck_assert_uint_le(curve.tried, 60);
    }
}

/* A guess saves most solves. */
UNIT_TEST(a_good_guess_saves_solves)
{
    struct curve curve = {.least = 90, .bends = 1.3};
    search(&curve, 0);
    const uint32_t without = curve.iterations;
    search(&curve, 112);
    ck_assert_uint_le(curve.tried, 6);
    ck_assert_uint_lt(2 * curve.iterations, without);
}
