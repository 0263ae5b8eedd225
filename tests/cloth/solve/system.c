/* Systems are made the same way in every run. */
#include "tests/cloth/solve/system.h"

#include "cloth/solve/assemble.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

double system_draw(void)
{
    return (double)(rand() % 20001 - 10000) / 10000;
}

static void add_spring(struct system *s, uint32_t a, uint32_t b, double stiffness)
{
    double d[3], square = 0;
    for (int c = 0; c < 3; c++) {
        d[c] = s->position[a][c] - s->position[b][c];
        square += d[c] * d[c];
    }
    const double w = sqrt(stiffness / square), alpha = 0.1 * stiffness;
    s->value[s->n_springs] = (phys_vec){w * d[0], w * d[1], w * d[2], alpha};
    s->end[s->n_springs][0] = a;
    s->end[s->n_springs++][1] = b;
}

static void place(struct system *s, uint32_t a, double x, double y)
{
    s->position[a] =
        (phys_vec){x + 0.1 * system_draw(), y + 0.1 * system_draw(), 0.1 * system_draw(), 0};
    s->diagonal[a] = 1 + 0.5 * system_draw();
    s->free[a] = 1;
}

static void clear(struct system *s)
{
    const enum solve_format format = s->format;
    const bool filtered = s->filtered;
    memset(s, 0, sizeof *s);
    s->format = format;
    s->filtered = filtered;
}

void system_chain(struct system *s, uint32_t n, double stiffness)
{
    clear(s);
    s->n = n;
    for (uint32_t a = 0; a < n; a++)
        place(s, a, a, 0);
    for (uint32_t a = 0; a + 1 < n; a++)
        add_spring(s, a, a + 1, stiffness);
}

void system_sheet(struct system *s, uint32_t nx, uint32_t ny, double stiffness)
{
    clear(s);
    s->n = nx * ny;
    for (uint32_t a = 0; a < s->n; a++)
        place(s, a, a % nx, a / nx);
    for (uint32_t a = 0; a < s->n; a++) {
        const bool right = a % nx + 1 < nx, up = a / nx + 1 < ny;
        if (right)
            add_spring(s, a, a + 1, stiffness);
        if (up)
            add_spring(s, a, a + nx, stiffness);
        if (right && up)
            add_spring(s, a, a + nx + 1, stiffness / 2);
    }
}

static uint32_t find(const struct system *s, uint32_t a, uint32_t b)
{
    uint32_t i = 0;
    while (i < s->n_springs && (s->end[i][0] != a || s->end[i][1] != b))
        i++;
    return i;
}

void system_turn(struct system *s, double size)
{
    for (uint32_t i = 0; i < s->n_springs && s->format != SOLVE_SPRINGS; i++)
        for (uint32_t j = i + 1; j < s->n_springs; j++) {
            const uint32_t k = find(s, s->end[i][0], s->end[j][1]);
            if (s->end[j][0] != s->end[i][1] || k == s->n_springs)
                continue;
            const phys_vec turn = size * (phys_vec){system_draw(), system_draw(), system_draw(), 0};
            s->turn[i] += turn;
            s->turn[j] += turn;
            s->turn[k] -= turn;
        }
}

/* ---- The dense matrix ---- */

/* N of a spring. */
static void block_of(const struct system *s, uint32_t i, double n[3][3])
{
    const phys_vec *w = s->value + i, *t = s->turn + i;
    const double turn[3][3] = {
        {0, -(*t)[2], (*t)[1]}, {(*t)[2], 0, -(*t)[0]}, {-(*t)[1], (*t)[0], 0}};
    for (int c = 0; c < 3; c++)
        for (int d = 0; d < 3; d++)
            n[c][d] = (*w)[c] * (*w)[d] + (c == d ? (*w)[3] : 0) + turn[c][d];
}

static void add_dense(struct system *s, uint32_t a, uint32_t b, double n[3][3])
{
    for (uint32_t c = 0; c < 3; c++)
        for (uint32_t d = 0; d < 3; d++) {
            const double half = 0.5 * (n[c][d] + n[d][c]);
            s->dense[3 * a + c][3 * a + d] += s->free[a] * half;
            s->dense[3 * b + c][3 * b + d] += s->free[b] * half;
            s->dense[3 * a + c][3 * b + d] -= s->free[a] * s->free[b] * n[c][d];
            s->dense[3 * b + d][3 * a + c] -= s->free[a] * s->free[b] * n[c][d];
        }
}

