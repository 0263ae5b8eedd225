/* Springs are worked on one after the other: whoever has the same arrays gets the same bits. */
#include "cloth/solve/system.h"

#include <stdlib.h>
#include <string.h>

int solve_system_make(struct solve_system *system, uint32_t n, size_t n_springs,
                      struct cloth_error *error)
{
    const size_t rows = (size_t)n + 1;
    *system = (struct solve_system){.n = n, .n_springs = n_springs};
    double **row[] = {&system->mass, &system->diagonal, &system->free};
    double **vector[] = {&system->b, &system->dv, &system->x, &system->v};
    int has = 1;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++)
        has = (*row[i] = calloc(rows, sizeof(double))) && has;
    for (size_t i = 0; i < sizeof vector / sizeof *vector; i++)
        has = (*vector[i] = calloc(rows, 3 * sizeof(double))) && has;
    system->end = calloc(n_springs + 1, sizeof *system->end);
    system->value = calloc(n_springs + 1, sizeof *system->value);
    if (has && system->end && system->value)
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
    *system = (struct solve_system){0};
}

/* ---- Order ---- */

struct entry {
    uint32_t end[2];
    size_t at;
};

static int compare(const void *va, const void *vb)
{
    const struct entry *a = va, *b = vb;
    for (int i = 0; i < 2; i++)
        if (a->end[i] != b->end[i])
            return a->end[i] < b->end[i] ? -1 : 1;
    return (a->at > b->at) - (a->at < b->at);
}

int solve_system_sort(struct solve_system *system, struct cloth_error *error)
{
    const size_t n = system->n_springs;
    struct entry *entry = malloc((n + 1) * sizeof *entry);
    double(*value)[4] = malloc((n + 1) * sizeof *value);
    const int has = entry && value;
    for (size_t i = 0; i < n && has; i++) {
        const uint32_t a = system->end[i][0], b = system->end[i][1];
        entry[i] = (struct entry){{a < b ? a : b, a < b ? b : a}, i};
    }
    if (has) {
        qsort(entry, n, sizeof *entry, compare);
        memcpy(value, system->value, n * sizeof *value);
    }
    for (size_t i = 0; i < n && has; i++) {
        memcpy(system->end[i], entry[i].end, sizeof system->end[i]);
        memcpy(system->value[i], value[entry[i].at], sizeof system->value[i]);
    }
    free(entry);
    free(value);
    return has ? CLOTH_OK
               : cloth_fail(error, CLOTH_E_MEMORY, "out of memory for %zu springs in order", n);
}

/* ---- Product ---- */

void solve_system_multiply(const struct solve_system *system, const double *p, double *y)
{
    const double *free = system->free;
    for (uint32_t a = 0; a < system->n; a++)
        for (size_t c = 0; c < 3; c++)
            y[3 * (size_t)a + c] = system->diagonal[a] * (free[a] * p[3 * (size_t)a + c]);
    for (size_t i = 0; i < system->n_springs; i++) {
        const size_t a = system->end[i][0], b = system->end[i][1];
        const double *w = system->value[i];
        double d[3];
        for (size_t c = 0; c < 3; c++)
            d[c] = free[a] * p[3 * a + c] - free[b] * p[3 * b + c];
        const double dot = w[0] * d[0] + w[1] * d[1] + w[2] * d[2];
        for (size_t c = 0; c < 3; c++) {
            const double force = w[3] * d[c] + dot * w[c];
            y[3 * a + c] += force;
            y[3 * b + c] -= force;
        }
    }
    for (uint32_t a = 0; a < system->n; a++)
        for (size_t c = 0; c < 3; c++)
            y[3 * (size_t)a + c] *= free[a];
}
