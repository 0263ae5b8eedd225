/* Every block that owns a corner of an element lists it, in the order of all elements. So both
 * sides sum up cut entries of the matrix alike. */
#include "cloth/flow/run/source.h"

#include "cloth/base/memory.h"
#include "cloth/base/order.h"
#include "cloth/solve/assemble.h"

#include <stdlib.h>

/* The blocks of an element's corners, each once. Returns how many. */
static uint32_t blocks_of(const struct flow_source *source, const struct element *element,
                          uint32_t guess, uint32_t block[4])
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < element->corners; i++) {
        const uint32_t place = source->blocks.place[element->first + element->corner[i]];
        const uint32_t b = flow_source_block(&source->blocks, place, n ? block[0] : guess);
        uint32_t k = 0;
        while (k < n && block[k] != b)
            k++;
        if (k == n)
            block[n++] = b;
    }
    return n;
}

struct counter {
    struct flow_source *source;
    uint32_t block;
};

static void count_member(void *to, const struct element *element)
{
    struct counter *counter = to;
    uint32_t block[4];
    const uint32_t n = blocks_of(counter->source, element, counter->block, block);
    for (uint32_t i = 0; i < n; i++)
        counter->source->shape[block[i]].n_elements[element->kind]++;
    counter->block = block[0];
}

void flow_source_count(struct flow_source *source)
{
    struct counter counter = {source, 0};
    element_each(&source->elements, count_member, &counter);
    for (uint32_t b = 0; b < source->blocks.n_blocks; b++)
        source->shape[b].n_materials = source->model->n_materials;
}

/* ---- Gathering ---- */

static size_t *list_of(const struct flow_source *source, uint32_t block, uint32_t kind)
{
    return source->member_start + (size_t)ELEMENT_KINDS * (block - source->from) + kind;
}

struct collector {
    struct flow_source *source;
    uint32_t from, to, block;
};

static void collect_member(void *to, const struct element *element)
{
    struct collector *collector = to;
    const struct flow_source *source = collector->source;
    uint32_t block[4];
    const uint32_t n = blocks_of(source, element, collector->block, block);
    collector->block = block[0];
    for (uint32_t i = 0; i < n; i++)
        if (block[i] >= collector->from && block[i] < collector->to)
            source->member[(*list_of(source, block[i], element->kind))++] = *element;
}

struct ordered {
    uint32_t root[2], number; /* of the ends of the hinge's edge, ascending */
    struct element element;
};

/* Hinges come in the order of their edges, as in one mesh: those across seams come last till then.
 */
static int order_hinges(const struct flow_source *source, size_t n, struct element *element,
                        struct cloth_error *error)
{
    struct ordered *ordered = cloth_alloc(n, sizeof *ordered, error);
    if (!ordered)
        return CLOTH_E_MEMORY;
    for (size_t i = 0; i < n; i++) {
        const uint32_t *corner = element[i].corner;
        const uint32_t a = flow_root(&source->particles.welds, element[i].first + corner[0]);
        const uint32_t b = flow_root(&source->particles.welds, element[i].first + corner[1]);
        ordered[i] = (struct ordered){{a < b ? a : b, a < b ? b : a}, (uint32_t)i, element[i]};
    }
    qsort(ordered, n, sizeof *ordered, cloth_by_three);
    for (size_t i = 0; i < n; i++)
        element[i] = ordered[i].element;
    free(ordered);
    return CLOTH_OK;
}

static int order_all(const struct flow_source *source, uint32_t from, uint32_t to,
                     struct cloth_error *error)
{
    int code = CLOTH_OK;
    for (uint32_t b = from; b < to && source->elements.n_seams && !code; b++)
        for (uint32_t kind = 0; kind < ELEMENT_KINDS && !code; kind++)
            if (element_kinds[kind]->part == ELEMENT_HINGES)
                code = order_hinges(source, source->shape[b].n_elements[kind],
                                    source->member + *list_of(source, b, kind), error);
    return code;
}

