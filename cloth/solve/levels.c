/* Levels are made once a run, of the graph of patches alone: the same everywhere. What a step does
 * with them is at the end. */
#include "cloth/solve/levels.h"

#include "cloth/base/memory.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* ---- What groups cover ---- */

/* Marks a holder's nodes. */
static void mark_holder(const struct solve_level *level, uint32_t node, unsigned char *mark)
{
    const struct solve_runs *holder = &level->holder;
    const uint32_t *start = holder->start + holder->of[node];
    memset(mark + start[0], 1, start[1] - start[0]);
}

/* Marks what group g covers. Returns how many nodes that are. */
static uint32_t mark_cover(const struct solve_level *level, uint32_t g, unsigned char *mark)
{
    uint32_t n = 0;
    memset(mark, 0, level->n);
    for (uint32_t p = level->group.start[g]; p < level->group.start[g + 1]; p++) {
        mark_holder(level, p, mark);
        for (uint32_t i = level->first[p]; i < level->first[p + 1]; i++)
            mark_holder(level, level->neighbour[i], mark);
    }
    for (uint32_t p = 0; p < level->n; p++)
        n += mark[p];
    return n;
}

/* How many neighbours these nodes have among all. */
static size_t count_neighbours(const struct solve_level *level, const struct solve_cover *cover)
{
    size_t n = 0;
    for (uint32_t i = 0; i < cover->n; i++)
        n += level->first[cover->node[i] + 1] - level->first[cover->node[i]];
    return n;
}

/* The graph of a cover, by places; place: of each node that is covered. */
static void join_cover(const struct solve_level *level, const unsigned char *mark,
                       const uint32_t *place, struct solve_cover *cover)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < cover->n; i++) {
        const uint32_t p = cover->node[i];
        for (uint32_t k = level->first[p]; k < level->first[p + 1]; k++) {
            const uint32_t other = level->neighbour[k];
            if (mark[other])
                cover->neighbour[n++] = place[other];
            else if (other > p) /* it has a block in the coupling of p */
                cover->neighbour[n++] = SOLVE_LEFT_OUT;
        }
        cover->first[i + 1] = n;
    }
}

/* mark, place: room for a number a node. */
static int make_cover(const struct solve_level *level, uint32_t g, unsigned char *mark,
                      uint32_t *place, struct cloth_error *error)
{
    struct solve_cover *cover = level->cover + g;
    cover->n = mark_cover(level, g, mark);
    cover->node = cloth_alloc(cover->n, sizeof *cover->node, error);
    cover->first = cloth_alloc((size_t)cover->n + 1, sizeof *cover->first, error);
    if (!cover->node || !cover->first)
        return CLOTH_E_MEMORY;
    for (uint32_t p = 0, n = 0; p < level->n; p++)
        if (mark[p]) {
            cover->node[n] = p;
            place[p] = n++;
        }
    cover->neighbour = cloth_alloc(count_neighbours(level, cover), sizeof *cover->neighbour, error);
    if (!cover->neighbour)
        return CLOTH_E_MEMORY;
    join_cover(level, mark, place, cover);
    return solve_pattern_make(&cover->pattern, cover->n, cover->first, cover->neighbour, error);
}

static int make_covers(struct solve_level *level, struct cloth_error *error)
{
    unsigned char *mark = cloth_alloc(level->n, sizeof *mark, error);
    uint32_t *place = cloth_alloc(level->n, sizeof *place, error);
    int code = mark && place ? CLOTH_OK : CLOTH_E_MEMORY;
    for (uint32_t g = 0; g < level->group.n && !code; g++)
        code = make_cover(level, g, mark, place, error);
    free(mark);
    free(place);
    return code;
}

/* Turns the covers round: which groups cover a node. */
static int find_covering(struct solve_level *level, struct cloth_error *error)
{
    uint32_t *first = level->covering_first;
    for (uint32_t g = 0; g < level->group.n; g++)
        for (uint32_t i = 0; i < level->cover[g].n; i++)
            first[level->cover[g].node[i] + 1]++;
    for (uint32_t p = 0; p < level->n; p++)
        first[p + 1] += first[p];
    level->covering = cloth_alloc(first[level->n], sizeof *level->covering, error);
    if (!level->covering)
        return CLOTH_E_MEMORY;
    for (uint32_t g = 0; g < level->group.n; g++)
        for (uint32_t i = 0; i < level->cover[g].n; i++)
            level->covering[first[level->cover[g].node[i]]++] = (struct solve_covering){g, i};
    for (uint32_t p = level->n; p > 0; p--) /* each was moved on to the next one's */
        first[p] = first[p - 1];
    first[0] = 0;
    return CLOTH_OK;
}

