/* The integrators of a run, a row each; model_schemes has what other folders ask of them. BDF2
 * needs to know how the step before ended, so no part of its steps is forked ahead. */
#include "cloth/flow/integrators/integrator.h"

const struct flow_integrator flow_integrators[MODEL_INTEGRATORS] = {
    [MODEL_IMPLICIT_EULER] = {.begin = flow_implicit_euler_begin,
                              .end = flow_implicit_euler_end,
                              .keeps = flow_implicit_euler_keeps},
    [MODEL_BDF2] = {.end = flow_bdf2_end, .two_steps = true},
    [MODEL_EXPLICIT_EULER] = {.end = flow_euler_end,
                              .keeps = flow_euler_keeps,
                              .restore = flow_euler_restore},
    [MODEL_SYMPLECTIC_EULER] = {.end = flow_euler_end,
                                .keeps = flow_euler_keeps,
                                .restore = flow_euler_restore},
    [MODEL_VERLET] = {.begin = flow_verlet_begin, .end = flow_verlet_end, .ends_forces = true},
    [MODEL_RK4] = {.end = flow_runge_end, .in_stages = true},
};

bool flow_integrator_keeps(const struct model *model)
{
    const struct flow_integrator *is = flow_integrators + model->integrator;
    return is->keeps && is->keeps(model);
}