int flow_source_collect(struct flow_source *source, uint32_t from, uint32_t to,
                        struct cloth_error *error)
{
    struct collector collector = {source, from, to, from};
    const size_t lists = (size_t)ELEMENT_KINDS * (to - from);
    size_t n = 0;
    source->member_start =
        cloth_take(&source->gathered, lists + 1, sizeof *source->member_start, error);
    if (!source->member_start)
        return CLOTH_E_MEMORY;
    for (uint32_t b = from; b < to; b++)
        for (uint32_t kind = 0; kind < ELEMENT_KINDS; kind++) {
            *list_of(source, b, kind) = n;
            n += source->shape[b].n_elements[kind];
        }
    source->member = cloth_take(&source->gathered, n, sizeof *source->member, error);
    if (!source->member)
        return CLOTH_E_MEMORY;
    if (n)
        element_each(&source->elements, collect_member, &collector);
    for (size_t i = lists; i > 0; i--) /* each was moved on to the next one's */
        source->member_start[i] = source->member_start[i - 1];
    source->member_start[0] = 0;
    return order_all(source, from, to, error);
}

/* ---- The table ---- */

/* Row of the block or, from n on, n and the number of the ghost. */
static uint32_t local_of(const struct flow_source *source, const struct flow_table *t,
                         uint32_t vertex)
{
    const uint32_t place = source->blocks.place[vertex];
    if (place - t->first < t->n) /* places below are far above, unsigned */
        return place - t->first;
    const uint32_t block = flow_source_block(&source->blocks, place, 0);
    uint32_t s = 0;
    while (t->neighbour[s] != block)
        s++;
    return t->n + flow_table_ghost(t, s, source->halo[place]);
}

/* The entry of two rows, at least one of them here, as solve_assemble_pairs wants it. */
static uint32_t members_entry_of(const struct flow_table *t, const struct flow_layout *layout,
                                 uint32_t a, uint32_t b)
{
    const uint32_t transposed = b < a, low = transposed ? b : a, high = transposed ? a : b;
    if (low >= t->n)
        return SOLVE_NO_ENTRY;
    if (high < t->n) {
        uint32_t i = layout->row[low];
        while (layout->column[i] != high)
            i++;
        return 2 * i + transposed;
    }
    uint32_t s = 0, i;
    while (t->ghost_start[s + 1] <= high - t->n)
        s++;
    for (i = layout->cut_entry[s];
         layout->ghost_end[i][0] != low || layout->ghost_end[i][1] != high - t->n;)
        i++;
    return 2 * (layout->row[t->n] + i) + transposed;
}

static void members_fill_corners(const struct flow_source *source, const struct flow_table *t,
                                 const struct flow_layout *layout, const struct element *element,
                                 uint32_t corner[4], uint32_t *at)
{
    for (uint32_t i = 0; i < ELEMENT_CORNERS; i++)
        corner[i] = i < element->corners ? local_of(source, t, element->first + element->corner[i])
                                         : PHYS_NO_CORNER;
    for (uint32_t j = 1; element_kinds[element->kind]->pairs && j < element->corners; j++)
        for (uint32_t i = 0; i < j; i++)
            *at++ = members_entry_of(t, layout, corner[i], corner[j]);
}

/* The corners of an element that say which material it has, and the ends of its edge. */
static struct flow_sized size_member(const struct flow_source *source,
                                     const struct element *element,
                                     const struct phys_elements *list, uint32_t e)
{
    const struct element_kind *kind = element_kinds[element->kind];
    const size_t n = kind->part == ELEMENT_TRIANGLES ? 3 : 2;
    struct flow_sized sized = {.size = element_size_of(&source->elements, element->cloth, n,
                                                       element->corner, element->triangle[0])};
    for (int i = 0; kind->vectors && i < 4; i++)
        sized.base[i] = list->vector[e][i];
    for (uint32_t i = 0; i < kind->numbers; i++)
        sized.base[4 + i] = list->number[i][e];
    return sized;
}

void flow_source_members(const struct flow_source *source, uint32_t block,
                         const struct flow_layout *layout)
{
    const struct flow_table *t = source->shape + block;
    struct flow_sized *sized = layout->sized + t->n_inner + t->n_cut;
    for (uint32_t i = 0; i < ELEMENT_KINDS; i++) {
        const struct element_kind *kind = element_kinds[i];
        const struct phys_elements *list = layout->list + i;
        const struct element *element = source->member + *list_of(source, block, i);
        if (list->n)
            element_materials(kind, source->model, list->material);
        for (uint32_t e = 0; e < list->n; e++, element++) {
            members_fill_corners(source, t, layout, element, list->corner[e],
                                 list->at + (size_t)kind->pairs * e);
            if (kind->pack)
                kind->pack(&source->elements, element, list, e);
            if (t->n_sized && kind->resize)
                *sized++ = size_member(source, element, list, e);
        }
    }
}
