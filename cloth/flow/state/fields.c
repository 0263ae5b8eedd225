/* The table of fields: the columns of the list in fields.h as functions, and the list by number. */
#include "cloth/flow/state/bodies.h"

#include "cloth/flow/contact/body.h"
#include "cloth/flow/contact/contact.h"
#include "cloth/flow/contact/image.h"
#include "cloth/flow/contact/mode.h"
#include "cloth/flow/contact/skin.h"
#include "cloth/flow/integrators/integrator.h"
#include "cloth/flow/solver/solver.h"

/* ---- The words of the columns ---- */

static struct flow_tie_room tie_room(const struct flow_state *state, uint32_t block)
{
    return state->tied.now.room ? state->tied.now.room[block] : (struct flow_tie_room){0};
}

static struct flow_body_place bodies_end(const struct model *model)
{
    return flow_body_place(model, model->n_obstacles);
}

static size_t tie_table_bytes(uint32_t n, struct flow_tie_room room)
{
    return flow_ties_bytes(n, &room);
}

static size_t box_bytes(struct contact_skin skin)
{
    return contact_boxes_bytes(&skin);
}

/* The diagonal, the filter if there is one, the values of the entries, those of ties, the ties that
 * add something: flow_matrix_in, flow_tie_values, flow_ties_solved. */
static size_t matrix_numbers(const struct flow_table *t, bool is_filtered, uint32_t ties)
{
    const size_t filter = is_filtered ? 4 * (size_t)t->n : 0;
    return 4 * (flow_diagonal_rows(t) + flow_value_rows(t) + ties + flow_acting_rows(ties)) +
           filter;
}

/* The size of one of a block's three lists of contacts. */
static size_t list_bytes(const struct flow_state *state, uint32_t block,
                         enum flow_field_id contacts)
{
    const uint32_t room = flow_kept_list(state, block, contacts)->room;
    return flow_contact_index_room(room, state->flow->tables.n_blocks);
}

/* A word is a function of the state and a block, whose shape is t. */
#define WORD(type, name, value)                                                                    \
    static type name(const struct flow_state *state, uint32_t block)                               \
    {                                                                                              \
        const struct flow *flow = state->flow;                                                     \
        const struct flow_table *t = flow->tables.block + block;                                   \
        const struct model *model = flow->model;                                                   \
        (void)t, (void)model;                                                                      \
        return value;                                                                              \
    }
#define ROWS(name, value)   WORD(size_t, name, value)
#define EXISTS(name, value) WORD(bool, name, value)
#define LIFE(name, value)                                                                          \
    static enum flow_life name(const struct model *model)                                          \
    {                                                                                              \
        (void)model;                                                                               \
        return value;                                                                              \
    }

/* clang-format off */
/* How many rows. tie_links: the first says how many. record_bytes: a block may have links to all. */
ROWS(one,           1)
ROWS(rows,          t->n)
ROWS(halo,          t->n_halo)
ROWS(ghosts,        t->n_ghosts)
ROWS(tie_rows,      tie_room(state, block).rows)
ROWS(tie_links,     1 + (size_t)tie_room(state, block).others)
ROWS(tie_count,     tie_room(state, block).ties)
ROWS(tie_bytes,     tie_table_bytes(t->n, tie_room(state, block)))
ROWS(ghosts_tied,   ghosts(state, block) + tie_rows(state, block))
ROWS(record_bytes,  sizeof(struct flow_tie_record) + flow->tables.n_blocks * sizeof(struct flow_tie_link))
ROWS(records_bytes, flow->tables.n_blocks * record_bytes(state, block))
ROWS(contacts_bytes,      list_bytes(state, block, FLOW_FIELD_contacts))
ROWS(kept_contacts_bytes, list_bytes(state, block, FLOW_FIELD_kept_contacts))
ROWS(contacts_next_bytes, list_bytes(state, block, FLOW_FIELD_contacts_next))
ROWS(sides,         (size_t)flow->tables.n_blocks + model->n_obstacles)
ROWS(obstacles,     model->n_obstacles)
ROWS(body_skins,    bodies_end(model).skin)
ROWS(body_fans,     bodies_end(model).vertex)
ROWS(body_points,   bodies_end(model).point)
ROWS(body_boxes,    bodies_end(model).boxes)
ROWS(map_bytes,     flow_map_bytes(flow, block))
ROWS(watched,       t->n_watched)
ROWS(table_bytes,   flow_table_bytes(t))
ROWS(skin_bytes,    flow_skin_bytes(t))
ROWS(skin_points,   2 * (size_t)t->skin.n_points)
ROWS(skin_boxes,    box_bytes(flow_skin_counts(t)))
ROWS(matrix,        matrix_numbers(t, model_is_filtered(model), tie_room(state, block).ties))
ROWS(factor,        1 + flow_factor_shifted(t, flow->conditioner.local))
ROWS(part,          flow_part_doubles(flow))
ROWS(couplings,     SOLVE_COUPLING * flow_coupling_at(flow, flow->patches * (block + 1) - 1, UINT32_MAX))
ROWS(dots,          flow_dots(flow))
ROWS(coarse_factor, solve_coarse_doubles(&flow->pattern))
ROWS(patches,       flow->patches)
ROWS(lifted,        flow->first_lifted[flow->n_levels])
ROWS(motion,        flow_motion_doubles(flow))
ROWS(pulled_seams,  model->n_pulled)
ROWS(pieces,        state->head.n_pieces)

