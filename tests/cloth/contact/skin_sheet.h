#ifndef TESTS_CLOTH_CONTACT_SKIN_SHEET_H
#define TESTS_CLOTH_CONTACT_SKIN_SHEET_H

#include "cloth/contact/skin_table.h"
#include "tests/support/random.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A sheet of one of several shapes that moves in a step, cut into parts with a skin each. For one
 * test program: what is made stands in variables of the file. */

enum {
    SIDE = 17, /* vertices */
    N = SIDE * SIDE,
    TRIANGLES = 2 * (SIDE - 1) * (SIDE - 1),
    EDGES = 3 * SIDE * SIDE,
    TIMES = 4,
    PARTS = 6,
    SHAPES = 10
};
static const double EDGE = 5e-3; /* m, at rest */
static double longest;           /* m, of an edge in the step */

struct skin {
    void *table, *boxes;
    struct contact_skin skin;
    uint32_t point[N], triangle[TRIANGLES]; /* of the sheet; triangles as they were given */
    phys_vec x[N], y[N];
};

static phys_vec x[N], y[N];
static uint32_t corner[TRIANGLES][3], edge[EDGES][2], n_edges, part_of[N];
static uint32_t edge_of[N][N]; /* by its ends, ascending */
static struct skin skins[PARTS];

/* ---- The sheet ---- */

static inline void make_triangles(void)
{
    uint32_t n = 0;
    n_edges = 0;
    for (uint32_t j = 0; j < SIDE; j++)
        for (uint32_t i = 0; i < SIDE; i++) {
            const uint32_t v = j * SIDE + i;
            const uint32_t to[3] = {v + 1, v + SIDE, v + SIDE + 1};
            const int is[3] = {i + 1 < SIDE, j + 1 < SIDE, i + 1 < SIDE && j + 1 < SIDE};
            for (int k = 0; k < 3; k++)
                if (is[k]) {
                    edge_of[v][to[k]] = n_edges;
                    memcpy(edge[n_edges++], (uint32_t[2]){v, to[k]}, sizeof *edge);
                }
            if (!is[2])
                continue;
            memcpy(corner[n++], (uint32_t[3]){v, v + SIDE + 1, v + 1}, sizeof *corner);
            memcpy(corner[n++], (uint32_t[3]){v, v + SIDE, v + SIDE + 1}, sizeof *corner);
        }
}

/* A part of a ring, of so many degrees, that rises by a millimetre. */
static inline void ring(double degrees, double u, double v, phys_vec *at)
{
    const double part = u / ((SIDE - 1) * EDGE), turn = (part - 0.5) * degrees * acos(-1) / 180;
    *at = (phys_vec){(0.03 + v) * cos(turn), 1e-3 * part, (0.03 + v) * sin(turn), 0};
}

static inline void place(int shape, double u, double v, phys_vec *at)
{
    const double width = (SIDE - 1) * EDGE, pi = acos(-1);
    *at = (phys_vec){u, 0, v, 0};
    if (shape == 1 || shape == 4) { /* waves */
        (*at)[1] = 0.01 * sin(60 * u) * cos(45 * v);
    } else if (shape == 2 || shape == 5) { /* six layers, 1 mm from each other */
        const double layer = floor(6 * u / width), along = u - layer * width / 6;
        *at = (phys_vec){fmod(layer, 2) < 1 ? along : width / 6 - along, 1e-3 * layer, v, 0};
        (*at)[1] += 1e-3 * (6 * u / width - layer) + 2e-3 * sin(80 * v);
    } else if (shape == 3) { /* crumpled */
        *at = 0.3 * *at;
        for (int c = 0; c < 3; c++)
            (*at)[c] += uniform(-0.012, 0.012);
    } else if (shape == 6) { /* a roll */
        const double turn = u / width * 6 * pi, radius = 2e-3 + 2e-3 * turn / pi;
        *at = (phys_vec){radius * cos(turn), radius * sin(turn), v, 0};
    } else if (shape == 7) { /* a winding stair: all normals are up, and it lies above itself */
        const double turn = u / width * 4 * pi, radius = 0.01 + v;
        *at = (phys_vec){radius * cos(turn), 1.2e-3 * turn / (2 * pi), radius * sin(turn), 0};
    } else if (shape == 9) {
        ring(354, u, v, at);
    }
}

/* Two that are flat when the step begins: one folds, the other's border comes to cross itself. */
static inline void move(int shape, double u, double v, phys_vec *to)
{
    const double middle = 0.5 * (SIDE - 1) * EDGE, over = u - middle;
    if (shape == 8 && over > 0)
        *to = (phys_vec){middle - over, 1e-3, v, 0};
    if (shape == 9)
        ring(366, u, v, to);
}

/* Some are far away, some fast; every vertex has a motion of its own. */
static inline void make_sheet(int shape)
{
    const double fast = shape >= 4 && shape <= 7 ? 0.2 : 0, own = shape == 3   ? 5e-3
                                                                  : shape == 9 ? 1e-5
                                                                               : 5e-4;
    const phys_vec way = {fast, -2 * fast, fast, 0}, far = {0, fast > 0 ? 100 : 0, 0, 0};
    for (uint32_t i = 0; i < N; i++) {
        place(shape, EDGE * (i % SIDE), EDGE * (i / SIDE), x + i);
        x[i] += far;
        y[i] = x[i] + way;
        move(shape, EDGE * (i % SIDE), EDGE * (i / SIDE), y + i);
        for (int c = 0; c < 3; c++)
            y[i][c] += uniform(-own, own);
    }
}

