/* Whatever the order of sums, all numbers are whole and far below 2^53, but for roots and quotients
 * in between, which are exact, too. So a tile that was read too early or too late shows.
 * Vectors are two doubles, which every processor has. */
#include "bench/tiles.h"

#include <math.h>
#include <stdlib.h>

enum { LANES = 2, COLUMNS = 4 };
typedef double vector __attribute__((vector_size(LANES * sizeof(double)), may_alias));

/* Rows of a column that stay in registers. */
struct strip {
    vector upper, lower;
} __attribute__((may_alias));
_Static_assert(TILES_ROWS * sizeof(double) == sizeof(struct strip), "a strip is TILES_ROWS rows");

static inline const struct strip *strip(const double *tile, size_t place)
{
    return (const struct strip *)(const void *)(tile + place);
}

static inline struct strip *strip_to(double *tile, size_t place)
{
    return (struct strip *)(void *)(tile + place);
}

static inline void minus(struct strip *to, const struct strip *from, double factor)
{
    to->upper -= from->upper * factor;
    to->lower -= from->lower * factor;
}

/* ---- Routines ---- */

/* z -= x y; y[k][j] is y[k * row + j * column]. A strip of four columns stays in registers. */
static inline __attribute__((always_inline)) void
subtract(const double *x, const double *y, double *z, size_t size, size_t row, size_t column)
{
    for (size_t j = 0; j < size; j += COLUMNS, y += COLUMNS * column)
        for (size_t i = 0; i < size; i += TILES_ROWS) {
            struct strip *to[COLUMNS];
            for (size_t c = 0; c < COLUMNS; c++)
                to[c] = strip_to(z, (j + c) * size + i);
            struct strip a = *to[0], b = *to[1], c = *to[2], d = *to[3];
            for (size_t k = 0; k < size; k++) {
                const struct strip from = *strip(x, k * size + i);
                const double *factor = y + k * row;
                minus(&a, &from, factor[0]);
                minus(&b, &from, factor[column]);
                minus(&c, &from, factor[2 * column]);
                minus(&d, &from, factor[3 * column]);
            }
            *to[0] = a, *to[1] = b, *to[2] = c, *to[3] = d;
        }
}

static void gemm(const double *x, const double *y, double *z, size_t size)
{
    subtract(x, y, z, size, 1, size);
}

static void gemm_t(const double *x, const double *y, double *z, size_t size)
{
    subtract(x, y, z, size, size, 1);
}

static void syrk(const double *x, const double *y, double *z, size_t size)
{
    (void)y;
    subtract(x, x, z, size, size, 1);
}

/* z = z r^-1, where r is upper and r[k][j] is x[k * row + j * column]. */
static inline __attribute__((always_inline)) void
solve_right(const double *x, double *z, size_t size, size_t row, size_t column)
{
    for (size_t i = 0; i < size; i += TILES_ROWS)
        for (size_t j = 0; j < size; j++) {
            struct strip sum = *strip(z, j * size + i);
            const double diagonal = x[j * row + j * column];
            for (size_t k = 0; k < j; k++)
                minus(&sum, strip(z, k * size + i), x[k * row + j * column]);
            sum.upper /= diagonal;
            sum.lower /= diagonal;
            *strip_to(z, j * size + i) = sum;
        }
}

static void trsm_lower(const double *x, const double *y, double *z, size_t size)
{
    (void)y;
    solve_right(x, z, size, size, 1);
}

static void trsm_upper(const double *x, const double *y, double *z, size_t size)
{
    (void)y;
    solve_right(x, z, size, 1, size);
}

/* to[i] -= from[i] * factor for first <= i < size: row by row to the next strip. */
static inline __attribute__((always_inline)) void
subtract_column(const double *from, double *to, double factor, size_t first, size_t size)
{
    for (; first % TILES_ROWS; first++)
        to[first] -= from[first] * factor;
    for (; first < size; first += TILES_ROWS)
        minus(strip_to(to, first), strip(from, first), factor);
}

static void trsm_unit(const double *x, const double *y, double *z, size_t size)
{
    (void)y;
    for (size_t k = 0; k < size; k++)
        for (size_t j = 0; j < size; j++)
            subtract_column(x + k * size, z + j * size, z[j * size + k], k + 1, size);
}

