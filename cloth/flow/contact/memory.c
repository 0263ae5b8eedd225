/* Memory of contacts besides fields: the main program's, and objects whose number or size changes
 * during the run. */
#include "cloth/flow/contact/contact.h"
#include "cloth/flow/contact/mode.h"
#include "cloth/flow/run/setup.h"

#include "cloth/base/memory.h"
#include "cloth/contact/solid.h"

#include <stdlib.h>

void flow_contact_take(struct flow_state *state)
{
    struct flow_contact_state *contact = &state->contact;
    const uint32_t n_blocks = state->head.n_blocks;
    const size_t n_obstacles = state->flow->model->n_obstacles;
    struct cloth_error *trouble = &state->flow->trouble;
    if (!model_seeks(state->flow->model))
        return;
    contact->kept = cloth_alloc(n_blocks, sizeof *contact->kept, trouble);
    contact->root = cloth_alloc(n_blocks + n_obstacles, FLOW_ROOT * sizeof *contact->root, trouble);
    contact->solid = cloth_alloc(n_obstacles, sizeof *contact->solid, trouble);
    contact->found = cloth_alloc(n_blocks, sizeof *contact->found, trouble);
    contact->mark = cloth_alloc(n_blocks, sizeof *contact->mark, trouble);
    contact->said = cloth_alloc(flow_field_numbers(state, FLOW_FIELD_tie_said, 0), 1, trouble);
}

void flow_contact_free(struct flow_state *state)
{
    struct flow_contact_state *contact = &state->contact;
    free(contact->kept);
    free(contact->root);
    free(contact->solid);
    free(contact->found);
    free(contact->mark);
    free(contact->said);
    free(contact->refs);
    free(contact->meetings.all);
    free(contact->meetings.count);
    *contact = (struct flow_contact_state){0};
}

int flow_contact_room(struct flow_state *state, uint32_t n)
{
    struct flow_contact_state *contact = &state->contact;
    struct flow_meetings *meetings = &contact->meetings;
    struct cloth_error *trouble = &state->flow->trouble;
    if (n <= meetings->room && contact->refs)
        return DUITE_OK;
    free(meetings->all);
    free(meetings->count);
    free(contact->refs);
    meetings->room = n + n / 2;
    meetings->all = cloth_alloc(meetings->room, sizeof *meetings->all, trouble);
    meetings->count = cloth_alloc(meetings->room, FLOW_COUNTS * sizeof *meetings->count, trouble);
    contact->refs =
        cloth_alloc(2 * (size_t)meetings->room + state->head.n_blocks + FLOW_MAX_PARAMETERS,
                    sizeof *contact->refs, trouble);
    return flow_memory_agree(state);
}

/* ---- Lists of contacts ---- */

void flow_contact_keep(struct flow_state *state, uint32_t block, unsigned which, uint32_t room)
{
    struct flow_kept_contacts *kept = state->contact.kept + block;
    if (kept->list[which].generation && kept->room[which] >= room)
        return;
    if (kept->list[which].generation)
        duite_free(state->rt, kept->list[which]); /* a failure is returned by the next fork */
    while (kept->room[which] < room)
        kept->room[which] = kept->room[which] ? 2 * kept->room[which] : FLOW_TIE_CLASS;
    duite_new_sized(state->rt, DUITE_BYTE, 0,
                    flow_contact_index_room(kept->room[which], state->flow->tables.n_blocks),
                    &kept->list[which]);
    duite_colocate(state->rt, kept->list[which], state->block[block].x);
}

void flow_contact_keep_again(struct flow_state *state, uint32_t block, uint32_t n)
{
    flow_contact_keep(state, block, state->contact.begin, n ? n : 1);
    state->contact.kept[block].n[state->contact.begin] = n;
}

int flow_contact_none(struct flow_state *state)
{
    const struct flow_list none = {0};
    int code = DUITE_OK;
    for (uint32_t b = 0; b < state->flow->tables.n_blocks && !code; b++) {
        flow_contact_keep(state, b, state->contact.now, 1);
        code = duite_set_sized(state->rt, state->contact.kept[b].list[state->contact.now], &none,
                               sizeof none);
    }
    return code;
}

/* ---- Freeing ---- */

/* A failure is returned by the next call of the runtime. */
void flow_contact_part(struct flow_state *state)
{
    struct flow_meetings *meetings = &state->contact.meetings;
    for (uint32_t i = 0; i < meetings->n; i++)
        duite_free(state->rt, meetings->all[i].near);
    if (meetings->counts.generation)
        duite_free(state->rt, meetings->counts);
    meetings->counts = (duite_object){0};
    meetings->n = 0;
}

int flow_contact_free_objects(struct flow_state *state)
{
    const struct flow_contact_state *contact = &state->contact;
    int code = DUITE_OK;
    flow_contact_part(state);
    for (uint32_t b = 0; contact->kept && b < state->flow->tables.n_blocks; b++)
        for (int k = 0; k < FLOW_CONTACT_LISTS; k++) {
            const duite_object list = contact->kept[b].list[k];
            const int failed = list.generation ? duite_free(state->rt, list) : DUITE_OK;
            code = code ? code : failed;
        }
    return code;
}
