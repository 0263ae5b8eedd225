/* Ties in runs: joints between up to four weighted points, and rooms for ties from step to step. */
#include "cloth/flow/run/step.h"
#include "cloth/flow/solver/solve.h"
#include "cloth/flow/state/bodies.h"
#include "tests/cloth/flow/session.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 6, STEPS = 5 };

/* A sheet that falls, in four blocks and more, with joints across it. */
static void tied_sheet(struct session *s, enum model_preconditioner preconditioner, uint32_t grain)
{
    static uint32_t from[] = {1, SIDE * SIDE - 2, 3, 14}, to[] = {SIDE * SIDE - 2, SIDE, 30, 15};
    static struct model_joint joint;
    *s = (struct session){0};
    joint = (struct model_joint){.pairs = {.end = {{.cloth = 0, .n = 4, .vertices = from},
                                                   {.cloth = 0, .n = 4, .vertices = to}}},
                                 .stiffness = 1e5,
                                 .damping = 0.01,
                                 .length = 0.5,
                                 .end = 100};
    setup_sheet(&s->setup, SIDE);
    s->setup.model.grain = grain;
    s->setup.model.tolerance = 1e-12;
    s->setup.model.preconditioner = preconditioner;
    s->setup.model.joints = &joint;
    s->setup.model.n_joints = 1;
    session_start(s);
}

/* The positions by vertex after some steps. Joint 0 becomes `tie`, the others are none. */
static void run(struct session *s, const struct flow_tie_corners *tie, double position[][3])
{
    struct flow_tie *made = (struct flow_tie *)(uintptr_t)s->flow->tie;
    if (tie)
        made[0].at = *tie;
    for (uint32_t i = 1; i < s->flow->n_ties; i++)
        made[i].at.n = 0;
    ck_assert_int_eq(flow_cg_record(&s->state), 0);
    ck_assert_int_eq(flow_initialise(&s->state), 0);
    for (int step = 0; step < STEPS; step++)
        ck_assert_int_eq(flow_step(&s->state), 0);
    for (uint32_t b = 0; b < s->flow->tables.n_blocks; b++) {
        const struct flow_table *t = s->flow->tables.block + b;
        ck_assert_int_eq(duite_get(s->rt, s->state.block[b].x, s->state.rows), 0);
        for (uint32_t i = 0; i < t->n; i++)
            memcpy(position[s->flow->vertex[t->first + i]], s->state.rows + 4 * i,
                   sizeof *position);
    }
}

/* The iterations of the last step. */
static double iterations(struct session *s)
{
    double status[FLOW_STATUS];
    ck_assert_int_eq(duite_get(s->rt, s->state.run.status, status), 0);
    return status[FLOW_ITERATIONS];
}

static double apart(double a[][3], double b[][3])
{
    double most = 0;
    for (int v = 0; v < SIDE * SIDE; v++)
        for (int c = 0; c < 3; c++)
            most = fmax(most, fabs(a[v][c] - b[v][c]));
    return most;
}

/* Puts the corner at end e of joint j. */
static void put_corner(const struct flow *flow, struct flow_tie_corners *to, uint32_t j, int e,
                       double weight)
{
    to->block[to->n] = flow->tie[j].at.block[e];
    to->row[to->n] = flow->tie[j].at.row[e];
    to->weight[to->n++] = weight;
}

static const enum model_preconditioner preconditioners[] = {MODEL_PLAIN, MODEL_JACOBI, MODEL_IC0,
                                                            MODEL_COARSE, MODEL_IC0_COARSE};

/* A joint whose ends are two corners each, at one place, is a joint. */
UNIT_LOOP(corners_at_one_place, 0, sizeof preconditioners / sizeof *preconditioners)
{
    static double once[SIDE * SIDE][3], twice[SIDE * SIDE][3];
    struct flow_tie_corners tie = {0};
    struct session s;
    tied_sheet(&s, preconditioners[_i], 9);
    run(&s, NULL, once);
    session_end(&s);
    tied_sheet(&s, preconditioners[_i], 9);
    put_corner(s.flow, &tie, 0, 0, 0.3);
    put_corner(s.flow, &tie, 0, 1, -0.6);
    put_corner(s.flow, &tie, 0, 0, 0.7);
    put_corner(s.flow, &tie, 0, 1, -0.4);
    run(&s, &tie, twice);
    session_end(&s);
    ck_assert_double_le(apart(once, twice), 1e-10);
}

/* Between points of four blocks: as where all are one block. */
UNIT_LOOP(corners_in_four_blocks, 0, sizeof preconditioners / sizeof *preconditioners)
{
    static double many[SIDE * SIDE][3], one[SIDE * SIDE][3], free[SIDE * SIDE][3];
    static const uint32_t grain[] = {4, SIDE * SIDE + 1};
    struct session s;
    for (int i = 0; i < 2; i++) {
        struct flow_tie_corners tie = {0};
        tied_sheet(&s, preconditioners[_i], grain[i]);
        put_corner(s.flow, &tie, 0, 0, 0.8);
        put_corner(s.flow, &tie, 1, 1, 0.2);
        put_corner(s.flow, &tie, 2, 0, -0.4);
        put_corner(s.flow, &tie, 2, 1, -0.6);
        if (i == 0)
            ck_assert(tie.block[0] != tie.block[1] && tie.block[0] != tie.block[2] &&
                      tie.block[0] != tie.block[3] && tie.block[2] != tie.block[3]);
        run(&s, &tie, i ? one : many);
        /* Not more for what the pattern of the coarse matrix lacks. */
        if (i == 0 && _i >= 3)
            ck_assert_double_le(iterations(&s), 22);
        session_end(&s);
    }
    ck_assert_double_le(apart(one, many), 1e-11);
    tied_sheet(&s, preconditioners[_i], 9);
    run(&s, &(struct flow_tie_corners){0}, free);
    session_end(&s);
    ck_assert_double_ge(apart(one, free), 1e-4);
}

