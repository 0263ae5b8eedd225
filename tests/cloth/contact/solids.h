#ifndef TESTS_CLOTH_CONTACT_SOLIDS_H
#define TESTS_CLOTH_CONTACT_SOLIDS_H

#include "cloth/contact/solid.h"
#include "tests/cloth/contact/shapes.h"

#include <check.h>

/* A moving convex shape and a triangle, and what is inside of the shape at a time of the step: said
 * here once more, without what the product knows. */

enum { TIMES = 50, THIRDS = 30 };

/* A random size between two: as many of each power of ten. */
static inline double any_size(double low, double high)
{
    return low * pow(high / low, uniform(0, 1));
}

/* ---- Scenes of one shape and one triangle ---- */

struct meeting {
    struct contact_shape shape;
    struct phys_key keys[2]; /* at 0 and 1 s */
    struct contact_pose pose;
    struct contact_solid solid;
    phys_vec x[3], y[3];
};

static inline void make_shape(uint32_t kind, double shift, double turn, struct meeting *m)
{
    pick_shape(kind, 0.1, &m->shape);
    for (int i = 0; i < 3; i++)
        m->shape.about[i] = uniform(-1, 1);
    for (int k = 0; k < 2; k++) {
        m->keys[k].time = k;
        for (int i = 0; i < 3; i++)
            m->keys[k].translate[i] =
                k ? m->keys[0].translate[i] + uniform(-shift, shift) : uniform(-1, 1);
        for (int i = 0; i < 4; i++)
            m->keys[k].rotate[i] =
                k ? m->keys[0].rotate[i] + uniform(-turn, turn) / 2 : uniform(-1, 1);
        make_unit(4, m->keys[k].rotate);
    }
    contact_pose_over(&m->shape, m->keys, NULL, 0, 1, &m->pose);
    contact_solid_make(&m->shape, &m->pose, &m->solid);
}

/* Where what the shape carries along is at the end. */
static inline void carry(const struct meeting *m, const phys_vec *x, phys_vec *y)
{
    phys_pose_back(&m->pose.from, x, y);
    phys_pose_point(&m->pose.to, y, y);
}

/* A triangle so far from the shape at the begin. Its end: carried along or not, and moved. */
static inline void place_triangle(double gap, double edge, bool carried, double away,
                                  struct meeting *m)
{
    struct contact_solid_point point;
    phys_vec middle, common;
    pick_point(3, &middle);
    for (int k = 0; k < 3; k++) {
        pick_point(edge, m->x + k);
        m->x[k] += middle;
    }
    for (int i = 0; i < 3; i++) {
        contact_solid_nearest(&m->solid, CONTACT_BEGIN, m->x, &point);
        for (int k = 0; k < 3; k++)
            m->x[k] += (gap - point.gap) * point.normal;
    }
    pick_point(away, &common);
    for (int k = 0; k < 3; k++) {
        phys_vec own;
        pick_point(away, &own);
        m->y[k] = m->x[k];
        if (carried)
            carry(m, m->x + k, m->y + k);
        m->y[k] += own + common;
    }
}

/* ---- What is inside at a time between both ends ---- */

/* The point of the shape's own axes that is there then: the chords of all are an affine map. */
static inline void point_then(const struct meeting *m, double s, const phys_vec *x, phys_vec *own)
{
    const struct phys_pose *from = &m->pose.from, *to = &m->pose.to;
    double a[3][4];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            a[i][j] = (1 - s) * from->turn[i][j] + s * to->turn[i][j];
        a[i][3] = (*x)[i] - from->about[i] - (1 - s) * from->translate[i] - s * to->translate[i];
    }
    for (int i = 0; i < 3; i++) { /* near to a rotation: pivots are not small where it matters */
        int best = i;
        for (int r = i + 1; r < 3; r++)
            best = fabs(a[r][i]) > fabs(a[best][i]) ? r : best;
        for (int j = 0; j < 4; j++) {
            const double value = a[i][j];
            a[i][j] = a[best][j];
            a[best][j] = value;
        }
        for (int r = 0; r < 3; r++)
            for (int j = 3; r != i && j >= i; j--)
                a[r][j] -= a[r][i] / a[i][i] * a[i][j];
    }
    *own = (phys_vec){0};
    for (int i = 0; i < 3; i++)
        (*own)[i] = a[i][3] / a[i][i] + from->about[i];
}

static inline void chord(const struct meeting *m, double s, const double *own, phys_vec *x)
{
    const phys_vec p = {own[0], own[1], own[2], 0};
    phys_vec was, is;
    phys_pose_point(&m->pose.from, &p, &was);
    phys_pose_point(&m->pose.to, &p, &is);
    *x = (1 - s) * was + s * is;
}

/* A convex function of a point x that is 0 on the shape's surface, and changes no faster than x for
 * shapes that do not turn. */
static inline double level_plane(const struct meeting *m, double s, const phys_vec *x)
{
    const phys_vec up = {m->shape.value[3], m->shape.value[4], m->shape.value[5], 0};
    phys_vec at, was, is;
    chord(m, s, m->shape.value, &at);
    phys_pose_direction(&m->pose.from, &up, &was);
    phys_pose_direction(&m->pose.to, &up, &is);
    const phys_vec normal = (1 - s) * was + s * is, from = *x - at;
    return phys_dot(&from, &normal);
}

static inline double level_sphere(const struct meeting *m, double s, const phys_vec *x)
{
    phys_vec at;
    chord(m, s, m->shape.value, &at);
    at = *x - at;
    return length(&at) - m->shape.value[3];
}