static void make_dense(struct system *s)
{
    double n[3][3];
    memset(s->dense, 0, sizeof s->dense);
    for (uint32_t i = 0; i < 3 * s->n; i++)
        s->dense[i][i] = s->free[i / 3] > 0 ? s->diagonal[i / 3] : 1;
    for (uint32_t i = 0; i < s->n_springs; i++) {
        block_of(s, i, n);
        add_dense(s, s->end[i][0], s->end[i][1], n);
    }
}

/* S A S + I - S. */
static void filter_dense(struct system *s)
{
    for (uint32_t a = 0; a < s->n; a++)
        for (uint32_t i = 0; i < 3 * s->n; i++) {
            double *row[3] = {s->dense[3 * a] + i, s->dense[3 * a + 1] + i,
                              s->dense[3 * a + 2] + i};
            phys_vec y = {*row[0], *row[1], *row[2], 0};
            solve_filter(s->filter + a, &y);
            for (int c = 0; c < 3; c++)
                *row[c] = y[c];
        }
    for (uint32_t a = 0; a < s->n; a++)
        for (uint32_t i = 0; i < 3 * s->n; i++) {
            double *row = s->dense[i] + 3 * a;
            phys_vec y = {row[0], row[1], row[2], 0};
            solve_filter(s->filter + a, &y);
            for (int c = 0; c < 3; c++)
                row[c] = y[c];
        }
    for (uint32_t a = 0; a < s->n; a++)
        for (uint32_t c = 0; c < 3; c++) {
            phys_vec y = {0};
            y[c] = 1;
            solve_filter(s->filter + a, &y);
            for (uint32_t d = 0; d < 3; d++)
                s->dense[3 * a + d][3 * a + c] += (d == c) - y[d];
        }
}

