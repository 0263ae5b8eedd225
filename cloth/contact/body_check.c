/* A body's mesh must be closed and hold room. Its triangles must have an area, be wound alike, and
 * not lie on each other. */
#include "cloth/base/sets.h"
#include "cloth/contact/making.h"

#include <math.h>
#include <stdlib.h>

/* FLAT, EMPTY: below these parts of the possible size, a triangle has no area, or a body no room.
 * FOLDED, rad: below it, two triangles at an edge lie on each other. */
static const double FLAT = 1e-9, EMPTY = 1e-9, FOLDED = 1e-10;
enum { MAX_TRIANGLES = 1 << 28 };

/* ---- Triangles and edges ---- */

int contact_body_check_vertices(const struct contact_making *making)
{
    const struct mesh *mesh = making->mesh;
    if (!making->n)
        return cloth_fail(making->error, CLOTH_E_INPUT,
                          "the mesh has no triangles; a closed surface is expected");
    if (making->n >= MAX_TRIANGLES)
        return cloth_fail(making->error, CLOTH_E_INPUT,
                          "the mesh has %u triangles; fewer than %d are expected", making->n,
                          MAX_TRIANGLES);
    for (size_t i = 0; i < 3 * (size_t)mesh->n_vertices; i++)
        if (!(fabs(mesh->position[i]) < CONTACT_BODY_BOUND))
            return cloth_fail(making->error, CLOTH_E_INPUT,
                              "vertex %zu is %g m from the origin along an axis; less than %g m is "
                              "expected (vertices count from 1)",
                              i / 3 + 1, fabs(mesh->position[i]), CONTACT_BODY_BOUND);
    return CLOTH_OK;
}

/* Normals, and boxes. */
static int measure_triangle(struct contact_making *making, uint32_t t)
{
    phys_vec x[3], longest = {0};
    uint32_t *corner = making->corner[t];
    mesh_corners(making->mesh, t, corner);
    for (int i = 0; i < 3; i++)
        contact_load(making, corner[i], x + i);
    for (int c = 0; c < 3; c++) {
        making->low[t][c] = fmin(x[0][c], fmin(x[1][c], x[2][c]));
        making->high[t][c] = fmax(x[0][c], fmax(x[1][c], x[2][c]));
    }
    for (int i = 0; i < 3; i++) {
        const phys_vec edge = x[(i + 1) % 3] - x[i];
        longest[0] = fmax(longest[0], phys_dot(&edge, &edge));
    }
    const phys_vec ab = x[1] - x[0], ac = x[2] - x[0];
    contact_cross(&ab, &ac, making->normal + t);
    const double twice = sqrt(phys_dot(making->normal + t, making->normal + t));
    if (!(twice > FLAT * longest[0]))
        return cloth_fail(making->error, CLOTH_E_INPUT,
                          "triangle %u, of vertices %u, %u and %u, has no area; remove it, or move "
                          "a vertex (triangles and vertices count from 1)",
                          t + 1, corner[0] + 1, corner[1] + 1, corner[2] + 1);
    making->normal[t] /= twice;
    return CLOTH_OK;
}

static int by_ends(const void *left, const void *right)
{
    const struct contact_making_side *a = left, *b = right;
    if (a->ends != b->ends)
        return a->ends < b->ends ? -1 : 1;
    return (a->triangle > b->triangle) - (a->triangle < b->triangle);
}

static void body_check_sort_sides(struct contact_making *making)
{
    for (uint32_t t = 0; t < making->n; t++)
        for (uint32_t i = 0; i < 3; i++) {
            const uint32_t a = making->corner[t][i], b = making->corner[t][(i + 1) % 3];
            making->side[3 * (size_t)t + i] = (struct contact_making_side){
                a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a, t, i, a < b};
        }
    qsort(making->side, 3 * (size_t)making->n, sizeof *making->side, by_ends);
}

