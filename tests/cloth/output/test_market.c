/* A system's files hold the matrix that the system's own product multiplies by, each entry once and
 * in order, and its vectors under the filter. */
#include "tests/cloth/output/sample.h"
#include "tests/support/unit.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { N = 7, ROWS = 3 * N };

static struct solve_system system_;
static double matrix[ROWS][ROWS];

/* Vertex 2 is held, 6 unused; 1 and 4 are joined twice, 3 to the held one. */
static void make(void)
{
    static const uint32_t end[][2] = {{4, 1}, {0, 1}, {1, 4}, {2, 3}, {5, 0}, {3, 1}, {2, 5}};
    const size_t n = sizeof end / sizeof *end;
    sample_make();
    ck_assert_int_eq(solve_system_make(&system_, N, n, SOLVE_PAIRS_OF_SPRINGS, NULL), 0);
    system_.h = 0.5;
    for (uint32_t v = 0; v < N; v++) {
        system_.free[v] = v != 2 && v != 6;
        system_.mass[v] = v == 6 ? 0 : 1 + v;
        system_.diagonal[v] = v == 6 ? 0 : 2 + v;
        for (size_t c = 0; c < 3; c++) {
            system_.b[3 * v + c] = 10 * v + (double)c;
            system_.dv[3 * v + c] = v == 2 ? 0 : 0.1 * v - (double)c;
        }
    }
    for (size_t i = 0; i < n; i++) {
        memcpy(system_.end[i], end[i], sizeof end[i]);
        for (size_t k = 0; k < 4; k++)
            system_.value[i][k] = 1 / (1 + (double)(3 * i + k));
    }
    ck_assert_int_eq(solve_system_sort(&system_, NULL), 0);
}

static void end(void)
{
    solve_system_free(&system_);
    sample_free();
}

static FILE *open_file(const char *name, const char *banner)
{
    char line[200];
    FILE *file = fopen(sample_at("%s.mtx", name), "r");
    ck_assert_ptr_nonnull(file);
    ck_assert_ptr_nonnull(fgets(line, sizeof line, file));
    ck_assert_str_eq(line, banner);
    ck_assert_ptr_nonnull(fgets(line, sizeof line, file));
    ck_assert_int_eq(line[0], '%');
    return file;
}

/* Entries come column by column, rows ascending, all in the lower triangle, none twice. */
static void read_matrix(void)
{
    size_t rows, columns, entries, row, column, before = 0;
    double value;
    FILE *file = open_file("matrix", "%%MatrixMarket matrix coordinate real symmetric\n");
    ck_assert_int_eq(fscanf(file, "%zu %zu %zu", &rows, &columns, &entries), 3);
    ck_assert_uint_eq(rows, ROWS);
    ck_assert_uint_eq(columns, ROWS);
    for (size_t i = 0; i < entries; i++) {
        ck_assert_int_eq(fscanf(file, "%zu %zu %lf", &row, &column, &value), 3);
        ck_assert(row >= column && column >= 1 && row <= ROWS);
        ck_assert_uint_gt(column * ROWS + row, before);
        before = column * ROWS + row;
        matrix[row - 1][column - 1] = matrix[column - 1][row - 1] = value;
    }
    ck_assert_int_eq(fscanf(file, "%zu", &rows), EOF);
    fclose(file);
}

static void read_array(const char *name, double *value)
{
    size_t rows, columns;
    FILE *file = open_file(name, "%%MatrixMarket matrix array real general\n");
    ck_assert_int_eq(fscanf(file, "%zu %zu", &rows, &columns), 2);
    ck_assert_uint_eq(rows, ROWS);
    ck_assert_uint_eq(columns, 1);
    for (size_t i = 0; i < ROWS; i++)
        ck_assert_int_eq(fscanf(file, "%lf", value + i), 1);
    ck_assert_int_eq(fscanf(file, "%zu", &rows), EOF);
    fclose(file);
}

UNIT_FIXTURE(make, end)

UNIT_TEST(the_matrix_is_the_product)
{
    double p[ROWS], y[ROWS];
    UNIT_FINE(output_system(sample.folder, &system_, &error));
    read_matrix();
    for (size_t i = 0; i < ROWS; i++)
        p[i] = 1 / (1 + (double)(i * i % 11));
    solve_system_multiply(&system_, p, y);
    for (size_t i = 0; i < ROWS; i++) {
        double sum = 0;
        for (size_t k = 0; k < ROWS; k++)
            sum += matrix[i][k] * p[k];
        ck_assert_double_eq_tol(sum, system_.free[i / 3] > 0 ? y[i] : p[i], 1e-14);
    }
}

UNIT_TEST(vectors_are_filtered)
{
    double value[ROWS];
    UNIT_FINE(output_system(sample.folder, &system_, &error));
    read_array("rhs", value);
    for (size_t i = 0; i < ROWS; i++)
        ck_assert_double_eq(value[i], system_.free[i / 3] * system_.b[i]);
    read_array("solution", value);
    for (size_t i = 0; i < ROWS; i++)
        ck_assert_double_eq(value[i], system_.free[i / 3] * system_.dv[i]);
    read_array("mass", value);
    for (size_t i = 0; i < ROWS; i++)
        ck_assert_double_eq(value[i], system_.free[i / 3] * system_.mass[i / 3]);
}

UNIT_TEST(springs_are_in_order)
{
    for (size_t i = 0; i < system_.n_pairs; i++) {
        ck_assert_uint_lt(system_.end[i][0], system_.end[i][1]);
        if (i == 0)
            continue;
        const uint32_t *a = system_.end[i - 1], *b = system_.end[i];
        ck_assert(a[0] < b[0] || (a[0] == b[0] && a[1] <= b[1]));
    }
    /* the two of equal ends as they were given */
    ck_assert_double_eq(system_.value[3][0], 1);
    ck_assert_double_eq(system_.value[4][0], 1.0 / 7);
}

UNIT_TEST(what_cannot_be_written)
{
    UNIT_REFUSED(output_system(sample_at("file/under"), &system_, &error), CLOTH_E_INPUT, "");
    ck_assert_int_eq(mkdir(sample_at("rhs.mtx"), 0700), 0);
    UNIT_REFUSED(output_system(sample.folder, &system_, &error), CLOTH_E_INPUT, "rhs.mtx");
}