/* Momentum of cloth that touches nothing is exact to rounding, however the solve stops. */
UNIT_TEST(free_until_it_touches)
{
    UNIT_OWNED(record_free) struct record made = {0};
    SETUP(setup_sheet(&setup, SIDE));
    setup_load(&setup, 3, 0.1, 0.2, -0.3);
    setup.model.contact.mode = MODEL_CONTACT_CERTIFIED;
    setup.model.contact.self = true;
    setup.model.contact.thickness = 1e-3;
    setup.model.halving = true;
    setup.model.tolerance = 0.1;
    record_run(&made, &setup.model);
    ck_assert_msg(!made.code, "%s", made.error.text);
    ck_assert_double_le(made.report.momentum_lost, 1e-15);
}

/* ---- Rooms ---- */

/* Blocks k and k + 1 share so many ties, and show each other as many rows: of n pairs. */
static void say(struct session *s, uint32_t n, const uint32_t *shared)
{
    struct flow_tie_records *said = &s->state.tied.said;
    uint32_t links = 0;
    for (uint32_t b = 0; b < s->flow->tables.n_blocks; b++) {
        const uint32_t before = b > 0 && b - 1 < n ? shared[b - 1] : 0,
                       behind = b < n ? shared[b] : 0;
        said->first[b] = links;
        said->of[b] =
            (struct flow_tie_record){before + behind, before + behind, before + behind, 0};
        if (before)
            said->link[links++] = (struct flow_tie_link){b - 1, before};
        if (behind)
            said->link[links++] = (struct flow_tie_link){b + 1, behind};
        said->of[b].n_links = links - said->first[b];
    }
    said->first[s->flow->tables.n_blocks] = links;
}

/* True if the round was recorded again. */
static bool adopt(struct session *s, uint32_t n, const uint32_t *shared)
{
    const duite_graph before = s->state.solve;
    say(s, n, shared);
    ck_assert_int_eq(flow_ties_adopt(&s->state), 0);
    return memcmp(&before, &s->state.solve, sizeof before) != 0;
}

static void check_room(const struct session *s, uint32_t b, uint32_t ties_and_rows, uint32_t others)
{
    const struct flow_tied_blocks *now = &s->state.tied.now;
    size_t count;
    ck_assert_uint_eq(now->room[b].ties, ties_and_rows);
    ck_assert_uint_eq(now->room[b].rows, ties_and_rows);
    ck_assert_uint_eq(now->first[b + 1] - now->first[b], others);
    ck_assert_int_eq(duite_get_count(s->rt, s->state.block[b].tie_halo, &count), 0);
    ck_assert_uint_eq(count, 8 * (ties_and_rows ? ties_and_rows : 1));
}

static void check_links(const struct session *s, uint32_t b, uint32_t n, const uint32_t (*links)[2])
{
    uint32_t is[1 + FLOW_TIE_OTHERS][2];
    ck_assert_int_eq(duite_get(s->rt, s->state.block[b].tie_links, is), 0);
    ck_assert_uint_eq(is[0][0], n);
    ck_assert(!n || !memcmp(is + 1, links, n * sizeof *links));
}

UNIT_TEST(rooms_grow_and_shrink)
{
    struct session s;
    tied_sheet(&s, MODEL_IC0_COARSE, 9);
    ck_assert_uint_gt(s.flow->tables.n_blocks, 3);
    ck_assert(adopt(&s, 1, (const uint32_t[]){128}));
    check_room(&s, 0, 128, 1);
    check_room(&s, 2, 0, 0);
    ck_assert(!adopt(&s, 1, (const uint32_t[]){1}));
    check_room(&s, 0, 128, 1);
    ck_assert(adopt(&s, 1, (const uint32_t[]){129}));
    check_room(&s, 1, 256, 1);
    ck_assert(!adopt(&s, 1, (const uint32_t[]){128}));
    ck_assert(!adopt(&s, 1, (const uint32_t[]){65}));
    ck_assert(adopt(&s, 1, (const uint32_t[]){64}));
    check_room(&s, 1, 128, 1);
    ck_assert(adopt(&s, 0, NULL));
    check_room(&s, 0, 0, 0);
    session_end(&s);
}

UNIT_TEST(others_stay_for_a_while)
{
    struct session s;
    tied_sheet(&s, MODEL_IC0, 9);
    adopt(&s, 2, (const uint32_t[]){10, 20});
    check_links(&s, 0, 1, (const uint32_t[][2]){{1, 0}});
    check_links(&s, 1, 2, (const uint32_t[][2]){{0, 0}, {2, 0}});
    check_links(&s, 2, 1, (const uint32_t[][2]){{1, 10}});
    ck_assert(!adopt(&s, 2, (const uint32_t[]){11, 0}));
    check_links(&s, 1, 2, (const uint32_t[][2]){{0, 0}, {2, 0}});
    check_links(&s, 2, 1, (const uint32_t[][2]){{1, 0}});
    ck_assert(!adopt(&s, 2, (const uint32_t[]){0, 12}));
    check_links(&s, 2, 1, (const uint32_t[][2]){{1, 0}});
    ck_assert(
        adopt(&s, 3, (const uint32_t[]){0, 0, 13})); /* with all others less than half is used */
    check_links(&s, 1, 0, NULL);
    check_links(&s, 3, 1, (const uint32_t[][2]){{2, 0}});
    session_end(&s);
}
