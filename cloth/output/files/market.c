/* Columns are written one after the other, rows ascending; pairs of equal ends are one entry. */
#include "cloth/output/files/files.h"
#include "cloth/output/output.h"

#include <stdlib.h>
#include <string.h>

/* Sums of 3x3 blocks: of a vertex, and of the pairs with one higher vertex. */
struct sums {
    const struct solve_system *system;
    double (*own)[6];  /* n: xx yx zx yy zy zz */
    size_t n_pairs;    /* of free vertices */
    size_t *start;     /* n + 1: pairs of each lower vertex */
    uint32_t *other;   /* n_pairs */
    double (*pair)[9]; /* n_pairs: rows of the higher vertex, columns of the lower */
};

static void add_own(double sum[6], double factor, double n[3][3])
{
    int k = 0;
    for (int j = 0; j < 3; j++)
        for (int i = j; i < 3; i++)
            sum[k++] += factor * (0.5 * (n[i][j] + n[j][i]));
}

static void market_add_pair(double sum[9], double n[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            sum[3 * i + j] -= n[j][i];
}

/* A symmetric block's entry. */
static double entry(const double sum[6], int i, int j)
{
    static const int at[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
    return sum[at[i][j]];
}

/* What vertices have besides pairs, and where the pairs of those without any begin. */
static void add_diagonals(struct sums *sums)
{
    const struct solve_system *s = sums->system;
    for (uint32_t a = 0; a < s->n; a++) {
        double *own = sums->own[a];
        const double scalar = s->free[a] > 0 ? s->diagonal[a] : 1;
        own[0] += scalar;
        own[3] += scalar;
        own[5] += scalar;
        if (sums->start[a + 1] < sums->start[a])
            sums->start[a + 1] = sums->start[a];
    }
}

static void add_pairs(struct sums *sums)
{
    const struct solve_system *s = sums->system;
    uint32_t before[2] = {0, 0}; /* no pair has equal ends */
    for (size_t i = 0; i < s->n_pairs; i++) {
        const uint32_t a = s->end[i][0], b = s->end[i][1];
        double n[3][3];
        solve_system_pair(s, i, n);
        add_own(sums->own[a], s->free[a] * s->free[a], n);
        add_own(sums->own[b], s->free[b] * s->free[b], n);
        if (!(s->free[a] > 0) || !(s->free[b] > 0))
            continue;
        if (a != before[0] || b != before[1]) {
            sums->other[sums->n_pairs++] = b;
            sums->start[a + 1] = sums->n_pairs;
        }
        before[0] = a;
        before[1] = b;
        market_add_pair(sums->pair[sums->n_pairs - 1], n);
    }
    add_diagonals(sums);
}

static int sums_make(struct sums *sums, const struct solve_system *system)
{
    *sums = (struct sums){.system = system};
    sums->own = calloc((size_t)system->n + 1, sizeof *sums->own);
    sums->start = calloc((size_t)system->n + 2, sizeof *sums->start);
    sums->other = calloc(system->n_pairs + 1, sizeof *sums->other);
    sums->pair = calloc(system->n_pairs + 1, sizeof *sums->pair);
    if (!sums->own || !sums->start || !sums->other || !sums->pair)
        return 1;
    add_pairs(sums);
    return 0;
}

static void sums_free(struct sums *sums)
{
    free(sums->own);
    free(sums->start);
    free(sums->other);
    free(sums->pair);
}

/* ---- Files ---- */

/* Lines and columns of files count from 1. */
static void fill_column(FILE *file, const struct sums *sums, size_t a, int j)
{
    const size_t column = 3 * a + (size_t)j + 1;
    for (int i = j; i < 3; i++)
        if (i == j || sums->system->free[a] > 0)
            fprintf(file, "%zu %zu %.17g\n", 3 * a + (size_t)i + 1, column,
                    entry(sums->own[a], i, j));
    for (size_t k = sums->start[a]; k < sums->start[a + 1]; k++)
        for (int i = 0; i < 3; i++)
            fprintf(file, "%zu %zu %.17g\n", 3 * (size_t)sums->other[k] + (size_t)i + 1, column,
                    sums->pair[k][3 * i + j]);
}

static int fill_matrix(FILE *file, const void *what)
{
    const struct sums *sums = what;
    const size_t n = sums->system->n;
    size_t entries = 9 * sums->n_pairs;
    for (size_t a = 0; a < n; a++)
        entries += sums->system->free[a] > 0 ? 6 : 3;
    fprintf(file, "%%%%MatrixMarket matrix coordinate real symmetric\n");
    fprintf(file, "%% S A S + I - S of an implicit step of h = %.17g s; kg\n", sums->system->h);
    fprintf(file, "%zu %zu %zu\n", 3 * n, 3 * n, entries);
    for (size_t a = 0; a < n && !ferror(file); a++)
        for (int j = 0; j < 3; j++)
            fill_column(file, sums, a, j);
    return ferror(file);
}

struct array {
    const char *comment;
    uint32_t n;
    const double *free;  /* n: factors, NULL: all 1, */
    const double *value; /* of n x 3 numbers, or of n that stand for three each */
    size_t of_vertex;
};

static int fill_array(FILE *file, const void *what)
{
    const struct array *array = what;
    fprintf(file, "%%%%MatrixMarket matrix array real general\n%% %s\n%zu 1\n", array->comment,
            3 * (size_t)array->n);
    for (size_t v = 0; v < array->n && !ferror(file); v++)
        for (size_t c = 0; c < 3; c++) {
            const double value = array->value[array->of_vertex * v + c % array->of_vertex];
            fprintf(file, "%.17g\n", !array->free || array->free[v] > 0 ? value : 0.0);
        }
    return ferror(file);
}

int output_system(const char *folder, const struct solve_system *s, struct cloth_error *error)
{
    static const char *const name[] = {"rhs", "solution", "mass", "position"};
    const struct array array[] = {
        {"S b; kg m/s", s->n, s->free, s->b, 3},
        {"dv, as the step found it; m/s", s->n, s->free, s->dv, 3},
        {"mass of each unknown, 0 where held; kg", s->n, s->free, s->mass, 1},
        {"positions after the step; m", s->n, NULL, s->x, 3}};
    struct sums sums;
    int code = CLOTH_OK;
    if (sums_make(&sums, s))
        code = cloth_fail(error, CLOTH_E_MEMORY, "no memory for the matrix of %u vertices", s->n);
    if (!code)
        code = output_write_file(output_path(folder, "matrix.mtx").text, fill_matrix, &sums, error);
    for (size_t i = 0; i < sizeof array / sizeof *array && !code; i++)
        code = output_write_file(output_path(folder, "%s.mtx", name[i]).text, fill_array, array + i,
                                 error);
    sums_free(&sums);
    return code;
}
