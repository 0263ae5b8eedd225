/* Triangles against convex shapes of every kind, in random poses: how deep one is follows here of
 * nested searches, since gaps are convex. Points against closed surfaces. */
#include "cloth/verify/verify.h"
#include "tests/cloth/contact/bodies.h"
#include "tests/cloth/contact/shapes.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TRIANGLES = 100, HALVINGS = 50 };
static const double DEPTH = 1e-6;

/* Two key frames, whose motion lasts from 1 to 2 s. */
static void make_shape(uint32_t kind, struct contact_shape *shape, struct phys_key keys[2])
{
    pick_shape(kind, 0.2, shape);
    memset(keys, 0, 2 * sizeof *keys);
    for (int k = 0; k < 2; k++) {
        keys[k].time = 1 + k;
        pick_turn(keys[k].rotate);
    }
}

/* ---- How deep a triangle is ---- */

struct place {
    const struct contact_shape *shape;
    struct contact_pose pose;
    double x[3][3];
};

static double gap_at(const struct place *place, double u, double v, phys_vec *normal)
{
    phys_vec at = {0};
    struct contact_hit hit;
    for (int c = 0; c < 3; c++)
        at[c] = place->x[0][c] + (1 - v) * u * (place->x[1][c] - place->x[0][c]) +
                v * (place->x[2][c] - place->x[0][c]);
    contact_closest(place->shape, &place->pose, 1, &at, &hit);
    *normal = hit.normal;
    return hit.gap;
}

/* Along a line from corner 2 to the opposite edge, or of all lines if u < 0. */
static double least_gap(const struct place *place, double u, phys_vec *normal)
{
    double low = 0, high = 1, gap[2] = {0};
    for (int i = 0; i < HALVINGS; i++) {
        const double part[2] = {low + (high - low) / 3, high - (high - low) / 3};
        for (int k = 0; k < 2; k++)
            gap[k] = u < 0 ? least_gap(place, part[k], normal) : gap_at(place, u, part[k], normal);
        *(gap[0] < gap[1] ? &high : &low) = part[gap[0] < gap[1]];
    }
    return gap[0];
}

/* A triangle, moved along the normal at its deepest point to about `deep`. */
static void make_place(struct place *place, double deep)
{
    phys_vec normal;
    const double size = uniform(0, 1) < 0.5 ? 2 : 0.2;
    for (int c = 0; c < 3; c++) {
        const double middle = uniform(-1.5, 1.5);
        for (int i = 0; i < 3; i++)
            place->x[i][c] = middle + uniform(-size, size);
    }
    const double gap = least_gap(place, -1, &normal);
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 3; c++)
            place->x[i][c] -= (gap + deep) * normal[c];
}

static void check_place(const struct place *place, int count[3])
{
    static const uint32_t corner[1][3] = {{0, 1, 2}};
    const struct verify_soup soup = {3, 1, 1, place->x, corner, NULL};
    struct cloth_list list = {0};
    phys_vec normal;
    UNIT_FINE(verify_enter(&soup, place->shape, &place->pose, DEPTH, &list, &error));
    const double gap = least_gap(place, -1, &normal);
    const bool shallow = gap > -0.99 * DEPTH, deep = gap < -2.01 * DEPTH;
    ck_assert_msg(!shallow || !list.n, "%s: found at gap %.17g",
                  contact_kinds[place->shape->kind]->name, gap);
    ck_assert_msg(!deep || list.n, "%s: not found at gap %.17g",
                  contact_kinds[place->shape->kind]->name, gap);
    count[shallow ? 0 : deep ? 2 : 1]++;
    free(list.items);
}

UNIT_TEST(enter)
{
    static const double deep[] = {1e-2, 4e-6, 1e-6, 0.5e-6, 0, -1e-6, -1e-3};
    const int n = unit_quick() ? TRIANGLES / 10 : TRIANGLES;
    for (uint32_t kind = 0; contact_kinds[kind] != &contact_body_kind; kind++) {
        int count[3] = {0};
        for (int k = 0; k < n; k++) {
            struct contact_shape shape;
            struct phys_key keys[2];
            struct place place = {.shape = &shape};
            make_shape(kind, &shape, keys);
            contact_pose_over(&shape, keys, NULL, 1.3, 1.3, &place.pose);
            make_place(&place, deep[k % 7]);
            check_place(&place, count);
        }
        ck_assert(count[0] > n / 5 && count[2] > n / 10);
    }
}

