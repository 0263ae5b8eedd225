/* A spring between two blocks makes each read the other's row. These rows, sorted by reader, block
 * and row, each once, are the ghosts; their blocks are the neighbours. */
#include "cloth/flow/run/source.h"

#include "cloth/base/memory.h"
#include "cloth/base/order.h"

#include <stdlib.h>

/* Block `reader` needs a place of block `other`; patches: of the reader, as bits. */
struct need {
    uint32_t reader, other, place, patches;
};

struct finder {
    struct flow_source *source;
    uint32_t block; /* of the last spring's lower end: the next one's is often the same */
    struct cloth_list needs;
    struct cloth_error *error;
    int code;
};

/* The patch of a place. */
static uint32_t patch_of(const struct flow_source *source, uint32_t block, uint32_t place)
{
    const uint32_t first = source->blocks.start[block];
    const struct solve_patches patches =
        solve_patches_of(source->blocks.start[block + 1] - first, source->patches);
    return solve_patch_of(&patches, place - first);
}

static void add_need(struct finder *finder, uint32_t reader, uint32_t other, uint32_t place,
                     uint32_t patch)
{
    const struct need need = {reader, other, place, UINT32_C(1) << patch};
    finder->source->halo[place] = 1;
    if (cloth_list_put(&finder->needs, &need, sizeof need, finder->error))
        finder->code = CLOTH_E_MEMORY;
}

/* Counts an entry between vertices a and b that something joins; that they have one already does
 * no harm. Returns the blocks of both. */
static void join_blocks(struct finder *finder, uint32_t a, uint32_t b, struct flow_table *block[2])
{
    const struct flow_source *source = finder->source;
    const uint32_t p = source->blocks.place[a], q = source->blocks.place[b];
    const uint32_t bp = flow_source_block(&source->blocks, p, finder->block);
    const uint32_t bq = flow_source_block(&source->blocks, q, bp);
    const uint32_t kp = patch_of(source, bp, p), kq = patch_of(source, bq, q);
    const unsigned char *free = source->particles.free;
    const bool free_p = free[source->blocks.vertex[p]], free_q = free[source->blocks.vertex[q]];
    finder->block = bp;
    block[0] = source->shape + bp;
    block[1] = source->shape + bq;
    if (free_p != free_q)
        block[free_q]->n_held++;
    if (bp == bq) {
        block[0]->n_entries++;
        block[0]->span = (uint32_t)cloth_larger(block[0]->span, p > q ? p - q : q - p);
        block[0]->joined |= solve_patch_bit(kp, kq) | solve_patch_bit(kq, kp);
        return;
    }
    block[0]->n_cut_entries++;
    block[1]->n_cut_entries++;
    if (finder->code)
        return;
    add_need(finder, bp, bq, q, kp);
    add_need(finder, bq, bp, p, kq);
}

static void find_need(void *to, const struct flow_spring *spring)
{
    const struct flow_source *source = ((struct finder *)to)->source;
    struct flow_table *block[2];
    join_blocks(to, spring->a, spring->b, block);
    const bool cut = block[0] != block[1], corrected = spring->correction;
    for (int k = 0; k <= cut; k++) {
        block[k]->n_stiff += spring->stiffness > 0;
        block[k]->n_pulled += spring->seam != 0;
        block[k]->n_inner += !cut;
        block[k]->n_cut += cut;
        block[k]->n_corrected += corrected && !cut;
        block[k]->n_corrected_cut += corrected && cut;
    }
    if (corrected && cut) {
        source->cut[source->blocks.place[spring->a]]++;
        source->cut[source->blocks.place[spring->b]]++;
    }
}

/* Numbers the rows that other blocks need, which are marked. */
static void number_halo(const struct flow_source *source, struct flow_table *shape)
{
    uint32_t *halo = source->halo + shape->first;
    const struct solve_patches patches = solve_patches_of(shape->n, source->patches);
    for (uint32_t k = 0; k < SOLVE_MAX_PATCHES; k++) {
        shape->halo_start[k] = shape->n_halo;
        for (uint32_t i = patches.start[k]; i < patches.start[k + 1]; i++)
            halo[i] = halo[i] ? shape->n_halo++ : MESH_NO_PLACE;
    }
    shape->halo_start[SOLVE_MAX_PATCHES] = shape->n_halo;
}

