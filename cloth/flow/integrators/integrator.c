/* The integrators of a run by number, from the model's list. */
#include "cloth/flow/integrators/integrator.h"

#define FLOW_INTEGRATOR_OF(number, name, ...) [number] = &flow_integrator_##name,
static const struct flow_integrator *const integrators[MODEL_INTEGRATORS] = {
    MODEL_ALL_INTEGRATORS(FLOW_INTEGRATOR_OF)};

const struct flow_integrator *flow_integrator(const struct model *model)
{
    return integrators[model->integrator];
}

bool flow_integrator_keeps(const struct model *model)
{
    const struct flow_integrator *is = flow_integrator(model);
    return is->keeps && is->keeps(model);
}
