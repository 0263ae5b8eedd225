/* The contents of a checkpoint. Fields come from their table (cloth/flow/state/fields.h): every
 * lasting field is saved without a word here. */
#include "cloth/flow/checkpoint/checkpoint.h"

#include "cloth/flow/contact/contact.h"
#include "cloth/flow/contact/mode.h"

#include <string.h>

enum { LAYOUT_VERSION = 1 }; /* raised for changes that sizes and names do not show */

size_t flow_saved_width(duite_type type)
{
    switch (type) {
    case DUITE_BYTE:
        return 1;
    case DUITE_I32:
        return 4;
    default:
        return 8;
    }
}

size_t flow_saved_main_bytes(const struct flow_saved *saved)
{
    const size_t ties = saved->has_ties ? saved->n_blocks * sizeof(struct flow_tie_room) +
                                              ((size_t)saved->n_blocks + 1) * sizeof(uint32_t) +
                                              2 * (size_t)saved->n_others * sizeof(uint32_t)
                                        : 0;
    const size_t bytes = sizeof *saved + ties + saved->n_meetings * sizeof(struct flow_saved_side) +
                         saved->n_kept * sizeof(uint32_t);
    return (bytes + 7) / 8 * 8;
}

struct flow_saved_arrays flow_saved_arrays(const struct flow_saved *saved,
                                           const unsigned char *bytes)
{
    struct flow_saved_arrays arrays = {0};
    void *at = (unsigned char *)bytes + sizeof *saved; /* users of const bytes do not write */
    if (saved->has_ties) {
        arrays.tied.room = at;
        arrays.tied.first = (void *)(arrays.tied.room + saved->n_blocks);
        arrays.tied.other = arrays.tied.first + saved->n_blocks + 1;
        arrays.tied.place = arrays.tied.other + saved->n_others;
        at = arrays.tied.place + saved->n_others;
    }
    arrays.side = at;
    arrays.kept = (void *)(arrays.side + saved->n_meetings);
    return arrays;
}

/* A field that takes turns is saved by the object whose turn it is. */
static bool is_saved(const struct model *model, int field)
{
    return !flow_fields[field].place && flow_fields[field].life(model) == FLOW_STATE_FIELD;
}

uint64_t flow_saved_layout(const struct model *model)
{
    const uint64_t sizes[] = {LAYOUT_VERSION,           sizeof(struct flow_saved),
                              sizeof(struct flow_list), sizeof(struct flow_contact),
                              sizeof(phys_vec),         sizeof(struct flow_tie_room)};
    uint64_t hash = XXH64(sizes, sizeof sizes, 0);
    for (int field = 0; field < FLOW_FIELDS_OF_ALL; field++) {
        const struct flow_field *is = flow_fields + field;
        const uint64_t shape[] = {(uint64_t)is->type, is->width};
        if (!is_saved(model, field))
            continue;
        hash = XXH64(is->name, strlen(is->name), hash);
        hash = XXH64(shape, sizeof shape, hash);
    }
    return hash;
}

size_t flow_saved_objects(const struct flow_state *state, uint32_t block, duite_object *refs)
{
    const struct model *model = state->flow->model;
    const bool of_run = block == state->flow->tables.n_blocks;
    const int from = of_run ? FLOW_FIELDS_OF_BLOCK : 0;
    const int to = of_run ? FLOW_FIELDS_OF_ALL : FLOW_FIELDS_OF_BLOCK;
    duite_object *end = refs;
    for (int field = from; field < to; field++)
        if (is_saved(model, field) && flow_fields[field].exists(state, of_run ? 0 : block))
            *end++ = flow_field_object(state, (enum flow_field_id)field, of_run ? 0 : block);
    return (size_t)(end - refs);
}