void system_filter(struct system *s, bool oblique)
{
    static const double axis[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (uint32_t a = 0; a < s->n; a++) {
        const double *n = axis[a % 3];
        const phys_vec along = {n[0], n[1], n[2], a % 2}, askew = {0.6, 0, -0.8, a % 2};
        s->filter[a] = oblique && a % 5 < 2 ? askew : along;
        if (a % 4 == 3)
            s->filter[a] = (phys_vec){0, 0, 0, a % 8 > 3};
    }
}

/* ---- Blocks ---- */

static uint32_t copy_of(const struct system_block *b, uint32_t row)
{
    uint32_t i = 0;
    while (b->ghost[i] != row)
        i++;
    return i;
}

/* Adds spring i of the whole to entry `at`, of which the second end may be here. */
static void add_entry(const struct system *s, uint32_t i, uint32_t at, bool transposed,
                      struct system_block *b, struct phys_pair *sums)
{
    if (s->format == SOLVE_SPRINGS) {
        b->value[at] = s->value[i];
        return;
    }
    const phys_vec *t = s->turn + i;
    double turn[3][3] = {{0, -(*t)[2], (*t)[1]}, {(*t)[2], 0, -(*t)[0]}, {-(*t)[1], (*t)[0], 0}};
    solve_assemble_springs(1, &at, s->value + i, sums);
    system_assemble(sums + at, transposed, (const double(*)[3])turn);
}

/* Entries between rows of the block and of others, behind the inner ones. */
static void cut_entries(struct system *s, struct system_block *b, uint32_t n,
                        struct phys_pair *sums)
{
    for (uint32_t i = 0; i < s->n_springs; i++) {
        const uint32_t x = s->end[i][0] - b->first, y = s->end[i][1] - b->first;
        if ((x < n) == (y < n))
            continue;
        add_entry(s, i, b->row[n] + (uint32_t)b->cut.n, y < n, b, sums);
        b->end[b->cut.n][0] = x < n ? x : y;
        b->end[b->cut.n++][1] = copy_of(b, (x < n ? y : x) + b->first);
    }
}

/* Inner springs, then those cut, of the rows first .. first + n - 1. */
static void cut_block(struct system *s, struct system_block *b, uint32_t first, uint32_t n)
{
    bool seen[SYSTEM_ROWS] = {0}, halo[SYSTEM_ROWS] = {0};
    struct phys_pair sums[SYSTEM_SPRINGS] = {{{{0}}}};
    uint32_t inner = 0, span = 0;
    *b = (struct system_block){.first = first};
    memcpy(b->diagonal, s->diagonal + first, n * sizeof *b->diagonal);
    memcpy(b->free, s->free + first, n * sizeof *b->free);
    memcpy(b->position, s->position + first, n * sizeof *b->position);
    for (uint32_t i = 0; i < s->n_springs; i++) {
        const uint32_t x = s->end[i][0] - first, y = s->end[i][1] - first;
        if (x < n && y < n) {
            add_entry(s, i, inner, false, b, sums);
            b->column[inner++] = y;
            span = span > y - x ? span : y - x;
            b->row[x + 1] = inner;
        } else if (x < n || y < n) {
            seen[(x < n ? y : x) + first] = true;
            halo[x < n ? x : y] = true;
        }
    }
    for (uint32_t a = 0; a < n; a++) {
        b->row[a + 1] = b->row[a + 1] > b->row[a] ? b->row[a + 1] : b->row[a];
        if (halo[a])
            b->halo[b->cut.n_halo++] = a;
    }
    for (uint32_t a = 0; a < s->n; a++)
        if (seen[a])
            b->ghost[b->n_ghosts++] = a;
    cut_entries(s, b, n, sums);
    b->matrix = (struct solve_block){.n = n,
                                     .diagonal = b->diagonal,
                                     .free = b->free,
                                     .row = b->row,
                                     .column = b->column,
                                     .span = span,
                                     .format = s->format,
                                     .filter = s->filtered ? s->filter + first : NULL};
    b->cut.end = (const uint32_t(*)[2])b->end;
    b->cut.halo = b->halo;
    if (s->format != SOLVE_SPRINGS)
        solve_assembled(b->row[n] + b->cut.n, sums, (double *)(void *)b->value);
}

void system_cut(struct system *s, uint32_t n_blocks)
{
    s->n_blocks = n_blocks;
    make_dense(s);
    if (s->filtered)
        filter_dense(s);
    for (uint32_t b = 0; b < n_blocks; b++) {
        const uint32_t first = b * s->n / n_blocks;
        cut_block(s, s->block + b, first, (b + 1) * s->n / n_blocks - first);
    }
}

/* ---- Rows ---- */

void system_draw_rows(const struct system *s, phys_vec *y)
{
    for (uint32_t a = 0; a < s->n; a++) {
        y[a] = s->free[a] * (phys_vec){system_draw(), system_draw(), system_draw(), 0};
        if (s->filtered)
            solve_filter(s->filter + a, y + a);
    }
}

void system_multiply(const struct system *s, const phys_vec *x, phys_vec *y)
{
    for (uint32_t i = 0; i < 3 * s->n; i++) {
        double sum = 0;
        for (uint32_t j = 0; j < 3 * s->n; j++)
            sum += s->dense[i][j] * x[j / 3][j % 3];
        y[i / 3][i % 3] = sum;
    }
    for (uint32_t a = 0; a < s->n; a++)
        y[a][3] = 0;
}

void system_solve(const struct system *s, const phys_vec *y, phys_vec *x)
{
    static double m[3 * SYSTEM_ROWS][3 * SYSTEM_ROWS + 1];
    const uint32_t n = 3 * s->n;
    for (uint32_t i = 0; i < n; i++) {
        memcpy(m[i], s->dense[i], n * sizeof *m[i]);
        m[i][n] = y[i / 3][i % 3];
    }
    for (uint32_t k = 0; k < n; k++)
        for (uint32_t i = k + 1; i < n; i++) {
            const double factor = m[i][k] / m[k][k];
            for (uint32_t j = k; j <= n; j++)
                m[i][j] -= factor * m[k][j];
        }
    memset(x, 0, s->n * sizeof *x);
    for (uint32_t k = n; k-- > 0;) {
        double sum = m[k][n];
        for (uint32_t j = k + 1; j < n; j++)
            sum -= m[k][j] * x[j / 3][j % 3];
        x[k / 3][k % 3] = sum / m[k][k];
    }
}

double system_dot(const struct system *s, const phys_vec *x, const phys_vec *y)
{
    double sum = 0;
    for (uint32_t a = 0; a < s->n; a++)
        for (int c = 0; c < 3; c++)
            sum += x[a][c] * y[a][c];
    return sum;
}
