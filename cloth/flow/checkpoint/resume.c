/* A run goes on from another run's checkpoint. Rank 0 has its bytes; it sends the main program's
 * state to all ranks, and each block's state to the block's present home. Halos and tables are made
 * again. */
#include "cloth/flow/checkpoint/checkpoint.h"

#include "cloth/flow/contact/body.h"
#include "cloth/flow/contact/contact.h"
#include "cloth/flow/contact/mode.h"
#include "cloth/flow/run/setup.h"
#include "cloth/flow/solver/levels.h"
#include "cloth/flow/solver/solve.h"
#include "cloth/flow/state/bodies.h"

#include "cloth/base/memory.h"

#include <stdlib.h>
#include <string.h>

enum { TRAVEL = 16 }; /* blocks on their way */

/* ---- Before the run, on rank 0 ---- */

static int refuse_checkpoint(struct cloth_error *error, const char *why)
{
    return cloth_fail(error, CLOTH_E_INPUT, "the checkpoint %s", why);
}

/* True if the checkpoint's run is complete: it cannot go on. */
static bool is_complete(const struct flow_saved *saved, uint64_t end)
{
    return saved->finished && (saved->lasting.over || saved->lasting.grid.now >= end);
}

int flow_resume(struct flow *flow, struct flow_checkpoint from, struct flow_resumed *at,
                struct cloth_error *error)
{
    struct flow_saved saved;
    const uint64_t end = flow->n_steps * FLOW_TICKS;
    const double tick = flow->model->h / FLOW_TICKS;
    if (from.n >= sizeof saved)
        memcpy(&saved, from.bytes, sizeof saved);
    if (from.n < sizeof saved || saved.layout != flow_saved_layout(flow->model))
        return refuse_checkpoint(error,
                                 "is of another version of duite, or of another kind of processor");
    if (saved.main_bytes > from.n || saved.main_bytes != flow_saved_main_bytes(&saved))
        return refuse_checkpoint(error, "is no whole one");
    if (saved.n_vertices != flow->n_vertices || saved.n_blocks != flow->source.blocks.n_blocks ||
        saved.partition_hash != flow->partition_hash)
        return refuse_checkpoint(error, "has other blocks of vertices");
    if (end < saved.end)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "the run of the checkpoint is to end at %g s: an end may be later, not "
                          "%g s",
                          (double)saved.end * tick, (double)end * tick);
    const char *wrong = flow_saved_wrong(flow, from.bytes);
    if (wrong)
        return refuse_checkpoint(error, wrong);
    flow->from = from;
    *at = (struct flow_resumed){.steps = saved.report.steps,
                                .frames = is_complete(&saved, end) ? saved.lasting.next_frame
                                                                   : saved.lasting.certain.next,
                                .time = (double)saved.lasting.grid.now * tick,
                                .end = (double)saved.end * tick};
    return CLOTH_OK;
}

/* ---- State of the main program ---- */

FLOW_KERNEL_WITH(resume_main, FLOW_NO_PART, struct flow_block_args, (GIVEN_W(sent)), .fixed = 1)
{
    memcpy(on->sent, flow_of(call)->from.bytes,
           duite_count(call, FLOW_INDEX_OF(resume_main, sent)));
    return 0;
}

/* Frames that only the end of the earlier run called for are shown again, at their right times. */
static void take_report(struct flow_state *state, const struct flow_saved *saved)
{
    const uint64_t end = state->grid.end;
    state->complete = is_complete(saved, end);
    state->lasting = saved->lasting;
    state->grid.end = end;
    if (!state->complete) {
        state->next_frame = state->certain.next;
        state->shown = state->certain.shown;
    }
    *state->report = saved->report;
    state->saved_wall = saved->report.wall_seconds;
    state->attempt.begin = state->grid.now;
    state->contact.attempt = saved->attempt;
    state->contact.accepted = saved->accepted;
    state->flow->frames = state->next_frame;
}

static void take_main(struct flow_state *state, const unsigned char *from)
{
    struct flow_saved saved;
    memcpy(&saved, from, sizeof saved);
    const struct flow_saved_arrays arrays = flow_saved_arrays(&saved, from);
    take_report(state, &saved);
    if (saved.has_ties)
        flow_ties_again(state, &arrays.tied);
    if (model_seeks(state->flow->model))
        flow_noted(state, flow_contact_meet_again(state, saved.n_meetings, arrays.side));
    for (uint32_t b = 0; b < saved.n_kept; b++)
        flow_contact_keep(state, b, FLOW_FIELD_contacts, arrays.kept[b]);
}

int flow_resume_main(struct flow_state *state)
{
    unsigned char *main = cloth_alloc(state->head.resumed_bytes, 1, &state->flow->trouble);
    state->grid.end = state->flow->n_steps * FLOW_TICKS;
    if (!flow_memory_agree(state) &&
        !flow_broadcast(state, &flow_kernel_resume_main, state->head.resumed_bytes, main))
        take_main(state, main);
    free(main);
    return state->code;
}

/* ---- State of blocks ---- */

