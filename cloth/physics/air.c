/* A triangle's force depends on its corners alone, in their order: blocks that share it find the
 * same bits. */
#include "cloth/physics/air.h"

#include <math.h>

struct corner {
    phys_vec x, v;
};

PHYS_INLINE struct corner corner_of(const struct phys_sight *sight, uint32_t i)
{
    if (i < sight->n)
        return (struct corner){sight->x[i], sight->v[i]};
    return (struct corner){sight->x_ghost[i - sight->n], sight->v_ghost[i - sight->n]};
}

PHYS_INLINE double length_of(const phys_vec *a)
{
    return sqrt(phys_dot(a, a));
}

/* The part of the force on a triangle that each of so many corners takes. */
static void push(const struct phys_air *air, const struct corner c[3], int corners, phys_vec *part)
{
    const phys_vec wind = PHYS_VEC(air->wind);
    const phys_vec u = wind - (c[0].v + c[1].v + c[2].v) / 3;
    const phys_vec a = c[1].x - c[0].x, b = c[2].x - c[0].x;
    phys_vec normal;
    phys_cross(&a, &b, &normal);
    const double twice = length_of(&normal);
    *part = (phys_vec){0};
    if (!(twice > 0))
        return;
    normal /= twice;
    const phys_vec across = phys_dot(&u, &normal) * normal, along = u - across;
    *part = air->density * twice / (4 * corners) *
            (air->normal * length_of(&across) * across + air->tangent * length_of(&along) * along);
}

void phys_air_force(const struct phys_elements *faces, const struct phys_air *air,
                    const struct phys_sight *sight, phys_vec *f)
{
    for (uint32_t e = 0; e < faces->n; e++) {
        const uint32_t *corner = faces->corner[e];
        const int corners = corner[3] == PHYS_NO_CORNER ? 3 : 4;
        struct corner c[3];
        phys_vec part;
        for (int i = 0; i < 3; i++)
            c[i] = corner_of(sight, corner[i]);
        push(air, c, corners, &part);
        for (int i = 0; i < corners; i++)
            if (corner[i] < sight->n)
                f[corner[i]] += part;
    }
}

/* ---- Pressure ---- */

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
