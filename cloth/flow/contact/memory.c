/* Memory of contacts besides fields: the main program's, and lists that change their size. */
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
    contact->failing = cloth_alloc(n_blocks, sizeof *contact->failing, trouble);
    contact->mark = cloth_alloc(n_blocks + n_obstacles, sizeof *contact->mark, trouble);
    contact->said = cloth_alloc(flow_field_numbers(state, FLOW_FIELD_tie_said, 0), 1, trouble);
}

void flow_contact_free(struct flow_state *state)
{
    struct flow_contact_state *contact = &state->contact;
    free(contact->kept);
    free(contact->root);
    free(contact->solid);
    free(contact->found);
    free(contact->failing);
    free(contact->mark);
    free(contact->said);
    free(contact->refs);
    free(contact->meetings.all);
    free(contact->meetings.count);
    free(contact->meetings.counted);
    free(contact->meetings.counts);
    *contact = (struct flow_contact_state){0};
}

int flow_contact_room(struct flow_state *state, uint32_t n)
{
    struct flow_contact_state *contact = &state->contact;
    struct flow_meetings *meetings = &contact->meetings;
    struct cloth_error *trouble = &state->flow->trouble;
    if (n <= meetings->room && meetings->all)
        return DUITE_OK;
    free(meetings->all);
    free(meetings->count);
    free(meetings->counted);
    free(meetings->counts);
    free(contact->refs);
    meetings->room = (n + n / 2) / FLOW_MEETING_GROUP * FLOW_MEETING_GROUP + FLOW_MEETING_GROUP;
    meetings->counts =
        cloth_alloc(meetings->room / FLOW_MEETING_GROUP, sizeof *meetings->counts, trouble);
    meetings->all = cloth_alloc(meetings->room, sizeof *meetings->all, trouble);
    meetings->count = cloth_alloc(meetings->room, FLOW_COUNTS * sizeof *meetings->count, trouble);
    meetings->counted =
        cloth_alloc(meetings->room, FLOW_COUNTS * sizeof *meetings->counted, trouble);
    contact->refs =
        cloth_alloc(2 * (size_t)meetings->room + state->head.n_blocks + FLOW_MAX_PARAMETERS,
                    sizeof *contact->refs, trouble);
    return flow_memory_agree(state);
}

/* ---- Lists of contacts ---- */

/* Room for n contacts with an eighth to spare, in whole classes: lists grow from step to step. */
static uint32_t contact_room_for(uint32_t n)
{
    return (n + n / 8) / FLOW_TIE_CLASS * FLOW_TIE_CLASS + FLOW_TIE_CLASS;
}

void flow_contact_keep(struct flow_state *state, uint32_t block, enum flow_field_id contacts,
                       uint32_t n)
{
    enum { TOO_MUCH = 4 }; /* times what is needed: more room goes back */
    struct flow_kept_list *list = flow_kept_list(state, block, contacts);
    const uint32_t room = contact_room_for(n);
    list->n = n;
    if (list->room >= n && list->room <= TOO_MUCH * room)
        return;
    list->room = room;
    flow_object_again(state, contacts, block);
}

void flow_contact_swap(struct flow_state *state, enum flow_field_id a, enum flow_field_id b)
{
    flow_fields_swap(state, a, b);
    for (uint32_t i = 0; i < state->flow->tables.n_blocks; i++) {
        struct flow_kept_list *one = flow_kept_list(state, i, a);
        struct flow_kept_list *two = flow_kept_list(state, i, b);
        const struct flow_kept_list was = *one;
        *one = *two;
        *two = was;
    }
}

void flow_contact_return(struct flow_state *state)
{
    if (state->contact.kept_begin)
        flow_contact_swap(state, FLOW_FIELD_contacts, FLOW_FIELD_kept_contacts);
    state->contact.kept_begin = false;
}

int flow_contact_none(struct flow_state *state)
{
    const struct flow_list none = {0};
    int code = DUITE_OK;
    for (uint32_t b = 0; b < state->flow->tables.n_blocks && !code; b++)
        code = duite_set_sized(state->rt, state->block[b].contacts, &none, sizeof none);
    return code;
}

void flow_contact_part(struct flow_state *state)
{
    struct flow_meetings *meetings = &state->contact.meetings;
    for (uint32_t i = 0; i < meetings->n; i++)
        flow_noted(state, duite_free(state->rt, meetings->all[i].near));
    for (uint32_t g = 0; g < flow_meeting_groups(meetings); g++)
        flow_noted(state, duite_free(state->rt, meetings->counts[g]));
    meetings->n = 0;
}