static void potrf(const double *x, const double *y, double *z, size_t size)
{
    (void)x;
    (void)y;
    for (size_t k = 0; k < size; k++) {
        const double root = sqrt(z[k * size + k]);
        for (size_t i = k; i < size; i++)
            z[k * size + i] /= root;
        for (size_t j = k + 1; j < size; j++)
            subtract_column(z + k * size, z + j * size, z[k * size + j], j, size);
    }
}

static void getrf(const double *x, const double *y, double *z, size_t size)
{
    (void)x;
    (void)y;
    for (size_t k = 0; k < size; k++) {
        for (size_t i = k + 1; i < size; i++)
            z[k * size + i] /= z[k * size + k];
        for (size_t j = k + 1; j < size; j++)
            subtract_column(z + k * size, z + j * size, z[j * size + k], k + 1, size);
    }
}

tiles_body *const volatile tiles_routine[TILES_ROUTINES] = {
    [TILES_POTRF] = potrf,      [TILES_TRSM_L] = trsm_lower, [TILES_SYRK] = syrk,
    [TILES_GEMM_T] = gemm_t,    [TILES_GETRF] = getrf,       [TILES_TRSM_U] = trsm_upper,
    [TILES_TRSM_1] = trsm_unit, [TILES_GEMM] = gemm};
const unsigned tiles_reads[TILES_ROUTINES] = {
    [TILES_POTRF] = 0, [TILES_TRSM_L] = 1, [TILES_SYRK] = 1,   [TILES_GEMM_T] = 2,
    [TILES_GETRF] = 0, [TILES_TRSM_U] = 1, [TILES_TRSM_1] = 1, [TILES_GEMM] = 2};

/* ---- Tasks ---- */

typedef void visitor(const struct tiles_task *task, void *context);

static void visit_cholesky(size_t n, visitor *visit, void *context)
{
    for (size_t k = 0; k < n; k++) {
        const size_t kk = k * n + k;
        visit(&(struct tiles_task){.routine = TILES_POTRF, .z = kk}, context);
        for (size_t i = k + 1; i < n; i++)
            visit(&(struct tiles_task){.routine = TILES_TRSM_L, .x = kk, .z = i * n + k}, context);
        for (size_t i = k + 1; i < n; i++) {
            for (size_t j = k + 1; j < i; j++)
                visit(&(struct tiles_task){TILES_GEMM_T, i * n + k, j * n + k, i * n + j}, context);
            visit(&(struct tiles_task){.routine = TILES_SYRK, .x = i * n + k, .z = i * n + i},
                  context);
        }
    }
}

static void visit_lu(size_t n, visitor *visit, void *context)
{
    for (size_t k = 0; k < n; k++) {
        const size_t kk = k * n + k;
        visit(&(struct tiles_task){.routine = TILES_GETRF, .z = kk}, context);
        for (size_t j = k + 1; j < n; j++)
            visit(&(struct tiles_task){.routine = TILES_TRSM_1, .x = kk, .z = k * n + j}, context);
        for (size_t i = k + 1; i < n; i++)
            visit(&(struct tiles_task){.routine = TILES_TRSM_U, .x = kk, .z = i * n + k}, context);
        for (size_t i = k + 1; i < n; i++)
            for (size_t j = k + 1; j < n; j++)
                visit(&(struct tiles_task){TILES_GEMM, i * n + k, k * n + j, i * n + j}, context);
    }
}

void tiles_visit(struct tiles tiles, visitor *visit, void *context)
{
    (tiles.kind == TILES_LU ? visit_lu : visit_cholesky)(tiles.n, visit, context);
}

double tiles_tasks(struct tiles tiles)
{
    const double n = (double)tiles.n;
    return tiles.kind == TILES_LU ? n * (n + 1) * (2 * n + 1) / 6 : n * (n + 1) * (n + 2) / 6;
}

double tiles_least(double least, int time, double seconds)
{
    return time < 2 ? seconds : fmin(least, seconds);
}

/* ---- Answers ---- */

