/* Cholesky's factorisation A = L transpose(L) by tiles. A is made from an L of small whole numbers,
 * so that nothing is ever rounded, and the factor must be L exactly. */

#include <duite.h>

#include <math.h>
#include <stdio.h>

enum { TILES = 6, SIZE = 16 };

static double l(int i, int j) /* the factor */
{
    return j > i ? 0 : j == i ? 2 : (7 * i + 3 * j) % 5 - 2;
}

static int factor(const duite_call *call) /* A = L transpose(L), in place, below the diagonal */
{
    double(*a)[SIZE] = call->param[0].data;
    for (int j = 0; j < SIZE; j++) {
        for (int i = j; i < SIZE; i++)
            for (int k = 0; k < j; k++)
                a[i][j] -= a[i][k] * a[j][k];
        if (!(a[j][j] > 0))
            return duite_fail(call, 1, "the matrix is not positive definite");
        a[j][j] = sqrt(a[j][j]);
        for (int i = j + 1; i < SIZE; i++)
            a[i][j] /= a[j][j];
    }
    return 0;
}

static int solve(const duite_call *call) /* A = A transpose(L)^-1 */
{
    const double(*f)[SIZE] = call->param[0].data;
    double(*a)[SIZE] = call->param[1].data;
    for (int i = 0; i < SIZE; i++)
        for (int j = 0; j < SIZE; j++) {
            for (int k = 0; k < j; k++)
                a[i][j] -= a[i][k] * f[j][k];
            a[i][j] /= f[j][j];
        }
    return 0;
}

static int update(const duite_call *call) /* C -= A transpose(B); B is A if it is not given */
{
    double(*c)[SIZE] = call->param[0].data;
    const double(*a)[SIZE] = call->param[1].data, (*b)[SIZE] = call->param[call->n_params - 1].data;
    for (int i = 0; i < SIZE; i++)
        for (int j = 0; j < SIZE; j++)
            for (int k = 0; k < SIZE; k++)
                c[i][j] -= a[i][k] * b[j][k];
    return 0;
}

static const duite_kernel FACTOR = {.name = "factor", .body = factor, .access = {DUITE_RW}};
static const duite_kernel SOLVE = {.name = "solve", .body = solve, .access = {DUITE_R, DUITE_RW}};
static const duite_kernel UPDATE = {
    .name = "update", .body = update, .access = {DUITE_RW, DUITE_R}, .variadic = DUITE_R};

static void cholesky(duite *rt, duite_object a[TILES][TILES])
{
    for (int k = 0; k < TILES; k++) {
        DUITE_FORK(rt, &FACTOR, NULL, a[k][k]);
        for (int i = k + 1; i < TILES; i++)
            DUITE_FORK(rt, &SOLVE, NULL, a[k][k], a[i][k]);
        for (int i = k + 1; i < TILES; i++) {
            DUITE_FORK(rt, &UPDATE, NULL, a[i][i], a[i][k]);
            for (int j = k + 1; j < i; j++)
                DUITE_FORK(rt, &UPDATE, NULL, a[i][j], a[i][k], a[j][k]);
        }
    }
}

static void make(duite *rt, duite_object a[TILES][TILES]) /* the lower triangle */
{
    for (int row = 0; row < TILES; row++)
        for (int column = 0; column <= row; column++) {
            double tile[SIZE * SIZE] = {0};
            for (int k = 0; k < SIZE * SIZE; k++)
                for (int m = 0; m < TILES * SIZE; m++)
                    tile[k] += l(row * SIZE + k / SIZE, m) * l(column * SIZE + k % SIZE, m);
            duite_new(rt, DUITE_F64, SIZE * SIZE, &a[row][column]);
            duite_set(rt, a[row][column], tile);
        }
}

static int run(duite *rt)
{
    duite_object a[TILES][TILES];
    double tile[SIZE * SIZE] = {0};
    int wrong = 0;
    make(rt, a);
    cholesky(rt, a);
    if (duite_wait(rt)) /* tells what is wrong so far */
        fprintf(stderr, "cholesky: %s\n", duite_message());
    for (int row = 0; row < TILES; row++)
        for (int column = 0; column <= row; column++) {
            duite_get(rt, a[row][column], tile);
            for (int k = 0; k < SIZE * SIZE; k++) {
                int i = row * SIZE + k / SIZE, j = column * SIZE + k % SIZE;
                wrong |= j <= i && tile[k] != l(i, j);
            }
            duite_free(rt, a[row][column]);
        }
    return wrong;
}

int main(int argc, char **argv)
{
    duite_options options = duite_options_default();
    duite *rt;
    options.kernels = (const duite_kernel *const[]){&FACTOR, &SOLVE, &UPDATE, NULL};
    options.mapping = duite_mapping_find("cyclic"); /* tile after tile to rank after rank */
    if (argc > 1)
        options.scheduler = duite_scheduler_find(argv[1]);
    if (duite_start(&rt, &options))
        return fprintf(stderr, "cholesky: %s\n", duite_message()), 1;
    int wrong = run(rt);
    if (duite_stop(&rt)) /* tells the errors that nobody asked for */
        return fprintf(stderr, "cholesky: %s\n", duite_message()), 1;
    return wrong;
}