static inline double level_box(const struct meeting *m, double s, const phys_vec *x)
{
    phys_vec own;
    struct contact_hit hit;
    point_then(m, s, x, &own);
    contact_kinds[m->shape.kind]->closest(m->shape.value, NULL, 1, &own, &hit);
    return hit.gap;
}

static inline double level_capsule(const struct meeting *m, double s, const phys_vec *x)
{
    phys_vec from, to;
    chord(m, s, m->shape.value, &from);
    chord(m, s, m->shape.value + 3, &to);
    const phys_vec axis = to - from;
    phys_vec away = *x - from;
    const double along = phys_dot(&away, &axis) / phys_dot(&axis, &axis);
    away -= fmax(0, fmin(1, along)) * axis;
    return length(&away) - m->shape.value[6];
}

static const struct {
    const struct contact_kind *kind;
    double (*level)(const struct meeting *m, double s, const phys_vec *x);
} LEVELS[] = {{&contact_plane, level_plane},
              {&contact_sphere, level_sphere},
              {&contact_box, level_box},
              {&contact_capsule, level_capsule},
              {&contact_cylinder, level_box}};

static inline double level(const struct meeting *m, double s, const phys_vec *x)
{
    for (size_t i = 0; i < sizeof LEVELS / sizeof *LEVELS; i++)
        if (LEVELS[i].kind == contact_kinds[m->shape.kind])
            return LEVELS[i].level(m, s, x);
    ck_abort_msg("%s: nothing here says what is inside", contact_kinds[m->shape.kind]->name);
    return NAN;
}

/* The least of a convex function on a line of a triangle, then of a triangle: thirds that cannot
 * hold it are left out. */
static inline double least_on_line(const struct meeting *m, double s, const phys_vec *a,
                                   const phys_vec *b)
{
    double low = 0, high = 1, value[2] = {0};
    for (int i = 0; i < THIRDS; i++) {
        const double part[2] = {low + (high - low) / 3, high - (high - low) / 3};
        for (int k = 0; k < 2; k++) {
            const phys_vec x = (1 - part[k]) * *a + part[k] * *b;
            value[k] = level(m, s, &x);
        }
        *(value[0] < value[1] ? &high : &low) = part[value[0] < value[1]];
    }
    return fmin(value[0], value[1]);
}

static inline double least_level(const struct meeting *m, double s, const phys_vec x[3])
{
    double low = 0, high = 1, value[2] = {0};
    for (int i = 0; i < THIRDS; i++) {
        const double part[2] = {low + (high - low) / 3, high - (high - low) / 3};
        for (int k = 0; k < 2; k++) {
            const phys_vec a = (1 - part[k]) * x[0] + part[k] * x[1],
                           b = (1 - part[k]) * x[0] + part[k] * x[2];
            value[k] = least_on_line(m, s, &a, &b);
        }
        *(value[0] < value[1] ? &high : &low) = part[value[0] < value[1]];
    }
    return fmin(value[0], value[1]);
}

/* True if the triangle is surely outside at a time: all of it as its middle is. */
static inline bool outside_by_middle(const struct meeting *m, double s, const phys_vec x[3])
{
    const phys_vec middle = (x[0] + x[1] + x[2]) / 3;
    double reach = 0;
    for (int k = 0; k < 3; k++) {
        const phys_vec away = x[k] - middle;
        reach = fmax(reach, length(&away));
    }
    return level(m, s, &middle) > 2 * reach;
}

/* The shape at a time as one that stands still, and the triangle as that one sees it: of a box and
 * a cylinder in the axes in which they are what they were. */
static inline void freeze(const struct meeting *m, double s, struct meeting *still)
{
    *still = *m;
    still->pose = (struct contact_pose){0};
    for (int k = 0; k < 3; k++)
        still->x[k] = (1 - s) * m->x[k] + s * m->y[k];
    if (contact_kinds[m->shape.kind] == &contact_box ||
        contact_kinds[m->shape.kind] == &contact_cylinder) {
        for (int k = 0; k < 3; k++)
            point_then(m, s, still->x + k, still->x + k);
    } else { /* points come first, and what else they have keeps its size */
        const int points = contact_kinds[m->shape.kind] == &contact_capsule ? 2 : 1;
        for (int i = 0; i < points; i++) {
            phys_vec at;
            chord(m, s, m->shape.value + 3 * i, &at);
            for (int c = 0; c < 3; c++)
                still->shape.value[3 * i + c] = at[c];
        }
    }
    contact_solid_make(&still->shape, &still->pose, &still->solid);
}

/* The same by the nearest point, which `nearest` holds against the search above. */
static inline bool comes_near(const struct meeting *m)
{
    for (int i = 0; i <= TIMES; i++) {
        const double s = (double)i / TIMES;
        struct contact_solid_point point = {.gap = INFINITY};
        struct meeting still;
        phys_vec x[3];
        for (int k = 0; k < 3; k++) {
            x[k] = (1 - s) * m->x[k] + s * m->y[k];
            if (contact_kinds[m->shape.kind] == &contact_plane)
                point.gap = fmin(point.gap, level_plane(m, s, x + k));
        }
        if (contact_kinds[m->shape.kind] != &contact_plane) {
            freeze(m, s, &still);
            contact_solid_nearest(&still.solid, CONTACT_BEGIN, still.x, &point);
        }
        if (!(point.gap > 0))
            return true;
    }
    return false;
}

static inline bool touches(const struct meeting *m)
{
    for (int i = 0; i <= TIMES; i++) {
        const double s = (double)i / TIMES;
        phys_vec x[3];
        for (int k = 0; k < 3; k++)
            x[k] = (1 - s) * m->x[k] + s * m->y[k];
        if (!outside_by_middle(m, s, x) && !(least_level(m, s, x) > 0))
            return true;
    }
    return false;
}

#endif
