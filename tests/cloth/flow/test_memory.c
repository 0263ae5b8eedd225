/* Every allocation of the flow fails once: while it prepares, locally; while it runs, on one rank
 * alone, and all ranks must hear of it and end together. */
#include "tests/cloth/flow/models.h"
#include "tests/support/scarce.h"
#include "tests/support/unit.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Prepares once for each allocation, which fails. Returns how many there are. */
static long prepare_all(const struct model *model)
{
    for (long n = 0;; n++) {
        struct cloth_error error = {0};
        struct flow *flow = NULL;
        scarce_left = n;
        const int code = flow_prepare(&flow, model, 1, &error);
        const bool through = scarce_left >= 0;
        scarce_left = -1;
        ck_assert_int_eq(code, error.code);
        ck_assert(!code == (flow != NULL));
        flow_free(flow);
        if (through)
            return n;
        if (code)
            ck_assert_msg(code == CLOTH_E_MEMORY && strstr(error.text, "out of memory"), "%s",
                          error.text);
    }
}

UNIT_TEST(each_fails_once_in_prepare)
{
    SETUP(setup_sheet(&setup, 3));
    setup_pin(&setup, 1, (const uint32_t[]){0});
    ck_assert_int_gt(prepare_all(&setup.model), 20);
}

/* A sheet that bends, two of whose border edges are welded, with a joint across and a timed one. */
UNIT_TEST(each_fails_once_with_welds)
{
    UNIT_OWNED(setup_free) struct setup setup;
    uint32_t from[] = {0, 1}, to[] = {20, 21}, ends[] = {7, 17};
    struct model_weld weld = {.pairs = {.end = {{.cloth = 0, .n = 2, .vertices = from},
                                                {.cloth = 0, .n = 2, .vertices = to}}},
                              .tolerance = 2};
    const struct model_joint joint = {
        .pairs = {.end = {{.cloth = 0, .n = 1, .vertices = ends},
                          {.cloth = 0, .n = 1, .vertices = ends + 1}}},
        .stiffness = 1,
        .length = 0};
    struct model_joint joints[] = {joint, joint};
    joints[1].end = 1;
    setup_sheet(&setup, 5);
    setup.material.bending = MODEL_HINGES;
    setup.material.rigidity[0] = setup.material.rigidity[1] = 1e-3;
    setup.model.format = SOLVE_HALF;
    setup.model.contact.mode = MODEL_CONTACT_CERTIFIED;
    setup.model.contact.thickness = 1e-3;
    const long without = prepare_all(&setup.model);
    setup.model.n_welds = 1;
    setup.model.n_joints = 2;
    setup.model.welds = &weld;
    setup.model.joints = joints;
    ck_assert_int_gt(prepare_all(&setup.model), without + 10);
}

struct flow_state;
int __real_flow_memory_take(struct flow_state *state);
int __wrap_flow_memory_take(struct flow_state *state);
struct flow_source;
int __real_flow_source_gather(struct flow_source *source, uint32_t from, uint32_t to,
                              struct cloth_error *error);
int __wrap_flow_source_gather(struct flow_source *source, uint32_t from, uint32_t to,
                              struct cloth_error *error);

static long next_run = -1, next_sides = -1; /* which one fails, of this rank; negative: none */

/* Those of a run's own memory, which it takes before its first object. */
int __real_duite_new(duite *rt, duite_type type, size_t count, duite_object *object);
int __wrap_duite_new(duite *rt, duite_type type, size_t count, duite_object *object);

int __wrap_duite_new(duite *rt, duite_type type, size_t count, duite_object *object)
{
    scarce_left = -1;
    return __real_duite_new(rt, type, count, object);
}

int __wrap_flow_memory_take(struct flow_state *state)
{
    scarce_left = next_run;
    return __real_flow_memory_take(state);
}

int __wrap_flow_source_gather(struct flow_source *source, uint32_t from, uint32_t to,
                              struct cloth_error *error)
{
    scarce_left = next_sides;
    const int code = __real_flow_source_gather(source, from, to, error);
    scarce_left = -1;
    return code;
}

/* True if the run fails, by the memory of that rank, and all ranks hear of it. */
static bool ends_everywhere(const struct setup *setup, int where)
{
    UNIT_OWNED(record_free) struct record record = {0};
    char text[64];
    record_run(&record, &setup->model);
    scarce_left = -1;
    snprintf(text, sizeof text, "rank %d: out of memory", where);
    ck_assert_msg(!record.code ||
                      (record.code == CLOTH_E_MEMORY && strstr(record.error.text, text) &&
                       strstr(record.error.text, "; no frame was written")),
                  "%s", record.error.text);
    return record.code;
}

UNIT_TEST(each_fails_once_in_a_run)
{
    int rank, ranks;
    SETUP(setup_sheet(&setup, 6));
    record_mpi(&rank, &ranks);
    for (int where = 0; where < ranks && where < 2; where++) {
        long n = 0;
        do
            next_run = rank == where ? n : -1;
        while (ends_everywhere(&setup, where) && n++ < 1000);
        ck_assert_int_gt(n, 10);
        ck_assert_int_lt(n, 1000);
    }
    next_run = -1;
}

/* Rank 0 has no room to gather what tables are made of. */
UNIT_TEST(each_fails_once_in_distributing)
{
    SETUP(setup_sheet(&setup, 6));
    for (next_sides = 0; ends_everywhere(&setup, 0); next_sides++)
        ck_assert_int_lt(next_sides, 1000);
    ck_assert_int_gt(next_sides, 1);
    next_sides = -1;
}
