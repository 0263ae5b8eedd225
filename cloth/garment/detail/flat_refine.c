/* Delaunay refinement (Chew, 1993; Ruppert, 1995) of the inside alone: the centre of a sharp
 * triangle's circumcircle becomes a vertex, where that is not too near to the boundary. So sizes
 * grow step by step from a boundary that is much finer than the lattice. */
#include "cloth/garment/detail/flat.h"

#include <math.h>

enum { ROUNDS = 12, MOST = 48 };

static const double POOR = 0.93969262;  /* cos 20 degrees: one such triangle calls for all this */
static const double SHARP = 0.88294759; /* cos 28 degrees: above that the insertions may not end */
static const double WIDE = -0.5; /* cos 120 degrees: of a boundary's edge seen from a vertex */

static bool is_sharper(const struct delaunay *plane, const unsigned char *sharp, uint32_t triangle,
                       double cosine)
{
    return plane->triangle[triangle].vertex[0] != DELAUNAY_NONE &&
           delaunay_sharpness_of(plane, triangle) > cosine &&
           !flat_excused(plane, plane->n_fixed, sharp, triangle);
}

void flat_centre(const struct delaunay *plane, uint32_t triangle, double centre[2])
{
    const uint32_t *v = plane->triangle[triangle].vertex;
    const double *a = plane->place[v[0]], *b = plane->place[v[1]], *c = plane->place[v[2]];
    const double ab[2] = {b[0] - a[0], b[1] - a[1]}, ac[2] = {c[0] - a[0], c[1] - a[1]};
    const double area = 2 * delaunay_area(a, b, c);
    const double bb = ab[0] * ab[0] + ab[1] * ab[1], cc = ac[0] * ac[0] + ac[1] * ac[1];
    centre[0] = a[0] + (ac[1] * bb - ab[1] * cc) / area;
    centre[1] = a[1] + (ab[0] * cc - ac[0] * bb) / area;
}

static double cosine_at(const double x[2], const double a[2], const double b[2])
{
    const double to_a[2] = {a[0] - x[0], a[1] - x[1]}, to_b[2] = {b[0] - x[0], b[1] - x[1]};
    return (to_a[0] * to_b[0] + to_a[1] * to_b[1]) /
           sqrt((to_a[0] * to_a[0] + to_a[1] * to_a[1]) * (to_b[0] * to_b[0] + to_b[1] * to_b[1]));
}

/* Whether a vertex sees an edge of the boundary under so wide an angle that a flat triangle is
 * between the two. */
static bool crowds(const struct delaunay *plane, uint32_t vertex)
{
    uint32_t around[MOST];
    const uint32_t n = delaunay_around(plane, vertex, MOST, around);
    for (uint32_t k = 0; k < n; k++) {
        const struct delaunay_triangle *of = &plane->triangle[around[k]];
        const int i = delaunay_corner(of, vertex);
        const double *x = plane->place[vertex], *a = plane->place[of->vertex[(i + 1) % 3]],
                     *b = plane->place[of->vertex[(i + 2) % 3]];
        if (of->beside[i] == DELAUNAY_NONE && cosine_at(x, a, b) < WIDE)
            return true;
    }
    return n == 0;
}

static bool insert_centre(struct delaunay *plane, uint32_t triangle)
{
    double centre[2];
    flat_centre(plane, triangle, centre);
    delaunay_log(plane);
    const uint32_t vertex = delaunay_insert(plane, centre, triangle);
    const bool good = vertex != DELAUNAY_NONE && !plane->failed && !crowds(plane, vertex);
    if (good)
        delaunay_keep(plane);
    else
        delaunay_undo(plane);
    return good;
}

bool flat_refine(struct delaunay *plane, const unsigned char *sharp)
{
    bool any = false;
    for (uint32_t t = 0; t < plane->n_triangles && !any; t++)
        any = is_sharper(plane, sharp, t, POOR);
    const bool called = any;
    for (int round = 0; round < ROUNDS && any && !plane->failed; round++) {
        any = false;
        for (uint32_t t = 0; t < plane->n_triangles; t++)
            if (is_sharper(plane, sharp, t, SHARP) && insert_centre(plane, t))
                any = true;
    }
    return called;
}
