/* The table of fields: the columns of the list in fields.h as functions, and the list by number. */
#include "cloth/flow/state/bodies.h"

#include "cloth/flow/contact/body.h"
#include "cloth/flow/contact/image.h"
#include "cloth/flow/contact/mode.h"
#include "cloth/flow/contact/skin.h"
#include "cloth/flow/integrators/integrator.h"
#include "cloth/flow/observe/observe.h"
#include "cloth/flow/solver/solver.h"
#include "cloth/flow/state/life.h"

/* ---- How many rows ---- */

static const struct flow_table *table_of(const struct flow_state *state, uint32_t block)
{
    return state->flow->tables.block + block;
}

static size_t one(const struct flow_state *state, uint32_t block)
{
    (void)state, (void)block;
    return 1;
}

static size_t rows(const struct flow_state *state, uint32_t block)
{
    return table_of(state, block)->n;
}

static size_t halo(const struct flow_state *state, uint32_t block)
{
    return table_of(state, block)->n_halo;
}

static size_t ghosts(const struct flow_state *state, uint32_t block)
{
    return table_of(state, block)->n_ghosts;
}

static struct flow_tie_room tie_room(const struct flow_state *state, uint32_t block)
{
    return state->tied.now.room ? state->tied.now.room[block] : (struct flow_tie_room){0};
}

static size_t tie_rows(const struct flow_state *state, uint32_t block)
{
    return tie_room(state, block).rows;
}

/* The first says how many. */
static size_t tie_links(const struct flow_state *state, uint32_t block)
{
    return 1 + (size_t)tie_room(state, block).others;
}

static size_t ghosts_tied(const struct flow_state *state, uint32_t block)
{
    return ghosts(state, block) + tie_rows(state, block);
}

static size_t tie_bytes(const struct flow_state *state, uint32_t block)
{
    const struct flow_tie_room room = tie_room(state, block);
    return flow_ties_bytes(table_of(state, block)->n, &room);
}

static size_t blocks(const struct flow_state *state, uint32_t block)
{
    (void)block;
    return state->flow->tables.n_blocks;
}

static size_t sides(const struct flow_state *state, uint32_t block)
{
    return blocks(state, block) + state->flow->model->n_obstacles;
}

static size_t obstacles(const struct flow_state *state, uint32_t block)
{
    (void)block;
    return state->flow->model->n_obstacles;
}

static struct flow_body_place bodies_end(const struct flow_state *state)
{
    return flow_body_place(state->flow->model, state->flow->model->n_obstacles);
}

static size_t body_skins(const struct flow_state *state, uint32_t block)
{
    (void)block;
    return bodies_end(state).skin;
}

static size_t body_fans(const struct flow_state *state, uint32_t block)
{
    (void)block;
    return bodies_end(state).vertex;
}

static size_t body_points(const struct flow_state *state, uint32_t block)
{
    (void)block;
    return bodies_end(state).point;
}

static size_t body_boxes(const struct flow_state *state, uint32_t block)
{
    (void)block;
    return bodies_end(state).boxes;
}

static size_t map_bytes(const struct flow_state *state, uint32_t block)
{
    return flow_map_bytes(state->flow, block);
}

/* The record of a block's ties: it may have links to all blocks. */
static size_t record_bytes(const struct flow_state *state, uint32_t block)
{
    return sizeof(struct flow_tie_record) + blocks(state, block) * sizeof(struct flow_tie_link);
}

static size_t records_bytes(const struct flow_state *state, uint32_t block)
{
    return blocks(state, block) * record_bytes(state, block);
}

static size_t tie_count(const struct flow_state *state, uint32_t block)
{
    return tie_room(state, block).ties;
}

static size_t watched(const struct flow_state *state, uint32_t block)
{
    return table_of(state, block)->n_watched;
}

static size_t saved(const struct flow_state *state, uint32_t block)
{
    return flow_system_doubles(table_of(state, block), tie_room(state, block).ties);
}

static size_t table_bytes(const struct flow_state *state, uint32_t block)
{
    return flow_table_bytes(table_of(state, block));
}

static size_t skin_bytes(const struct flow_state *state, uint32_t block)
{
    return flow_skin_bytes(table_of(state, block));
}

