/* Every block that owns a corner of an element has it in its lists, in the order of all: so cut
 * entries of the matrix are summed up alike on both sides. */
#include "cloth/flow/setup/source.h"

#include "cloth/base/memory.h"
#include "cloth/solve/assemble.h"

#include <stdlib.h>
#include <string.h>

/* The blocks of an element's corners, each once. Returns how many. */
static uint32_t blocks_of(const struct flow_source *source, const struct flow_element *element,
                          uint32_t guess, uint32_t block[4])
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < element->corners; i++) {
        const uint32_t place = source->blocks.place[element->corner[i]];
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

static void count(void *to, const struct flow_element *element)
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
    flow_elements_each(&source->elements, count, &counter);
    for (uint32_t b = 0; b < source->blocks.n_blocks; b++)
        if (source->shape[b].n_elements[FLOW_TRIANGLES])
            source->shape[b].n_membranes = source->model->n_materials;
}

/* ---- Gathering ---- */

static size_t *list_of(const struct flow_source *source, uint32_t block, enum flow_kind kind)
{
    return source->member_start + (size_t)FLOW_KINDS * (block - source->from) + kind;
}

struct collector {
    struct flow_source *source;
    uint32_t from, to, block;
};

static void collect(void *to, const struct flow_element *element)
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

int flow_source_collect(struct flow_source *source, uint32_t from, uint32_t to,
                        struct cloth_error *error)
{
    struct collector collector = {source, from, to, from};
    const size_t lists = (size_t)FLOW_KINDS * (to - from);
    size_t n = 0;
    source->member_start = cloth_alloc(lists + 1, sizeof *source->member_start, error);
    if (!source->member_start)
        return CLOTH_E_MEMORY;
    for (uint32_t b = from; b < to; b++)
        for (int kind = 0; kind < FLOW_KINDS; kind++) {
            *list_of(source, b, (enum flow_kind)kind) = n;
            n += source->shape[b].n_elements[kind];
        }
    source->member = cloth_alloc(n, sizeof *source->member, error);
    if (!source->member)
        return CLOTH_E_MEMORY;
    if (n)
        flow_elements_each(&source->elements, collect, &collector);
    for (size_t i = lists; i > 0; i--) /* each was moved on to the next one's */
        source->member_start[i] = source->member_start[i - 1];
    source->member_start[0] = 0;
    return CLOTH_OK;
}

/* ---- The table ---- */

/* Row of the block or, from n on, n and the number of the copy. */
static uint32_t local_of(const struct flow_source *source, const struct flow_table *t,
                         uint32_t vertex)
{
    const uint32_t place = source->blocks.place[vertex];
    if (place - t->first < t->n) /* places below are far above, unsigned */
        return place - t->first;
    const uint32_t block = flow_source_block(&source->blocks, place, 0);
    uint32_t s = 0;
    while (t->slot[s] != block)
        s++;
    return t->n + flow_table_copy(t, s, source->rim[place]);
}

/* The entry of two rows, one of which at least is here, as solve_assemble_pairs wants it. */
static uint32_t entry_of(const struct flow_table *t, const struct flow_image *image, uint32_t a,
                         uint32_t b)
{
    const uint32_t turned = b < a, low = turned ? b : a, high = turned ? a : b;
    if (low >= t->n)
        return SOLVE_NO_ENTRY;
    if (high < t->n) {
        uint32_t i = image->row[low];
        while (image->column[i] != high)
            i++;
        return 2 * i + turned;
    }
    uint32_t s = 0, i;
    while (t->copies[s + 1] <= high - t->n)
        s++;
    for (i = image->cut_entry[s];
         image->copy_end[i][0] != low || image->copy_end[i][1] != high - t->n;)
        i++;
    return 2 * (image->row[t->n] + i) + turned;
}

static void fill_corners(const struct flow_source *source, const struct flow_table *t,
                         const struct flow_image *image, const struct flow_element *element,
                         uint32_t corner[4], uint32_t *at)
{
    for (uint32_t i = 0; i < element->corners; i++)
        corner[i] = local_of(source, t, element->corner[i]);
    for (uint32_t j = 1; flow_pairs[element->kind] && j < element->corners; j++)
        for (uint32_t i = 0; i < j; i++)
            *at++ = entry_of(t, image, corner[i], corner[j]);
}

static void fill_membranes(const struct flow_source *source, const struct flow_table *t,
                           const struct flow_image *image)
{
    for (uint32_t m = 0; m < t->n_membranes; m++) {
        const struct model_material *material = source->model->materials + m;
        if (material->model != MODEL_TRIANGLES)
            continue;
        phys_membrane_make(material->stretch, model_weft(material), material->shear,
                           material->poisson, material->damping_stiffness,
                           image->membrane + m); /* the model was checked */
        image->membrane[m].uncorrected = material->uncorrected;
    }
}

void flow_source_members(const struct flow_source *source, uint32_t block,
                         const struct flow_image *image)
{
    const struct flow_table *t = source->shape + block;
    fill_membranes(source, t, image);
    for (int kind = 0; kind < FLOW_KINDS; kind++) {
        const struct flow_list *list = image->list + kind;
        const struct flow_element *element =
            source->member + *list_of(source, block, (enum flow_kind)kind);
        for (uint32_t e = 0; e < t->n_elements[kind]; e++, element++) {
            struct flow_rest_of rest;
            flow_element_rest(&source->elements, element, &rest);
            fill_corners(source, t, image, element, list->corner[e],
                         list->at + (size_t)flow_pairs[kind] * e);
            if (kind == FLOW_SAILS && element->corners < 4) {
                list->corner[e][3] = PHYS_NO_CORNER;
            } else if (kind == FLOW_TRIANGLES) {
                list->corner[e][3] = rest.material;
                list->vector[e] = (phys_vec){rest.gradient[0], rest.gradient[1], rest.gradient[2],
                                             rest.gradient[3]};
                list->number[0][e] = rest.area;
            } else if (kind == FLOW_FOLDS) {
                list->vector[e] =
                    (phys_vec){rest.weight[0], rest.weight[1], rest.weight[2], rest.weight[3]};
            } else if (kind == FLOW_HINGES) {
                list->number[0][e] = rest.stiffness;
                list->number[1][e] = rest.damping;
                list->number[2][e] = rest.s;
            }
        }
    }
}
