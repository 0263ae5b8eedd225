/* Springs are not kept; only the blocks that they join, and where, are. */
#include "cloth/flow/run/source.h"

#include "cloth/base/memory.h"
#include "cloth/base/order.h"
#include "cloth/base/sets.h"

#include <stdlib.h>
#include <string.h>

uint32_t flow_source_block(const struct mesh_blocks *blocks, uint32_t place, uint32_t guess)
{
    if (blocks->start[guess] <= place && place < blocks->start[guess + 1])
        return guess;
    return cloth_first_from(blocks->start, 1, blocks->n_blocks + 1, place + 1) - 1;
}

void flow_source_cloth(struct flow_cloths *at, const struct model *model, uint32_t vertex)
{
    if (vertex < at->first)
        *at = (struct flow_cloths){0};
    while (vertex - at->first >= model->cloths[at->cloth].mesh.n_vertices)
        at->first += model->cloths[at->cloth++].mesh.n_vertices;
}

void flow_particle_at(const struct flow_particles *particles, const struct model *model,
                      struct flow_cloths *at, uint32_t vertex, struct flow_particle *particle)
{
    flow_source_cloth(at, model, vertex);
    flow_particle_of(particles, model, model->cloths + at->cloth, at->first, vertex, particle);
}

/* ---- Pieces ----
 *
 * A piece has all vertices that springs and elements join, directly or through others. Pieces are
 * numbered by their lowest vertex, so that the numbers depend on the scene alone. */

static void join_ends(void *to, const struct flow_spring *spring)
{
    uint32_t *parent = to;
    cloth_sets_join(parent, spring->a, spring->b);
}

/* Numbers the vertices of pieces: the lowest vertex of a piece gets the number, or 0 if a pin holds
 * a vertex of the piece; then all others get theirs. Vertices come after the lowest one of their
 * piece. */
static uint32_t number_pieces(struct flow_particles *p, uint32_t *parent, const unsigned char *held)
{
    uint32_t n = 0;
    for (uint32_t v = 0; v < p->n; v++) {
        const uint32_t root = cloth_sets_root(parent, v);
        const bool counts = root == v && p->used[v] && !held[v];
        p->piece[v] = counts ? ++n : root == v ? 0 : p->piece[root];
    }
    return n;
}

static int make_pieces(struct flow_source *source, struct cloth_error *error)
{
    struct flow_particles *p = &source->particles;
    uint32_t *parent = cloth_alloc(p->n, sizeof *parent, error);
    unsigned char *held = cloth_alloc(p->n, 1, error);
    p->piece = cloth_take(&p->memory, p->n, sizeof *p->piece, error);
    const bool made = parent && held && p->piece;
    if (made)
        cloth_sets_start(parent, p->n);
    if (made)
        flow_springs_each(&source->springs, join_ends, parent);
    for (uint32_t i = 0; made && i < p->welds.n; i++)
        join_ends(parent,
                  &(struct flow_spring){.a = p->welds.name[i][0], .b = p->welds.name[i][1]});
    for (uint32_t v = 0; made && v < p->n; v++)
        if (!p->free[v] || (p->slider && p->slider[v]))
            held[cloth_sets_root(parent, v)] = 1;
    if (made)
        p->n_pieces = number_pieces(p, parent, held);
    free(parent);
    free(held);
    return made ? CLOTH_OK : CLOTH_E_MEMORY;
}

/* ---- Cutting ---- */

struct pair_visitor {
    const struct flow_welds *welds;
    void (*visit)(void *to, uint32_t a, uint32_t b);
    void *to;
};

static void visit_pair(void *to, const struct flow_spring *spring)
{
    const struct pair_visitor *visitor = to;
    visitor->visit(visitor->to, flow_root(visitor->welds, spring->a),
                   flow_root(visitor->welds, spring->b));
}

static void each_pair(const void *context, void (*visit)(void *to, uint32_t a, uint32_t b),
                      void *to)
{
    const struct flow_springs *springs = context;
    struct pair_visitor visitor = {springs->welds, visit, to};
    flow_springs_each(springs, visit_pair, &visitor);
}

/* Cuts the used vertices, of welded ones their roots. */
static int cut_roots(struct flow_source *source, const struct mesh_pairs *pairs,
                     struct cloth_error *error)
{
    const struct flow_particles *p = &source->particles;
    unsigned char *used = p->welds.n ? cloth_alloc(p->n, 1, error) : p->used;
    if (!used)
        return CLOTH_E_MEMORY;
    for (uint32_t v = 0; v < p->n && p->welds.n; v++)
        used[v] = p->used[v] && p->welds.root[v] == v;
    int code = mesh_blocks_cut(&source->blocks, p->n, used, pairs, source->model->grain, error);
    if (used != p->used)
        free(used);
    return code ? code : flow_names_make(&source->names, &p->welds, &source->blocks, error);
}

static int cut_blocks(struct flow_source *source, int ranks, struct cloth_error *error)
{
    const struct mesh_pairs pairs = {&source->springs, each_pair};
    const struct mesh_blocks *blocks = &source->blocks;
    const uint32_t grain = source->model->grain;
    const int code = cut_roots(source, &pairs, error);
    if (code || (uint32_t)ranks <= blocks->n_blocks)
        return code;
    return cloth_fail(error, CLOTH_E_INPUT,
                      "%d ranks are more than there are blocks (%u): %u vertices at a grain of "
                      "%u; start fewer ranks or give a smaller grain",
                      ranks, blocks->n_blocks, blocks->n_places, grain);
}

/* ---- Shapes ---- */

