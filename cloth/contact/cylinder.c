/* A cylinder with flat ends; a flat one is a disc. It has sharp edges, as a box has. Outside, the
 * nearest point is the point itself, clamped to the ends and the side. Inside, it is on the nearer
 * of end and side; on an end if they are equal. */
#include "cloth/contact/shape.h"

#include <math.h>

enum { CENTRE = 0, AXIS = 3, RADIUS = 6, LENGTH = 7 };

static void cylinder_closest(const double *value, const struct contact_body *body, size_t n,
                             const phys_vec *x, struct contact_hit *hit)
{
    (void)body;
    const phys_vec centre = {value[CENTRE], value[CENTRE + 1], value[CENTRE + 2], 0};
    const phys_vec axis = {value[AXIS], value[AXIS + 1], value[AXIS + 2], 0};
    phys_vec aside;
    contact_aside(&axis, &aside);
    for (size_t i = 0; i < n; i++) {
        const phys_vec from = x[i] - centre;
        const double along = phys_dot(&from, &axis);
        const phys_vec away = from - along * axis;
        const double across = sqrt(phys_dot(&away, &away));
        const phys_vec end = copysign(1, along) * axis;
        const phys_vec side = across > CONTACT_TINY ? away / across : aside;
        const double beyond = fabs(along) - value[LENGTH] / 2, wide = across - value[RADIUS];
        const phys_vec out = (beyond > 0 ? beyond : 0) * end + (wide > 0 ? wide : 0) * side;
        const double length = sqrt(phys_dot(&out, &out));
        hit[i].gap = length > 0 ? length : beyond < wide ? wide : beyond;
        hit[i].normal = length > 0 ? out / length : beyond < wide ? side : end;
    }
}

static void cylinder_around(const double *value, struct phys_pose *axes, double half[3])
{
    contact_axes(value + CENTRE, value + AXIS, axes);
    half[0] = value[LENGTH] / 2;
    half[1] = half[2] = value[RADIUS];
}

static void cylinder_core(const double *value, const struct contact_body *body,
                          struct contact_core *core)
{
    (void)body;
    *core = (struct contact_core){.round = true};
    cylinder_around(value, &core->axes, core->half);
}

static const struct contact_parameter parameters[] = {{"centre", CONTACT_POINT},
                                                      {"axis", CONTACT_DIRECTION},
                                                      {"radius", CONTACT_LENGTH},
                                                      {"length", CONTACT_LENGTH},
                                                      {NULL, 0}};
const struct contact_kind contact_cylinder = {.name = "cylinder",
                                              .parameter = parameters,
                                              .closest = cylinder_closest,
                                              .around = cylinder_around,
                                              .core = cylinder_core,
                                              .round = true};
