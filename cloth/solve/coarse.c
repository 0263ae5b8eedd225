/* The coarse factor, C = L L' in dense blocks of nine, by columns of blocks in the order of
 * elimination. A block is nine columns of twelve numbers, the last three zero; of a diagonal block
 * the entries on the diagonal are inverted, and zero for a column that was dropped. */
#include "cloth/solve/coarse.h"

#include "cloth/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- The pattern ---- */

/* The graph that elimination leaves, as bits: row b of `words` words has those that b still meets.
 */
struct graph {
    uint32_t n, words;
    uint64_t *bits;
    uint32_t *degree; /* UINT32_MAX: eliminated */
};

static uint64_t *row_of(const struct graph *graph, uint32_t b)
{
    return graph->bits + (size_t)b * graph->words;
}

static uint32_t count_bits(const struct graph *graph, uint32_t b)
{
    uint32_t count = 0;
    for (uint32_t w = 0; w < graph->words; w++)
        count += (uint32_t)__builtin_popcountll(row_of(graph, b)[w]);
    return count;
}

static bool meets(const struct graph *graph, uint32_t a, uint32_t b)
{
    return row_of(graph, a)[b / 64] >> b % 64 & 1;
}

static void forget(struct graph *graph, uint32_t a, uint32_t b)
{
    row_of(graph, a)[b / 64] &= ~(UINT64_C(1) << b % 64);
}

/* The first block of least degree. */
static uint32_t least(const struct graph *graph)
{
    uint32_t best = 0;
    for (uint32_t b = 1; b < graph->n; b++)
        if (graph->degree[b] < graph->degree[best])
            best = b;
    return best;
}

/* Joins all that meet b to each other. */
static void eliminate(struct graph *graph, uint32_t b)
{
    for (uint32_t a = 0; a < graph->n; a++) {
        if (!meets(graph, b, a))
            continue;
        for (uint32_t w = 0; w < graph->words; w++)
            row_of(graph, a)[w] |= row_of(graph, b)[w];
        forget(graph, a, a);
        forget(graph, a, b);
        graph->degree[a] = count_bits(graph, a);
    }
    graph->degree[b] = UINT32_MAX;
}

/* Fills block, place and first; leaves in the rows of bits what each block met when it went. */
static void order(struct graph *graph, struct solve_pattern *pattern)
{
    pattern->first[0] = 0;
    for (uint32_t k = 0; k < graph->n; k++) {
        const uint32_t b = least(graph);
        pattern->block[k] = b;
        pattern->place[b] = k;
        pattern->first[k + 1] = pattern->first[k] + graph->degree[b];
        eliminate(graph, b);
    }
}

static int ascending(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return x < y ? -1 : x > y;
}

static void list(const struct graph *graph, struct solve_pattern *pattern)
{
    for (uint32_t k = 0; k < graph->n; k++) {
        uint32_t *row = pattern->row + pattern->first[k], n = 0;
        for (uint32_t a = 0; a < graph->n; a++)
            if (meets(graph, pattern->block[k], a))
                row[n++] = pattern->place[a];
        qsort(row, n, sizeof *row, ascending);
    }
}

int solve_pattern_make(struct solve_pattern *pattern, uint32_t n, const uint32_t *first,
                       const uint32_t *slot, struct cloth_error *error)
{
    struct graph graph = {.n = n, .words = n / 64 + 1};
    *pattern = (struct solve_pattern){.n = n};
    graph.bits = cloth_alloc((size_t)n * graph.words, sizeof *graph.bits, error);
    graph.degree = cloth_alloc(n, sizeof *graph.degree, error);
    pattern->block = cloth_alloc(n, sizeof *pattern->block, error);
    pattern->place = cloth_alloc(n, sizeof *pattern->place, error);
    pattern->first = cloth_alloc((size_t)n + 1, sizeof *pattern->first, error);
    if (!graph.bits || !graph.degree || !pattern->block || !pattern->place || !pattern->first)
        goto done;
    for (uint32_t b = 0; b < n; b++) {
        for (uint32_t i = first[b]; i < first[b + 1]; i++)
            row_of(&graph, b)[slot[i] / 64] |= UINT64_C(1) << slot[i] % 64;
        graph.degree[b] = count_bits(&graph, b);
    }
    order(&graph, pattern);
    pattern->row = cloth_alloc(pattern->first[n], sizeof *pattern->row, error);
    if (pattern->row)
        list(&graph, pattern);
done:
    free(graph.bits);
    free(graph.degree);
    if (pattern->row)
        return CLOTH_OK;
    solve_pattern_free(pattern);
    return CLOTH_E_MEMORY;
}

