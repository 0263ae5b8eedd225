/* Columns are written one after the other, rows ascending. Pairs of equal ends follow each other,
 * and are one entry. */
#include "cloth/output/files/files.h"
#include "cloth/output/output.h"

#include <stdlib.h>

/* The 3x3 blocks of the diagonal, which are symmetric, and how many entries the matrix has. */
struct blocks {
    const struct solve_system *system;
    double (*own)[6]; /* n: xx yx zx yy zy zz */
    size_t n_entries;
};

static void add_own(double sum[6], double factor, double n[3][3])
{
    int k = 0;
    for (int j = 0; j < 3; j++)
        for (int i = j; i < 3; i++)
            sum[k++] += factor * (0.5 * (n[i][j] + n[j][i]));
}

static double entry(const double sum[6], int i, int j)
{
    static const int at[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
    return sum[at[i][j]];
}

static bool has_ends(const struct solve_system *s, size_t pair, uint32_t a, uint32_t b)
{
    return pair < s->n_pairs && s->end[pair][0] == a && s->end[pair][1] == b;
}

static void add_blocks(struct blocks *blocks)
{
    const struct solve_system *s = blocks->system;
    for (size_t i = 0; i < s->n_pairs; i++) {
        const uint32_t a = s->end[i][0], b = s->end[i][1];
        double n[3][3];
        solve_system_pair(s, i, n);
        add_own(blocks->own[a], s->free[a] * s->free[a], n);
        add_own(blocks->own[b], s->free[b] * s->free[b], n);
        if (s->free[a] > 0 && s->free[b] > 0 && !has_ends(s, i + 1, a, b))
            blocks->n_entries += 9;
    }
    for (uint32_t a = 0; a < s->n; a++) {
        const double scalar = s->free[a] > 0 ? s->diagonal[a] : 1;
        static const int diagonal[] = {0, 3, 5}; /* xx yy zz */
        for (int k = 0; k < 3; k++)
            blocks->own[a][diagonal[k]] += scalar;
        blocks->n_entries += s->free[a] > 0 ? 6 : 3;
    }
}

/* ---- Files ---- */

/* Column j of vertex a; pair: the first one whose lower end it is. Lines and columns of files count
 * from 1. */
static void fill_column(FILE *file, const struct blocks *blocks, uint32_t a, int j, size_t pair)
{
    const struct solve_system *s = blocks->system;
    const size_t column = 3 * (size_t)a + (size_t)j + 1;
    for (int i = j; i < 3; i++)
        if (i == j || s->free[a] > 0)
            fprintf(file, "%zu %zu %.17g\n", 3 * (size_t)a + (size_t)i + 1, column,
                    entry(blocks->own[a], i, j));
    while (pair < s->n_pairs && s->end[pair][0] == a) {
        const uint32_t b = s->end[pair][1];
        double sum[3] = {0}, n[3][3];
        for (; has_ends(s, pair, a, b); pair++) {
            solve_system_pair(s, pair, n);
            for (int i = 0; i < 3; i++)
                sum[i] -= n[j][i];
        }
        for (int i = 0; i < 3 && s->free[a] > 0 && s->free[b] > 0; i++)
            fprintf(file, "%zu %zu %.17g\n", 3 * (size_t)b + (size_t)i + 1, column, sum[i]);
    }
}

static int fill_matrix(FILE *file, const void *what)
{
    const struct blocks *blocks = what;
    const struct solve_system *s = blocks->system;
    const size_t n = 3 * (size_t)s->n;
    size_t pair = 0;
    fprintf(file, "%%%%MatrixMarket matrix coordinate real symmetric\n");
    fprintf(file, "%% S A S + I - S of an implicit step of h = %.17g s; kg\n", s->h);
    fprintf(file, "%zu %zu %zu\n", n, n, blocks->n_entries);
    for (uint32_t a = 0; a < s->n && !ferror(file); a++) {
        for (int j = 0; j < 3; j++)
            fill_column(file, blocks, a, j, pair);
        while (pair < s->n_pairs && s->end[pair][0] == a)
            pair++;
    }
    return ferror(file);
}

struct array {
    const char *name, *comment;
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
    const struct array array[] = {
        {"rhs", "S b; kg m/s", s->n, s->free, s->b, 3},
        {"solution", "dv, as the step found it; m/s", s->n, s->free, s->dv, 3},
        {"mass", "mass of each unknown, 0 where held; kg", s->n, s->free, s->mass, 1},
        {"position", "positions after the step; m", s->n, NULL, s->x, 3}};
    struct blocks blocks = {.system = s, .own = calloc((size_t)s->n + 1, sizeof *blocks.own)};
    if (!blocks.own)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the matrix of %u vertices", s->n);
    add_blocks(&blocks);
    int code =
        output_write_file(output_path(folder, "matrix.mtx").text, fill_matrix, &blocks, error);
    for (size_t i = 0; i < sizeof array / sizeof *array && !code; i++)
        code = output_write_file(output_path(folder, "%s.mtx", array[i].name).text, fill_array,
                                 array + i, error);
    free(blocks.own);
    return code;
}