/* The number of sides that have the edge of this one, the first of them. */
static size_t body_check_count_sides(const struct contact_making *making, size_t first)
{
    size_t n = 1;
    while (first + n < 3 * (size_t)making->n &&
           making->side[first + n].ends == making->side[first].ends)
        n++;
    return n;
}

static int fail_open(const struct contact_making *making, size_t first, size_t n)
{
    const uint64_t ends = making->side[first].ends;
    size_t others = 0;
    for (size_t i = first, count; i < 3 * (size_t)making->n; i += count)
        others += (count = body_check_count_sides(making, i)) != 2;
    return cloth_fail(making->error, CLOTH_E_INPUT,
                      "the mesh is not closed: the edge between vertices %u and %u has %zu "
                      "triangle%s where 2 are expected, as %zu edge%s in all (vertices count from "
                      "1); fill the holes, or join the parts; an open surface may be a cloth whose "
                      "vertices are all pinned",
                      (uint32_t)(ends >> 32) + 1, (uint32_t)ends + 1, n, n == 1 ? "" : "s", others,
                      others == 1 ? " has" : "s have");
}

static int fail_turned(const struct contact_making *making, const struct contact_making_side *side)
{
    return cloth_fail(making->error, CLOTH_E_INPUT,
                      "triangles %u and %u, at the edge between vertices %u and %u, are wound "
                      "against each other (triangles and vertices count from 1); turn one round",
                      side[0].triangle + 1, side[1].triangle + 1, (uint32_t)(side->ends >> 32) + 1,
                      (uint32_t)side->ends + 1);
}

/* Their normals point against each other: between them there is nothing, and no side is inside. */
static int fail_folded(const struct contact_making *making, const struct contact_making_side *side)
{
    return cloth_fail(making->error, CLOTH_E_INPUT,
                      "triangles %u and %u lie on each other, at the edge between vertices %u and "
                      "%u (triangles and vertices count from 1); a body has room between its "
                      "sides: remove both, or move a vertex",
                      side[0].triangle + 1, side[1].triangle + 1, (uint32_t)(side->ends >> 32) + 1,
                      (uint32_t)side->ends + 1);
}

static bool are_folded(const struct contact_making *making, const struct contact_making_side *side)
{
    const phys_vec sum = making->normal[side[0].triangle] + making->normal[side[1].triangle];
    return phys_dot(&sum, &sum) < FOLDED * FOLDED;
}

static int join_sides(struct contact_making *making)
{
    body_check_sort_sides(making);
    for (size_t i = 0; i < 3 * (size_t)making->n; i += 2) {
        const struct contact_making_side *side = making->side + i;
        const size_t n = body_check_count_sides(making, i);
        if (n != 2)
            return fail_open(making, i, n);
        if (side[0].rises == side[1].rises)
            return fail_turned(making, side);
        if (are_folded(making, side))
            return fail_folded(making, side);
        making->neighbour[side[0].triangle][side[0].edge] = side[1].triangle;
        making->neighbour[side[1].triangle][side[1].edge] = side[0].triangle;
    }
    return CLOTH_OK;
}

/* ---- Inside and outside ---- */

/* The corners of a triangle as seen from a point. */
static void see(const struct contact_making *making, uint32_t t, const phys_vec *from,
                phys_vec x[3])
{
    for (int i = 0; i < 3; i++) {
        contact_load(making, making->corner[t][i], x + i);
        x[i] -= *from;
    }
}

/* Six times the volume, m^3, and its possible size: its magnitude if all parts had one sign. */
static void find_volume(const struct contact_making *making, double *volume, double *most)
{
    phys_vec origin;
    contact_load(making, making->corner[0][0], &origin);
    *volume = *most = 0;
    for (uint32_t t = 0; t < making->n; t++) {
        phys_vec x[3], area;
        see(making, t, &origin, x);
        contact_cross(x + 1, x + 2, &area);
        const double part = phys_dot(x, &area);
        *volume += part;
        *most += fabs(part);
    }
}