enum { CLASSES = 61 }; /* rows that many apart have equal entries off the diagonal */

static double entry(size_t i, size_t j)
{
    i %= CLASSES, j %= CLASSES;
    return (double)((i * i + 7 * i * j + 3 * j) % CLASSES % 5) - 2;
}

/* An entry of L left of its diagonal; of transpose(L), or U, right of it. */
static double left_entry(size_t i, size_t k)
{
    return entry(i, k);
}

static double right_entry(enum tiles_kind kind, size_t k, size_t j)
{
    return kind == TILES_LU ? entry(k + 1, j) : entry(j, k);
}

/* The entry of the factors, both in one matrix, at a row and a column. */
static double factor_entry(enum tiles_kind kind, size_t i, size_t j)
{
    return i == j ? 2 : i > j ? left_entry(i, j) : right_entry(kind, i, j);
}

int tiles_kept(struct tiles tiles, size_t place)
{
    return tiles.kind == TILES_LU || place % tiles.n <= place / tiles.n;
}

/* The entry of A whose place in the matrix is given. */
static double *entry_of(struct tiles tiles, double *a, size_t i, size_t j)
{
    const size_t size = tiles.size, place = i / size * tiles.n + j / size;
    return a + place * size * size + j % size * size + i % size;
}

/* A[i][j] is a sum over the k before both, which depends on the classes of i and j alone, and the
 * product at the lesser of both: where one factor has its diagonal. */
static void fill(struct tiles tiles, double *a, double sum[CLASSES][CLASSES])
{
    const size_t order = tiles.n * tiles.size;
    for (size_t m = 0; m < order; m++) {
        const double left = tiles.kind == TILES_LU ? 1 : 2;
        *entry_of(tiles, a, m, m) = sum[m % CLASSES][m % CLASSES] + 2 * left;
        for (size_t i = m + 1; i < order; i++) {
            *entry_of(tiles, a, i, m) = sum[i % CLASSES][m % CLASSES] + 2 * left_entry(i, m);
            *entry_of(tiles, a, m, i) =
                sum[m % CLASSES][i % CLASSES] + left * right_entry(tiles.kind, m, i);
        }
        for (size_t i = 0; i < CLASSES; i++)
            for (size_t j = 0; j < CLASSES; j++)
                sum[i][j] += left_entry(i, m) * right_entry(tiles.kind, m, j);
    }
}

size_t tiles_bytes(struct tiles tiles)
{
    const size_t order = tiles.n * tiles.size;
    return order * order * sizeof(double);
}

double *tiles_make(struct tiles tiles)
{
    double *a = aligned_alloc(64, tiles_bytes(tiles));
    double(*sum)[CLASSES] = calloc(CLASSES, sizeof *sum);
    if (a && sum)
        fill(tiles, a, sum);
    free(sum);
    if (a && sum)
        return a;
    free(a);
    return NULL;
}

struct loop {
    double *a;
    size_t size;
};

static void run(const struct tiles_task *task, void *context)
{
    const struct loop *loop = context;
    const size_t length = loop->size * loop->size;
    tiles_routine[task->routine](loop->a + task->x * length, loop->a + task->y * length,
                                 loop->a + task->z * length, loop->size);
}

void tiles_factor(struct tiles tiles, double *a)
{
    tiles_visit(tiles, run, &(struct loop){a, tiles.size});
}

int tiles_wrong(struct tiles tiles, size_t place, const double *tile)
{
    const size_t size = tiles.size, row = place / tiles.n * size, column = place % tiles.n * size;
    int wrong = 0;
    for (size_t j = 0; j < size; j++)
        for (size_t i = 0; i < size; i++)
            if (tiles.kind == TILES_LU || row + i >= column + j)
                wrong |= tile[j * size + i] != factor_entry(tiles.kind, row + i, column + j);
    return wrong;
}

int tiles_all_wrong(struct tiles tiles, const double *a)
{
    int wrong = 0;
    for (size_t place = 0; place < tiles.n * tiles.n; place++)
        if (tiles_kept(tiles, place))
            wrong |= tiles_wrong(tiles, place, a + place * tiles.size * tiles.size);
    return wrong;
}
