/* A ball: its gap is the distance from its centre less its radius. */
#include "cloth/contact/shape.h"

#include <math.h>

enum { CENTRE = 0, RADIUS = 3 };

static void sphere_closest(const double *value, const struct contact_body *body, size_t n,
                           const phys_vec *x, struct contact_hit *hit)
{
    (void)body;
    const phys_vec centre = {value[CENTRE], value[CENTRE + 1], value[CENTRE + 2], 0};
    const phys_vec up = {0, 1, 0, 0}; /* all ways out of the centre are as short */
    for (size_t i = 0; i < n; i++) {
        const phys_vec from = x[i] - centre;
        const double length = sqrt(phys_dot(&from, &from));
        hit[i].gap = length - value[RADIUS];
        hit[i].normal = length > CONTACT_TINY ? from / length : up;
    }
}

static void sphere_around(const double *value, struct phys_pose *axes, double half[3])
{
    const struct phys_key middle = {
        .translate = {value[CENTRE], value[CENTRE + 1], value[CENTRE + 2]}, .rotate = {1, 0, 0, 0}};
    phys_pose_at(1, &middle, (const double[3]){0}, 0, axes);
    half[0] = half[1] = half[2] = value[RADIUS];
}

/* Its centre, and all around it. */
static void sphere_core(const double *value, const struct contact_body *body,
                        struct contact_core *core)
{
    double half[3];
    (void)body;
    *core = (struct contact_core){.radius = value[RADIUS]};
    sphere_around(value, &core->axes, half);
}

static const struct contact_parameter parameters[] = {
    {"centre", CONTACT_POINT}, {"radius", CONTACT_LENGTH}, {NULL, 0}};
const struct contact_kind contact_sphere = {.name = "sphere",
                                            .parameter = parameters,
                                            .closest = sphere_closest,
                                            .around = sphere_around,
                                            .core = sphere_core};
