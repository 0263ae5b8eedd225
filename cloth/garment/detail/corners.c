/* Two panels that are sewn on both sides of a corner fill it by one triangle each, of the same
 * three seam vertices. Sewn, the two are one sheet, and the corner could never open. So one of them
 * and its neighbour are divided the other way, from the corner inwards. */
#include "cloth/base/memory.h"
#include "cloth/base/order.h"
#include "cloth/base/sets.h"
#include "cloth/garment/detail/meshing.h"

#include <stdlib.h>

/* A triangle that fills a corner. */
struct ear {
    uint32_t root[3];     /* of its vertices' sets, ascending: equal in triangles that coincide */
    uint32_t triangle;    /* its number, */
    uint32_t beside;      /* and that of the triangle at its inner edge; itself: there is none */
    uint32_t corner, end; /* vertices: the corner, and the one after it, counterclockwise */
};

struct corners {
    struct garment *garment;
    uint32_t *set; /* by vertex: those that are sewn together are one set */
    uint32_t *at;  /* by vertex: the ear whose corner it is, plus one; 0: none */
    struct ear *ear;
    uint32_t n_ears;
};

/* The vertex of a panel's boundary that comes after `from` and before `to`; UINT32_MAX: they are
 * not two apart. */
static uint32_t vertex_between(const struct garment_piece *piece, uint32_t n_around, uint32_t from,
                               uint32_t to)
{
    const uint32_t a = from - piece->first, b = to - piece->first;
    const bool around = n_around > 3 && a < n_around && (a + 2) % n_around == b;
    return around ? piece->first + (a + 1) % n_around : UINT32_MAX;
}

/* Visits the edges of a panel's triangles, each in its triangle's direction. The boundary is
 * counterclockwise, too: the inner edge of an ear skips a corner backwards, its neighbour's skips
 * it forwards. */
static void find_ears(struct corners *of, const struct garment_piece *piece, uint32_t n_around)
{
    for (uint32_t i = 0; i < 3 * piece->n_triangles; i++) {
        const uint32_t t = piece->first_triangle + i / 3, *v = of->garment->triangle[t];
        const uint32_t corner = v[i % 3], end = v[(i + 1) % 3], begin = v[(i + 2) % 3];
        if (vertex_between(piece, n_around, begin, end) != corner)
            continue;
        struct ear *ear = &of->ear[of->n_ears++];
        *ear = (struct ear){.triangle = t, .beside = t, .corner = corner, .end = end};
        for (int k = 0; k < 3; k++)
            ear->root[k] = cloth_sets_root(of->set, v[k]);
        qsort(ear->root, 3, sizeof *ear->root, cloth_compare_items_u32);
        of->at[corner] = of->n_ears;
    }
    for (uint32_t i = 0; i < 3 * piece->n_triangles; i++) {
        const uint32_t t = piece->first_triangle + i / 3, *v = of->garment->triangle[t];
        const uint32_t corner = vertex_between(piece, n_around, v[i % 3], v[(i + 1) % 3]);
        if (corner != UINT32_MAX && of->at[corner] && of->ear[of->at[corner] - 1].triangle != t)
            of->ear[of->at[corner] - 1].beside = t;
    }
}

/* Divides an ear and its neighbour the other way, if no angle becomes bad. */
static void open_corner(struct garment *garment, const struct ear *ear)
{
    uint32_t *beside = garment->triangle[ear->beside], *of = garment->triangle[ear->triangle];
    uint32_t i = 0, begin = 0;
    while (i < 3 && beside[i] != ear->end)
        i++;
    for (int k = 0; k < 3; k++)
        begin = of[k] != ear->corner && of[k] != ear->end ? of[k] : begin;
    if (ear->beside == ear->triangle || i == 3 || beside[(i + 2) % 3] != begin)
        return; /* there is no neighbour, or another corner's opening has changed it */
    const uint32_t inner = beside[(i + 1) % 3];
    const double(*uv)[2] = (const double(*)[2])garment->uv;
    if (delaunay_sharpness(uv[ear->corner], uv[ear->end], uv[inner]) > MESHING_POOR ||
        delaunay_sharpness(uv[ear->corner], uv[inner], uv[begin]) > MESHING_POOR)
        return;
    of[0] = beside[0] = ear->corner;
    of[1] = ear->end;
    of[2] = beside[1] = inner;
    beside[2] = begin;
}

static void find_sets(const struct corners *of)
{
    const struct garment *garment = of->garment;
    cloth_sets_start(of->set, garment->n_vertices);
    for (uint32_t s = 0; s < garment->n_seams; s++)
        for (uint32_t k = 0; k < garment->seam[s].n_pairs; k++)
            cloth_sets_join(of->set, garment->seam[s].pair[k][0], garment->seam[s].pair[k][1]);
}

int corners_open(struct garment *garment, const struct garment_pattern *pattern,
                 struct cloth_error *error)
{
    uint32_t n_around = 0;
    for (uint32_t p = 0; p < garment->n_pieces; p++)
        n_around += garment->piece[p].start[pattern->panel[p].n_edges];
    struct cloth_pool memory = {0};
    struct corners of = {garment, cloth_take(&memory, garment->n_vertices, sizeof *of.set, error),
                         cloth_take(&memory, garment->n_vertices, sizeof *of.at, error),
                         cloth_take(&memory, n_around, sizeof *of.ear, error), 0};
    if (!memory.lacks) {
        find_sets(&of);
        for (uint32_t p = 0; p < garment->n_pieces; p++)
            find_ears(&of, &garment->piece[p], garment->piece[p].start[pattern->panel[p].n_edges]);
        qsort(of.ear, of.n_ears, sizeof *of.ear, cloth_by_four);
    }
    for (uint32_t i = 0; i + 1 < of.n_ears; i++)
        if (!cloth_by_three(of.ear + i, of.ear + i + 1))
            open_corner(garment, of.ear + i);
    const int code = memory.lacks ? CLOTH_E_MEMORY : CLOTH_OK;
    cloth_pool_free(&memory);
    return code;
}