void solve_pattern_free(struct solve_pattern *pattern)
{
    free(pattern->block);
    free(pattern->place);
    free(pattern->first);
    free(pattern->row);
    *pattern = (struct solve_pattern){0};
}

/* ---- The factor ---- */

/* A pivot below this part of its entry in C is rounding. */
#define LEAST 1e-10

enum { N = SOLVE_COARSE, WIDTH = 3 };

struct dense {
    phys_vec c[N][WIDTH];
};

/* The diagonal of C, a stride a column of blocks; the diagonal blocks of all columns; the entries.
 */
struct parts {
    double *whole;
    struct dense *diagonal, *entry;
};

static struct parts parts_of(const struct solve_pattern *pattern, double *factor)
{
    double *dense = factor + (size_t)pattern->n * SOLVE_COARSE_STRIDE;
    struct dense *diagonal = (struct dense *)(void *)dense;
    return (struct parts){factor, diagonal, diagonal + pattern->n};
}

size_t solve_coarse_doubles(const struct solve_pattern *pattern)
{
    const size_t n = (size_t)pattern->n + pattern->first[pattern->n];
    return (size_t)pattern->n * SOLVE_COARSE_STRIDE + n * (sizeof(struct dense) / sizeof(double));
}

void solve_coarse_clear(const struct solve_pattern *pattern, double *factor)
{
    memset(factor, 0, solve_coarse_doubles(pattern) * sizeof *factor);
}

PHYS_INLINE double get(const phys_vec *column, int i)
{
    return ((const double *)(const void *)column)[i];
}

/* The entry of a place in a column. */
static struct dense *entry_of(const struct solve_pattern *pattern, struct dense *entry, uint32_t k,
                              uint32_t place)
{
    uint32_t i = pattern->first[k];
    while (pattern->row[i] != place)
        i++;
    return entry + i;
}

/* Copies a matrix by rows, or, turned, its transpose. */
static void fill(const double *matrix, bool turned, struct dense *to)
{
    for (int j = 0; j < N; j++) {
        double column[4 * WIDTH] = {0};
        for (int i = 0; i < N; i++)
            column[i] = turned ? matrix[N * j + i] : matrix[N * i + j];
        memcpy(to->c[j], column, sizeof column);
    }
}

void solve_coarse_fill(const struct solve_pattern *pattern, const uint32_t *first,
                       const uint32_t *slot, uint32_t b, const double *coupling, double *factor)
{
    const struct parts parts = parts_of(pattern, factor);
    const uint32_t here = pattern->place[b];
    fill(coupling, false, parts.diagonal + here);
    for (int i = 0; i < N; i++)
        parts.whole[(size_t)here * SOLVE_COARSE_STRIDE + (size_t)i] = coupling[(N + 1) * i];
    for (uint32_t i = first[b]; i < first[b + 1]; i++) {
        if (slot[i] < b)
            continue;
        const uint32_t there = pattern->place[slot[i]];
        coupling += SOLVE_COUPLING;
        if (there < here) /* rows of what comes later, columns of what comes first */
            fill(coupling, false, entry_of(pattern, parts.entry, there, here));
        else
            fill(coupling, true, entry_of(pattern, parts.entry, here, there));
    }
}

/* to -= factor from, one column. */
PHYS_INLINE void subtract(double factor, const phys_vec *from, phys_vec *to)
{
    to[0] -= factor * from[0];
    to[1] -= factor * from[1];
    to[2] -= factor * from[2];
}

/* The factor of a diagonal block; whole: its entries on the diagonal in C. */
PHYS_INLINE uint32_t factor_dense(const double *whole, struct dense *d)
{
    uint32_t dropped = 0;
    for (int j = 0; j < N; j++) {
        for (int m = 0; m < j; m++)
            subtract(get(d->c[m], j), d->c[m], d->c[j]);
        const double pivot = get(d->c[j], j);
        const bool good = isfinite(pivot) && pivot > LEAST * whole[j];
        const double inverse = good ? 1 / sqrt(pivot) : 0;
        double *column = (double *)(void *)d->c[j];
        for (int i = 0; i < N; i++)
            column[i] = i > j && good ? column[i] * inverse : 0;
        column[j] = inverse;
        dropped += !good;
    }
    return dropped;
}

