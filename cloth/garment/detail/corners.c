/* Two panels that are sewn on both sides of a corner fill it by one triangle each, of the same
 * three seam vertices. Sewn, the two are one sheet, and the corner could never open. So one of them
 * and its neighbour are divided the other way, from the corner inwards. */
#include "cloth/base/memory.h"
#include "cloth/base/order.h"
#include "cloth/base/sets.h"
#include "cloth/garment/detail/meshing.h"

#include <stdlib.h>

/* A triangle that fills a corner: of its edges only that opposite the corner is no boundary. */
struct ear {
    uint32_t root[3];  /* of its vertices' sets, ascending: equal in triangles that coincide */
    uint32_t triangle; /* of the garment */
    uint32_t panel;
};

struct corners {
    struct garment *garment;
    const struct meshing *meshing;
    uint32_t *set; /* by vertex: those that are sewn together are one set */
    struct ear *ear;
    uint32_t n_ears;
};

static void find_ears(struct corners *of, uint32_t panel)
{
    const struct garment_piece *piece = &of->garment->piece[panel];
    for (uint32_t t = 0; t < piece->n_triangles; t++) {
        if (!meshing_is_ear(&of->meshing->panel[panel].plane, t))
            continue;
        struct ear *ear = &of->ear[of->n_ears++];
        *ear = (struct ear){.triangle = piece->first_triangle + t, .panel = panel};
        for (int k = 0; k < 3; k++)
            ear->root[k] = cloth_sets_root(of->set, of->garment->triangle[ear->triangle][k]);
        qsort(ear->root, 3, sizeof *ear->root, cloth_compare_items_u32);
    }
}

/* Divides an ear and its neighbour the other way, if no angle becomes bad. */
static void open_corner(const struct corners *of, const struct ear *ear)
{
    const struct garment_piece *piece = &of->garment->piece[ear->panel];
    const struct delaunay *plane = &of->meshing->panel[ear->panel].plane;
    const struct delaunay_triangle *is = plane->triangle + (ear->triangle - piece->first_triangle);
    int i = 0;
    while (i < 3 && is->beside[i] == DELAUNAY_NONE)
        i++;
    if (i == 3)
        return; /* it is all of its panel */
    const struct delaunay_triangle *other = plane->triangle + is->beside[i];
    uint32_t *mine = of->garment->triangle[ear->triangle];
    uint32_t *theirs = of->garment->triangle[piece->first_triangle + is->beside[i]];
    const uint32_t corner = is->vertex[i], end = is->vertex[(i + 1) % 3];
    const uint32_t begin = is->vertex[(i + 2) % 3], inner = delaunay_after(other, end, 1);
    const double(*place)[2] = (const double(*)[2])plane->place;
    if (theirs[0] != piece->first + other->vertex[0] ||
        delaunay_sharpness(place[corner], place[end], place[inner]) > MESHING_POOR ||
        delaunay_sharpness(place[corner], place[inner], place[begin]) > MESHING_POOR)
        return; /* the first: another corner's opening has changed the neighbour */
    mine[0] = theirs[0] = piece->first + corner;
    mine[1] = piece->first + end;
    mine[2] = theirs[1] = piece->first + inner;
    theirs[2] = piece->first + begin;
}

static void find_sets(const struct corners *of)
{
    const struct garment *garment = of->garment;
    cloth_sets_start(of->set, garment->n_vertices);
    for (uint32_t s = 0; s < garment->n_seams; s++)
        for (uint32_t k = 0; k < garment->seam[s].n_pairs; k++)
            cloth_sets_join(of->set, garment->seam[s].pair[k][0], garment->seam[s].pair[k][1]);
}

int corners_open(struct garment *garment, const struct meshing *meshing, struct cloth_error *error)
{
    uint32_t n_around = 0;
    for (uint32_t p = 0; p < garment->n_pieces; p++)
        n_around += meshing->panel[p].start[meshing->pattern->panel[p].n_edges];
    struct cloth_pool memory = {0};
    struct corners of = {garment, meshing,
                         cloth_take(&memory, garment->n_vertices, sizeof *of.set, error),
                         cloth_take(&memory, n_around, sizeof *of.ear, error), 0};
    if (!memory.lacks) {
        find_sets(&of);
        for (uint32_t p = 0; p < garment->n_pieces; p++)
            find_ears(&of, p);
        qsort(of.ear, of.n_ears, sizeof *of.ear, cloth_by_four);
    }
    for (uint32_t i = 0; i + 1 < of.n_ears; i++)
        if (!cloth_by_three(of.ear + i, of.ear + i + 1))
            open_corner(&of, of.ear + i);
    const int code = memory.lacks ? CLOTH_E_MEMORY : CLOTH_OK;
    cloth_pool_free(&memory);
    return code;
}
