/* The table of fields against runs. Fields that exist are made in the size that the table says, and
 * freed. A step uses a field as the table calls it. Work fields may be anything when a step begins;
 * a state field may not. */
#include "cloth/flow/checkpoint/checkpoint.h"
#include "cloth/flow/contact/mode.h"
#include "cloth/flow/run/setup.h"
#include "cloth/flow/run/step.h"
#include "cloth/flow/solver/solve.h"
#include "tests/cloth/flow/kinds.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS = 4 };

/* ---- What exists ---- */

static duite_object made(const struct session *s, int field, uint32_t block)
{
    return field < FLOW_FIELDS_OF_BLOCK ? s->state.block[block].of[field]
                                        : s->state.run.of[field - FLOW_FIELDS_OF_BLOCK];
}

static uint32_t blocks_of(const struct session *s, int field)
{
    return field < FLOW_FIELDS_OF_BLOCK ? s->flow->tables.n_blocks : 1;
}

static void check_made(const struct session *s, int field, uint32_t block)
{
    const struct flow_field *is = flow_fields + field;
    const duite_object object = made(s, field, block);
    const bool exists = is->exists(&s->state, block);
    size_t count = 0;
    ck_assert_msg(exists == (object.generation != 0), "%s of block %u", is->name, block);
    if (!exists)
        return;
    ck_assert_int_eq(duite_get_count(s->rt, object, &count), 0);
    const size_t full = flow_field_numbers(&s->state, (enum flow_field_id)field, block);
    ck_assert_msg(count == (is->turns == FLOW_SIZED ? 0 : full), "%s of block %u has %zu numbers",
                  is->name, block, count);
}

/* Forks that name a field of all blocks look at no block behind the last one that has it: else a
 * step of n blocks takes n x n looks. */
static void check_last(const struct session *s, int field)
{
    const struct flow_field *is = flow_fields + field;
    const uint32_t n = s->flow->made[field];
    ck_assert_msg(n <= s->flow->tables.n_blocks, "%s", is->name);
    ck_assert_msg(!n || is->exists(&s->state, n - 1), "%s: not in block %u", is->name, n - 1);
    for (uint32_t b = n; b < blocks_of(s, field); b++)
        ck_assert_msg(!is->exists(&s->state, b), "%s: in block %u", is->name, b);
}

UNIT_LOOP(what_exists_is_made, 0, KINDS)
{
    struct session s;
    kind_setup(_i, &s);
    session_start(&s);
    ck_assert_uint_gt(s.flow->tables.n_blocks, 2);
    for (int field = 0; field < FLOW_FIELDS_OF_ALL; field++)
        for (uint32_t b = 0; b < blocks_of(&s, field); b++)
            check_made(&s, field, b);
    for (int field = 0; field < FLOW_FIELDS_OF_ALL; field++)
        check_last(&s, field);
    session_end(&s);
}

UNIT_LOOP(all_is_freed, 0, KINDS)
{
    struct session s;
    kind_setup(_i, &s);
    session_start(&s);
    ck_assert_int_eq(flow_objects_free(&s.state), 0);
    for (int field = 0; field < FLOW_FIELDS_OF_ALL; field++)
        for (uint32_t b = 0; b < blocks_of(&s, field); b++) {
            size_t count;
            const duite_object object = made(&s, field, b);
            if (object.generation)
                ck_assert_msg(duite_get_count(s.rt, object, &count), "%s is there",
                              flow_fields[field].name);
        }
    flow_memory_free(&s.state);
    duite_stop(&s.rt);
    flow_free(s.flow);
    setup_free(&s.setup);
}

/* Every field exists in some kind of run, or is of what these runs do not have. */
UNIT_TEST(every_field_has_a_run)
{
    static const char *const others[] = {
        "filter",     "probe_force",   "probe_values",       "pieces",
        "groups",     "body_skins",    "body_fans",          "body_points",
        "body_boxes", "contact_force", "kept_contact_force", "obstacle_force",
        "maps",       "kept_last_x",   "kept_last_v"};
    bool exists[FLOW_FIELDS_OF_ALL] = {false};
    for (int kind = 0; kind < KINDS; kind++) {
        struct session s;
        kind_setup(kind, &s);
        session_start(&s);
        for (int field = 0; field < FLOW_FIELDS_OF_ALL; field++)
            exists[field] = exists[field] || made(&s, field, 0).generation;
        session_end(&s);
    }
    for (int field = 0; field < FLOW_FIELDS_OF_ALL; field++) {
        bool other = false;
        for (size_t i = 0; i < sizeof others / sizeof *others; i++)
            other = other || !strcmp(others[i], flow_fields[field].name);
        ck_assert_msg(exists[field] || other, "%s exists in no run", flow_fields[field].name);
    }
}