/* ---- Its skins ---- */

/* Parts of unlike sizes; a triangle belongs to the lowest of its corners. */
static inline void make_parts(uint32_t n_parts)
{
    for (uint32_t i = 0; i < N; i++) {
        const uint32_t u = 3 * (i % SIDE) / SIDE, v = i / SIDE > SIDE / 3;
        part_of[i] = (u + 3 * v) % n_parts;
    }
}

static inline uint32_t part_of_triangle(uint32_t t)
{
    uint32_t least = PARTS;
    for (int k = 0; k < 3; k++)
        least = part_of[corner[t][k]] < least ? part_of[corner[t][k]] : least;
    return least;
}

static inline bool has(uint32_t t, uint32_t v)
{
    return corner[t][0] == v || corner[t][1] == v || corner[t][2] == v;
}

/* The first triangle of the sheet that has a vertex, or an edge, stands for it. */
static inline unsigned char stands_of(uint32_t t)
{
    unsigned char stands = 63;
    for (uint32_t s = 0; s < t; s++)
        for (int k = 0; k < 3; k++) {
            const uint32_t a = corner[t][k], b = corner[t][(k + 1) % 3];
            if (has(s, a))
                stands &= (unsigned char)~(1 << k);
            if (has(s, a) && has(s, b))
                stands &= (unsigned char)~(8 << k);
        }
    return stands;
}

static inline uint32_t point_of(struct skin *skin, uint32_t *n, uint32_t vertex)
{
    for (uint32_t i = 0; i < *n; i++)
        if (skin->point[i] == vertex)
            return i;
    skin->point[*n] = vertex;
    return (*n)++;
}

static inline void make_skin(struct skin *skin, uint32_t part)
{
    static uint32_t local[TRIANGLES][3];
    static unsigned char stands[TRIANGLES], held[N];
    struct contact_skin_source from = {.corner = (const uint32_t(*)[3])local,
                                       .stands = stands,
                                       .id = skin->point,
                                       .block = skin->point,
                                       .row = skin->point,
                                       .cloth = skin->point,
                                       .held = held,
                                       .x = skin->x};
    struct contact_skin sizes = {0};
    for (uint32_t t = 0; t < TRIANGLES; t++) {
        if (part_of_triangle(t) != part)
            continue;
        for (int k = 0; k < 3; k++)
            local[from.n_triangles][k] = point_of(skin, &from.n_points, corner[t][k]);
        stands[from.n_triangles] = stands_of(t);
        sizes.n_vertices += (uint32_t)__builtin_popcount(stands[from.n_triangles] & 7u);
        sizes.n_edges += (uint32_t)__builtin_popcount(stands[from.n_triangles] & 56u);
        skin->triangle[from.n_triangles++] = t;
    }
    for (uint32_t i = 0; i < from.n_points; i++)
        skin->x[i] = x[skin->point[i]];
    sizes.n_points = from.n_points;
    sizes.n_triangles = from.n_triangles;
    skin->table = aligned_alloc(CONTACT_ALIGN, contact_skin_bytes(&sizes));
    skin->boxes = aligned_alloc(CONTACT_ALIGN, contact_boxes_bytes(&sizes));
    ck_assert(skin->table && skin->boxes);
    ck_assert_int_eq(contact_skin_make(&from, skin->table, NULL), 0);
    skin->skin = contact_skin_open(skin->table);
    ck_assert_uint_eq(skin->skin.n_vertices, sizes.n_vertices);
    ck_assert_uint_eq(skin->skin.n_edges, sizes.n_edges);
}

/* Makes the boxes, in a frame as a run has it: the mean way of the points. Marks those that moved:
 * vertices by their number in the sheet. */
static unsigned char vertex_moved[N];

static inline void refit(struct skin *skin)
{
    phys_vec way = {0};
    const uint32_t n = skin->skin.n_points;
    for (uint32_t i = 0; i < n; i++) {
        skin->x[i] = x[skin->point[i]];
        skin->y[i] = y[skin->point[i]];
        way += (skin->y[i] - skin->x[i]) / n;
        contact_moved_points(&skin->skin, skin->boxes)[i] = vertex_moved[skin->point[i]];
    }
    contact_refit(&skin->skin, skin->x, skin->y, &way, skin->boxes);
    contact_moved_mark(&skin->skin, skin->boxes);
}

static inline void make(int shape, uint32_t n_parts)
{
    make_triangles();
    make_sheet(shape);
    make_parts(n_parts);
    for (uint32_t p = 0; p < PARTS; p++) {
        make_skin(skins + p, p);
        refit(skins + p);
    }
}

static inline void end(void)
{
    for (uint32_t p = 0; p < PARTS; p++) {
        free(skins[p].table);
        free(skins[p].boxes);
        skins[p] = (struct skin){0};
    }
}

/* In loops: each ck_assert writes to a file. */
static inline void must(bool is)
{
    if (!is)
        ck_abort_msg("a pair twice, or of features that share a vertex, or one that is left out or "
                     "parted and should not be, or a batch too large");
}

#endif
