/* Each row is computed from itself alone: no order of rows matters. */
#include "cloth/contact/meet.h"

enum { AT_ONCE = 32 }; /* rows, whose hits are on the stack: 5 KB */

bool contact_leave(const struct contact_hit *hit, const phys_vec *way, phys_vec *x, phys_vec *v)
{
    if (!(hit->gap <= 0))
        return false; /* so is NaN */
    *x -= hit->gap * *way;
    const phys_vec relative = *v - hit->velocity;
    const double speed = phys_dot(&relative, &hit->normal);
    if (speed < 0)
        *v -= speed * *way;
    return true;
}

/* True if a cheap test shows that none of at most AT_ONCE points is on or in the shape. */
static bool contact_meet_are_apart(const struct contact_shape *shape,
                                   const struct contact_pose *pose, size_t n, const phys_vec *x)
{
    const struct contact_kind *kind = contact_kinds[shape->kind];
    phys_vec own[AT_ONCE];
    if (pose->image || !kind->apart)
        return false;
    for (size_t i = 0; i < n && pose->moves; i++)
        phys_pose_back(&pose->to, x + i, own + i);
    return kind->apart(shape->value, pose->body, n, pose->moves ? own : x);
}

size_t contact_project(const struct contact_shape *shape, const struct contact_pose *pose, size_t n,
                       const double *free, phys_vec *x, phys_vec *v)
{
    struct contact_hit hit[AT_ONCE];
    size_t touched = 0;
    for (size_t from = 0; from < n; from += AT_ONCE) {
        const size_t some = n - from < AT_ONCE ? n - from : AT_ONCE;
        if (contact_meet_are_apart(shape, pose, some, x + from))
            continue;
        contact_closest(shape, pose, some, x + from, hit);
        for (size_t i = 0; i < some; i++)
            if (free[from + i] != 0)
                touched += contact_leave(hit + i, &hit[i].normal, x + from + i, v + from + i);
    }
    return touched;
}