static size_t skin_points(const struct flow_state *state, uint32_t block)
{
    return 2 * (size_t)table_of(state, block)->skin.n_points;
}

static size_t skin_boxes(const struct flow_state *state, uint32_t block)
{
    const struct contact_skin skin = flow_skin_counts(table_of(state, block));
    return contact_boxes_bytes(&skin);
}

/* The diagonal, the filter if there is one, the values of the entries, those of ties, the ties that
 * add something: flow_matrix_in, flow_tie_values, flow_ties_solved. */
static size_t matrix(const struct flow_state *state, uint32_t block)
{
    const struct flow_table *t = table_of(state, block);
    const size_t filter = model_is_filtered(state->flow->model) ? 4 * (size_t)t->n : 0;
    const uint32_t ties = tie_room(state, block).ties;
    return 4 * (flow_diagonal_rows(t) + flow_value_rows(t) + ties + flow_acting_rows(ties)) +
           filter;
}

static size_t factor(const struct flow_state *state, uint32_t block)
{
    const struct flow_table *t = table_of(state, block);
    return solve_local_doubles(t->n, t->n_entries, flow_local(state->flow));
}

static size_t part(const struct flow_state *state, uint32_t block)
{
    (void)block;
    return flow_part_doubles(state->flow);
}

static size_t couplings(const struct flow_state *state, uint32_t block)
{
    const uint32_t last = state->flow->patches * (block + 1) - 1;
    return SOLVE_COUPLING * flow_coupling_at(state->flow, last, UINT32_MAX);
}

static size_t dots(const struct flow_state *state, uint32_t block)
{
    (void)block;
    return flow_dots(state->flow);
}

static size_t coarse_factor(const struct flow_state *state, uint32_t block)
{
    (void)block;
    return solve_coarse_doubles(&state->flow->pattern);
}

static size_t patches(const struct flow_state *state, uint32_t block)
{
    (void)block;
    return state->flow->patches;
}

static size_t lifted(const struct flow_state *state, uint32_t block)
{
    (void)block;
    return state->flow->first_lifted[state->flow->n_levels];
}

static size_t motion(const struct flow_state *state, uint32_t block)
{
    (void)block;
    return flow_motion_doubles(state->flow);
}

static size_t pulled_seams(const struct flow_state *state, uint32_t block)
{
    (void)block;
    return state->flow->model->n_pulled;
}

static size_t pieces(const struct flow_state *state, uint32_t block)
{
    (void)block;
    return state->head.n_pieces;
}

/* ---- When a field exists ---- */

static bool always(const struct flow_state *state, uint32_t block)
{
    (void)state, (void)block;
    return true;
}

static bool kept(const struct flow_state *state, uint32_t block)
{
    (void)block;
    return model_keeps(state->flow->model);
}

static bool implicit_run(const struct flow_state *state, uint32_t block)
{
    (void)block;
    return model_is_implicit(state->flow->model);
}

static bool sweeps(const struct flow_state *state, uint32_t block)
{
    (void)block;
    return flow_contact_mode(state->flow->model)->sweeps;
}

static bool feels(const struct flow_state *state, uint32_t block)
{
    (void)block;
    return flow_feels_contact(state);
}

static bool meets(const struct flow_state *state, uint32_t block)
{
    (void)block;
    return model_seeks(state->flow->model);
}

static bool shows_force(const struct flow_state *state, uint32_t block)
{
    (void)block;
    return flow_shows_contact(state);
}

static bool meets_bodies(const struct flow_state *state, uint32_t block)
{
    (void)block;
    return flow_bodies_are_met(state->flow->model);
}

static bool mapped(const struct flow_state *state, uint32_t block)
{
    return block < flow_map_strips(state->flow);
}

static bool corrected(const struct flow_state *state, uint32_t block)
{
    (void)block;
    return state->flow->model->correction_rounds > 0;
}

static bool explicit_run(const struct flow_state *state, uint32_t block)
{
    return !implicit_run(state, block);
}

static const struct flow_integrator *integrator_of(const struct flow_state *state)
{
    return flow_integrators + state->flow->model->integrator;
}