/* a = a L^-T. */
PHYS_INLINE void solve_dense(const struct dense *l, struct dense *a)
{
    for (int j = 0; j < N; j++) {
        for (int m = 0; m < j; m++)
            subtract(get(l->c[m], j), a->c[m], a->c[j]);
        for (int w = 0; w < WIDTH; w++)
            a->c[j][w] *= get(l->c[j], j);
    }
}

/* c -= a b'. */
PHYS_INLINE void reduce(const struct dense *a, const struct dense *b, struct dense *c)
{
    for (int j = 0; j < N; j++)
        for (int m = 0; m < N; m++)
            subtract(get(b->c[m], j), a->c[m], c->c[j]);
}

/* Takes column k out of the columns behind it. */
PHYS_INLINE void reduce_all(const struct solve_pattern *pattern, uint32_t k, struct dense *diagonal)
{
    struct dense *entry = diagonal + pattern->n;
    const uint32_t *row = pattern->row, to = pattern->first[k + 1];
    for (uint32_t j = pattern->first[k]; j < to; j++) {
        uint32_t at = pattern->first[row[j]];
        reduce(entry + j, entry + j, diagonal + row[j]);
        for (uint32_t i = j + 1; i < to; i++) {
            while (row[at] != row[i])
                at++;
            reduce(entry + i, entry + j, entry + at);
        }
    }
}

PHYS_KERNEL_OF(uint32_t, solve_coarse_factor, (const struct solve_pattern *pattern, double *factor),
               (pattern, factor))
{
    const struct parts parts = parts_of(pattern, factor);
    uint32_t dropped = 0;
    for (uint32_t k = 0; k < pattern->n; k++) {
        const double *whole = parts.whole + (size_t)k * SOLVE_COARSE_STRIDE;
        dropped += factor_dense(whole, parts.diagonal + k);
        for (uint32_t i = pattern->first[k]; i < pattern->first[k + 1]; i++)
            solve_dense(parts.diagonal + k, parts.entry + i);
        reduce_all(pattern, k, parts.diagonal);
    }
    return dropped;
}

/* ---- The solution ---- */

/* y = L^-1 y of a diagonal block. */
PHYS_INLINE void forward_dense(const struct dense *l, phys_vec *y)
{
    for (int j = 0; j < N; j++) {
        const double value = get(y, j) * get(l->c[j], j);
        subtract(value, l->c[j], y);
        ((double *)(void *)y)[j] = value;
    }
}

/* y = L^-T y. */
PHYS_INLINE void backward_dense(const struct dense *l, phys_vec *y)
{
    double *x = (double *)(void *)y;
    for (int j = N; j-- > 0;) {
        double sum = x[j];
        for (int i = j + 1; i < N; i++)
            sum -= get(l->c[j], i) * x[i];
        x[j] = sum * get(l->c[j], j);
    }
}

/* y -= sum of l' x over the entries of a column. */
PHYS_INLINE void backward_column(const struct solve_pattern *pattern, const struct dense *entry,
                                 uint32_t k, const phys_vec *all, phys_vec *y)
{
    phys_vec sum[N] = {{0}};
    for (uint32_t i = pattern->first[k]; i < pattern->first[k + 1]; i++) {
        const phys_vec *x = all + WIDTH * (size_t)pattern->row[i];
        for (int j = 0; j < N; j++)
            sum[j] += entry[i].c[j][0] * x[0] + entry[i].c[j][1] * x[1] + entry[i].c[j][2] * x[2];
    }
    for (int j = 0; j < N; j++)
        ((double *)(void *)y)[j] -= phys_lanes(sum + j);
}

PHYS_KERNEL(solve_coarse_solve,
            (const struct solve_pattern *pattern, const double *factor, double *x),
            (pattern, factor, x))
{
    const struct parts parts = parts_of(pattern, (double *)(uintptr_t)factor);
    phys_vec *all = (phys_vec *)(void *)x;
    for (uint32_t k = 0; k < pattern->n; k++) {
        phys_vec *here = all + WIDTH * (size_t)k;
        forward_dense(parts.diagonal + k, here);
        for (uint32_t i = pattern->first[k]; i < pattern->first[k + 1]; i++)
            for (int j = 0; j < N; j++)
                subtract(get(here, j), parts.entry[i].c[j], all + WIDTH * (size_t)pattern->row[i]);
    }
    for (uint32_t k = pattern->n; k-- > 0;) {
        phys_vec *here = all + WIDTH * (size_t)k;
        backward_column(pattern, parts.entry, k, all, here);
        backward_dense(parts.diagonal + k, here);
    }
}
