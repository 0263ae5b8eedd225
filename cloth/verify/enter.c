/* The gap of a convex shape is a convex function of the point. So the gap and the normal at any
 * point make a plane that lies below it everywhere. If the lowest point of all planes of a
 * triangle is not deep, the triangle is not deep. Else the gap at that point decides, or adds a
 * plane (Kelley, The cutting-plane method for solving convex programs, 1960). A plane is given
 * by its heights at the three corners, a point by weights of these. */
#include "cloth/verify/verify.h"

#include <math.h>
#include <string.h>

enum { ROOM = 12, ROUNDS = 100 };

struct planes {
    int n;
    double height[ROOM][3];
};

/* A point of a triangle, and the height of the highest plane there. */
struct lowest {
    double weight[3], height;
};

/* ---- The lowest point ---- */

static double height_at(const double plane[3], const double weight[3])
{
    return weight[0] * plane[0] + weight[1] * plane[1] + weight[2] * plane[2];
}

static void try_point(const struct planes *planes, const double weight[3], struct lowest *lowest)
{
    double height = -INFINITY;
    for (int k = 0; k < planes->n; k++)
        height = fmax(height, height_at(planes->height[k], weight));
    if (height < lowest->height) {
        memcpy(lowest->weight, weight, sizeof lowest->weight);
        lowest->height = height;
    }
}

/* Points of the edges where two planes are equally high. */
static void try_two(const struct planes *planes, const double *a, const double *b,
                    struct lowest *lowest)
{
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        const double at_i = a[i] - b[i], at_j = a[j] - b[j];
        if (!(at_i * at_j < 0))
            continue;
        double weight[3] = {0};
        weight[i] = at_j / (at_j - at_i);
        weight[j] = 1 - weight[i];
        try_point(planes, weight, lowest);
    }
}

/* The point where three planes are equally high. */
static void try_three(const struct planes *planes, const double *a, const double *b,
                      const double *c, struct lowest *lowest)
{
    double weight[3], sum = 0;
    bool within = true;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        weight[i] = (a[j] - b[j]) * (a[k] - c[k]) - (a[k] - b[k]) * (a[j] - c[j]);
        sum += weight[i];
    }
    for (int i = 0; i < 3; i++) {
        weight[i] /= sum;
        within = within && weight[i] >= 0;
    }
    if (within)
        try_point(planes, weight, lowest);
}

/* Tries all points where as many planes are equally high as weights are above 0. */
static void find_lowest(const struct planes *planes, struct lowest *lowest)
{
    const double(*plane)[3] = planes->height;
    lowest->height = INFINITY;
    for (int i = 0; i < 3; i++) {
        double corner[3] = {0};
        corner[i] = 1;
        try_point(planes, corner, lowest);
    }
    for (int a = 0; a < planes->n; a++)
        for (int b = 0; b < a; b++) {
            try_two(planes, plane[a], plane[b], lowest);
            for (int c = 0; c < b; c++)
                try_three(planes, plane[a], plane[b], plane[c], lowest);
        }
}

/* ---- Triangles ---- */

static void plane_at(const phys_vec x[3], const phys_vec *at, const struct contact_hit *hit,
                     double plane[3])
{
    for (int i = 0; i < 3; i++) {
        const phys_vec way = x[i] - *at;
        plane[i] = hit->gap + phys_dot(&hit->normal, &way);
    }
}

/* Adds a plane; if there is no room, it replaces the lowest one at that point. */
static void put_plane(struct planes *planes, const double plane[3], const double weight[3])
{
    int to = 0;
    for (int k = 1; k < planes->n; k++)
        if (height_at(planes->height[k], weight) < height_at(planes->height[to], weight))
            to = k;
    if (planes->n < ROOM)
        to = planes->n++;
    memcpy(planes->height[to], plane, sizeof planes->height[to]);
}

/* True if a triangle is deep somewhere. corner: the hits of its corners, none of them deep. */
static bool is_deep(const struct contact_shape *shape, const struct contact_pose *pose,
                    const phys_vec x[3], const struct contact_hit corner[3], double depth)
{
    struct planes planes = {.n = 3};
    struct lowest lowest;
    struct contact_hit hit;
    for (int i = 0; i < 3; i++)
        plane_at(x, x + i, corner + i, planes.height[i]);
    for (int round = 0; round < ROUNDS; round++) {
        find_lowest(&planes, &lowest);
        if (lowest.height >= -2 * depth)
            return false;
        const double *w = lowest.weight;
        const phys_vec at = w[0] * x[0] + w[1] * x[1] + w[2] * x[2];
        contact_closest(shape, pose, 1, &at, &hit);
        if (hit.gap < -depth)
            return true;
        double plane[3];
        plane_at(x, &at, &hit, plane);
        put_plane(&planes, plane, w);
    }
    return true; /* not shown to be outside */
}

/* True if the plane of one corner is deep at no corner. */
static bool is_clear(const phys_vec x[3], const struct contact_hit hit[3], double depth)
{
    bool clear = false;
    for (int i = 0; i < 3 && !clear; i++) {
        double plane[3];
        plane_at(x, x + i, hit + i, plane);
        clear = plane[0] >= -depth && plane[1] >= -depth && plane[2] >= -depth;
    }
    return clear;
}

static bool enters(const struct verify_soup *soup, uint32_t triangle,
                   const struct contact_shape *shape, const struct contact_pose *pose, double depth)
{
    phys_vec x[3];
    struct contact_hit hit[3];
    for (int i = 0; i < 3; i++) {
        const double *from = soup->x[soup->corner[triangle][i]];
        x[i] = (phys_vec){from[0], from[1], from[2], 0};
    }
    contact_closest(shape, pose, 3, x, hit);
    return hit[0].gap < -depth || hit[1].gap < -depth || hit[2].gap < -depth ||
           (!is_clear(x, hit, depth) && is_deep(shape, pose, x, hit, depth));
}

int verify_enter(const struct verify_soup *soup, const struct contact_shape *shape,
                 const struct contact_pose *pose, double depth, struct cloth_list *triangles,
                 struct cloth_error *error)
{
    for (uint32_t t = 0; t < soup->n_first; t++) {
        if (!enters(soup, t, shape, pose, depth))
            continue;
        uint32_t *number = cloth_list_add(triangles, sizeof *number, 1, error);
        if (!number)
            return CLOTH_E_MEMORY;
        *number = t;
    }
    return CLOTH_OK;
}