static bool in_stages(const struct flow_state *state, uint32_t block)
{
    (void)block;
    return integrator_of(state)->in_stages;
}

static bool staged(const struct flow_state *state, uint32_t block)
{
    (void)block;
    return integrator_of(state)->in_stages || integrator_of(state)->ends_forces;
}

static bool two_steps(const struct flow_state *state, uint32_t block)
{
    (void)block;
    return integrator_of(state)->two_steps;
}

static bool based(const struct flow_state *state, uint32_t block)
{
    return two_steps(state, block) ||
           (implicit_run(state, block) && state->flow->model->newton_steps > 1);
}

static bool filtered(const struct flow_state *state, uint32_t block)
{
    return implicit_run(state, block) && model_is_filtered(state->flow->model);
}

static bool conditioned(const struct flow_state *state, uint32_t block)
{
    (void)block;
    return flow_is_preconditioned(state->flow);
}

static bool plain_solve(const struct flow_state *state, uint32_t block)
{
    return implicit_run(state, block) && !conditioned(state, block);
}

static bool coarse_run(const struct flow_state *state, uint32_t block)
{
    (void)block;
    return flow_is_coarse(state->flow);
}

static bool by_levels(const struct flow_state *state, uint32_t block)
{
    (void)block;
    return state->flow->n_levels;
}

static bool may_be_tied(const struct flow_state *state, uint32_t block)
{
    return state->flow->n_ties > 0 || meets(state, block);
}

static bool solves_tied(const struct flow_state *state, uint32_t block)
{
    return may_be_tied(state, block) && implicit_run(state, block);
}

static bool coarse_tied(const struct flow_state *state, uint32_t block)
{
    return may_be_tied(state, block) && coarse_run(state, block);
}

static bool probed(const struct flow_state *state, uint32_t block)
{
    return flow_writes_probes(state) && table_of(state, block)->n_watched;
}

static bool saves(const struct flow_state *state, uint32_t block)
{
    return implicit_run(state, block) && state->output && state->output->system;
}

static bool in_pieces(const struct flow_state *state, uint32_t block)
{
    return pieces(state, block);
}

static bool tied_pieces(const struct flow_state *state, uint32_t block)
{
    return in_pieces(state, block) && may_be_tied(state, block);
}

/* ---- The table ---- */

#define TYPE_OF(type)                                                                              \
    _Generic((type *)0, unsigned char *                                                            \
             : DUITE_BYTE, uint32_t *                                                              \
             : DUITE_I32, int64_t *                                                                \
             : DUITE_I64, uint64_t *                                                               \
             : DUITE_I64, default                                                                  \
             : DUITE_F64)
#define FIELD(name, turns, place, type, width, rows, exists, life)                                 \
    {#name, turns, place, TYPE_OF(type), width, rows, exists, flow_##life},
#define ROW(name, many, ...)   ROW_##many(name, __VA_ARGS__)
#define ROW_ONE(name, ...)     FIELD(name, FLOW_ONE, 0, __VA_ARGS__)
#define ROW_SIZED(name, ...)   FIELD(name, FLOW_SIZED, 0, __VA_ARGS__)
#define ROW_BY_STEP(name, ...) ROWS(name, FLOW_BY_STEP, __VA_ARGS__)
#define ROW_BY_PASS(name, ...) ROWS(name, FLOW_BY_PASS, __VA_ARGS__)
#define ROWS(name, turns, ...) FIELD(name, turns, 0, __VA_ARGS__) FIELD(name, turns, 1, __VA_ARGS__)

const struct flow_field flow_fields[FLOW_FIELDS_OF_ALL] = {FLOW_FIELDS(ROW)};

_Static_assert(sizeof(struct flow_objects) == FLOW_FIELDS_OF_BLOCK * sizeof(duite_object),
               "a block's objects by name are those by number");
_Static_assert(sizeof(struct flow_run_objects) == FLOW_FIELDS_OF_RUN * sizeof(duite_object),
               "the run's objects by name are those by number");

size_t flow_field_numbers(const struct flow_state *state, enum flow_field_id field, uint32_t block)
{
    const struct flow_field *is = flow_fields + field;
    const size_t n = is->rows(state, block);
    return is->width * (n ? n : 1);
}
