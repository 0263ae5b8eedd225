/* A box. Outside, the nearest point is the point itself, cut off at the faces; inside, it is on the
 * nearest face, the first of equals. */
#include "cloth/contact/shape.h"

#include <math.h>

enum { CENTRE = 0, SIZE = 3, ROTATE = 6 };

static void box_around(const double *value, struct phys_pose *axes, double half[3])
{
    struct phys_key middle = {0};
    for (int c = 0; c < 3; c++) {
        middle.translate[c] = value[CENTRE + c];
        half[c] = value[SIZE + c] / 2;
    }
    for (int c = 0; c < 4; c++)
        middle.rotate[c] = value[ROTATE + c];
    phys_pose_at(1, &middle, (const double[3]){0}, 0, axes);
}

/* In the box's own axes. */
static void box_closest_own(const double half[3], const phys_vec *x, struct contact_hit *hit)
{
    phys_vec out = {0}, side = {0};
    int nearest = 0;
    for (int c = 0; c < 3; c++) {
        side[c] = fabs((*x)[c]) - half[c];
        out[c] = side[c] > 0 ? copysign(side[c], (*x)[c]) : 0;
        nearest = side[c] > side[nearest] ? c : nearest;
    }
    const double length = sqrt(phys_dot(&out, &out));
    hit->gap = length > 0 ? length : side[nearest];
    if (length > 0) {
        hit->normal = out / length;
    } else {
        hit->normal = (phys_vec){0};
        hit->normal[nearest] = copysign(1, (*x)[nearest]);
    }
}

static void box_closest(const double *value, const struct contact_body *body, size_t n,
                        const phys_vec *x, struct contact_hit *hit)
{
    (void)body;
    struct phys_pose axes;
    double half[3];
    box_around(value, &axes, half);
    for (size_t i = 0; i < n; i++) {
        phys_vec own;
        phys_pose_back(&axes, x + i, &own);
        box_closest_own(half, &own, hit + i);
        phys_pose_direction(&axes, &hit[i].normal, &hit[i].normal);
    }
}

static void box_core(const double *value, const struct contact_body *body,
                     struct contact_core *core)
{
    (void)body;
    *core = (struct contact_core){0};
    box_around(value, &core->axes, core->half);
}

static const struct contact_parameter parameters[] = {
    {"centre", CONTACT_POINT}, {"size", CONTACT_LENGTHS}, {"rotate", CONTACT_ROTATION}, {NULL, 0}};
const struct contact_kind contact_box = {.name = "box",
                                         .parameter = parameters,
                                         .closest = box_closest,
                                         .around = box_around,
                                         .core = box_core};
