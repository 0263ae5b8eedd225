/* Closest points of every kind of shape, in random poses, against what a point inside it is. That
 * is said here once more, without distances; the surface is found from it by halving. */
#include "cloth/contact/surface.h"
#include "tests/cloth/contact/shapes.h"
#include "tests/support/unit.h"

#include <stdlib.h>
#include <string.h>

enum { SHAPES = 20, POINTS = 100, SAMPLES = 1000 };

/* Two key frames, whose motion lasts from 1 to 2 s. */
static void make(uint32_t kind, struct contact_shape *shape, struct phys_key keys[2])
{
    pick_shape(kind, 0.2, shape);
    for (int k = 0; k < 2; k++) {
        keys[k].time = 1 + k;
        for (int i = 0; i < 3; i++) {
            keys[k].translate[i] = uniform(-1, 1);
            shape->about[i] = uniform(-1, 1);
        }
        pick_turn(keys[k].rotate);
    }
}

/* ---- What is inside: a function a kind, of its parameters as they stand in scenes ---- */

static bool inside_plane(const double *v, const phys_vec *x)
{
    return ((*x)[0] - v[0]) * v[3] + ((*x)[1] - v[1]) * v[4] + ((*x)[2] - v[2]) * v[5] <= 0;
}

static bool inside_sphere(const double *v, const phys_vec *x)
{
    double square = 0;
    for (int i = 0; i < 3; i++)
        square += ((*x)[i] - v[i]) * ((*x)[i] - v[i]);
    return square <= v[3] * v[3];
}

/* The conjugate of q times x - centre times q. */
static bool inside_box(const double *v, const phys_vec *x)
{
    const double w = v[6], *u = v + 7;
    double d[3], c[3], own[3];
    for (int i = 0; i < 3; i++)
        d[i] = (*x)[i] - v[i];
    for (int i = 0; i < 3; i++)
        c[i] = d[(i + 1) % 3] * u[(i + 2) % 3] - d[(i + 2) % 3] * u[(i + 1) % 3] + w * d[i];
    for (int i = 0; i < 3; i++)
        own[i] = w * c[i] + c[(i + 1) % 3] * u[(i + 2) % 3] - c[(i + 2) % 3] * u[(i + 1) % 3] +
                 u[i] * (u[0] * d[0] + u[1] * d[1] + u[2] * d[2]);
    return fabs(own[0]) <= v[3] / 2 && fabs(own[1]) <= v[4] / 2 && fabs(own[2]) <= v[5] / 2;
}

/* Nearer than the radius to some point of the line: sought for by halving three parts of it. */
static bool inside_capsule(const double *v, const phys_vec *x)
{
    double low = 0, high = 1, square[2] = {0};
    for (int i = 0; i < 60; i++) {
        const double part[2] = {low + (high - low) / 3, high - (high - low) / 3};
        for (int k = 0; k < 2; k++) {
            square[k] = 0;
            for (int c = 0; c < 3; c++) {
                const double away = (*x)[c] - (1 - part[k]) * v[c] - part[k] * v[3 + c];
                square[k] += away * away;
            }
        }
        *(square[0] < square[1] ? &high : &low) = part[square[0] < square[1]];
    }
    return square[0] <= v[6] * v[6];
}

static bool inside_cylinder(const double *v, const phys_vec *x)
{
    double along = 0, square = 0;
    for (int c = 0; c < 3; c++) {
        along += ((*x)[c] - v[c]) * v[3 + c];
        square += ((*x)[c] - v[c]) * ((*x)[c] - v[c]);
    }
    return fabs(along) <= v[7] / 2 && square - along * along <= v[6] * v[6];
}

/* A point that is inside, too. */
static const struct inside {
    const char *name;
    bool (*is)(const double *value, const phys_vec *x);
    double deep[3]; /* weights of the first three vectors of parameters */
} INSIDE[] = {{"plane", inside_plane, {1, -1, 0}},
              {"sphere", inside_sphere, {1, 0, 0}},
              {"box", inside_box, {1, 0, 0}},
              {"capsule", inside_capsule, {0.5, 0.5, 0}},
              {"cylinder", inside_cylinder, {1, 0, 0}}};

static const struct inside *inside_of(uint32_t kind)
{
    for (size_t i = 0; i < sizeof INSIDE / sizeof *INSIDE; i++)
        if (!strcmp(INSIDE[i].name, contact_kinds[kind]->name))
            return INSIDE + i;
    ck_abort_msg("%s: nothing here says what is inside", contact_kinds[kind]->name);
    return NULL;
}

static bool is_inside(const struct contact_shape *shape, const struct contact_pose *pose,
                      const phys_vec *x)
{
    phys_vec own;
    phys_pose_back(&pose->to, x, &own);
    return inside_of(shape->kind)->is(shape->value, &own);
}

