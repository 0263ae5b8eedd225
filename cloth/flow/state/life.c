/* The use of fields between two steps: the last column of their list, as functions. */
#include "cloth/flow/state/life.h"

#include "cloth/flow/contact/body.h"
#include "cloth/flow/integrators/integrator.h"

enum flow_life flow_is_state(const struct model *model)
{
    (void)model;
    return FLOW_STATE_FIELD;
}

enum flow_life flow_is_derived(const struct model *model)
{
    (void)model;
    return FLOW_DERIVED;
}

enum flow_life flow_is_work(const struct model *model)
{
    (void)model;
    return FLOW_WORK;
}

/* The filter, and so the basis, changes in each step with sliders that move, or with a program's
 * filter. */
enum flow_life flow_is_derived_once(const struct model *model)
{
    return model_is_filtered(model) ? FLOW_WORK : FLOW_DERIVED;
}

enum flow_life flow_is_derived_of_bodies(const struct model *model)
{
    return flow_bodies_move(model) ? FLOW_WORK : FLOW_DERIVED;
}

/* A step may begin with the forces that ended the one before. */
enum flow_life flow_is_state_of_ends(const struct model *model)
{
    const bool stays = flow_integrators[model->integrator].ends_forces && model_leaves_ends(model);
    return stays ? FLOW_STATE_FIELD : FLOW_WORK;
}

/* A linear step may begin its solve with dv of the step before. */
enum flow_life flow_is_state_of_guess(const struct model *model)
{
    return model_is_linear(model) && model->guess != MODEL_GUESS_ZERO ? FLOW_STATE_FIELD
                                                                      : FLOW_WORK;
}

/* A frame may show the end of the step before. */
enum flow_life flow_is_state_of_frames(const struct model *model)
{
    return model->contact.force ? FLOW_STATE_FIELD : FLOW_WORK;
}