/* Where the objects of the next block are, on rank 0: bytes of the checkpoint. */
struct load_args {
    uint32_t block; /* n_blocks: those of the run */
    bool keeps;     /* the last one is the list of its contacts */
    uint64_t at;
};

/* How many bytes an object has; UINT64_MAX: the checkpoint ends before. */
static uint64_t bytes_at(const struct flow_checkpoint *from, uint64_t at)
{
    uint64_t bytes;
    if (at > from->n || from->n - at < sizeof bytes)
        return UINT64_MAX;
    memcpy(&bytes, from->bytes + at, sizeof bytes);
    return bytes <= from->n - at - sizeof bytes ? bytes : UINT64_MAX;
}

/* Where the object behind that one is; UINT64_MAX: there is none. */
static uint64_t next_at(uint64_t at, uint64_t bytes)
{
    return bytes == UINT64_MAX ? bytes : at + sizeof bytes + (bytes + 7) / 8 * 8;
}

/* Checks the list of a block and makes its index again. */
static bool is_list(const struct flow *flow, uint32_t block, const duite_param *to, uint64_t bytes)
{
    struct flow_list *list = to->data;
    const uint32_t n_blocks = flow->tables.n_blocks;
    if (bytes > to->max || !flow_saved_are_contacts(flow, block, to->data, bytes))
        return false;
    return !list->n || (flow_contact_index_room(list->n, n_blocks) <= to->max &&
                        flow_contact_index(list, n_blocks) == bytes);
}

/* Checks the numbers of x and v, the first objects of a block. */
static bool is_field(const struct flow *flow, uint32_t block, const duite_param *to, size_t i)
{
    return block == flow->tables.n_blocks || i > 1 || flow_saved_is_place(to->data, to->count);
}

FLOW_KERNEL_WITH(resume_load, FLOW_NO_PART, struct load_args, (REST_W(saved_objects)), .fixed = 1)
{
    const struct load_args *args = on->args;
    const struct flow *flow = flow_of(call);
    const struct flow_checkpoint *from = &flow->from;
    uint64_t at = args->at;
    for (size_t i = 0; i < on->n_saved_objects; i++) {
        const duite_param *to = on->saved_objects + i;
        const size_t width = flow_saved_width(to->type);
        const uint64_t bytes = bytes_at(from, at);
        const bool list = args->keeps && i == on->n_saved_objects - 1;
        if (list ? bytes > to->max : bytes != to->count * width)
            return duite_fail(call, FLOW_UNFIT, "the checkpoint has a block of another size");
        memcpy(to->data, from->bytes + at + sizeof bytes, bytes);
        if (list ? !is_list(flow, args->block, to, bytes) : !is_field(flow, args->block, to, i))
            return duite_fail(call, FLOW_UNFIT,
                              "the checkpoint has places or contacts that no run comes to");
        if (list && bytes != to->count && duite_resize(call, i, bytes))
            return duite_fail(call, FLOW_NO_MEMORY, "out of memory for the contacts of a block");
        at = next_at(at, bytes);
    }
    return 0;
}

/* Runs at the block's home and writes last, so that the home holds the objects. */
FLOW_KERNEL(resume, FLOW_NO_PART, struct flow_block_args,
            (R(table), RW(x), RW(v), W(halo_x), W(halo_v)))
{
    const struct flow_table table = flow_table_in(call, on->table);
    flow_write_halo(&table, on->x, on->halo_x);
    flow_write_halo(&table, on->v, on->halo_v);
    return 0;
}

/* Rank 0 alone knows where the next block's are. */
static void skip(const struct flow_state *state, size_t n, struct load_args *args)
{
    const struct flow_checkpoint *from = &state->flow->from;
    for (size_t i = 0; i < n && from->bytes; i++)
        args->at = next_at(args->at, bytes_at(from, args->at));
}

static void load_all(struct flow_state *state)
{
    const uint32_t n_blocks = state->flow->tables.n_blocks;
    duite_object refs[FLOW_MAX_PARAMETERS + FLOW_FIELDS_OF_ALL];
    duite_object *rest = refs + FLOW_MAX_PARAMETERS;
    struct load_args args = {.at = state->head.resumed_bytes};
    for (uint32_t b = 0; b <= n_blocks && !state->code; b++) {
        const struct flow_block_args block = {b};
        args.block = b;
        args.keeps = b < n_blocks && flow_contact_mode(state->flow->model)->carries;
        const size_t n = flow_saved_objects(state, b, rest);
        if (n)
            flow_fork_with_at(state, 0, &flow_kernel_resume_load, &args,
                              &(struct flow_with){.n = n, .rest = rest});
        skip(state, n, &args);
        if (b < n_blocks)
            flow_fork_one(state, &flow_kernel_resume, &block);
        if (b % TRAVEL == TRAVEL - 1)
            flow_noted(state, duite_wait(state->rt));
    }
}

int flow_resume_blocks(struct flow_state *state)
{
    const struct model *model = state->flow->model;
    load_all(state);
    flow_levels_initialise(state);
    if (!model_is_filtered(model))
        flow_coarse_initialise(state);
    if (!state->code)
        flow_noted(state, flow_contact_resume(state));
    return flow_noted(state, duite_wait(state->rt)); /* the bytes are not read any more */
}