/* A point of the surface, in a random direction from one inside; false: there is none. */
static bool surface_point(const struct contact_shape *shape, const struct contact_pose *pose,
                          phys_vec *x)
{
    const double *deep = inside_of(shape->kind)->deep, *v = shape->value;
    phys_vec from = {0}, way;
    pick_point(1, &way);
    double in = 0, out = 20 / length(&way);
    for (int i = 0; i < 3; i++)
        from[i] = deep[0] * v[i] + deep[1] * v[3 + i] + deep[2] * v[6 + i];
    phys_pose_point(&pose->to, &from, &from);
    if (!is_inside(shape, pose, &from))
        ck_abort_msg("%s: no point inside", contact_kinds[shape->kind]->name);
    *x = from + out * way;
    if (is_inside(shape, pose, x))
        return false;
    for (int i = 0; i < 60; i++) {
        const double part = (in + out) / 2;
        *x = from + part * way;
        *(is_inside(shape, pose, x) ? &in : &out) = part;
    }
    return true;
}

/* ---- The cases, one for each kind ---- */

/* The last kind is bodies: test_body.c. */
#define N_SHAPES ((int)contact_n_kinds - 1)

UNIT_LOOP(nearest_of_all, 0, N_SHAPES)
{
    static phys_vec surface[SAMPLES];
    const int samples = unit_quick() ? SAMPLES / 10 : SAMPLES;
    for (int s = 0; s < SHAPES; s++) {
        struct contact_shape shape;
        struct phys_key keys[2];
        struct contact_pose pose;
        size_t n = 0;
        make((uint32_t)_i, &shape, keys);
        contact_pose_over(&shape, keys, NULL, 1.2, uniform(1.2, 2), &pose);
        for (int i = 0; i < samples; i++)
            n += surface_point(&shape, &pose, surface + n);
        ck_assert_uint_gt(n, (unsigned)samples / 4);
        for (int i = 0; i < POINTS; i++) {
            phys_vec x;
            pick_point(3, &x);
            struct contact_hit hit;
            contact_closest(&shape, &pose, 1, &x, &hit);
            const phys_vec foot = x - hit.gap * hit.normal, under = foot - 1e-9 * hit.normal,
                           over = foot + 1e-9 * hit.normal;
            ck_assert_double_eq_tol(length(&hit.normal), 1, 1e-14);
            ck_assert(is_inside(&shape, &pose, &x) == (hit.gap <= 0));
            ck_assert(is_inside(&shape, &pose, &under) && !is_inside(&shape, &pose, &over));
            double least = INFINITY;
            for (size_t k = 0; k < n; k++) {
                const phys_vec away = surface[k] - x;
                least = fmin(least, length(&away));
            }
            ck_assert_double_ge(least, fabs(hit.gap) - 1e-9);
        }
    }
}

/* Where the normal has no jump the gap's slope is the normal; the gap itself has no jump. */
UNIT_LOOP(the_slope_is_the_normal, 0, N_SHAPES)
{
    const double e = 1e-6;
    size_t smooth = 0;
    for (int s = 0; s < SHAPES; s++) {
        struct contact_shape shape;
        struct phys_key keys[2];
        struct contact_pose pose;
        make((uint32_t)_i, &shape, keys);
        contact_pose_over(&shape, keys, NULL, 1.2, 1.7, &pose);
        for (int i = 0; i < POINTS; i++) {
            phys_vec x;
            pick_point(2, &x);
            struct contact_hit hit, near[6];
            phys_vec around[6], slope = {0};
            bool is_smooth = true;
            contact_closest(&shape, &pose, 1, &x, &hit);
            for (int k = 0; k < 6; k++) {
                around[k] = x;
                around[k][k / 2] += k % 2 ? -e : e;
            }
            contact_closest(&shape, &pose, 6, around, near);
            for (int k = 0; k < 6; k++) {
                const phys_vec turn = near[k].normal - hit.normal;
                is_smooth = is_smooth && length(&turn) < 1e-3;
                slope[k / 2] += near[k].gap / (k % 2 ? -2 * e : 2 * e);
                ck_assert_double_le(fabs(near[k].gap - hit.gap), e * (1 + 1e-6));
            }
            const phys_vec off = slope - hit.normal;
            smooth += is_smooth;
            ck_assert(!is_smooth || length(&off) < 1e-5);
        }
    }
    ck_assert_uint_gt(smooth, SHAPES * POINTS / 10 * 9);
}

/* The surface goes with the keys: its points of one time are at another where its velocity says. */
UNIT_LOOP(the_surface_has_its_velocity, 0, N_SHAPES)
{
    const double from = 1.3, to = 1.7;
    for (int s = 0; s < SHAPES; s++) {
        struct contact_shape shape;
        struct phys_key keys[2];
        struct contact_pose pose, before;
        make((uint32_t)_i, &shape, keys);
        contact_pose_over(&shape, keys, NULL, from, to, &pose);
        contact_pose_over(&shape, keys, NULL, from, from, &before);
        for (int i = 0; i < POINTS; i++) {
            phys_vec x;
            pick_point(2, &x);
            struct contact_hit hit, was;
            contact_closest(&shape, &pose, 1, &x, &hit);
            const phys_vec foot = x - hit.gap * hit.normal,
                           back = foot - (to - from) * hit.velocity;
            contact_closest(&shape, &before, 1, &back, &was);
            ck_assert_double_eq_tol(was.gap, 0, 1e-12);
        }
    }
}

