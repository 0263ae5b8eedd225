/* Welds may join the borders of two cloths, or two parts of the border of one. The edge that both
 * share is then a hinge as inner edges are. */
#include "cloth/flow/run/source.h"

#include "cloth/base/memory.h"
#include "cloth/base/order.h"

#include <math.h>
#include <stdlib.h>

/* An edge at the border of its mesh with two welded ends. */
struct border {
    uint32_t root[2], cloth, edge; /* root: ascending */
    struct element_side side;      /* ends in the order of their roots */
};

/* Finds the borders of a cloth, the first vertex of which is `first`. */
static int find_borders(struct cloth_list *list, const struct element_cloths *elements,
                        const struct flow_welds *welds, uint32_t cloth, uint32_t first,
                        struct cloth_error *error)
{
    const struct mesh_edges *edges = elements->edges + cloth;
    for (uint32_t e = 0; e < edges->n; e++) {
        const struct mesh_edge *edge = edges->edge + e;
        const uint32_t a = welds->root[first + edge->a], b = welds->root[first + edge->b];
        const bool turned = b < a;
        if (edge->opposite[0] == UINT32_MAX || edge->opposite[1] != UINT32_MAX ||
            !flow_is_welded(welds, a) || !flow_is_welded(welds, b))
            continue;
        const uint32_t ends[2] = {edge->a, edge->b};
        const struct border border = {
            {turned ? b : a, turned ? a : b},
            cloth,
            e,
            {cloth, first, {ends[turned], ends[!turned], edge->opposite[0]}, edge->triangle[0]}};
        if (cloth_list_put(list, &border, sizeof border, error))
            return CLOTH_E_MEMORY;
    }
    return CLOTH_OK;
}

static bool is_shared(const struct border *a, const struct border *b)
{
    return a->root[0] == b->root[0] && a->root[1] == b->root[1];
}

/* The welds of a root. */
struct welded {
    double tolerance; /* m: the largest */
    bool sewn;        /* a weld of it is a seam's */
};

/* The welds of all roots, by root. The caller frees it; NULL: no memory. */
static struct welded *weld_hinges_find_welded(const struct model *model,
                                              const struct flow_welds *welds,
                                              struct cloth_error *error)
{
    const uint32_t n = model_first(model, model->n_cloths);
    struct welded *all = cloth_alloc(n, sizeof *all, error);
    for (uint32_t w = 0; w < model->n_welds && all; w++) {
        const struct model_pairs *pairs = &model->welds[w].pairs;
        const uint32_t *root = welds->root + model_first(model, pairs->end[0].cloth);
        for (uint32_t i = 0; i < pairs->end[0].n; i++) {
            struct welded *at = all + root[pairs->end[0].vertices[i]];
            at->tolerance = fmax(at->tolerance, model->welds[w].tolerance);
            at->sewn = at->sewn || pairs->seam;
        }
    }
    return all;
}

/* ---- How seams bend ---- */

/* A part of a seam that is welded. */
struct stitch {
    uint32_t root[2]; /* ascending */
    double bending;   /* as of model_sewing */
};

static int list_stitches(struct cloth_list *list, const struct model *model,
                         const struct flow_welds *welds, struct cloth_error *error)
{
    for (uint32_t w = 0; w < model->n_welds; w++) {
        const struct model_pairs *pairs = &model->welds[w].pairs;
        const uint32_t cloth = pairs->end[0].cloth;
        const uint32_t *root = welds->root + model_first(model, cloth);
        if (!pairs->seam)
            continue;
        const struct model_seam *seam = model->cloths[cloth].seams.seam + pairs->seam - 1;
        struct stitch *stitch = cloth_list_add(list, sizeof *stitch, seam->n_pairs - 1, error);
        if (!stitch)
            return CLOTH_E_MEMORY;
        for (uint32_t i = 0; i + 1 < seam->n_pairs; i++) {
            const uint32_t a = root[seam->pair[i][0]], b = root[seam->pair[i + 1][0]];
            stitch[i] = (struct stitch){{a < b ? a : b, a < b ? b : a}, seam->sewing.bending};
        }
    }
    cloth_list_sort(list, sizeof(struct stitch), cloth_by_two);
    return CLOTH_OK;
}

/* The bending of the edge between two roots; < 0: as the materials. */
static double bending_of(const struct cloth_list *stitches, const uint32_t root[2])
{
    const struct stitch key = {{root[0], root[1]}, 0};
    const struct stitch *found = stitches->n ? bsearch(&key, stitches->items, stitches->n,
                                                       sizeof(struct stitch), cloth_by_two)
                                             : NULL;
    return found ? found->bending : -1;
}

/* ---- Hinges ---- */

/* welded: by root. */
static void weld_hinges_add_seam(struct element_cloths *elements, const struct flow_welds *welds,
                                 const struct welded *welded, const struct cloth_list *stitches,
                                 const struct border *border)
{
    const struct welded *ends[2] = {welded + border->root[0], welded + border->root[1]};
    struct element_seam *seam = elements->seam + elements->n_seams;
    uint32_t opposite[2];
    for (int k = 0; k < 2; k++) {
        seam->side[k] = border[k].side;
        opposite[k] = welds->root[border[k].side.first + border[k].side.corner[2]];
    }
    seam->tolerance = fmax(ends[0]->tolerance, ends[1]->tolerance);
    seam->flat = ends[0]->sewn && ends[1]->sewn;
    seam->rigidity = bending_of(stitches, border->root);
    elements->n_seams += opposite[0] != opposite[1]; /* else one lies on the other */
}

static int make_seams(struct element_cloths *elements, const struct flow_welds *welds,
                      struct cloth_list *list, struct cloth_error *error)
{
    const struct border *border = list->items;
    struct cloth_list stitches = {0};
    if (!list->n)
        return CLOTH_OK;
    cloth_list_sort(list, sizeof *border, cloth_by_four);
    elements->seam = cloth_alloc(list->n, sizeof *elements->seam, error);
    struct welded *welded =
        elements->seam ? weld_hinges_find_welded(elements->model, welds, error) : NULL;
    int code = welded ? list_stitches(&stitches, elements->model, welds, error) : CLOTH_E_MEMORY;
    for (size_t i = 0, end; i < list->n && !code; i = end) {
        for (end = i + 1; end < list->n && is_shared(border + i, border + end);)
            end++;
        if (end == i + 2)
            weld_hinges_add_seam(elements, welds, welded, &stitches, border + i);
    }
    free(welded);
    free(stitches.items);
    return code ? code : element_seams_check(elements, error);
}

int flow_seams_make(struct element_cloths *elements, const struct flow_welds *welds,
                    struct cloth_error *error)
{
    const struct model *model = elements->model;
    struct cloth_list list = {0};
    int code = CLOTH_OK;
    for (uint32_t c = 0; c < model->n_cloths && welds->n && !code; c++)
        if (element_parts(model, model->cloths + c) & 1u << ELEMENT_HINGES)
            code = find_borders(&list, elements, welds, c, model_first(model, c), error);
    if (!code)
        code = make_seams(elements, welds, &list, error);
    free(list.items);
    return code;
}