/* ---- The graph of the clusters ---- */

/* Marks by k + 1 the clusters that cluster k is joined with. Returns how many. */
static uint32_t mark_joined(const struct solve_level *level, uint32_t k, uint32_t *mark)
{
    const struct solve_runs *cluster = &level->cluster;
    const uint32_t from = level->first[cluster->start[k]];
    const uint32_t to = level->first[cluster->start[k + 1]];
    uint32_t n = 0;
    for (uint32_t i = from; i < to; i++) {
        const uint32_t other = cluster->of[level->neighbour[i]];
        n += other != k && mark[other] != k + 1;
        mark[other] = k + 1;
    }
    mark[k] = 0;
    return n;
}

static int join_clusters(struct solve_level *level, struct cloth_error *error)
{
    const uint32_t n = level->cluster.n;
    uint32_t *mark = cloth_alloc(n, sizeof *mark, error), *first = level->cluster_first;
    if (!mark)
        return CLOTH_E_MEMORY;
    for (uint32_t k = 0; k < n; k++)
        first[k + 1] = first[k] + mark_joined(level, k, mark);
    level->cluster_neighbour = cloth_alloc(first[n], sizeof *level->cluster_neighbour, error);
    memset(mark, 0, n * sizeof *mark);
    for (uint32_t k = 0; k < n && level->cluster_neighbour; k++) {
        uint32_t *to = level->cluster_neighbour + first[k];
        mark_joined(level, k, mark);
        for (uint32_t other = 0; other < n; other++)
            if (mark[other] == k + 1)
                *to++ = other;
    }
    free(mark);
    return level->cluster_neighbour ? CLOTH_OK : CLOTH_E_MEMORY;
}

/* ---- Both ---- */

static int make_runs(struct solve_runs *runs, uint32_t n, uint32_t n_runs, const uint32_t *start,
                     struct cloth_error *error)
{
    const size_t starts = (size_t)n_runs + 1;
    runs->start = cloth_alloc(starts, sizeof *runs->start, error);
    runs->of = cloth_alloc(n, sizeof *runs->of, error);
    if (!runs->start || !runs->of)
        return CLOTH_E_MEMORY;
    runs->n = n_runs;
    memcpy(runs->start, start, starts * sizeof *start);
    for (uint32_t k = 0; k < n_runs; k++)
        for (uint32_t p = start[k]; p < start[k + 1]; p++)
            runs->of[p] = k;
    return CLOTH_OK;
}

static int make_room(struct solve_level *level, struct cloth_error *error)
{
    const size_t groups = level->group.n, clusters = level->cluster.n, n = level->n;
    level->first_cluster = cloth_alloc(groups + 1, sizeof *level->first_cluster, error);
    level->cover = cloth_alloc(groups, sizeof *level->cover, error);
    level->covering_first = cloth_alloc(n + 1, sizeof *level->covering_first, error);
    level->cluster_first = cloth_alloc(clusters + 1, sizeof *level->cluster_first, error);
    return level->first_cluster && level->cover && level->covering_first && level->cluster_first
               ? CLOTH_OK
               : CLOTH_E_MEMORY;
}

int solve_level_make(struct solve_level *level, uint32_t n, const uint32_t *first,
                     const uint32_t *neighbour, const struct solve_starts *starts,
                     struct cloth_error *error)
{
    *level = (struct solve_level){.n = n, .first = first, .neighbour = neighbour};
    int code = make_runs(&level->holder, n, starts->n_holders, starts->holder, error);
    if (!code)
        code = make_runs(&level->group, n, starts->n_groups, starts->group, error);
    if (!code)
        code = make_runs(&level->cluster, n, starts->n_clusters, starts->cluster, error);
    if (!code)
        code = make_room(level, error);
    if (code)
        return code;
    for (uint32_t k = 0; k < starts->n_clusters; k++)
        level->first_cluster[level->group.of[starts->cluster[k]] + 1] = k + 1;
    code = make_covers(level, error);
    if (!code)
        code = find_covering(level, error);
    return code ? code : join_clusters(level, error);
}

void solve_level_free(struct solve_level *level)
{
    for (uint32_t g = 0; level->cover && g < level->group.n; g++) {
        solve_pattern_free(&level->cover[g].pattern);
        free(level->cover[g].node);
        free(level->cover[g].first);
        free(level->cover[g].neighbour);
    }
    free(level->holder.start);
    free(level->holder.of);
    free(level->group.start);
    free(level->group.of);
    free(level->cluster.start);
    free(level->cluster.of);
    free(level->first_cluster);
    free(level->cover);
    free(level->covering_first);
    free(level->covering);
    free(level->cluster_first);
    free(level->cluster_neighbour);
    *level = (struct solve_level){0};
}