static void find_vertices(const struct flow_source *source, struct flow_table *shape)
{
    struct flow_name name;
    shape->lowest = UINT32_MAX;
    for (uint32_t k = 0; flow_name_of(&source->names, source->blocks.vertex, shape, k, &name);
         k++) {
        shape->lowest = (uint32_t)cloth_smaller(name.vertex, shape->lowest);
        shape->highest = (uint32_t)cloth_larger(name.vertex, shape->highest);
    }
}

/* Counts the watched vertices of each block. */
static void count_watched(struct flow_source *source)
{
    uint32_t block = 0;
    for (uint32_t i = 0; i < source->watched.n; i++) {
        block = flow_source_block(&source->blocks, source->watched.place[i], block);
        source->shape[block].n_watched++;
    }
}

/* A list whose items begin with a vertex of all cloths and their number: makes vertices places and
 * orders items by place; those of unused vertices are dropped. */
static void settle_places(const struct flow_source *source, struct cloth_list *list, size_t size)
{
    size_t n = 0;
    for (size_t i = 0; i < list->n; i++) {
        uint32_t *item = (uint32_t *)(void *)((char *)list->items + i * size);
        const uint32_t place = source->blocks.place[*item];
        if (place == MESH_NO_PLACE)
            continue;
        *item = place;
        memmove((char *)list->items + n++ * size, item, size);
    }
    list->n = n;
    cloth_list_sort(list, size, cloth_by_two);
}

uint32_t flow_placed_from(const struct cloth_list *list, size_t size, uint32_t place)
{
    return cloth_first_from(list->items, size / sizeof(uint32_t), (uint32_t)list->n, place);
}

/* The number of items of a list that are in a block. */
static uint32_t count_placed(const struct cloth_list *list, size_t size,
                             const struct flow_table *shape)
{
    return flow_placed_from(list, size, shape->first + shape->n) -
           flow_placed_from(list, size, shape->first);
}

/* Counts the vertices of a block that have a number: that of a motion, or of a slider. */
static uint32_t count_numbered(const struct flow_source *source, const struct flow_table *shape,
                               const uint32_t *number)
{
    uint32_t n = 0;
    for (uint32_t i = 0; number && i < shape->n; i++)
        n += number[source->blocks.vertex[shape->first + i]] != 0;
    return n;
}

/* All springs of a block, and its elements with a shape at rest, have an entry, or none has. */
static uint32_t count_sized(const struct flow_table *shape)
{
    uint32_t n = shape->n_inner + shape->n_cut;
    for (int kind = 0; kind < ELEMENT_KINDS; kind++)
        n += element_kinds[kind]->resize ? shape->n_elements[kind] : 0;
    return n;
}

static int find_shapes(struct flow_source *source, struct cloth_error *error)
{
    const struct mesh_blocks *blocks = &source->blocks;
    source->halo = cloth_take(&source->memory, blocks->n_places, sizeof *source->halo, error);
    source->shape = cloth_take(&source->memory, blocks->n_blocks, sizeof *source->shape, error);
    if (source->memory.lacks)
        return CLOTH_E_MEMORY;
    settle_places(source, &source->particles.varying, sizeof(struct flow_varying));
    settle_places(source, &source->particles.soft, sizeof(struct flow_soft));
    for (uint32_t b = 0; b < blocks->n_blocks; b++) {
        struct flow_table *shape = source->shape + b;
        shape->format = source->model->format;
        shape->first = blocks->start[b];
        shape->n = blocks->start[b + 1] - blocks->start[b];
        find_vertices(source, shape);
        shape->n_moved = count_numbered(source, shape, source->particles.motion);
        shape->n_sliding = count_numbered(source, shape, source->particles.slider);
        shape->n_loose = count_numbered(source, shape, source->particles.piece);
        shape->n_varying =
            count_placed(&source->particles.varying, sizeof(struct flow_varying), shape);
        shape->n_soft = count_placed(&source->particles.soft, sizeof(struct flow_soft), shape);
    }
    count_watched(source);
    flow_source_count(source);
    const int code = flow_source_meet(source, error);
    for (uint32_t b = 0; b < blocks->n_blocks && source->model->sizes; b++)
        source->shape[b].n_sized = count_sized(source->shape + b);
    return code;
}

int flow_source_make(struct flow_source *source, const struct model *model, int ranks,
                     struct cloth_error *error)
{
    *source = (struct flow_source){.model = model};
    const struct flow_welds *welds = &source->particles.welds;
    const bool seeks = model_seeks(model);
    int code = flow_particles_make(&source->particles, model, error);
    code = code ? code : element_cloths_make(&source->elements, model, error);
    code = code ? code : flow_welds_check(welds, &source->elements, error);
    code = code ? code : flow_seams_make(&source->elements, welds, error);
    code = code ? code : element_folds_check(&source->elements, error);
    code =
        code ? code : flow_springs_make(&source->springs, model, welds, &source->elements, error);
    code = code ? code : flow_springs_merge(&source->springs, error);
    code = code ? code : flow_joints_make(&source->springs, &source->particles, error);
    code = code || !model_is_implicit(model) ? code : make_pieces(source, error);
    code = code ? code : cut_blocks(source, ranks, error);
    code = code ? code : flow_watched_make(&source->watched, source, error);
    code = code ? code : find_shapes(source, error);
    code = code || !seeks ? code : flow_skins_make(source, error);
    if (code)
        flow_source_free(source);
    return code;
}

void flow_source_free(struct flow_source *source)
{
    flow_source_forget(source);
    cloth_pool_free(&source->memory);
    cloth_pool_free(&source->watched.memory);
    flow_skins_free(&source->skins);
    free(source->names.name);
    mesh_blocks_free(&source->blocks);
    flow_springs_free(&source->springs);
    element_cloths_free(&source->elements);
    flow_particles_free(&source->particles);
    *source = (struct flow_source){0};
}
