/* The systems of the bench "cg" as matrices of PETSc. */
#include "bench/rivals/petsc_system.h"

#include <stdbool.h>
#include <stdlib.h>

void system_free(struct system *s)
{
    MatDestroy(&s->a);
    VecDestroy(&s->b);
    VecDestroy(&s->x);
    free(s->place);
    *s = (struct system){0};
}

/* ---- Order ---- */

/* The graph of the vertices, on every rank, in reverse Cuthill-McKee order. */
static int cuthill(const struct state *state, uint32_t *place)
{
    const struct solve_system *y = &state->system;
    Mat graph;
    IS rows, columns;
    const PetscInt *index;
    TRY(MatCreateSeqAIJ(PETSC_COMM_SELF, (PetscInt)y->n, (PetscInt)y->n, 40, NULL, &graph));
    TRY(MatSetOption(graph, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
    for (uint32_t v = 0; v < y->n; v++)
        TRY(MatSetValue(graph, (PetscInt)v, (PetscInt)v, 1, INSERT_VALUES));
    for (size_t i = 0; i < y->n_pairs; i++) {
        const PetscInt a = (PetscInt)y->end[i][0], b = (PetscInt)y->end[i][1];
        TRY(MatSetValue(graph, a, b, 1, INSERT_VALUES));
        TRY(MatSetValue(graph, b, a, 1, INSERT_VALUES));
    }
    TRY(MatAssemblyBegin(graph, MAT_FINAL_ASSEMBLY));
    TRY(MatAssemblyEnd(graph, MAT_FINAL_ASSEMBLY));
    TRY(MatGetOrdering(graph, MATORDERINGRCM, &rows, &columns));
    TRY(ISGetIndices(rows, &index));
    for (uint32_t i = 0; i < y->n; i++)
        place[index[i]] = i;
    TRY(ISRestoreIndices(rows, &index));
    TRY(ISDestroy(&rows));
    TRY(ISDestroy(&columns));
    TRY(MatDestroy(&graph));
    return 0;
}

static int find_places(const struct state *state, enum order order, uint32_t *place)
{
    if (order == CUTHILL)
        return cuthill(state, place);
    for (uint32_t i = 0; i < state->system.n; i++)
        place[order == BLOCKS ? state->order[i] : i] = i;
    return 0;
}

/* ---- Matrix ---- */

static bool mine(const struct system *s, uint32_t place)
{
    return place >= s->first && place < s->end;
}

/* Blocks of each row of this rank, at most: in its own columns, in others, and of these those not
 * below the diagonal. */
static int allocate(const struct state *state, struct system *s)
{
    const struct solve_system *y = &state->system;
    const size_t n = s->end - s->first;
    PetscInt *count = calloc(4 * (n + 1), sizeof *count);
    if (!count)
        return serve_no_memory();
    PetscInt *own = count, *other = own + n + 1, *own_upper = other + n + 1,
             *other_upper = own_upper + n + 1;
    for (size_t i = 0; i < n; i++)
        own[i] = own_upper[i] = 1;
    for (size_t i = 0; i < y->n_pairs; i++)
        for (int k = 0; k < 2; k++) {
            const uint32_t a = s->place[y->end[i][k]], b = s->place[y->end[i][1 - k]];
            if (!mine(s, a))
                continue;
            (mine(s, b) ? own : other)[a - s->first]++;
            if (b > a)
                (mine(s, b) ? own_upper : other_upper)[a - s->first]++;
        }
    const PetscErrorCode code =
        MatXAIJSetPreallocation(s->a, 3, own, other, own_upper, other_upper);
    free(count);
    TRY(code);
    return 0;
}

static PetscErrorCode put(Mat a, PetscInt row, PetscInt column, const double block[9])
{
    return MatSetValuesBlocked(a, 1, &row, 1, &column, block, ADD_VALUES);
}

static int put_pair(const struct state *state, const struct system *s, size_t i)
{
    const struct solve_system *y = &state->system;
    double n[3][3], on[9], off[2][9]; /* off: of the lower vertex's row, of the higher one's */
    solve_system_pair(y, i, n);
    for (int k = 0; k < 9; k++) {
        on[k] = 0.5 * (n[k / 3][k % 3] + n[k % 3][k / 3]);
        off[0][k] = -n[k / 3][k % 3];
        off[1][k] = -n[k % 3][k / 3];
    }
    for (int k = 0; k < 2; k++) {
        const uint32_t v = y->end[i][k], u = y->end[i][1 - k];
        const PetscInt a = (PetscInt)s->place[v], b = (PetscInt)s->place[u];
        if (!mine(s, s->place[v]) || !(y->free[v] > 0))
            continue;
        TRY(put(s->a, a, a, on));
        if (y->free[u] > 0)
            TRY(put(s->a, a, b, off[k]));
    }
    return 0;
}

static int fill(const struct state *state, struct system *s)
{
    const struct solve_system *y = &state->system;
    for (uint32_t v = 0; v < y->n; v++) {
        const PetscInt at = (PetscInt)s->place[v];
        const double d = y->free[v] > 0 ? y->diagonal[v] : 1;
        const double block[9] = {d, 0, 0, 0, d, 0, 0, 0, d};
        if (!mine(s, s->place[v]))
            continue;
        TRY(put(s->a, at, at, block));
        for (PetscInt c = 0; c < 3; c++)
            TRY(VecSetValue(s->b, 3 * at + c, y->free[v] * y->b[3 * (size_t)v + (size_t)c],
                            INSERT_VALUES));
    }
    for (size_t i = 0; i < y->n_pairs; i++)
        if (put_pair(state, s, i))
            return 1;
    TRY(MatAssemblyBegin(s->a, MAT_FINAL_ASSEMBLY));
    TRY(MatAssemblyEnd(s->a, MAT_FINAL_ASSEMBLY));
    TRY(VecAssemblyBegin(s->b));
    TRY(VecAssemblyEnd(s->b));
    return 0;
}

int system_make(struct system *s, const struct state *state, enum format format, enum order order)
{
    static const char *const type[] = {MATAIJ, MATAIJ, MATBAIJ, MATSBAIJ};
    const uint64_t n = state->system.n;
    int rank, ranks;
    MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
    MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
    *s = (struct system){.place = calloc(n + 1, sizeof *s->place)};
    if (!s->place)
        return serve_no_memory();
    if (find_places(state, order, s->place))
        return 1;
    s->first = (uint32_t)(n * (uint64_t)rank / (uint64_t)ranks);
    s->end = (uint32_t)(n * (uint64_t)(rank + 1) / (uint64_t)ranks);
    const PetscInt rows = 3 * (PetscInt)(s->end - s->first);
    TRY(MatCreate(PETSC_COMM_WORLD, &s->a));
    TRY(MatSetSizes(s->a, rows, rows, PETSC_DETERMINE, PETSC_DETERMINE));
    TRY(MatSetType(s->a, type[format]));
    TRY(MatSetBlockSize(s->a, 3));
    if (allocate(state, s))
        return 1;
    TRY(MatSetOption(s->a, MAT_SYMMETRIC, PETSC_TRUE));
    if (format == SBAIJ)
        TRY(MatSetOption(s->a, MAT_IGNORE_LOWER_TRIANGULAR, PETSC_TRUE));
    if (format == AIJ_PLAIN)
        TRY(MatSetOption(s->a, MAT_USE_INODES, PETSC_FALSE));
    TRY(MatCreateVecs(s->a, &s->x, &s->b));
    return fill(state, s);
}