/* ---- What lasts from step to step ---- */

/* Changes the fields of one kind before each step but the first. */
typedef void change(struct session *s, int field, uint32_t block, double *numbers, size_t n);

static void to_nothing(struct session *s, int field, uint32_t block, double *numbers, size_t n)
{
    (void)s, (void)field, (void)block;
    for (size_t i = 0; i < n; i++)
        numbers[i] = NAN;
}

static void by_a_little(struct session *s, int field, uint32_t block, double *numbers, size_t n)
{
    (void)s, (void)field, (void)block;
    for (size_t i = 0; i < n; i++)
        numbers[i] += 1e-7;
}

static void change_field(struct session *s, int field, change *how)
{
    for (uint32_t b = 0; b < blocks_of(s, field); b++) {
        const duite_object object = made(s, field, b);
        const size_t n = flow_field_numbers(&s->state, (enum flow_field_id)field, b);
        double *numbers = calloc(n, sizeof *numbers);
        ck_assert_ptr_nonnull(numbers);
        ck_assert_int_eq(duite_get(s->rt, object, numbers), 0);
        how(s, field, b, numbers, n);
        ck_assert_int_eq(duite_set(s->rt, object, numbers), 0);
        free(numbers);
    }
}

static bool is_changed(const struct session *s, int field, enum flow_life life, int only)
{
    return (only < 0 || field == only) && flow_fields[field].type == DUITE_F64 &&
           made(s, field, 0).generation && flow_fields[field].life(&s->setup.model) == life;
}

static uint64_t hash_state(struct session *s)
{
    XXH64_state_t *hash = XXH64_createState();
    XXH64_reset(hash, 0);
    for (uint32_t b = 0; b < s->flow->tables.n_blocks; b++)
        for (int field = FLOW_FIELD_x; field <= FLOW_FIELD_v; field++) {
            const size_t n = flow_field_numbers(&s->state, (enum flow_field_id)field, b);
            ck_assert_int_eq(duite_get(s->rt, made(s, field, b), s->state.rows), 0);
            XXH64_update(hash, s->state.rows, n * sizeof *s->state.rows);
        }
    const uint64_t digest = XXH64_digest(hash);
    XXH64_freeState(hash);
    return digest;
}

/* A step; with a guess where the run has one, which flow_step has not. */
static int step_on(struct session *s)
{
    if (s->setup.model.guess != MODEL_GUESS_PREVIOUS)
        return flow_step(&s->state);
    s->state.attempt.length = FLOW_TICKS;
    const int code = flow_step_begin(&s->state);
    return code ? code : flow_step_end(&s->state);
}

/* The hash after some steps, where fields of this life (one of them, or all: less than 0) are
 * changed before each but the first. */
static uint64_t run_changed(int kind, enum flow_life life, int only, change *how)
{
    struct session s;
    kind_setup(kind, &s);
    session_start(&s);
    if (model_is_implicit(&s.setup.model))
        ck_assert_int_eq(flow_cg_record(&s.state), 0);
    ck_assert_int_eq(flow_initialise(&s.state), 0);
    ck_assert_int_eq(flow_contact_start(&s.state), 0);
    for (int step = 0; step < STEPS; step++) {
        for (int field = 0; field < FLOW_FIELDS_OF_ALL && step && how; field++)
            if (is_changed(&s, field, life, only))
                change_field(&s, field, how);
        ck_assert_int_eq(step_on(&s), 0);
        ck_assert_int_eq(duite_wait(s.rt), 0);
        const double status[FLOW_STATUS] = {0};
        ck_assert_int_eq(flow_contact_settled(&s.state, status, true), 0);
        s.state.smooth = FLOW_TICKS; /* BDF2 goes on */
    }
    const uint64_t hash = hash_state(&s);
    session_end(&s);
    return hash;
}

