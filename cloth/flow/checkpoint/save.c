/* Tasks on rank 0 copy the lasting state block after block, as for a frame: the next step need not
 * wait for the disk. Each task holds the token of frames. So bytes are in the order of blocks, and
 * all earlier frames and rows are written when the program gets the checkpoint. */
#include "cloth/flow/checkpoint/checkpoint.h"

#include "cloth/flow/contact/mode.h"

#include <stdlib.h>
#include <string.h>

/* ---- The bytes, on rank 0 ---- */

static void give_up_saving(struct flow *flow)
{
    free(flow->saving.bytes);
    flow->saving = (struct flow_checkpoint){0};
    flow->saving_room = 0;
}

/* The next n bytes; NULL: no memory, now or before. */
static unsigned char *append_room(struct flow *flow, size_t n)
{
    struct flow_checkpoint *to = &flow->saving;
    if (!to->bytes)
        return NULL;
    if (to->n + n > flow->saving_room) {
        const size_t room = flow->saving_room + flow->saving_room / 2 + n;
        unsigned char *more = realloc(to->bytes, room);
        if (!more) {
            give_up_saving(flow);
            return NULL;
        }
        to->bytes = more;
        flow->saving_room = room;
    }
    to->n += n;
    return to->bytes + to->n - n;
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
static int save_body(const duite_call *call, const struct save_fields *on)
{
    struct flow *flow = flow_of(call);
    for (size_t i = 0; i < on->n_saved_objects; i++)
        append_object(flow, on->saved_objects + i);
    if (!on->args->last)
        return 0;
    const struct flow_checkpoint whole = flow->saving;
    flow->saving = (struct flow_checkpoint){0};
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
        saved.report.wall_seconds = state->saved_wall + flow_now() - state->from;
    saved.main_bytes = flow_saved_main_bytes(&saved);
    return saved;
}

static unsigned char *save_put_bytes(unsigned char *to, const void *from, size_t n)
{
    if (n)
        memcpy(to, from, n);
    return to + n;
}

static void put_main(const struct flow_state *state, const struct flow_saved *saved,
                     unsigned char *to)
{
    const struct flow_tied_blocks *tied = &state->tied.now;
    const unsigned char *end = to + saved->main_bytes;
    to = save_put_bytes(to, saved, sizeof *saved);
    if (saved->has_ties) {
        to = save_put_bytes(to, tied->room, saved->n_blocks * sizeof *tied->room);
        to = save_put_bytes(to, tied->first, ((size_t)saved->n_blocks + 1) * sizeof *tied->first);
        to = save_put_bytes(to, tied->other, saved->n_others * sizeof *tied->other);
        to = save_put_bytes(to, tied->place, saved->n_others * sizeof *tied->place);
    }
    for (uint32_t i = 0; i < saved->n_meetings; i++) {
        const struct flow_meeting *of = state->contact.meetings.all + i;
        const struct flow_saved_side side = {{of->side[0], of->side[1]}, of->room};
        to = save_put_bytes(to, &side, sizeof side);
    }
    for (uint32_t b = 0; b < saved->n_kept; b++)
        to = save_put_bytes(to, &state->contact.kept[b].n[state->contact.begin], sizeof(uint32_t));
    memset(to, 0, (size_t)(end - to));
}

/* Bytes of a checkpoint without lists, whose length the main program does not know. */
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
    flow->saving_room = saved.main_bytes + fields_bytes(state);
    flow->saving = (struct flow_checkpoint){.bytes = malloc(flow->saving_room)};
    unsigned char *to = append_room(flow, saved.main_bytes);
    if (to)
        put_main(state, &saved, to);
}

int flow_save(struct flow_state *state, bool finished)
{
    const uint32_t n_blocks = state->flow->tables.n_blocks;
    duite_object refs[FLOW_MAX_PARAMETERS + FLOW_FIELDS_OF_ALL + 1];
    duite_object *rest = refs + FLOW_MAX_PARAMETERS;
    int64_t token;
    if (!state->output || !state->output->save)
        return DUITE_OK;
    int code = duite_get(state->rt, state->run.token, &token); /* the one before is over */
    if (!code && duite_rank(state->rt) == 0)
        begin_saving(state, finished);
    for (uint32_t b = 0; b <= n_blocks && !code; b++) {
        const struct save_args args = {.block = b, .last = b == n_blocks};
        const struct flow_given given = {.n = flow_saved_objects(state, b, rest), .rest = rest};
        code = flow_fork_given_at(state, 0, &flow_kernel_save, &args, &given);
    }
    return code;
}