/* Along a line between two keys the velocity is theirs, at rest it is none. */
UNIT_LOOP(keys_say_the_velocity, 0, N_SHAPES)
{
    const struct phys_key keys[2] = {{1, {0, 0, 0}, {1, 0, 0, 0}}, {3, {4, -2, 1}, {1, 0, 0, 0}}};
    const phys_vec x = {0.3, 0.4, 0.5, 0};
    struct phys_key own[2];
    struct contact_shape shape;
    make((uint32_t)_i, &shape, own);
    for (int when = 0; when < 3; when++) {
        struct contact_pose pose;
        struct contact_hit hit;
        contact_pose_over(&shape, keys, NULL, when * 1.5, when * 1.5 + 0.5, &pose);
        contact_closest(&shape, &pose, 1, &x, &hit);
        for (int c = 0; c < 3; c++)
            ck_assert_double_eq_tol(hit.velocity[c], when == 1 ? keys[1].translate[c] / 2 : 0,
                                    1e-14);
    }
}

/* Where a kind says so, points are apart where each has a gap. */
UNIT_LOOP(apart, 0, N_SHAPES)
{
    struct contact_shape shape;
    struct phys_key keys[2];
    size_t n_apart = 0;
    for (int i = 0; contact_kinds[_i]->apart && i < POINTS; i++) {
        phys_vec x[3];
        struct contact_hit hit[3];
        make((uint32_t)_i, &shape, keys);
        for (int k = 0; k < 3; k++)
            pick_point(2, x + k);
        contact_kinds[_i]->closest(shape.value, NULL, 3, x, hit);
        const bool is = contact_kinds[_i]->apart(shape.value, NULL, 3, x);
        ck_assert(is == (hit[0].gap > 0 && hit[1].gap > 0 && hit[2].gap > 0));
        n_apart += is;
        x[1][0] = NAN;
        ck_assert(!contact_kinds[_i]->apart(shape.value, NULL, 3, x));
    }
    ck_assert(!contact_kinds[_i]->apart || (n_apart > 0 && n_apart < POINTS));
}

/* So near to the middle of a ball or a rod that squares of distances vanish. */
UNIT_LOOP(normals_in_the_middle, 0, N_SHAPES)
{
    struct contact_shape shape;
    struct phys_key keys[2];
    make((uint32_t)_i, &shape, keys);
    for (int k = 0; k < 6; k++)
        shape.value[k] = k == 3 ? 1 : 0;
    for (double away = 1; away > 0; away /= 8) {
        struct contact_hit hit;
        const phys_vec x = {0, away, away / 2, 0};
        contact_kinds[_i]->closest(shape.value, NULL, 1, &x, &hit);
        if (contact_kinds[_i] != &contact_plane && contact_kinds[_i] != &contact_box)
            ck_assert_double_eq_tol(length(&hit.normal), 1, 1e-12);
    }
}

/* For pictures: points of the surface with their normals, triangles seen from outside. */
UNIT_LOOP(surfaces, 0, N_SHAPES)
{
    struct contact_shape shape;
    struct phys_key keys[2];
    if (!contact_kinds[_i]->around)
        return;
    double(*vertex)[6] = malloc(CONTACT_SURFACE_VERTICES * sizeof *vertex);
    uint32_t(*triangle)[3] = malloc(CONTACT_SURFACE_TRIANGLES * sizeof *triangle);
    ck_assert(vertex && triangle);
    make((uint32_t)_i, &shape, keys);
    contact_surface(&shape, NULL, vertex, triangle);
    for (size_t t = 0; t < CONTACT_SURFACE_TRIANGLES; t++) {
        phys_vec x[3], normal;
        for (int k = 0; k < 3; k++) {
            const double *p = vertex[triangle[t][k]];
            struct contact_hit hit;
            x[k] = (phys_vec){p[0], p[1], p[2], 0};
            normal = (phys_vec){p[3], p[4], p[5], 0};
            contact_kinds[_i]->closest(shape.value, NULL, 1, x + k, &hit);
            ck_assert_double_eq_tol(hit.gap, 0, 1e-12);
        }
        const phys_vec a = x[1] - x[0], b = x[2] - x[0];
        const phys_vec cross = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                                a[0] * b[1] - a[1] * b[0], 0};
        ck_assert_double_gt(phys_dot(&cross, &normal), 0.8 * length(&cross));
    }
    free(vertex);
    free(triangle);
}