/* Keeps each of the sorted needs once, and counts neighbours and ghosts. Returns how many are left.
 */
static size_t count_needs(struct flow_source *source, struct need *need, size_t n)
{
    size_t kept = 0;
    for (size_t i = 0; i < n; i++) {
        struct need *last = kept ? need + kept - 1 : NULL;
        if (last && cloth_by_three(last, need + i) == 0) {
            last->patches |= need[i].patches;
            continue;
        }
        struct flow_table *shape = source->shape + need[i].reader;
        if (!last || last->reader != need[i].reader || last->other != need[i].other)
            shape->n_neighbours++;
        shape->n_ghosts++;
        need[kept++] = need[i];
    }
    return kept;
}

/* The patches of a reader that are joined with the patch of a place. */
static uint32_t joins_of(const struct flow_source *source, const struct need *need)
{
    const uint32_t there = patch_of(source, need->other, need->place);
    uint32_t joins = 0;
    for (uint32_t k = 0; k < source->patches; k++)
        joins |= need->patches >> k & 1 ? solve_patch_bit(k, there) : 0;
    return joins;
}

/* Fills the arrays, and lets the shapes point into them. */
static void fill_neighbour(struct flow_source *source, const struct need *need)
{
    struct flow_neighbours at = source->neighbours; /* of the block */
    size_t first = 0; /* of the block's needs; there may be none at all */
    for (uint32_t b = 0; b < source->blocks.n_blocks; b++) {
        struct flow_table *shape = source->shape + b;
        uint32_t s = 0;
        shape->neighbour = at.neighbour;
        shape->ghost_start = at.ghost_start;
        shape->ghost = at.ghost;
        shape->joins = at.joins;
        for (uint32_t i = 0; i < shape->n_ghosts; i++) {
            const struct need *one = &need[first + i];
            if (i == 0 || one->other != one[-1].other) {
                at.ghost_start[s] = i;
                at.joins[s] = 0;
                at.neighbour[s++] = one->other;
            }
            at.joins[s - 1] |= joins_of(source, one);
            *at.ghost++ = source->halo[one->place];
        }
        at.ghost_start[s] = shape->n_ghosts;
        at.ghost_start += s + 1;
        at.neighbour += s;
        at.joins += s;
        first += shape->n_ghosts;
    }
}

static int make_neighbours(struct flow_source *source, struct cloth_list *needs,
                           struct cloth_error *error)
{
    struct flow_neighbours *all = &source->neighbours;
    const uint32_t n_blocks = source->blocks.n_blocks;
    cloth_list_sort(needs, sizeof(struct need), cloth_by_three);
    all->n_ghosts = (uint32_t)count_needs(source, needs->items, needs->n);
    for (uint32_t b = 0; b < n_blocks; b++)
        all->n_neighbours += source->shape[b].n_neighbours;
    struct cloth_pool *memory = &source->memory;
    const size_t n = all->n_neighbours;
    all->neighbour = cloth_take(memory, n, sizeof *all->neighbour, error);
    all->ghost_start = cloth_take(memory, n + n_blocks, sizeof *all->ghost_start, error);
    all->ghost = cloth_take(memory, all->n_ghosts, sizeof *all->ghost, error);
    all->joins = cloth_take(memory, n, sizeof *all->joins, error);
    if (memory->lacks)
        return CLOTH_E_MEMORY;
    fill_neighbour(source, needs->items);
    return CLOTH_OK;
}

int flow_source_meet(struct flow_source *source, struct cloth_error *error)
{
    struct finder finder = {.source = source, .error = error};
    source->patches = model_patches(source->model, source->blocks.n_blocks);
    if (source->model->correction_rounds)
        source->cut = cloth_take(&source->memory, source->particles.n, sizeof *source->cut, error);
    if (source->memory.lacks)
        return CLOTH_E_MEMORY;
    flow_springs_each(&source->springs, find_need, &finder);
    for (uint32_t b = 0; b < source->blocks.n_blocks; b++)
        number_halo(source, source->shape + b);
    if (!finder.code)
        finder.code = make_neighbours(source, &finder.needs, error);
    free(finder.needs.items);
    return finder.code;
}
