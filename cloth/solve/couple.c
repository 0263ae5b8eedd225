/* The part of one block in the coarse matrix. Let an entry between a and b be N = K + [w]x with K
 * symmetric, and phi the rows of P. It adds (phi_a - phi_b)(phi_a - phi_b)' times K, and (phi_b
 * phi_a' - phi_a phi_b') times [w]x, since the [w]x of a row sum to zero. The sums go over
 * symmetric 3 x 3 blocks, six for one block, nine for two, and over vectors w, three and nine. */
#include "cloth/solve/coarse.h"
#include "cloth/solve/frame.h"
#include "cloth/solve/matrix3.h"

#include <math.h>
#include <string.h>

/* ---- The basis ---- */

/* The two axes of a cloud of points, as solve_axes has them. */
static void couple_axes_of(size_t n, const phys_vec *position, const phys_vec *centre,
                           phys_vec axis[2])
{
    double m[3][3] = {{0}};
    for (size_t a = 0; a < n; a++) {
        const phys_vec d = position[a] - *centre;
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                m[i][j] += d[i] * d[j] / (double)n;
    }
    solve_axes(m, axis);
}

void solve_basis(size_t n, const double *free, const phys_vec *position, phys_vec *basis)
{
    phys_vec centre = {0}, axis[2];
    for (size_t a = 0; a < n; a++)
        centre += position[a] / (double)n;
    couple_axes_of(n, position, &centre, axis);
    for (size_t a = 0; a < n; a++) {
        const phys_vec d = position[a] - centre;
        basis[a] = free[a] * (phys_vec){1, phys_dot(&d, axis), phys_dot(&d, axis + 1), 0};
    }
}

void solve_basis_filter(size_t n, const phys_vec *filter, phys_vec *basis)
{
    for (size_t a = 0; a < n; a++) {
        int along = 0, missing = 0;
        for (int c = 0; c < 3; c++) {
            along += fabs(filter[a][c]) > 0;
            missing |= (filter[a][3] > 0) == (fabs(filter[a][c]) > 0) ? 1 << c : 0;
        }
        if (along > 1)
            basis[a] = (phys_vec){0};
        else
            basis[a][3] = missing;
    }
}

/* ---- The matrix ---- */

/* to += factor m. */
PHYS_INLINE void add(struct solve_symmetric *to, double factor, const struct solve_symmetric *m)
{
    to->diagonal += factor * m->diagonal;
    to->off_diagonal += factor * m->off_diagonal;
}

/* 1 if axis c of a row is in the space. */
PHYS_INLINE double has(const phys_vec *basis, int c)
{
    return ((int)(*basis)[3] >> c & 1) == 0;
}

/* phi of a row, a function at a time, without the axes that are missing. */
PHYS_INLINE void spread_out(const phys_vec *basis, phys_vec g[3])
{
    const phys_vec axes = {has(basis, 0), has(basis, 1), has(basis, 2), 0};
    for (int k = 0; k < 3; k++)
        g[k] = (*basis)[k] * axes;
}

/* Sums over entries with ends of which axes are missing: rows of function k by column d of function
 * l, an axis a lane. */
struct filtered {
    phys_vec c[3][3][3];
};

/* Adds sign times g' (columns) h. */
PHYS_INLINE void add_filtered(double sign, const phys_vec g[3], const struct solve_columns *columns,
                              const phys_vec h[3], struct filtered *sum)
{
    for (int k = 0; k < 3; k++)
        for (int d = 0; d < 3; d++) {
            const phys_vec rows = sign * g[k] * columns->c[d];
            for (int l = 0; l < 3; l++)
                sum->c[k][d][l] += h[l][d] * rows;
        }
}

static void put_filtered(const struct filtered *sum, double *matrix)
{
    for (int k = 0; k < 3; k++)
        for (int d = 0; d < 3; d++)
            for (int l = 0; l < 3; l++)
                for (int c = 0; c < 3; c++)
                    matrix[SOLVE_COARSE * (3 * k + c) + 3 * l + d] += sum->c[k][d][l][c];
}

/* Adds an entry between rows a and b that lack some axes. */
PHYS_INLINE void couple_filtered(enum solve_format format, const phys_vec *a, const phys_vec *b,
                                 const struct solve_symmetric *m, const phys_vec *turn,
                                 struct filtered *sum)
{
    const struct solve_symmetric none = {{0}, {0}};
    struct solve_columns columns;
    phys_vec ga[3], gb[3], g[3];
    spread_out(a, ga);
    spread_out(b, gb);
    for (int k = 0; k < 3; k++)
        g[k] = ga[k] - gb[k];
    solve_columns_of(m, &columns);
    add_filtered(1, g, &columns, g, sum);
    if (format == SOLVE_SPRINGS)
        return;
    solve_entry_columns(&none, turn, &columns);
    add_filtered(1, gb, &columns, ga, sum);
    add_filtered(-1, ga, &columns, gb, sum);
}

