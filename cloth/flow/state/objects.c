/* Loops over the table of fields (fields.h) make, free, find and swap their objects. A block's
 * objects live where its positions live. Mappings see the graph of the blocks: a block weighs its
 * vertices, and two blocks exchange the ghosts of each. */
#include "cloth/flow/contact/contact.h"
#include "cloth/flow/state/bodies.h"

#include <stddef.h>

/* Makes a field's object if it exists, beside x (except x itself). The next get returns a failure
 * again. */
static void make_field(struct flow_state *state, enum flow_field_id field, uint32_t block,
                       duite_object *object)
{
    if (!flow_fields[field].exists(state, block))
        return;
    const size_t numbers = flow_field_numbers(state, field, block);
    if (flow_fields[field].turns == FLOW_SIZED)
        duite_new_sized(state->rt, flow_fields[field].type, 0, numbers, object);
    else
        duite_new(state->rt, flow_fields[field].type, numbers, object);
    if (field != FLOW_FIELD_x)
        duite_colocate(state->rt, *object, state->block[block].x);
}

void flow_object_again(struct flow_state *state, enum flow_field_id field, uint32_t block)
{
    duite_object *object = field < FLOW_FIELDS_OF_BLOCK
                               ? state->block[block].of + field
                               : state->run.of + (field - FLOW_FIELDS_OF_BLOCK);
    duite_free(state->rt, *object);
    make_field(state, field, block, object);
}

static void hint_block(struct flow_state *state, uint32_t b)
{
    double *bytes = state->rows;
    const struct flow_tables *tables = &state->flow->tables;
    const struct flow_table *t = tables->block + b;
    for (uint32_t s = 0; s < t->n_neighbours; s++) {
        state->refs[s] = state->block[t->neighbour[s]].x;
        bytes[s] = 3.0 * sizeof(double) * (t->ghost_start[s + 1] - t->ghost_start[s]);
    }
    duite_hint(state->rt, state->block[b].x, t->n, t->n_neighbours, state->refs, bytes);
}

/* Up to the last block that has the field: forks of many blocks look no further. */
static uint32_t blocks_with(const struct flow_state *state, enum flow_field_id field)
{
    uint32_t n = state->flow->tables.n_blocks;
    while (n && !flow_fields[field].exists(state, n - 1))
        n--;
    return n;
}

void flow_objects_make(struct flow_state *state)
{
    const uint32_t n_blocks = state->flow->tables.n_blocks;
    for (int field = 0; field < FLOW_FIELDS_OF_ALL; field++)
        state->flow->made[field] = blocks_with(state, (enum flow_field_id)field);
    for (uint32_t b = 0; b < n_blocks; b++)
        for (int field = 0; field < FLOW_FIELDS_OF_BLOCK; field++)
            make_field(state, (enum flow_field_id)field, b, state->block[b].of + field);
    for (uint32_t b = 0; b < n_blocks; b++)
        hint_block(state, b);
    for (int field = 0; field < FLOW_FIELDS_OF_RUN; field++)
        make_field(state, (enum flow_field_id)(FLOW_FIELDS_OF_BLOCK + field), 0,
                   state->run.of + field);
}

/* Numbers of a field of a block; 0 where it does not exist. */
static size_t numbers_made(const struct flow_state *state, enum flow_field_id field, uint32_t block)
{
    return flow_fields[field].exists(state, block) ? flow_field_numbers(state, field, block) : 0;
}

void flow_objects_fit(struct flow_state *state, uint32_t block, const struct flow_tie_room *room)
{
    size_t before[FLOW_FIELDS_OF_BLOCK];
    for (int field = 0; field < FLOW_FIELDS_OF_BLOCK; field++)
        before[field] = numbers_made(state, (enum flow_field_id)field, block);
    state->tied.now.room[block] = *room;
    for (int field = 0; field < FLOW_FIELDS_OF_BLOCK; field++)
        if (before[field] != numbers_made(state, (enum flow_field_id)field, block))
            flow_object_again(state, (enum flow_field_id)field, block);
}

/* Frees the objects that were made; the others are zero. */
static void free_objects(struct flow_state *state, size_t n, const duite_object *object)
{
    for (size_t i = 0; i < n; i++)
        if (object[i].generation)
            flow_noted(state, duite_free(state->rt, object[i]));
}

int flow_objects_free(struct flow_state *state)
{
    state->code = DUITE_OK; /* of the run, which is over */
    if (state->solve.generation)
        flow_noted(state, duite_graph_free(state->rt, state->solve));
    if (state->correct.generation)
        flow_noted(state, duite_graph_free(state->rt, state->correct));
    flow_contact_part(state);
    for (uint32_t i = 0; i < state->packed.n; i++)
        free_objects(state, 2, state->packed.halo[i].object);
    for (uint32_t g = 0; g < state->groups.n; g++) {
        const struct flow_group *group = state->groups.all + g;
        const duite_object all[] = {group->factor, group->coupling, group->part, group->motion};
        free_objects(state, sizeof all / sizeof *all, all);
    }
    for (uint32_t b = 0; state->block && b < state->flow->tables.n_blocks; b++)
        free_objects(state, FLOW_FIELDS_OF_BLOCK, state->block[b].of);
    free_objects(state, FLOW_FIELDS_OF_RUN, state->run.of);
    return state->code;
}

size_t flow_field_place(const struct flow_state *state, enum flow_field_id field)
{
    const struct flow_field *is = flow_fields + field;
    const unsigned turn = is->turns == FLOW_BY_PASS ? state->pass : 0;
    return field - is->place + (is->place ^ turn);
}

duite_object flow_field_object(const struct flow_state *state, enum flow_field_id field,
                               uint32_t block)
{
    const size_t place = flow_field_place(state, field);
    return field < FLOW_FIELDS_OF_BLOCK ? state->block[block].of[place]
                                        : state->run.of[place - FLOW_FIELDS_OF_BLOCK];
}

int flow_set(struct flow_state *state, enum flow_field_id field, const void *value)
{
    const duite_object object = flow_field_object(state, field, 0);
    return state->code ? state->code : flow_noted(state, duite_set(state->rt, object, value));
}

int flow_get(struct flow_state *state, enum flow_field_id field, void *value)
{
    const duite_object object = flow_field_object(state, field, 0);
    return state->code ? state->code : flow_noted(state, duite_get(state->rt, object, value));
}

void flow_fields_swap(struct flow_state *state, enum flow_field_id a, enum flow_field_id b)
{
    for (uint32_t i = 0; i < state->flow->tables.n_blocks; i++) {
        duite_object *of = state->block[i].of;
        const duite_object was = of[a];
        of[a] = of[b];
        of[b] = was;
    }
}
