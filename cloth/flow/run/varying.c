/* Varying loads are those at the time of the state whose forces are computed; the end of the step
 * for implicit ones. */
#include "cloth/flow/state/bodies.h"

void flow_varying_add(const duite_call *call, const struct flow_table *t, double now, phys_vec *f)
{
    const struct model *model = flow_of(call)->model;
    uint32_t curve = 0; /* that the factor is of */
    double factor = 1;
    for (uint32_t i = 0; i < t->n_varying; i++) {
        if (curve != t->varying[i][1])
            factor = model_curve_at(model, t->varying[i][1], now);
        curve = t->varying[i][1];
        f[t->varying[i][0]] += factor * t->varying_force[i];
    }
}

double flow_varying_energy(const duite_call *call, const struct flow_table *t, double now,
                           const phys_vec *x)
{
    const struct model *model = flow_of(call)->model;
    double sum = 0;
    for (uint32_t i = 0; i < t->n_varying; i++)
        sum -= model_curve_at(model, t->varying[i][1], now) *
               phys_dot(t->varying_force + i, x + t->varying[i][0]);
    return sum;
}
