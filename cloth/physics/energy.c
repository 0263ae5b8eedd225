/* A spring's energy has the same bits whichever of its ends comes first. */
#include "cloth/physics/energy.h"

#include <math.h>

double phys_energy_weight(size_t n, const double *mass, const double gravity[3], const phys_vec *x)
{
    const phys_vec g = PHYS_VEC(gravity);
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum -= mass[i] * phys_dot(&g, x + i);
    return sum;
}

double phys_energy_load(size_t n, const double *mass, const double gravity[3], const phys_vec *load,
                        const phys_vec *x)
{
    const phys_vec g = PHYS_VEC(gravity);
    double sum = 0;
    for (size_t i = 0; i < n; i++) {
        const phys_vec rest = load[i] - mass[i] * g;
        sum -= phys_dot(&rest, x + i);
    }
    return sum;
}

double phys_energy_springs(const struct phys_springs *springs, const phys_vec *x,
                           const phys_vec *x_other)
{
    double sum = 0;
    for (size_t i = 0; i < springs->n; i++) {
        const phys_vec d = x_other[springs->end[i][1]] - x[springs->end[i][0]];
        const double longer = sqrt(phys_dot(&d, &d)) - springs->length[i];
        sum += 0.5 * springs->stiffness[i] * (longer * longer);
    }
    return sum;
}