/* A cloth that lies on a face of a box and hangs over its edge; and one that lies on the edge. */
UNIT_TEST(edges)
{
    const struct contact_shape box = {.kind = 2, .value = {0, -.5, 0, 1, 1, 1, 1, 0, 0, 0}};
    ck_assert_str_eq(contact_kinds[box.kind]->name, "box");
    const double lie[2][3][3] = {{{.4, 0, 0}, {.7, 0, 0}, {.5, 0, .3}},
                                 {{.3, .2, 0}, {.7, -.2, 0}, {.5, 0, .3}}};
    for (int i = 0; i < 2; i++)
        for (int k = -2; k <= 2; k++) {
            struct place place = {.shape = &box};
            int count[3] = {0};
            memcpy(place.x, lie[i], sizeof place.x);
            for (int p = 0; p < 3; p++)
                place.x[p][1] += 6 * k * DEPTH;
            check_place(&place, count);
            ck_assert_int_eq(count[k < 0 ? 2 : 0], 1);
        }
}

/* Only the first triangles count, by number. */
UNIT_TEST(numbers)
{
    const struct contact_shape ball = {.kind = 1, .value = {0, 0, 0, 1}};
    const double x[9][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},  {2, 0, 0},  {2, 1, 0},
                            {2, 0, 1}, {0, 0, 5}, {5, 0, -5}, {-5, 0, -5}};
    const uint32_t corner[4][3] = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {0, 1, 2}};
    const struct verify_soup soup = {9, 4, 3, x, corner, NULL};
    const struct contact_pose pose = {0};
    struct cloth_list list = {0};
    UNIT_FINE(verify_enter(&soup, &ball, &pose, 1e-9, &list, &error));
    ck_assert_uint_eq(list.n, 2);
    ck_assert_uint_eq(((uint32_t *)list.items)[0], 0);
    ck_assert_uint_eq(((uint32_t *)list.items)[1], 2);
    free(list.items);
}

/* ---- Closed surfaces ---- */

static bool is_in_ring(const double at[3], double radius, double tube, double slack)
{
    const double far = sqrt(at[0] * at[0] + at[2] * at[2]) - radius;
    return sqrt(far * far + at[1] * at[1]) < tube * (1 + slack);
}

UNIT_TEST(inside)
{
    static struct surface s;
    int count[2] = {0};
    surface_torus(&s, 1, 0.4, 40, 20);
    const struct verify_soup soup = {s.n,
                                     s.n_triangles,
                                     s.n_triangles,
                                     (const double(*)[3])s.x,
                                     (const uint32_t(*)[3])s.triangle,
                                     NULL};
    for (int k = 0; k < 1000; k++) {
        double at[3];
        for (int c = 0; c < 3; c++) /* half of them in line with corners */
            at[c] = k % 2 ? uniform(-1.6, 1.6) : s.x[(k * 37 + c) % (int)s.n][c] * (c == k % 3);
        const bool in = is_in_ring(at, 1, 0.4, -0.05);
        if (in == is_in_ring(at, 1, 0.4, 0.01)) {
            ck_assert_int_eq(verify_inside(&soup, 0, s.n_triangles, at), in);
            count[in]++;
        }
    }
    ck_assert(count[0] > 100 && count[1] > 100);
}

/* The first line that is tried goes through a corner. */
UNIT_TEST(touched)
{
    const double x[6][3] = {{.5, .25 * (2 * 0.0123), .25 * (2 * 0.0317)},
                            {-1, 0, 0},
                            {0, 1, 0},
                            {0, -1, 0},
                            {0, 0, 1},
                            {0, 0, -1}};
    const double at[2][3] = {{0, 0, 0}, {-2, 0, 0}};
    uint32_t corner[8][3];
    for (uint32_t k = 0; k < 8; k++)
        for (uint32_t c = 0; c < 3; c++)
            corner[k][c] = 2 * c + (k >> c & 1);
    const struct verify_soup soup = {6, 8, 8, x, (const uint32_t(*)[3])corner, NULL};
    ck_assert(verify_inside(&soup, 0, 8, at[0]));
    ck_assert(!verify_inside(&soup, 0, 8, at[1]));
}