/* Adds phi phi' times m: of functions 00 01 02 11 12 22. */
PHYS_INLINE void add_square(struct solve_symmetric sum[6], const phys_vec *phi,
                            const struct solve_symmetric *m)
{
    const double one = (*phi)[0], u = (*phi)[1], v = (*phi)[2];
    add(sum + 0, one * one, m);
    add(sum + 1, one * u, m);
    add(sum + 2, one * v, m);
    add(sum + 3, u * u, m);
    add(sum + 4, u * v, m);
    add(sum + 5, v * v, m);
}

/* Adds `sign` times a 3 x 3 block to that of functions k and l. */
PHYS_INLINE void couple_put(const struct solve_symmetric *m, double sign, int k, int l,
                            double *matrix)
{
    struct solve_columns columns;
    solve_columns_of(m, &columns);
    for (int c = 0; c < 3; c++) {
        double *row = matrix + SOLVE_COARSE * (3 * k + c) + 3 * l;
        for (int d = 0; d < 3; d++)
            row[d] += sign * columns.c[c][d];
    }
}

static void put_squares(const struct solve_symmetric sum[6], double *matrix)
{
    int i = 0;
    for (int k = 0; k < 3; k++)
        for (int l = k; l < 3; l++, i++) {
            couple_put(sum + i, 1, k, l, matrix);
            if (l > k)
                couple_put(sum + i, 1, l, k, matrix);
        }
}

/* Adds [w]x to the block of functions k and l. */
static void put_turn(const phys_vec *w, double sign, int k, int l, double *matrix)
{
    for (int c = 0; c < 3; c++) {
        const int d = (c + 1) % 3, e = (c + 2) % 3;
        matrix[SOLVE_COARSE * (3 * k + e) + 3 * l + d] += sign * (*w)[c];
        matrix[SOLVE_COARSE * (3 * k + d) + 3 * l + e] -= sign * (*w)[c];
    }
}

/* Adds the turns between a and b: of functions 01 02 12. */
PHYS_INLINE void add_turns(phys_vec sum[3], const phys_vec *a, const phys_vec *b, const phys_vec *w)
{
    sum[0] += ((*b)[0] * (*a)[1] - (*a)[0] * (*b)[1]) * *w;
    sum[1] += ((*b)[0] * (*a)[2] - (*a)[0] * (*b)[2]) * *w;
    sum[2] += ((*b)[1] * (*a)[2] - (*a)[1] * (*b)[2]) * *w;
}

PHYS_INLINE void couple(const struct solve_block *block, enum solve_format format, size_t from,
                        size_t to, const void *values, const phys_vec *basis,
                        double own[SOLVE_COUPLING])
{
    struct solve_symmetric sum[6] = {{{0}, {0}}};
    struct filtered filtered = {{{{{0}}}}};
    phys_vec turns[3] = {{0}};
    memset(own, 0, SOLVE_COUPLING * sizeof *own);
    for (size_t a = from; a < to; a++) {
        const double d = block->diagonal[a];
        struct solve_symmetric mass = {{0}, {0}};
        for (int c = 0; c < 3; c++)
            mass.diagonal[c] = d * has(basis + a, c);
        add_square(sum, basis + a, &mass);
        for (uint32_t i = block->row[a]; i < block->row[a + 1] && block->column[i] < to; i++) {
            const phys_vec *other = basis + block->column[i], phi = basis[a] - *other;
            struct solve_symmetric m = {{0}, {0}};
            phys_vec w;
            solve_entry_of(format, values, i, &m, &w);
            if (basis[a][3] + (*other)[3] > 0) {
                couple_filtered(format, basis + a, other, &m, &w, &filtered);
                continue;
            }
            add_square(sum, &phi, &m);
            if (format != SOLVE_SPRINGS)
                add_turns(turns, basis + a, other, &w);
        }
    }
    put_squares(sum, own);
    put_filtered(&filtered, own);
    for (int k = 0; k < 3 && format != SOLVE_SPRINGS; k++) {
        const int first = k == 2, last = k ? 2 : 1;
        put_turn(turns + k, 1, first, last, own);
        put_turn(turns + k, -1, last, first, own);
    }
}

PHYS_KERNEL(solve_couple,
            (const struct solve_block *block, size_t from, size_t to, const void *values,
             const phys_vec *basis, double own[SOLVE_COUPLING]),
            (block, from, to, values, basis, own))
{
    if (block->format == SOLVE_SPRINGS)
        couple(block, SOLVE_SPRINGS, from, to, values, basis, own);
    else
        couple(block, SOLVE_HALF, from, to, values, basis, own);
}

/* The same for an entry between two sets of columns. */
PHYS_INLINE void couple_cut_filtered(const phys_vec *a, const phys_vec *b,
                                     const struct solve_symmetric *m, const phys_vec *turn,
                                     struct filtered *own, struct filtered *off_diagonal)
{
    struct solve_columns columns;
    phys_vec ga[3], gb[3];
    spread_out(a, ga);
    spread_out(b, gb);
    solve_columns_of(m, &columns);
    add_filtered(1, ga, &columns, ga, own);
    solve_entry_columns(m, turn, &columns);
    add_filtered(-1, ga, &columns, gb, off_diagonal);
}

