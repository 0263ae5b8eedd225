/* The integrators of a run, a row each. BDF2 needs to know how the step before ended, so no part of
 * its steps is forked ahead. */
#include "cloth/flow/integrators/integrator.h"

const struct flow_integrator flow_integrators[] = {
    [MODEL_IMPLICIT_EULER] = {flow_implicit_euler_begin, flow_implicit_euler_end,
                              flow_implicit_euler_keeps, NULL},
    [MODEL_BDF2] = {NULL, flow_bdf2_end, NULL, NULL},
    [MODEL_EXPLICIT_EULER] = {NULL, flow_euler_end, flow_euler_keeps, flow_euler_restore},
    [MODEL_SYMPLECTIC_EULER] = {NULL, flow_euler_end, flow_euler_keeps, flow_euler_restore},
    [MODEL_VERLET] = {flow_verlet_begin, flow_verlet_end, NULL, NULL},
    [MODEL_RK4] = {NULL, flow_runge_end, NULL, NULL},
};

bool flow_integrator_keeps(const struct model *model)
{
    const struct flow_integrator *is = flow_integrators + model->integrator;
    return is->keeps && is->keeps(model);
}
