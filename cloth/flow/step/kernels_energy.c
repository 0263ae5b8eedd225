/* Energies of a block; a spring between two blocks gives half of its own to each. Sums are
 * contributions, so that they are the same for any ranks and threads. */
#include "cloth/flow/step/guides.h"

#include "cloth/physics/energy.h"
#include "cloth/physics/particle.h"

#define ARGS sizeof(struct flow_args)

static int energy(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    const double *gravity = flow_of(call)->model->gravity;
    const phys_vec *x = duite_in(call, 1, phys_vec);
    double *sums = duite_out(call, 3, double), fastest = 0;
    struct phys_springs springs = flow_table_inner(t);
    const struct flow_view view = {.x = x, .rim_x = call->param + 4};
    sums[FLOW_ENERGY_MOTION] = phys_kinetic(t->n, t->mass, duite_in(call, 2, phys_vec), &fastest);
    sums[FLOW_ENERGY_GRAVITY] = phys_energy_weight(t->n, t->mass, gravity, x);
    sums[FLOW_ENERGY_LOADS] =
        phys_energy_load(t->n, t->mass, gravity, t->load, x) + flow_varying_energy(call, t, x);
    sums[FLOW_ENERGY_ELASTIC] = flow_elements_energy(call, t, &view, sums + FLOW_TORQUE) +
                                phys_energy_springs(&springs, x, x);
    for (uint32_t s = 0; s < t->n_slots; s++) {
        springs = flow_table_cut(t, s);
        sums[FLOW_ENERGY_ELASTIC] +=
            0.5 * phys_energy_springs(&springs, x, duite_in(call, 4 + s, phys_vec));
    }
    return 0;
}
const duite_kernel flow_energy = {.name = "energy",
                                  .body = energy,
                                  .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_CW},
                                  .variadic = DUITE_R,
                                  .args_size = ARGS};

/* f becomes v and half a kick more: the velocity where x is, of steps that hold them half a step
 * apart. */
static int level(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    const phys_vec *v = duite_in(call, 1, phys_vec);
    phys_vec *f = duite_out(call, 2, phys_vec);
    phys_accelerate(t->n, t->mass, t->free, f);
    flow_guides_filter(call, t, f);
    for (uint32_t i = 0; i < t->n; i++)
        f[i] = v[i] + 0.5 * flow_args_of(call)->h * f[i];
    return 0;
}
const duite_kernel flow_level = {
    .name = "level", .body = level, .access = {DUITE_R, DUITE_R, DUITE_RW}, .args_size = ARGS};
