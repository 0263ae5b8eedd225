/* A triangle's force depends on its corners alone, in their order: blocks that share it find the
 * same bits. */
#include "cloth/physics/pressure.h"

void phys_pressure_force(const struct phys_elements *list, const struct phys_air *air,
                         const struct phys_sight *sight, phys_vec *f)
{
    (void)air;
    for (uint32_t e = 0; e < list->n; e++) {
        const uint32_t *corner = list->corner[e];
        phys_vec x[3], push;
        for (int i = 0; i < 3; i++)
            x[i] =
                corner[i] < sight->n ? sight->x[corner[i]] : sight->x_ghost[corner[i] - sight->n];
        const phys_vec a = x[1] - x[0], b = x[2] - x[0];
        phys_cross(&a, &b, &push);
        push *= list->number[PHYS_PRESSURE][e] / 6; /* of p A n, a third; the product is 2 A n */
        for (int i = 0; i < 3; i++)
            if (corner[i] < sight->n)
                f[corner[i]] += push;
    }
}