/* ---- In a step ---- */

size_t solve_level_coupling_at(const struct solve_level *level, uint32_t group, uint32_t cluster)
{
    const uint32_t from = level->first_cluster[group];
    size_t n = cluster - from;
    for (uint32_t k = from; k < cluster; k++)
        for (uint32_t i = level->cluster_first[k]; i < level->cluster_first[k + 1]; i++)
            n += level->cluster_neighbour[i] > k;
    return n;
}

/* Where the block of clusters k <= l is in the couplings of a group. */
static size_t coupling_of(const struct solve_level *level, uint32_t group, uint32_t k, uint32_t l)
{
    size_t at = solve_level_coupling_at(level, group, k) + (k < l);
    for (uint32_t i = level->cluster_first[k]; k < l && level->cluster_neighbour[i] != l; i++)
        at += level->cluster_neighbour[i] > k;
    return SOLVE_COUPLING * at;
}

/* M = T' C, then M T', in terms of functions: T of nine by nine is `lift` for each axis. */
static void lift_block(const double *c, const double rows[9], const double columns[9],
                       double to[SOLVE_COUPLING])
{
    double half[SOLVE_COUPLING] = {0};
    memset(to, 0, SOLVE_COUPLING * sizeof *to);
    for (int a = 0; a < 3; a++)
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < 3; i++)
                for (int j = 0; j < SOLVE_COARSE; j++)
                    half[SOLVE_COARSE * (3 * k + i) + j] +=
                        rows[3 * a + k] * c[SOLVE_COARSE * (3 * a + i) + j];
    for (int i = 0; i < SOLVE_COARSE; i++)
        for (int b = 0; b < 3; b++)
            for (int l = 0; l < 3; l++)
                for (int j = 0; j < 3; j++)
                    to[SOLVE_COARSE * i + 3 * l + j] +=
                        half[SOLVE_COARSE * i + 3 * b + j] * columns[3 * b + l];
}

/* to += m, or, transposed, its transpose. */
static void add_block(const double m[SOLVE_COUPLING], bool transposed, double *to)
{
    for (int i = 0; i < SOLVE_COARSE; i++)
        for (int j = 0; j < SOLVE_COARSE; j++)
            to[SOLVE_COARSE * i + j] +=
                transposed ? m[SOLVE_COARSE * j + i] : m[SOLVE_COARSE * i + j];
}

void solve_level_couple(const struct solve_level *level, uint32_t node, const double *coupling,
                        const double (*lift)[9], double *to)
{
    const uint32_t group = level->group.of[node], cluster = level->cluster.of[node];
    double lifted[SOLVE_COUPLING];
    lift_block(coupling, lift[node], lift[node], lifted);
    add_block(lifted, false, to + coupling_of(level, group, cluster, cluster));
    for (uint32_t i = level->first[node]; i < level->first[node + 1]; i++) {
        const uint32_t other = level->neighbour[i];
        if (other < node)
            continue;
        double *block = to + coupling_of(level, group, cluster, level->cluster.of[other]);
        coupling += SOLVE_COUPLING;
        lift_block(coupling, lift[node], lift[other], lifted);
        add_block(lifted, false, block);
        if (level->cluster.of[other] == cluster)
            add_block(lifted, true, block);
    }
}

void solve_level_solve(const struct solve_level *level, uint32_t group, const double *factor,
                       double *x)
{
    const struct solve_cover *cover = level->cover + group;
    const double weight = level->group.n > 1 ? 0.5 : 1;
    solve_coarse_solve(&cover->pattern, factor, x);
    for (size_t i = 0; i < SOLVE_COARSE_STRIDE * (size_t)cover->n; i++)
        x[i] *= weight;
}

void solve_level_restrict(const double lift[9], const double x[SOLVE_COARSE],
                          double sum[SOLVE_COARSE])
{
    for (int a = 0; a < 3; a++)
        for (int k = 0; k < 3; k++)
            for (int c = 0; c < 3; c++)
                sum[3 * k + c] += lift[3 * a + k] * x[3 * a + c];
}

void solve_level_prolong(const double lift[9], double x[SOLVE_COARSE])
{
    double y[SOLVE_COARSE] = {0};
    for (int a = 0; a < 3; a++)
        for (int k = 0; k < 3; k++)
            for (int c = 0; c < 3; c++)
                y[3 * a + c] += lift[3 * a + k] * x[3 * k + c];
    memcpy(x, y, sizeof y);
}
