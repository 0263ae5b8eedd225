/* The table of contact modes, and the calls of a run's mode. */
#include "cloth/flow/contact/mode.h"

#include "cloth/flow/contact/contact.h"

#include <math.h>

static bool is_none(const struct model *model)
{
    (void)model;
    return true;
}

static const struct flow_contact_mode flow_contact_none_at_all = {.is = is_none};

/* In order; the last one always is. A new mode is a row. */
static const struct flow_contact_mode *const modes[] = {
    &flow_contact_certified, &flow_contact_repulsion, &flow_contact_image, &flow_contact_project,
    &flow_contact_none_at_all};

const struct flow_contact_mode *flow_contact_mode(const struct model *model)
{
    const struct flow_contact_mode *const *mode = modes;
    while (!(*mode)->is(model))
        mode++;
    return *mode;
}

static const struct flow_contact_mode *mode_of(const struct flow_state *state)
{
    return flow_contact_mode(state->flow->model);
}

double flow_contact_reach(const struct model *model)
{
    return flow_contact_mode(model)->reach(model);
}

struct flow_thickness flow_thickness_of(const struct flow *flow, uint32_t a, uint32_t b)
{
    const uint32_t n_blocks = flow->tables.n_blocks, obstacle = flow->n_cloths + (b - n_blocks);
    const uint32_t *own = flow->tables.block[a].skin.cloth;
    const uint32_t of[2] = {obstacle, obstacle};
    const uint32_t *other = b < n_blocks ? flow->tables.block[b].skin.cloth : of;
    struct flow_thickness all = {INFINITY, 0};
    for (uint32_t c = own[0]; c <= own[1]; c++)
        for (uint32_t i = other[0]; i <= other[1]; i++) {
            const double thickness = flow_sides_of(flow, c, i)->thickness;
            all.least = thickness < all.least ? thickness : all.least;
            all.most = thickness > all.most ? thickness : all.most;
        }
    return all;
}

int flow_contact_start(struct flow_state *state)
{
    const struct flow_contact_mode *mode = mode_of(state);
    return mode->start ? mode->start(state) : DUITE_OK;
}

int flow_contact_resume(struct flow_state *state)
{
    const struct flow_contact_mode *mode = mode_of(state);
    return mode->resume ? mode->resume(state) : DUITE_OK;
}

int flow_contact_begin(struct flow_state *state)
{
    const struct flow_contact_mode *mode = mode_of(state);
    return mode->begin ? mode->begin(state) : DUITE_OK;
}

int flow_contact_settle(struct flow_state *state)
{
    const struct flow_contact_mode *mode = mode_of(state);
    return mode->settle ? mode->settle(state) : DUITE_OK;
}

void flow_contact_status(const struct flow_state *state, double status[FLOW_STATUS])
{
    const struct flow_contact_mode *mode = mode_of(state);
    if (mode->status)
        mode->status(state, status);
}

int flow_contact_settled(struct flow_state *state, const double status[FLOW_STATUS], bool accepted)
{
    const struct flow_contact_mode *mode = mode_of(state);
    return mode->settled ? mode->settled(state, status, accepted) : DUITE_OK;
}
