/* The pattern of the coarse matrix (coarse.c): which patches anything joins, ties that come later
 * too. It is the same on every rank, and is made once a run. */
#include "cloth/flow/setup/setup.h"
#include "cloth/flow/solver/solver.h"

#include "cloth/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* Appends to `to` the patches of block `other` that patch k is joined with. */
static uint32_t *add_joined(const struct flow *flow, uint32_t joins, uint32_t k, uint32_t other,
                            uint32_t *to)
{
    for (uint32_t l = 0; l < flow->patches; l++)
        if (joins & solve_patch_bit(k, l))
            *to++ = flow->patches * other + l;
    return to;
}

/* Those of patch k of block b, ascending. Returns the end. */
static uint32_t *add_neighbours(const struct flow *flow, uint32_t b, uint32_t k, uint32_t *to)
{
    const struct flow_table *t = flow->tables.block + b;
    const uint32_t itself = solve_patch_bit(k, k);
    uint32_t s = 0;
    for (; s < t->n_neighbours && t->neighbour[s] < b; s++)
        to = add_joined(flow, t->joins[s], k, t->neighbour[s], to);
    to = add_joined(flow, t->joined & ~itself, k, b, to);
    for (; s < t->n_neighbours; s++)
        to = add_joined(flow, t->joins[s], k, t->neighbour[s], to);
    return to;
}

uint32_t flow_patch_of(const struct flow *flow, uint32_t block, uint32_t row)
{
    const struct solve_patches patches =
        solve_patches_of(flow->tables.block[block].n, flow->patches);
    return flow->patches * block + solve_patch_of(&patches, row);
}

/* Puts a patch among those from .. end - 1, which ascend, unless it is there. Returns the end. */
static uint32_t *insert(uint32_t *from, uint32_t *end, uint32_t patch)
{
    uint32_t *at = from;
    while (at < end && *at < patch)
        at++;
    if (at < end && *at == patch)
        return end;
    memmove(at + 1, at, (size_t)(end - at) * sizeof *at);
    *at = patch;
    return end + 1;
}

/* Adds to the neighbours of patch p of block b those that ties may join it with, at any time. */
static uint32_t *insert_tied(const struct flow *flow, uint32_t b, uint32_t p, uint32_t *from,
                             uint32_t *end)
{
    for (const struct flow_tie *tie = flow->tie; tie < flow->tie + flow->n_ties; tie++) {
        const struct flow_tie_corners *at = &tie->at;
        bool has = false;
        for (uint32_t k = 0; k < at->n; k++)
            has = has || (at->block[k] == b && flow_patch_of(flow, b, at->row[k]) == p);
        for (uint32_t k = 0; k < at->n && has; k++) {
            const uint32_t patch = flow_patch_of(flow, at->block[k], at->row[k]);
            if (patch != p)
                end = insert(from, end, patch);
        }
    }
    return end;
}

/* How many neighbours all patches can have. */
static size_t max_patch_neighbours(const struct flow *flow)
{
    size_t neighbours = 0;
    for (uint32_t i = 0; i < flow->n_ties; i++)
        neighbours += (size_t)flow->tie[i].at.n * (flow->tie[i].at.n - 1);
    for (uint32_t b = 0; b < flow->tables.n_blocks; b++)
        neighbours += 1 + (size_t)flow->tables.block[b].n_neighbours;
    return neighbours * flow->patches * flow->patches;
}

static void make_pattern(struct flow *flow)
{
    const uint32_t n_blocks = flow->tables.n_blocks, n = flow->patches * n_blocks;
    struct cloth_error *trouble = &flow->trouble;
    flow->patch_first = cloth_alloc((size_t)n + 1, sizeof *flow->patch_first, trouble);
    flow->patch_neighbour =
        cloth_alloc(max_patch_neighbours(flow), sizeof *flow->patch_neighbour, trouble);
    if (!flow->patch_first || !flow->patch_neighbour)
        return;
    for (uint32_t b = 0; b < n_blocks; b++)
        for (uint32_t k = 0; k < flow->patches; k++) {
            const uint32_t p = flow->patches * b + k;
            uint32_t *from = flow->patch_neighbour + flow->patch_first[p];
            uint32_t *end = add_neighbours(flow, b, k, from);
            end = insert_tied(flow, b, p, from, end);
            flow->patch_first[p + 1] = (uint32_t)(end - flow->patch_neighbour);
        }
    solve_pattern_make(&flow->pattern, n, flow->patch_first, flow->patch_neighbour, trouble);
}

/* How many neighbours of patch p are behind it and before `end`. */
static size_t count_later(const struct flow *flow, uint32_t p, uint32_t end)
{
    size_t count = 0;
    for (uint32_t i = flow->patch_first[p]; i < flow->patch_first[p + 1]; i++)
        count += flow->patch_neighbour[i] > p && flow->patch_neighbour[i] < end;
    return count;
}

bool flow_patches_joined(const struct flow *flow, uint32_t p, uint32_t q)
{
    uint32_t i = flow->patch_first[p];
    while (i < flow->patch_first[p + 1] && flow->patch_neighbour[i] != q)
        i++;
    return p == q || i < flow->patch_first[p + 1];
}

size_t flow_coupling_at(const struct flow *flow, uint32_t p, uint32_t q)
{
    size_t at = q > p ? 1 + count_later(flow, p, q) : 0;
    for (uint32_t before = p - p % flow->patches; before < p; before++)
        at += 1 + count_later(flow, before, UINT32_MAX);
    return at;
}

int flow_coarse_prepare(struct flow_state *state)
{
    make_pattern(state->flow);
    return flow_memory_agree(state);
}

void flow_coarse_free(struct flow *flow)
{
    solve_pattern_free(&flow->pattern);
    free(flow->patch_first);
    free(flow->patch_neighbour);
    flow->patch_first = flow->patch_neighbour = NULL;
}