UNIT_LOOP(work_is_written_before_it_is_read, 0, KINDS)
{
    const uint64_t hash = run_changed(_i, FLOW_WORK, -1, NULL);
    ck_assert_uint_eq(run_changed(_i, FLOW_WORK, -1, to_nothing), hash);
}

/* The place of a parameter: objects that the fork gives stand among the task's own. */
static enum flow_whose place_of(const struct flow_parameter *p)
{
    return p->whose == FLOW_OF_FORK ? FLOW_OWN : p->whose;
}

/* A body's pointers are counted on from the last object of the task's own: behind those come the
 * ones of neighbours, then those that may not be there; behind those of all blocks, and behind all
 * others that the fork gives, comes nothing. */
UNIT_LOOP(parameters_stand_in_order, 0, FLOW_KERNELS_OF_ALL)
{
#define ADDRESS(name) &flow_kernel_##name,
    const struct flow_kernel *const all[] = {FLOW_KERNELS(ADDRESS)};
    const struct flow_parameter *p = all[_i]->parameter;
    for (; p->whose != FLOW_NOBODY && p[1].whose != FLOW_NOBODY; p++) {
        ck_assert_msg(place_of(p) <= place_of(p + 1), "%s: parameter %d", all[_i]->task.name,
                      (int)(p - all[_i]->parameter) + 1);
        ck_assert_msg(p->whose != FLOW_OF_ALL && p->whose != FLOW_OF_KEEPERS &&
                          p->whose != FLOW_REST_OF_FORK,
                      "%s: parameter %d", all[_i]->task.name, (int)(p - all[_i]->parameter));
    }
}

/* dv counts where steps begin with a guess. */
UNIT_LOOP(state_lasts, 0, KINDS)
{
    const uint64_t hash = run_changed(_i, FLOW_WORK, -1, NULL);
    struct session s;
    bool is_state[FLOW_FIELDS_OF_ALL];
    kind_setup(_i, &s);
    session_start(&s);
    for (int field = 0; field < FLOW_FIELDS_OF_ALL; field++)
        is_state[field] = is_changed(&s, field, FLOW_STATE_FIELD, field);
    if (s.setup.model.guess != MODEL_GUESS_PREVIOUS)
        is_state[FLOW_FIELD_dv] = false;
    session_end(&s);
    ck_assert(is_state[FLOW_FIELD_x] && is_state[FLOW_FIELD_v]);
    for (int field = 0; field < FLOW_FIELDS_OF_ALL; field++)
        if (is_state[field])
            ck_assert_msg(run_changed(_i, FLOW_STATE_FIELD, field, by_a_little) != hash,
                          "no step reads %s", flow_fields[field].name);
}

/* ---- What a checkpoint has of the main program ---- */

static void take_checkpoint(void *context, struct flow_checkpoint state)
{
    ck_assert_ptr_nonnull(state.bytes);
    *(struct flow_checkpoint *)context = state;
}

UNIT_LOOP(what_the_main_program_knows_lasts, 0, KINDS)
{
    struct session s;
    struct flow_checkpoint saved = {0};
    const struct flow_output output = {.save = take_checkpoint, .context = &saved};
    kind_setup(_i, &s);
    session_start(&s);
    s.state.output = s.flow->output = &output;
    s.state.contact.attempt = 11;
    s.state.contact.accepted = 7;
    s.state.saved_wall = 3;
    s.report.steps = 5;
    const struct flow_lasting lasting = s.state.lasting;
    ck_assert_msg(!flow_save(&s.state, true), "%d: %s", _i, duite_message());
    ck_assert_int_eq(duite_wait(s.rt), 0);
    s.state.contact.attempt = s.state.contact.accepted = 0;
    memset(&s.state.lasting, 1, sizeof s.state.lasting);
    memset(&s.report, 0, sizeof s.report);
    s.flow->from = saved;
    s.state.head.resumed_bytes = ((const struct flow_saved *)(const void *)saved.bytes)->main_bytes;
    ck_assert_int_eq(flow_resume_main(&s.state), 0);
    ck_assert_uint_eq(s.state.contact.attempt, 11);
    ck_assert_uint_eq(s.state.contact.accepted, 7);
    ck_assert_uint_eq(s.report.steps, 5);
    ck_assert_uint_eq(s.state.grid.now, lasting.grid.now);
    ck_assert_uint_eq(s.state.grid.length, lasting.grid.length);
    free(saved.bytes);
    session_end(&s);
}
