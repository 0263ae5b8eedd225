/* The preconditioner of a run, and the pattern of its coarse matrix (coarse.c): the patches that
 * anything joins, later ties too. It is the same on every rank, and is made once a run. */
#include "cloth/flow/run/setup.h"
#include "cloth/flow/solver/levels.h"
#include "cloth/flow/solver/solve.h"
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

/* Appends the neighbours of patch k of block b, ascending. Returns the end. */
static uint32_t *solver_pattern_add_neighbours(const struct flow *flow, uint32_t b, uint32_t k,
                                               uint32_t *to)
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

/* The patch of a row of a block. */
static uint32_t solver_pattern_patch_of(const struct flow *flow, uint32_t block, uint32_t row)
{
    const struct solve_patches patches =
        solve_patches_of(flow->tables.block[block].n, flow->patches);
    return flow->patches * block + solve_patch_of(&patches, row);
}

/* Puts a patch among those from .. end - 1, which ascend, unless it is there. Returns the end. */
static uint32_t *insert_patch(uint32_t *from, uint32_t *end, uint32_t patch)
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
            has = has || (at->block[k] == b && solver_pattern_patch_of(flow, b, at->row[k]) == p);
        for (uint32_t k = 0; k < at->n && has; k++) {
            const uint32_t patch = solver_pattern_patch_of(flow, at->block[k], at->row[k]);
            if (patch != p)
                end = insert_patch(from, end, patch);
        }
    }
    return end;
}

/* The most neighbours that all patches can have. */
static size_t max_patch_neighbours(const struct flow *flow)
{
    size_t neighbours = 0;
    for (uint32_t i = 0; i < flow->n_ties; i++)
        neighbours += (size_t)flow->tie[i].at.n * (flow->tie[i].at.n - 1);
    for (uint32_t b = 0; b < flow->tables.n_blocks; b++)
        neighbours += 1 + (size_t)flow->tables.block[b].n_neighbours;
    return neighbours * flow->patches * flow->patches;
}

/* Returns false without memory for the graph of all patches. */
static bool join_patches(struct flow *flow)
{
    const uint32_t n_blocks = flow->tables.n_blocks;
    const size_t n = (size_t)flow->patches * n_blocks;
    flow->patch_first = flow_take(flow, n + 1, sizeof *flow->patch_first);
    flow->patch_neighbour =
        flow_take(flow, max_patch_neighbours(flow), sizeof *flow->patch_neighbour);
    if (!flow->patch_first || !flow->patch_neighbour)
        return false;
    for (uint32_t b = 0; b < n_blocks; b++)
        for (uint32_t k = 0; k < flow->patches; k++) {
            const uint32_t p = flow->patches * b + k;
            uint32_t *from = flow->patch_neighbour + flow->patch_first[p];
            uint32_t *end = solver_pattern_add_neighbours(flow, b, k, from);
            end = insert_tied(flow, b, p, from, end);
            flow->patch_first[p + 1] = (uint32_t)(end - flow->patch_neighbour);
        }
    return true;
}

/* ---- Levels ---- */

/* Writes the first blocks of runs of at most so many blocks, as METIS' bisections made them
 * (cloth/mesh/blocks.h): the lower half is the smaller one. So runs of more blocks are made of
 * whole runs of fewer. Returns the end. */
static uint32_t *split_runs(uint32_t from, uint32_t to, uint64_t most, uint32_t *start)
{
    const uint32_t middle = from + (to - from) / 2;
    if (to - from > most)
        return split_runs(middle, to, most, split_runs(from, middle, most, start));
    *start = from;
    return start + 1;
}

/* The node of a level that the first patch of a block is in. */
static uint32_t solver_pattern_node_of(const struct flow *flow, uint32_t level, uint32_t block)
{
    uint32_t node = flow->patches * block;
    for (uint32_t l = 0; l < level; l++)
        node = flow->level[l].group[node];
    return node;
}

/* Makes the next level, of groups of at most so many blocks. */
static int add_level(struct flow *flow, uint64_t most)
{
    const uint32_t l = flow->n_levels, n_blocks = flow->tables.n_blocks;
    const struct flow_graph nodes = flow_levels_graph(flow);
    uint32_t *start = cloth_alloc((size_t)n_blocks + 1, sizeof *start, &flow->trouble);
    if (!start)
        return CLOTH_E_MEMORY;
    const uint32_t n_groups = (uint32_t)(split_runs(0, n_blocks, most, start) - start);
    for (uint32_t g = 0; g < n_groups; g++)
        start[g] = solver_pattern_node_of(flow, l, start[g]);
    start[n_groups] = nodes.n;
    flow->n_levels++;
    flow->first_group[l + 1] = flow->first_group[l] + n_groups;
    flow->first_lifted[l + 1] = flow->first_lifted[l] + nodes.n;
    const int code = solve_level_make(flow->level + l, nodes.n, nodes.first, nodes.neighbour,
                                      n_groups, start, l == 0, &flow->trouble);
    free(start);
    return code;
}

/* As many levels as it takes until few nodes are on top; none if patches are few. */
static int make_levels(struct flow *flow)
{
    enum { MOST_ON_TOP = 100 };
    uint32_t most = MODEL_ONE_FACTOR;
    uint64_t blocks = FLOW_MAX_NODES / flow->patches;
    int code = CLOTH_OK;
    while (flow_levels_graph(flow).n > most && !flow->model->exact_coarse &&
           flow->n_levels < FLOW_MAX_LEVELS && !code) {
        code = add_level(flow, blocks);
        blocks *= FLOW_MAX_NODES;
        most = MOST_ON_TOP;
    }
    return code;
}

static void make_pattern(struct flow *flow)
{
    if (!join_patches(flow) || make_levels(flow))
        return;
    const struct flow_graph top = flow_levels_graph(flow);
    solve_pattern_make(&flow->pattern, top.n, top.first, top.neighbour, &flow->trouble);
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

void flow_preconditioner_choose(struct flow *flow, uint32_t n_blocks)
{
    const struct model *model = flow->model;
    flow->conditioner =
        model_conditioners[model_is_implicit(model) ? model->preconditioner : MODEL_PLAIN];
    flow->patches = model_patches(model, n_blocks);
}

int flow_preconditioner_prepare(struct flow_state *state)
{
    struct flow *flow = state->flow;
    flow_preconditioner_choose(flow, flow->tables.n_blocks);
    if (!flow->conditioner.coarse)
        return DUITE_OK;
    make_pattern(flow);
    if (flow->n_levels && !flow->trouble.code)
        flow_levels_take(state);
    return flow_memory_agree(state);
}

void flow_preconditioner_free(struct flow *flow)
{
    solve_pattern_free(&flow->pattern);
    for (uint32_t l = 0; l < flow->n_levels; l++)
        solve_level_free(flow->level + l);
}
