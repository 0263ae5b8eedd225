/* A kind sees points in the axes of its parameters; they are brought there and back here. Points of
 * shapes that stand still are left untouched, so that the bits are those of the kind alone. */
#include "cloth/contact/shape.h"

#include "cloth/contact/image.h"

#include <math.h>

enum { AT_ONCE = 32 }; /* points, whose room is on the stack */

const struct contact_kind *const contact_kinds[] = {&contact_plane,    &contact_sphere,
                                                    &contact_box,      &contact_capsule,
                                                    &contact_cylinder, &contact_body_kind};
const uint32_t contact_n_kinds = sizeof contact_kinds / sizeof *contact_kinds;

size_t contact_role_size(enum contact_role role)
{
    static const size_t size[] = {[CONTACT_POINT] = 3,
                                  [CONTACT_DIRECTION] = 3,
                                  [CONTACT_LENGTH] = 1,
                                  [CONTACT_LENGTHS] = 3,
                                  [CONTACT_ROTATION] = 4};
    return size[role];
}

void contact_aside(const phys_vec *axis, phys_vec *aside)
{
    const double square = phys_dot(axis, axis);
    int least = 0;
    for (int c = 1; c < 3; c++)
        least = fabs((*axis)[c]) < fabs((*axis)[least]) ? c : least;
    *aside = (phys_vec){0};
    (*aside)[least] = 1;
    if (square > CONTACT_TINY * CONTACT_TINY)
        *aside -= (*axis)[least] / square * *axis;
    *aside /= sqrt(phys_dot(aside, aside));
}

void contact_axes(const double point[3], const double along[3], struct phys_pose *axes)
{
    struct phys_key key = {.rotate = {1, 0, 0, 0}};
    double square = 0;
    for (int c = 0; c < 3; c++) {
        key.translate[c] = point[c];
        square += along[c] * along[c];
    }
    const double length = sqrt(square);
    if (along[0] > -length) {
        key.rotate[0] = length + along[0];
        key.rotate[2] = -along[2];
        key.rotate[3] = along[1];
    } else if (length > 0) { /* half a turn, about any axis across */
        key.rotate[0] = 0;
        key.rotate[3] = 1;
    }
    phys_pose_at(1, &key, (const double[3]){0}, 0, axes);
}

void contact_pose_over(const struct contact_shape *shape, const struct phys_key *keys,
                       const struct contact_bodies *bodies, double from, double to,
                       struct contact_pose *pose)
{
    *pose = (struct contact_pose){.body = contact_bodies_at(bodies, shape->body),
                                  .moves = shape->n > 0,
                                  .begin = from,
                                  .end = to,
                                  .rate = to > from ? 1 / (to - from) : 0};
    if (!pose->moves)
        return;
    phys_pose_at(shape->n, keys + shape->first, shape->about, from, &pose->from);
    phys_pose_at(shape->n, keys + shape->first, shape->about, to, &pose->to);
}

/* In the axes of the parameters. */
static void closest_own(const struct contact_shape *shape, const struct contact_pose *pose,
                        size_t n, const phys_vec *x, struct contact_hit *hit)
{
    if (pose->image)
        contact_image_closest(pose->image, n, x, hit);
    else
        contact_kinds[shape->kind]->closest(shape->value, pose->body, n, x, hit);
}

static void closest_still(const struct contact_shape *shape, const struct contact_pose *pose,
                          size_t n, const phys_vec *x, struct contact_hit *hit)
{
    for (size_t i = 0; i < n; i++)
        hit[i].velocity = (phys_vec){0};
    closest_own(shape, pose, n, x, hit);
}

static void closest_moving(const struct contact_shape *shape, const struct contact_pose *pose,
                           size_t n, const phys_vec *x, struct contact_hit *hit)
{
    phys_vec own[AT_ONCE], was, is;
    for (size_t i = 0; i < n; i++)
        phys_pose_back(&pose->to, x + i, own + i);
    closest_own(shape, pose, n, own, hit);
    for (size_t i = 0; i < n; i++) {
        if (!(hit[i].gap < INFINITY))
            continue;
        const phys_vec surface = own[i] - hit[i].gap * hit[i].normal;
        phys_pose_point(&pose->from, &surface, &was);
        phys_pose_point(&pose->to, &surface, &is);
        hit[i].velocity = pose->rate * (is - was);
        phys_pose_direction(&pose->to, &hit[i].normal, &hit[i].normal);
    }
}

void contact_closest(const struct contact_shape *shape, const struct contact_pose *pose, size_t n,
                     const phys_vec *x, struct contact_hit *hit)
{
    for (size_t i = 0; i < n; i += AT_ONCE) {
        const size_t some = n - i < AT_ONCE ? n - i : AT_ONCE;
        if (pose->moves)
            closest_moving(shape, pose, some, x + i, hit + i);
        else
            closest_still(shape, pose, some, x + i, hit + i);
    }
}
