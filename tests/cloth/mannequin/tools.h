#ifndef TESTS_CLOTH_MANNEQUIN_TOOLS_H
#define TESTS_CLOTH_MANNEQUIN_TOOLS_H

#include "cloth/mannequin/mannequin.h"
#include "cloth/verify/verify.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdlib.h>

static inline const double *place_of(const struct mesh *mesh, uint32_t v)
{
    return mesh->position + 3 * (size_t)v;
}

static inline double distance_of(const double *a, const double *b)
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                (a[2] - b[2]) * (a[2] - b[2]));
}

static inline void make_mannequin(struct mesh *mesh, const struct mannequin *mannequin)
{
    UNIT_FINE(mannequin_make(mesh, NULL, mannequin, NULL, &error));
}

/* How many pairs of its triangles intersect, with its vertices at x. */
static inline size_t crossings(const struct mesh *mesh, const double *x)
{
    const struct verify_soup soup = {.n_points = mesh->n_vertices,
                                     .n_triangles = mesh->n_triangles,
                                     .n_first = mesh->n_triangles,
                                     .x = (const double(*)[3])x,
                                     .corner = (const uint32_t(*)[3])mesh->triangle};
    struct cloth_list pairs = {0};
    UNIT_FINE(verify_pairs(&soup, &pairs, &error));
    free(pairs.items);
    return pairs.n;
}

#endif
