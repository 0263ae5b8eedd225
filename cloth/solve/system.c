/* Pairs are worked on one after the other: equal arrays give equal bits. */
#include "cloth/solve/system.h"

#include "cloth/base/order.h"

#include <stdlib.h>
#include <string.h>

int solve_system_make(struct solve_system *system, uint32_t n, size_t n_pairs,
                      enum solve_pairs pairs, struct cloth_error *error)
{
    const size_t rows = (size_t)n + 1;
    *system = (struct solve_system){.n = n, .n_pairs = n_pairs};
    double **row[] = {&system->mass, &system->diagonal, &system->free};
    double **vector[] = {&system->b, &system->dv, &system->x, &system->v};
    int has = 1;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++)
        has = (*row[i] = calloc(rows, sizeof(double))) && has;
    for (size_t i = 0; i < sizeof vector / sizeof *vector; i++)
        has = (*vector[i] = calloc(rows, 3 * sizeof(double))) && has;
    system->end = calloc(n_pairs + 1, sizeof *system->end);
    if (pairs == SOLVE_PAIRS_OF_SPRINGS)
        system->value = calloc(n_pairs + 1, sizeof *system->value);
    else
        system->block = calloc(n_pairs + 1, sizeof *system->block);
    if (has && system->end && (system->value || system->block))
        return CLOTH_OK;
    solve_system_free(system);
    return cloth_fail(error, CLOTH_E_MEMORY, "out of memory for a system of %u vertices", n);
}

void solve_system_free(struct solve_system *system)
{
    double *array[] = {system->mass, system->diagonal, system->free, system->b,
                       system->dv,   system->x,        system->v};
    for (size_t i = 0; i < sizeof array / sizeof *array; i++)
        free(array[i]);
    free(system->end);
    free(system->value);
    free(system->block);
    *system = (struct solve_system){0};
}

void solve_system_pair(const struct solve_system *system, size_t i, double n[3][3])
{
    for (int c = 0; c < 3; c++)
        for (int d = 0; d < 3; d++) {
            if (system->block) {
                n[c][d] = system->block[i][3 * c + d];
                continue;
            }
            const double *w = system->value[i];
            n[c][d] = w[c] * w[d] + (c == d ? w[3] : 0);
        }
}

/* ---- Order ---- */

struct entry {
    uint32_t end[2];
    size_t at;
    int transposed;
};

static int solve_system_compare(const void *va, const void *vb)
{
    const struct entry *a = va, *b = vb;
    const int order = cloth_compare_numbers(a->end, b->end, 2);
    return order ? order : (a->at > b->at) - (a->at < b->at);
}

/* Moves the data of pairs, `bytes` each, to their new places. room: as large. */
static void solve_system_move(const struct entry *entry, size_t n, size_t bytes, void *array,
                              void *room)
{
    char *to = array, *from = room;
    memcpy(from, to, n * bytes);
    for (size_t i = 0; i < n; i++)
        memcpy(to + i * bytes, from + entry[i].at * bytes, bytes);
}

static void transpose(double n[9])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < i; j++) {
            const double other = n[3 * i + j];
            n[3 * i + j] = n[3 * j + i];
            n[3 * j + i] = other;
        }
}

int solve_system_sort(struct solve_system *system, struct cloth_error *error)
{
    const size_t n = system->n_pairs;
    const size_t bytes = system->block ? sizeof *system->block : sizeof *system->value;
    struct entry *entry = malloc((n + 1) * sizeof *entry);
    void *room = malloc((n + 1) * bytes);
    if (!entry || !room) {
        free(entry);
        free(room);
        return cloth_fail(error, CLOTH_E_MEMORY, "out of memory for %zu pairs in order", n);
    }
    for (size_t i = 0; i < n; i++) {
        const uint32_t a = system->end[i][0], b = system->end[i][1];
        entry[i] = (struct entry){{a < b ? a : b, a < b ? b : a}, i, a > b};
    }
    qsort(entry, n, sizeof *entry, solve_system_compare);
    solve_system_move(entry, n, bytes, system->block ? (void *)system->block : system->value, room);
    for (size_t i = 0; i < n; i++) {
        memcpy(system->end[i], entry[i].end, sizeof system->end[i]);
        if (system->block && entry[i].transposed)
            transpose(system->block[i]);
    }
    free(entry);
    free(room);
    return CLOTH_OK;
}

/* ---- Product ---- */

/* (N + N') / 2 of the difference d, and the turn of N, (N - N') / 2, of p_a and p_b. */
static void add_pair(const double n[3][3], const double p[2][3], double *y_a, double *y_b)
{
    for (int c = 0; c < 3; c++) {
        double same = 0, a = 0, b = 0;
        for (int e = 0; e < 3; e++) {
            const double turn = 0.5 * (n[c][e] - n[e][c]);
            same += 0.5 * (n[c][e] + n[e][c]) * (p[0][e] - p[1][e]);
            a += turn * p[1][e];
            b += turn * p[0][e];
        }
        y_a[c] += same - a;
        y_b[c] -= same - b;
    }
}

void solve_system_multiply(const struct solve_system *system, const double *p, double *y)
{
    const double *free = system->free;
    for (uint32_t a = 0; a < system->n; a++)
        for (size_t c = 0; c < 3; c++)
            y[3 * (size_t)a + c] = system->diagonal[a] * (free[a] * p[3 * (size_t)a + c]);
    for (size_t i = 0; i < system->n_pairs; i++) {
        const size_t a = system->end[i][0], b = system->end[i][1];
        double ends[2][3], n[3][3];
        for (size_t c = 0; c < 3; c++) {
            ends[0][c] = free[a] * p[3 * a + c];
            ends[1][c] = free[b] * p[3 * b + c];
        }
        solve_system_pair(system, i, n);
        add_pair((const double(*)[3])n, (const double(*)[3])ends, y + 3 * a, y + 3 * b);
    }
    for (uint32_t a = 0; a < system->n; a++)
        for (size_t c = 0; c < 3; c++)
            y[3 * (size_t)a + c] *= free[a];
}