PHYS_KERNEL(solve_couple_cut,
            (const struct solve_block *block, const void *values, size_t n, const uint32_t *at,
             const uint32_t (*end)[2], const phys_vec *basis, const phys_vec *other_basis,
             double own[SOLVE_COUPLING], double off_diagonal[SOLVE_COUPLING]),
            (block, values, n, at, end, basis, other_basis, own, off_diagonal))
{
    struct solve_symmetric square[6] = {{{0}, {0}}}, sum[9] = {{{0}, {0}}};
    struct filtered filtered = {{{{{0}}}}}, filtered_off_diagonal = {{{{{0}}}}};
    phys_vec turns[9] = {{0}};
    for (size_t i = 0; i < n; i++) {
        const phys_vec phi = basis[end[i][0]], other = other_basis[end[i][1]];
        struct solve_symmetric m = {{0}, {0}};
        phys_vec w;
        solve_entry_of(block->format, values, at[i], &m, &w);
        if (phi[3] + other[3] > 0) {
            couple_cut_filtered(&phi, &other, &m, &w, &filtered, &filtered_off_diagonal);
            continue;
        }
        add_square(square, &phi, &m);
        for (int k = 0; k < 3; k++)
            for (int l = 0; l < 3; l++) {
                add(sum + 3 * k + l, phi[k] * other[l], &m);
                turns[3 * k + l] += (phi[k] * other[l]) * w;
            }
    }
    put_squares(square, own);
    put_filtered(&filtered, own);
    put_filtered(&filtered_off_diagonal, off_diagonal);
    for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++) {
            couple_put(sum + 3 * k + l, -1, k, l, off_diagonal);
            put_turn(turns + 3 * k + l, -1, k, l, off_diagonal);
        }
}

/* ---- Ties ---- */

void solve_lift_corner(double weight, const phys_vec *basis, struct solve_lifted *sum)
{
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < 3; c++)
            sum->c[3 * k + c] += weight * (*basis)[k] * has(basis, c);
}

PHYS_KERNEL(solve_couple_lifted,
            (const phys_vec *value, const struct solve_lifted *a, const struct solve_lifted *b,
             double block[SOLVE_COUPLING]),
            (value, a, b, block))
{
    double n[3][SOLVE_COARSE]; /* rows of N, as often as there are functions */
    for (int c = 0; c < 3; c++)
        for (int column = 0; column < SOLVE_COARSE; column++)
            n[c][column] = (*value)[c] * (*value)[column % 3] + (c == column % 3 ? (*value)[3] : 0);
    for (int row = 0; row < SOLVE_COARSE; row++)
        for (int column = 0; column < SOLVE_COARSE; column++)
            block[SOLVE_COARSE * row + column] += a->c[row] * b->c[column] * n[row % 3][column];
}

/* ---- Between the levels ---- */

PHYS_KERNEL(solve_restrict,
            (size_t n, const phys_vec *basis, const phys_vec *y, double x[SOLVE_COARSE]),
            (n, basis, y, x))
{
    phys_vec sum[3] = {{0}};
    for (size_t a = 0; a < n; a++) {
        sum[0] += basis[a][0] * y[a];
        sum[1] += basis[a][1] * y[a];
        sum[2] += basis[a][2] * y[a];
    }
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < 3; c++)
            x[3 * k + c] = sum[k][c];
}

/* y += P x of one row, wherever a row or its ghost is. */
PHYS_INLINE void lift(const phys_vec *basis, const phys_vec x[3], phys_vec *y)
{
    phys_vec lifted = (*basis)[0] * x[0] + (*basis)[1] * x[1] + (*basis)[2] * x[2];
    for (int c = 0; c < 3 && (*basis)[3] > 0; c++)
        lifted[c] *= has(basis, c);
    *y += lifted;
}

PHYS_INLINE void motions(const double x[SOLVE_COARSE], phys_vec motion[3])
{
    for (int k = 0; k < 3; k++)
        motion[k] = (phys_vec){x[3 * k], x[3 * k + 1], x[3 * k + 2], 0};
}

PHYS_KERNEL(solve_prolong,
            (size_t n, const phys_vec *basis, const double x[SOLVE_COARSE], phys_vec *y),
            (n, basis, x, y))
{
    phys_vec motion[3];
    motions(x, motion);
    for (size_t a = 0; a < n; a++)
        lift(basis + a, motion, y + a);
}

PHYS_KERNEL(solve_advance_ghosts_coarse,
            (size_t n, double alpha, double beta, const double *s, const uint32_t *at,
             const phys_vec *basis, const double x[SOLVE_COARSE], phys_vec *z, phys_vec *p),
            (n, alpha, beta, s, at, basis, x, z, p))
{
    phys_vec motion[3];
    motions(x, motion);
    for (size_t i = 0; i < n; i++) {
        const double *row = s + 3 * (size_t)at[i];
        phys_vec value = PHYS_VEC(row);
        lift(basis + i, motion, &value);
        solve_advance(alpha, beta, &value, z + i, p + i);
    }
}
