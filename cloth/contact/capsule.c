/* A capsule: all points within a radius of a line between two points. It is a ball if both ends are
 * one. */
#include "cloth/contact/shape.h"

#include <math.h>

enum { FROM = 0, TO = 3, RADIUS = 6 };

static void capsule_closest(const double *value, const struct contact_body *body, size_t n,
                            const phys_vec *x, struct contact_hit *hit)
{
    (void)body;
    const phys_vec from = {value[FROM], value[FROM + 1], value[FROM + 2], 0};
    const phys_vec to = {value[TO], value[TO + 1], value[TO + 2], 0}, axis = to - from;
    const double square = phys_dot(&axis, &axis);
    phys_vec aside;
    contact_aside(&axis, &aside);
    for (size_t i = 0; i < n; i++) {
        phys_vec away = x[i] - from;
        const double along = square > 0 ? phys_dot(&away, &axis) / square : 0;
        away -= (along < 0 ? 0 : along > 1 ? 1 : along) * axis;
        const double length = sqrt(phys_dot(&away, &away));
        hit[i].gap = length - value[RADIUS];
        hit[i].normal = length > CONTACT_TINY ? away / length : aside;
    }
}

static void capsule_around(const double *value, struct phys_pose *axes, double half[3])
{
    double middle[3], along[3], square = 0;
    for (int c = 0; c < 3; c++) {
        middle[c] = (value[FROM + c] + value[TO + c]) / 2;
        along[c] = value[TO + c] - value[FROM + c];
        square += along[c] * along[c];
    }
    contact_axes(middle, along, axes);
    half[0] = sqrt(square) / 2 + value[RADIUS];
    half[1] = half[2] = value[RADIUS];
}

/* Its line, and all around it. */
static void capsule_core(const double *value, const struct contact_body *body,
                         struct contact_core *core)
{
    (void)body;
    *core = (struct contact_core){.radius = value[RADIUS]};
    capsule_around(value, &core->axes, core->half);
    core->half[0] -= value[RADIUS];
    core->half[1] = core->half[2] = 0;
}

static const struct contact_parameter parameters[] = {
    {"from", CONTACT_POINT}, {"to", CONTACT_POINT}, {"radius", CONTACT_LENGTH}, {NULL, 0}};
const struct contact_kind contact_capsule = {.name = "capsule",
                                             .parameter = parameters,
                                             .closest = capsule_closest,
                                             .around = capsule_around,
                                             .core = capsule_core};