static void turn_round(struct contact_making *making)
{
    for (uint32_t t = 0; t < making->n; t++) {
        uint32_t *corner = making->corner[t], *neighbour = making->neighbour[t];
        const uint32_t second = corner[1], first = neighbour[0];
        corner[1] = corner[2];
        corner[2] = second;
        neighbour[0] = neighbour[2];
        neighbour[2] = first;
        making->normal[t] = -making->normal[t];
    }
}

static int orient(struct contact_making *making, bool *turned)
{
    double volume, most;
    find_volume(making, &volume, &most);
    if (!(fabs(volume) > EMPTY * most))
        return cloth_fail(making->error, CLOTH_E_INPUT,
                          "the mesh holds no room: its volume is zero; a body is expected");
    *turned = volume < 0;
    if (*turned)
        turn_round(making);
    return CLOTH_OK;
}

/* ---- Parts ---- */

/* The parts of a mesh are joined by edges. By number of the triangle, until the tree takes its
 * room: `order` leads to the first triangle of the part, whose normal has its volume in lane 3. */
static uint32_t body_check_part_of(const struct contact_making *making, uint32_t t)
{
    return cloth_sets_root(making->order, t);
}

static void body_check_find_parts(struct contact_making *making)
{
    cloth_sets_start(making->order, making->n);
    for (uint32_t t = 0; t < making->n; t++)
        for (int i = 0; i < 3; i++)
            cloth_sets_join(making->order, t, making->neighbour[t][i]);
}

static void measure_parts(struct contact_making *making)
{
    for (uint32_t t = 0; t < making->n; t++) {
        const uint32_t part = body_check_part_of(making, t);
        phys_vec origin, x[3], area;
        contact_load(making, making->corner[part][0], &origin);
        see(making, t, &origin, x);
        contact_cross(x + 1, x + 2, &area);
        making->normal[part][3] += phys_dot(x, &area);
    }
}

/* The winding number of the other parts around a vertex of a part: sums of solid angles (van
 * Oosterom & Strackee 1983). It is rounded to a whole number, so that the bits of atan2 do not
 * matter. */
static double windings_of(const struct contact_making *making, uint32_t part)
{
    phys_vec from;
    double sum = 0;
    contact_load(making, making->corner[part][0], &from);
    for (uint32_t t = 0; t < making->n; t++) {
        phys_vec x[3], area;
        double length[3];
        if (body_check_part_of(making, t) == part)
            continue;
        see(making, t, &from, x);
        for (int i = 0; i < 3; i++)
            length[i] = sqrt(phys_dot(x + i, x + i));
        contact_cross(x + 1, x + 2, &area);
        sum += 2 * atan2(phys_dot(x, &area),
                         length[0] * length[1] * length[2] + phys_dot(x, x + 1) * length[2] +
                             phys_dot(x + 1, x + 2) * length[0] + phys_dot(x + 2, x) * length[1]);
    }
    return round(sum / (4 * 3.14159265358979323846));
}

/* A part that is inside out is right as a hole in another one only. */
static int check_parts(struct contact_making *making)
{
    int code = CLOTH_OK;
    body_check_find_parts(making);
    measure_parts(making);
    for (uint32_t t = 0; t < making->n; t++) {
        if (!code && making->normal[t][3] < 0 && windings_of(making, t) < 1)
            code = cloth_fail(making->error, CLOTH_E_INPUT,
                              "the part of the mesh that has vertex %u is inside out, and is no "
                              "hole in another part (vertices count from 1); turn its faces round",
                              making->corner[t][0] + 1);
        making->normal[t][3] = 0;
    }
    return code;
}

int contact_body_check(struct contact_making *making, bool *turned)
{
    int code = CLOTH_OK;
    for (uint32_t t = 0; t < making->n && !code; t++)
        code = measure_triangle(making, t);
    code = code ? code : join_sides(making);
    code = code ? code : orient(making, turned);
    return code ? code : check_parts(making);
}
