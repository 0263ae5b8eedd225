/* Systems are made the same way in every run. */
#include "tests/cloth/solve/system.h"

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

void system_chain(struct system *s, uint32_t n, double stiffness)
{
    memset(s, 0, sizeof *s);
    s->n = n;
    for (uint32_t a = 0; a < n; a++)
        place(s, a, a, 0);
    for (uint32_t a = 0; a + 1 < n; a++)
        add_spring(s, a, a + 1, stiffness);
}

void system_sheet(struct system *s, uint32_t nx, uint32_t ny, double stiffness)
{
    memset(s, 0, sizeof *s);
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

/* ---- The dense matrix ---- */

static void add_dense(struct system *s, uint32_t a, uint32_t b, const phys_vec *value, double sign)
{
    const double factor = sign * s->free[a] * s->free[b];
    for (int c = 0; c < 3; c++)
        for (int d = 0; d < 3; d++)
            s->dense[3 * a + (uint32_t)c][3 * b + (uint32_t)d] +=
                factor * ((*value)[c] * (*value)[d] + (c == d ? (*value)[3] : 0));
}

static void make_dense(struct system *s)
{
    memset(s->dense, 0, sizeof s->dense);
    for (uint32_t i = 0; i < 3 * s->n; i++)
        s->dense[i][i] = s->free[i / 3] > 0 ? s->diagonal[i / 3] : 1;
    for (uint32_t i = 0; i < s->n_springs; i++) {
        const uint32_t a = s->end[i][0], b = s->end[i][1];
        add_dense(s, a, a, s->value + i, 1);
        add_dense(s, b, b, s->value + i, 1);
        add_dense(s, a, b, s->value + i, -1);
        add_dense(s, b, a, s->value + i, -1);
    }
}

/* ---- Blocks ---- */

static uint32_t copy_of(const struct system_block *b, uint32_t row)
{
    uint32_t i = 0;
    while (b->copy[i] != row)
        i++;
    return i;
}

/* Inner springs, then those cut, of the rows first .. first + n - 1. */
static void cut_block(struct system *s, struct system_block *b, uint32_t first, uint32_t n)
{
    bool seen[SYSTEM_ROWS] = {0}, rim[SYSTEM_ROWS] = {0};
    uint32_t inner = 0;
    *b = (struct system_block){.first = first};
    memcpy(b->diagonal, s->diagonal + first, n * sizeof *b->diagonal);
    memcpy(b->free, s->free + first, n * sizeof *b->free);
    memcpy(b->position, s->position + first, n * sizeof *b->position);
    for (uint32_t i = 0; i < s->n_springs; i++) {
        const uint32_t x = s->end[i][0] - first, y = s->end[i][1] - first;
        if (x < n && y < n) {
            b->value[inner] = s->value[i];
            b->column[inner++] = y;
            b->row[x + 1] = inner;
        } else if (x < n || y < n) {
            seen[(x < n ? y : x) + first] = true;
            rim[x < n ? x : y] = true;
        }
    }
    for (uint32_t a = 0; a < n; a++) {
        b->row[a + 1] = b->row[a + 1] > b->row[a] ? b->row[a + 1] : b->row[a];
        if (rim[a])
            b->rim[b->cut.n_rim++] = a;
    }
    for (uint32_t a = 0; a < s->n; a++)
        if (seen[a])
            b->copy[b->n_copies++] = a;
    for (uint32_t i = 0; i < s->n_springs; i++) {
        const uint32_t x = s->end[i][0] - first, y = s->end[i][1] - first;
        if ((x < n) == (y < n))
            continue;
        b->value[inner + b->cut.n] = s->value[i];
        b->end[b->cut.n][0] = x < n ? x : y;
        b->end[b->cut.n++][1] = copy_of(b, (x < n ? y : x) + first);
    }
    b->matrix = (struct solve_block){n, b->diagonal, b->free, b->row, b->column};
    b->cut.end = (const uint32_t(*)[2])b->end;
    b->cut.rim = b->rim;
}

void system_cut(struct system *s, uint32_t n_blocks)
{
    s->n_blocks = n_blocks;
    make_dense(s);
    for (uint32_t b = 0; b < n_blocks; b++) {
        const uint32_t first = b * s->n / n_blocks;
        cut_block(s, s->block + b, first, (b + 1) * s->n / n_blocks - first);
    }
}

/* ---- Rows ---- */

void system_draw_rows(const struct system *s, phys_vec *y)
{
    for (uint32_t a = 0; a < s->n; a++)
        y[a] = s->free[a] * (phys_vec){system_draw(), system_draw(), system_draw(), 0};
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
