/* Pairs of vertices that the scene names, of joints and of welds: each is checked, and stands once.
 */
#include "cloth/flow/setup/source.h"

#include "cloth/base/memory.h"
#include "cloth/base/order.h"

#include <stdlib.h>

int flow_pair_fail(const struct model *model, const struct flow_pair *pair, const char *what,
                   const char *why, struct cloth_error *error)
{
    const struct model_pairs *of = pair->of;
    char seam[MODEL_SEAM_NAME];
    if (of->seam)
        model_name_seam(model->cloths + of->end[0].cloth, of->seam - 1, seam);
    return model_fail(of->place, error,
                      "%s is between vertex %u of cloth '%.60s' and vertex %u of cloth '%.60s', %s",
                      of->seam ? seam : what, of->end[0].vertices[pair->i],
                      model->cloths[of->end[0].cloth].name, of->end[1].vertices[pair->i],
                      model->cloths[of->end[1].cloth].name, why);
}

int flow_pairs_list(struct cloth_list *list, const struct model *model,
                    const struct model_pairs *pairs, const char *what, struct cloth_error *error)
{
    struct flow_pair *pair = cloth_list_add(list, sizeof *pair, pairs->end[0].n, error);
    if (!pair)
        return CLOTH_E_MEMORY;
    for (uint32_t i = 0; i < pairs->end[0].n; i++, pair++) {
        *pair = (struct flow_pair){
            .number = (uint32_t)(list->n - pairs->end[0].n + i), .i = i, .of = pairs};
        for (int end = 0; end < 2; end++) {
            const struct model_cloth *cloth = model->cloths + pairs->end[end].cloth;
            if (pairs->end[end].vertices[i] >= cloth->mesh.n_vertices)
                return flow_no_vertex(cloth, what, pairs->end[end].vertices[i], pairs->place,
                                      error);
            pair->vertex[end] =
                model_first(model, pairs->end[end].cloth) + pairs->end[end].vertices[i];
        }
        if (pair->vertex[0] == pair->vertex[1])
            return flow_pair_fail(model, pair, what, "itself; two vertices are expected", error);
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

static int compare_pairs(const void *va, const void *vb)
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
    if (list->n)
        qsort(list->items, list->n, sizeof *pair, compare_pairs);
    for (size_t i = 1; i < list->n; i++)
        if (low(pair + i - 1) == low(pair + i) && high(pair + i - 1) == high(pair + i))
            return flow_pair_fail(model, pair + i, what, "where there is one already", error);
    return CLOTH_OK;
}