/* When a field exists. */
EXISTS(always,       true)
EXISTS(kept,         model_keeps(model))
EXISTS(implicit_run, model_is_implicit(model))
EXISTS(explicit_run, !model_is_implicit(model))
EXISTS(sweeps,       flow_contact_mode(model)->sweeps)
EXISTS(feels,        flow_feels_contact(state))
EXISTS(meets,        model_seeks(model))
EXISTS(shows_force,  flow_shows_contact(state))
EXISTS(meets_bodies, flow_bodies_are_met(model))
EXISTS(mapped,       block < flow_map_strips(flow))
EXISTS(corrected,    model->correction_rounds > 0)
EXISTS(in_stages,    flow_integrator(model)->in_stages)
EXISTS(staged,       flow_integrator(model)->in_stages || flow_integrator(model)->ends_forces)
EXISTS(two_steps,    flow_integrator(model)->two_steps)
EXISTS(keeps_guess,  sweeps(state, block) && model_is_linear(model) && model->guess != MODEL_GUESS_ZERO)
EXISTS(keeps_last,   sweeps(state, block) && two_steps(state, block))
EXISTS(based,        two_steps(state, block) || (implicit_run(state, block) && model->newton_steps > 1))
EXISTS(filtered,     implicit_run(state, block) && model_is_filtered(model))
EXISTS(conditioned,  flow_is_preconditioned(flow))
EXISTS(plain_solve,  implicit_run(state, block) && !flow_is_preconditioned(flow))
EXISTS(coarse_run,   flow->conditioner.coarse)
EXISTS(by_levels,    flow->n_levels)
EXISTS(may_be_tied,  flow->n_ties > 0 || model_seeks(model))
EXISTS(solves_tied,  may_be_tied(state, block) && implicit_run(state, block))
EXISTS(coarse_tied,  may_be_tied(state, block) && coarse_run(state, block))
EXISTS(probed,       flow_writes_probes(state) && t->n_watched)
EXISTS(in_pieces,    state->head.n_pieces)
EXISTS(tied_pieces,  in_pieces(state, block) && may_be_tied(state, block))

/* The use between two steps. derived_once: the filter, and so the basis, changes in each step with
 * sliders that move. state_of_ends: a step may begin with the forces that ended the one before.
 * state_of_guess: a linear step may begin its solve with dv of the step before. state_of_carried:
 * contacts may hand over to those of the next step. state_of_frames: a frame may show the end of the
 * step before. */
LIFE(state_field,       FLOW_STATE_FIELD)
LIFE(derived,           FLOW_DERIVED)
LIFE(work,              FLOW_WORK)
LIFE(derived_once,      model_is_filtered(model) ? FLOW_WORK : FLOW_DERIVED)
LIFE(derived_of_bodies, flow_bodies_move(model) ? FLOW_WORK : FLOW_DERIVED)
LIFE(state_of_ends,     flow_integrator(model)->ends_forces && model_leaves_ends(model) ? FLOW_STATE_FIELD : FLOW_WORK)
LIFE(state_of_guess,    model_is_linear(model) && model->guess != MODEL_GUESS_ZERO ? FLOW_STATE_FIELD : FLOW_WORK)
LIFE(state_of_carried,  flow_contact_mode(model)->carries ? FLOW_STATE_FIELD : FLOW_WORK)
LIFE(state_of_frames,   model->contact.force ? FLOW_STATE_FIELD : FLOW_WORK)
/* clang-format on */

/* ---- The table ---- */

#define TYPE_OF(type)                                                                              \
    _Generic((type *)0, unsigned char *                                                            \
             : DUITE_BYTE, struct flow_list *                                                      \
             : DUITE_BYTE, uint32_t *                                                              \
             : DUITE_I32, int64_t *                                                                \
             : DUITE_I64, uint64_t *                                                               \
             : DUITE_I64, default                                                                  \
             : DUITE_F64)
#define FIELD(name, turns, place, type, width, rows, exists, life)                                 \
    {#name, turns, place, TYPE_OF(type), width, rows, exists, life},
#define ROW(name, many, ...) ROW_##many(name, __VA_ARGS__)
#define ROW_ONE(name, ...)   FIELD(name, FLOW_ONE, 0, __VA_ARGS__)
#define ROW_SIZED(name, ...) FIELD(name, FLOW_SIZED, 0, __VA_ARGS__)
#define ROW_BY_PASS(name, ...)                                                                     \
    FIELD(name, FLOW_BY_PASS, 0, __VA_ARGS__) FIELD(name, FLOW_BY_PASS, 1, __VA_ARGS__)

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
