/* Tasks on rank 0 copy the lasting state block after block, as for a frame: the next step need not
 * wait for the disk. Each task holds the token of frames. So bytes are in the order of blocks, and
 * all earlier frames and rows are written when the program gets the checkpoint. */
#include "cloth/flow/checkpoint/checkpoint.h"

#include "cloth/base/clock.h"

#include "cloth/flow/contact/contact.h"
#include "cloth/flow/contact/mode.h"

#include <stdlib.h>
#include <string.h>

/* ---- The bytes, on rank 0 ---- */

/* The next n bytes; NULL: no memory, now or before. */
static unsigned char *append_room(struct flow *flow, size_t n)
{
    struct cloth_list *to = &flow->saving;
    struct cloth_error ignored = {0}; /* the program gets no bytes */
    unsigned char *room = to->items ? cloth_list_add(to, 1, n, &ignored) : NULL;
    if (room)
        return room;
    free(to->items);
    *to = (struct cloth_list){0};
    return NULL;
}

static void append_object(struct flow *flow, const duite_param *object)
{
    const uint64_t bytes = object->count * flow_saved_width(object->type);
    const size_t whole = ((size_t)bytes + 7) / 8 * 8;
    unsigned char *to = append_room(flow, sizeof bytes + whole);
    if (!to)
        return;
    memcpy(to, &bytes, sizeof bytes);
    memset(to + whole, 0, sizeof bytes); /* the last bytes, where they are no whole ones */
    memcpy(to + sizeof bytes, object->data, bytes);
}

struct save_args {
    uint32_t block;
    uint32_t last; /* not zero: nothing follows */
};

FLOW_KERNEL_WITH(save, FLOW_OUTPUT, struct save_args, (RW(token), REST_R(saved_objects)),
                 .side_effects = 1, .fixed = 1)
{
    struct flow *flow = flow_of(call);
    for (size_t i = 0; i < on->n_saved_objects; i++)
        append_object(flow, on->saved_objects + i);
    if (!on->args->last)
        return 0;
    const struct flow_checkpoint whole = {flow->saving.items, flow->saving.n};
    flow->saving = (struct cloth_list){0};
    flow->output->save(flow->output->context, whole);
    return 0;
}

/* ---- State of the main program ---- */

static struct flow_saved describe_saved(const struct flow_state *state, bool finished)
{
    const struct flow *flow = state->flow;
    const struct flow_tied_blocks *tied = &state->tied.now;
    struct flow_saved saved;
    memset(&saved, 0, sizeof saved); /* padding, too: equal states have equal bytes */
    saved.layout = flow_saved_layout(flow->model);
    saved.partition_hash = flow->partition_hash;
    saved.n_vertices = flow->n_vertices;
    saved.n_blocks = flow->tables.n_blocks;
    saved.has_ties = tied->first != NULL;
    saved.n_others = tied->first ? tied->first[saved.n_blocks] : 0;
    saved.n_meetings = state->contact.meetings.n;
    saved.n_kept = flow_contact_mode(flow->model)->carries ? saved.n_blocks : 0;
    saved.attempt = state->contact.attempt;
    saved.accepted = state->contact.accepted;
    saved.finished = finished;
    saved.end = state->grid.end;
    saved.lasting = state->lasting;
    saved.report = *state->report;
    if (!finished)
        saved.report.wall_seconds = state->saved_wall + cloth_seconds() - state->from;
    saved.main_bytes = flow_saved_main_bytes(&saved);
    return saved;
}

static void put_main(const struct flow_state *state, const struct flow_saved *saved,
                     unsigned char *to)
{
    const struct flow_saved_arrays arrays = flow_saved_arrays(saved, to);
    memset(to, 0, saved->main_bytes);
    memcpy(to, saved, sizeof *saved);
    if (saved->has_ties)
        flow_ties_copy(&state->tied.now, saved->n_blocks, &arrays.tied);
    for (uint32_t i = 0; i < saved->n_meetings; i++) {
        const struct flow_meeting *of = state->contact.meetings.all + i;
        arrays.side[i] = (struct flow_saved_side){{of->side[0], of->side[1]}, of->room};
    }
    for (uint32_t b = 0; b < saved->n_kept; b++)
        arrays.kept[b] = flow_kept_list(state, b, FLOW_FIELD_contacts)->n;
}

/* Bytes of a checkpoint, with lists as long as there is room for. */
static size_t fields_bytes(const struct flow_state *state)
{
    const uint32_t n_blocks = state->flow->tables.n_blocks;
    size_t bytes = 0;
    for (uint32_t b = 0; b < n_blocks; b++)
        for (int field = 0; field < FLOW_FIELDS_OF_BLOCK; field++)
            if (flow_fields[field].life(state->flow->model) == FLOW_STATE_FIELD &&
                flow_fields[field].exists(state, b))
                bytes += 16 + flow_saved_width(flow_fields[field].type) *
                                  flow_field_numbers(state, (enum flow_field_id)field, b);
    return bytes;
}

static void begin_saving(struct flow_state *state, bool finished)
{
    struct flow *flow = state->flow;
    const struct flow_saved saved = describe_saved(state, finished);
    const size_t bytes = saved.main_bytes + fields_bytes(state);
    flow->saving = (struct cloth_list){.items = malloc(bytes), .capacity = bytes};
    unsigned char *to = append_room(flow, saved.main_bytes);
    if (to)
        put_main(state, &saved, to);
}

int flow_save(struct flow_state *state, bool finished)
{
    const uint32_t n_blocks = state->flow->tables.n_blocks;
    duite_object refs[FLOW_MAX_PARAMETERS + FLOW_FIELDS_OF_ALL];
    duite_object *rest = refs + FLOW_MAX_PARAMETERS;
    int64_t token;
    if (!state->output || !state->output->save)
        return DUITE_OK;
    if (!flow_get(state, FLOW_FIELD_token, &token) /* the one before is over */
        && duite_rank(state->rt) == 0)
        begin_saving(state, finished);
    for (uint32_t b = 0; b <= n_blocks; b++) {
        const struct save_args args = {.block = b, .last = b == n_blocks};
        const struct flow_with with = {.n = flow_saved_objects(state, b, rest), .rest = rest};
        flow_fork_with_at(state, 0, &flow_kernel_save, &args, &with);
    }
    return state->code;
}
