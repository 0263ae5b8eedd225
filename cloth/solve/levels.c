/* Levels are made once a run from the graph of patches alone, so they are the same everywhere. The
 * end of the file has the functions of a step. */
#include "cloth/solve/levels.h"

#include "cloth/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* ---- Covers of groups ---- */

/* Marks the nodes that group g covers. Returns their number. */
static uint32_t mark_cover(const struct solve_level *level, uint32_t g, unsigned char *mark)
{
    uint32_t n = 0;
    memset(mark, 0, level->n);
    for (uint32_t p = level->start[g]; p < level->start[g + 1]; p++) {
        mark[p] = 1;
        for (uint32_t i = level->first[p]; i < level->first[p + 1]; i++)
            mark[level->neighbour[i]] = 1;
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
    for (uint32_t g = 0; g < level->n_groups && !code; g++)
        code = make_cover(level, g, mark, place, error);
    free(mark);
    free(place);
    return code;
}

/* Turns the covers round: which groups cover a node. */
static int find_covering(struct solve_level *level, struct cloth_error *error)
{
    uint32_t *first = level->covering_first;
    for (uint32_t g = 0; g < level->n_groups; g++)
        for (uint32_t i = 0; i < level->cover[g].n; i++)
            first[level->cover[g].node[i] + 1]++;
    for (uint32_t p = 0; p < level->n; p++)
        first[p + 1] += first[p];
    level->covering = cloth_alloc(first[level->n], sizeof *level->covering, error);
    if (!level->covering)
        return CLOTH_E_MEMORY;
    for (uint32_t g = 0; g < level->n_groups; g++)
        for (uint32_t i = 0; i < level->cover[g].n; i++)
            level->covering[first[level->cover[g].node[i]]++] = (struct solve_covering){g, i};
    for (uint32_t p = level->n; p > 0; p--) /* each was moved on to the next one's */
        first[p] = first[p - 1];
    first[0] = 0;
    return CLOTH_OK;
}

/* ---- The graph of the groups ---- */

/* Marks by g + 1 the groups that group g is joined with. Returns how many. */
static uint32_t mark_joined(const struct solve_level *level, uint32_t g, uint32_t *mark)
{
    const uint32_t from = level->first[level->start[g]];
    const uint32_t to = level->first[level->start[g + 1]];
    uint32_t n = 0;
    for (uint32_t i = from; i < to; i++) {
        const uint32_t other = level->group[level->neighbour[i]];
        n += other != g && mark[other] != g + 1;
        mark[other] = g + 1;
    }
    mark[g] = 0;
    return n;
}

static int join_groups(struct solve_level *level, struct cloth_error *error)
{
    const uint32_t n = level->n_groups;
    uint32_t *mark = cloth_alloc(n, sizeof *mark, error), *first = level->group_first;
    if (!mark)
        return CLOTH_E_MEMORY;
    for (uint32_t g = 0; g < n; g++)
        first[g + 1] = first[g] + mark_joined(level, g, mark);
    level->group_neighbour = cloth_alloc(first[n], sizeof *level->group_neighbour, error);
    memset(mark, 0, n * sizeof *mark);
    for (uint32_t g = 0; g < n && level->group_neighbour; g++) {
        uint32_t *to = level->group_neighbour + first[g];
        mark_joined(level, g, mark);
        for (uint32_t other = 0; other < n; other++)
            if (mark[other] == g + 1)
                *to++ = other;
    }
    free(mark);
    return level->group_neighbour ? CLOTH_OK : CLOTH_E_MEMORY;
}

/* ---- Both ---- */

static int solve_levels_make_room(struct solve_level *level, struct cloth_error *error)
{
    const size_t groups = level->n_groups, n = level->n;
    level->start = cloth_alloc(groups + 1, sizeof *level->start, error);
    level->group = cloth_alloc(n, sizeof *level->group, error);
    level->cover = cloth_alloc(groups, sizeof *level->cover, error);
    level->covering_first = cloth_alloc(n + 1, sizeof *level->covering_first, error);
    level->group_first = cloth_alloc(groups + 1, sizeof *level->group_first, error);
    return level->start && level->group && level->cover && level->covering_first &&
                   level->group_first
               ? CLOTH_OK
               : CLOTH_E_MEMORY;
}

int solve_level_make(struct solve_level *level, uint32_t n, const uint32_t *first,
                     const uint32_t *neighbour, uint32_t n_groups, const uint32_t *start,
                     bool lowest, struct cloth_error *error)
{
    *level =
        (struct solve_level){.n = n, .first = first, .neighbour = neighbour, .n_groups = n_groups};
    level->weight = n_groups == 1 ? 1 : lowest ? 0.5 : 1.5;
    int code = solve_levels_make_room(level, error);
    if (code)
        return code;
    memcpy(level->start, start, ((size_t)n_groups + 1) * sizeof *start);
    for (uint32_t g = 0; g < n_groups; g++)
        for (uint32_t p = start[g]; p < start[g + 1]; p++)
            level->group[p] = g;
    code = make_covers(level, error);
    if (!code)
        code = find_covering(level, error);
    return code ? code : join_groups(level, error);
}

void solve_level_free(struct solve_level *level)
{
    for (uint32_t g = 0; level->cover && g < level->n_groups; g++) {
        solve_pattern_free(&level->cover[g].pattern);
        free(level->cover[g].node);
        free(level->cover[g].first);
        free(level->cover[g].neighbour);
    }
    free(level->start);
    free(level->group);
    free(level->cover);
    free(level->covering_first);
    free(level->covering);
    free(level->group_first);
    free(level->group_neighbour);
    *level = (struct solve_level){0};
}

/* ---- In a step ---- */

/* The block of groups g <= other in the coupling of g. */
static uint32_t coupling_of(const struct solve_level *level, uint32_t g, uint32_t other)
{
    uint32_t at = g < other;
    for (uint32_t i = level->group_first[g]; g < other && level->group_neighbour[i] != other; i++)
        at += level->group_neighbour[i] > g;
    return at;
}

uint32_t solve_level_couplings(const struct solve_level *level, uint32_t group)
{
    uint32_t n = 1;
    for (uint32_t i = level->group_first[group]; i < level->group_first[group + 1]; i++)
        n += level->group_neighbour[i] > group;
    return n;
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
static void solve_levels_add_block(const double m[SOLVE_COUPLING], bool transposed, double *to)
{
    for (int i = 0; i < SOLVE_COARSE; i++)
        for (int j = 0; j < SOLVE_COARSE; j++)
            to[SOLVE_COARSE * i + j] +=
                transposed ? m[SOLVE_COARSE * j + i] : m[SOLVE_COARSE * i + j];
}

void solve_level_couple(const struct solve_level *level, uint32_t node, const double *coupling,
                        const double (*lift)[9], double *to)
{
    const uint32_t group = level->group[node];
    double lifted[SOLVE_COUPLING];
    lift_block(coupling, lift[node], lift[node], lifted);
    solve_levels_add_block(lifted, false, to);
    for (uint32_t i = level->first[node]; i < level->first[node + 1]; i++) {
        const uint32_t other = level->neighbour[i];
        if (other < node)
            continue;
        double *block = to + SOLVE_COUPLING * coupling_of(level, group, level->group[other]);
        coupling += SOLVE_COUPLING;
        lift_block(coupling, lift[node], lift[other], lifted);
        solve_levels_add_block(lifted, false, block);
        if (level->group[other] == group)
            solve_levels_add_block(lifted, true, block);
    }
}

static void solve_scaled(const struct solve_pattern *pattern, const double *factor, double weight,
                         double *x)
{
    solve_coarse_solve(pattern, factor, x);
    for (size_t i = 0; i < SOLVE_COARSE_STRIDE * (size_t)pattern->n; i++)
        x[i] *= weight;
}

void solve_level_solve(const struct solve_level *level, uint32_t group, const double *factor,
                       double *x)
{
    const struct solve_cover *cover = level->cover + group;
    solve_scaled(&cover->pattern, factor, level->weight, x);
}

void solve_level_solve_top(const struct solve_pattern *pattern, const double *factor, double *x)
{
    solve_scaled(pattern, factor, 2, x);
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
