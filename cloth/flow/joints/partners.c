/* Pairs of vertices that the scene names, of joints and of welds: each is checked, and stands once.
 */
#include "cloth/flow/run/source.h"

#include "cloth/base/memory.h"
#include "cloth/base/order.h"

#include <stdio.h>
#include <stdlib.h>

int flow_pair_fail(const struct model *model, const struct flow_pair *pair, const char *what,
                   const char *why, struct cloth_error *error)
{
    const struct model_pairs *of = pair->of;
    const struct model_end *to = of->end + 1;
    char seam[MODEL_SEAM_NAME], other[64];
    if (of->seam)
        model_name_seam(model->cloths + of->end[0].cloth, of->seam - 1, seam);
    if (to->edges)
        snprintf(other, sizeof other, "the edge of vertices %u and %u", to->edges[pair->i][0],
                 to->edges[pair->i][1]);
    else
        snprintf(other, sizeof other, "vertex %u", to->vertices[pair->i]);
    return model_fail(
        of->place, error, "%s is between vertex %u of cloth '%.60s' and %s of cloth '%.60s', %s",
        of->seam ? seam : what, of->end[0].vertices[pair->i], model->cloths[of->end[0].cloth].name,
        other, model->cloths[to->cloth].name, why);
}

/* The vertex of an end, of all cloths; of its mesh: `vertex`. */
static int take_vertex(uint32_t *of_all, uint32_t vertex, const struct model *model,
                       const struct model_pairs *pairs, int end, const char *what,
                       struct cloth_error *error)
{
    const uint32_t cloth = pairs->end[end].cloth;
    if (vertex >= model->cloths[cloth].mesh.n_vertices)
        return flow_no_vertex(model->cloths + cloth, what, vertex, pairs->place, error);
    *of_all = model_first(model, cloth) + vertex;
    return CLOTH_OK;
}

/* Takes a point on an edge. At an end of the edge it is that vertex. */
static int partners_take_edge(struct flow_pair *pair, const struct model *model, const char *what,
                              struct cloth_error *error)
{
    const struct model_pairs *pairs = pair->of;
    const uint32_t *edge = pairs->end[1].edges[pair->i];
    const double at = pairs->end[1].at[pair->i];
    int code = take_vertex(&pair->vertex[1], edge[at >= 1], model, pairs, 1, what, error);
    if (!code && at > 0 && at < 1)
        code = take_vertex(&pair->second, edge[1], model, pairs, 1, what, error);
    pair->at = at;
    return code;
}

int flow_pairs_list(struct cloth_list *list, const struct model *model,
                    const struct model_pairs *pairs, const char *what, struct cloth_error *error)
{
    struct flow_pair *pair = cloth_list_add(list, sizeof *pair, pairs->end[0].n, error);
    if (!pair)
        return CLOTH_E_MEMORY;
    for (uint32_t i = 0; i < pairs->end[0].n; i++, pair++) {
        *pair = (struct flow_pair){.second = UINT32_MAX,
                                   .number = (uint32_t)(list->n - pairs->end[0].n + i),
                                   .i = i,
                                   .of = pairs};
        int code =
            take_vertex(&pair->vertex[0], pairs->end[0].vertices[i], model, pairs, 0, what, error);
        if (!code && pairs->end[1].edges)
            code = partners_take_edge(pair, model, what, error);
        else if (!code)
            code = take_vertex(&pair->vertex[1], pairs->end[1].vertices[i], model, pairs, 1, what,
                               error);
        if (code)
            return code;
        if (pair->vertex[0] == pair->vertex[1] || pair->vertex[0] == pair->second)
            return flow_pair_fail(model, pair, what,
                                  pairs->end[1].edges ? "an end of which it is; another is expected"
                                                      : "itself; two vertices are expected",
                                  error);
    }
    return CLOTH_OK;
}

static uint32_t low(const struct flow_pair *pair)
{
    return pair->vertex[pair->vertex[1] < pair->vertex[0]];
}

static uint32_t high(const struct flow_pair *pair)
{
    return pair->vertex[pair->vertex[1] > pair->vertex[0]];
}

static int partners_compare_pairs(const void *va, const void *vb)
{
    const struct flow_pair *a = va, *b = vb;
    int order = cloth_compare_u32(low(a), low(b));
    if (!order)
        order = cloth_compare_u32(high(a), high(b));
    return order ? order : cloth_compare_u32(a->number, b->number);
}

int flow_pairs_once(struct cloth_list *list, const struct model *model, const char *what,
                    struct cloth_error *error)
{
    const struct flow_pair *pair = list->items;
    cloth_list_sort(list, sizeof *pair, partners_compare_pairs);
    for (size_t i = 1; i < list->n; i++)
        if (low(pair + i - 1) == low(pair + i) && high(pair + i - 1) == high(pair + i))
            return flow_pair_fail(model, pair + i, what, "where there is one already", error);
    return CLOTH_OK;
}
