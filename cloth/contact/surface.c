/* Points of a grid on the box around a shape are drawn towards its middle until they are on it. So
 * sides of a box stay flat, and any other shape is as smooth as the grid is fine. */
#include "cloth/contact/surface.h"

#include <math.h>
#include <string.h>

enum { HALVINGS = 52 };
static const uint32_t N = CONTACT_CELLS;
/* A point on an edge of a box has no single normal: points of the sides keep so far inside, in
 * parts of its half size. */
static const double INSIDE = 1e-6;
static const double ROUND = 0.7; /* cosine between a body's triangle and the normal of its corner */

/* The point where the way from the middle of the shape to a point of the box around it leaves the
 * shape. */
static void find_exit(const struct contact_shape *shape, const struct phys_pose *axes,
                      const phys_vec *corner, double vertex[6])
{
    struct contact_hit hit;
    phys_vec x;
    double in = 0, out = 1;
    for (int i = 0; i < HALVINGS; i++) {
        const double part = (in + out) / 2;
        const phys_vec own = part * *corner;
        phys_pose_point(axes, &own, &x);
        contact_kinds[shape->kind]->closest(shape->value, NULL, 1, &x, &hit);
        *(hit.gap > 0 ? &out : &in) = part;
    }
    for (int c = 0; c < 3; c++) {
        vertex[c] = x[c];
        vertex[3 + c] = hit.normal[c];
    }
}

/* Takes a point of the box, in its own axes, to the cylinder in it. */
static void make_round(const double half[3], phys_vec *corner)
{
    const double u = (*corner)[1] / half[1], v = (*corner)[2] / half[2], far = sqrt(u * u + v * v);
    const double part = far > 0 ? fmax(fabs(u), fabs(v)) / far : 0;
    (*corner)[1] *= part;
    (*corner)[2] *= part;
}

/* Side 0 to 2 is across an axis, 3 to 5 at its other end. */
static void build_side(const struct contact_shape *shape, const struct phys_pose *axes,
                       const double half[3], uint32_t side, double (*vertex)[6])
{
    const uint32_t across = side % 3, u = (side + 1) % 3, v = (side + 2) % 3;
    for (uint32_t j = 0; j <= N; j++)
        for (uint32_t i = 0; i <= N; i++) {
            phys_vec corner = {0};
            corner[across] = side < 3 ? half[across] : -half[across];
            corner[u] = half[u] * (2.0 * i / N - 1) * (1 - INSIDE);
            corner[v] = half[v] * (2.0 * j / N - 1) * (1 - INSIDE);
            if (contact_kinds[shape->kind]->round)
                make_round(half, &corner);
            find_exit(shape, axes, &corner, vertex[j * (N + 1) + i]);
        }
}

static void join_side(uint32_t side, uint32_t first, uint32_t (*triangle)[3])
{
    for (uint32_t j = 0; j < N; j++)
        for (uint32_t i = 0; i < N; i++) {
            const uint32_t a = first + j * (N + 1) + i, b = a + 1, c = b + N + 1, d = c - 1;
            const uint32_t pair[2][3] = {{a, side < 3 ? b : c, side < 3 ? c : b},
                                         {a, side < 3 ? c : d, side < 3 ? d : c}};
            memcpy(triangle + 2 * (j * N + i), pair, sizeof pair);
        }
}

/* Corners are drawn round where the body bends little, else as the edges that they are. */
static void contact_surface_build_body(const struct contact_body *body, double (*vertex)[6],
                                       uint32_t (*triangle)[3])
{
    const struct contact_facet *facet = contact_body_facets(body);
    const phys_vec *at = contact_body_vertices(body), *round = contact_body_normals(body);
    for (uint32_t f = 0; f < body->n_triangles; f++)
        for (uint32_t k = 0; k < 3; k++) {
            const uint32_t corner = facet[f].corner[k], number = 3 * facet[f].number + k;
            const phys_vec *flat = contact_facet_normals(body) + f;
            const phys_vec *normal = phys_dot(flat, round + corner) > ROUND ? round + corner : flat;
            triangle[facet[f].number][k] = number;
            for (int c = 0; c < 3; c++) {
                vertex[number][c] = at[corner][c];
                vertex[number][3 + c] = (*normal)[c];
            }
        }
}

void contact_surface_count(const struct contact_shape *shape, const struct contact_body *body,
                           uint32_t *n_vertices, uint32_t *n_triangles)
{
    const bool bounded = contact_kinds[shape->kind]->around;
    *n_vertices = body ? 3 * body->n_triangles : bounded ? CONTACT_SURFACE_VERTICES : 0;
    *n_triangles = body ? body->n_triangles : bounded ? CONTACT_SURFACE_TRIANGLES : 0;
}

void contact_surface(const struct contact_shape *shape, const struct contact_body *body,
                     double (*vertex)[6], uint32_t (*triangle)[3])
{
    enum { VERTICES = CONTACT_SURFACE_VERTICES / 6, TRIANGLES = CONTACT_SURFACE_TRIANGLES / 6 };
    struct phys_pose axes;
    double half[3];
    if (body) {
        contact_surface_build_body(body, vertex, triangle);
        return;
    }
    contact_kinds[shape->kind]->around(shape->value, &axes, half);
    for (uint32_t side = 0; side < 6; side++) {
        build_side(shape, &axes, half, side, vertex + side * VERTICES);
        join_side(side, side * VERTICES, triangle + side * TRIANGLES);
    }
}
