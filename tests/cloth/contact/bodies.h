#ifndef TESTS_CLOTH_CONTACT_BODIES_H
#define TESTS_CLOTH_CONTACT_BODIES_H

#include "cloth/contact/shape.h"
#include "cloth/mesh/mesh.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Closed meshes for tests, centred on the origin, oriented outwards. */
enum { BODY_VERTICES = 2600, BODY_TRIANGLES = 5200 };

struct surface {
    uint32_t n, n_triangles;
    double x[BODY_VERTICES][3];
    uint32_t triangle[BODY_TRIANGLES][3];
};

static inline void surface_mesh(const struct surface *s, struct mesh *mesh)
{
    UNIT_FINE(mesh_inline(mesh, s->n, *s->x, 0, NULL, s->n_triangles, *s->triangle, &error));
}

static inline void surface_add(struct surface *s, uint32_t a, uint32_t b, uint32_t c)
{
    ck_assert_uint_lt(s->n_triangles, BODY_TRIANGLES);
    const uint32_t corner[3] = {a, b, c};
    for (int i = 0; i < 3; i++)
        s->triangle[s->n_triangles][i] = corner[i];
    s->n_triangles++;
}

/* The number of the vertex there, which is added if there is none. */
static inline uint32_t surface_vertex(struct surface *s, double x, double y, double z)
{
    for (uint32_t v = 0; v < s->n; v++)
        if (fabs(s->x[v][0] - x) + fabs(s->x[v][1] - y) + fabs(s->x[v][2] - z) < 1e-9)
            return v;
    ck_assert_uint_lt(s->n, BODY_VERTICES);
    s->x[s->n][0] = x;
    s->x[s->n][1] = y;
    s->x[s->n][2] = z;
    return s->n++;
}

/* A ring of a tube: u around the axis y, v around the tube. */
static inline void surface_torus(struct surface *s, double radius, double tube, uint32_t nu,
                                 uint32_t nv)
{
    const double turn = 2 * acos(-1);
    *s = (struct surface){.n = nu * nv};
    for (uint32_t i = 0; i < nu; i++)
        for (uint32_t j = 0; j < nv; j++) {
            double *x = s->x[i * nv + j];
            const double u = turn * i / nu, v = turn * j / nv, far = radius + tube * cos(v);
            const uint32_t a = i * nv + j, b = (i + 1) % nu * nv + j;
            const uint32_t c = (i + 1) % nu * nv + (j + 1) % nv, d = i * nv + (j + 1) % nv;
            x[0] = far * cos(u);
            x[1] = tube * sin(v);
            x[2] = far * sin(u);
            surface_add(s, a, d, c);
            surface_add(s, a, c, b);
        }
}

/* A sphere by so many halvings of an icosahedron's edges: 20 4^halvings triangles, corners on the
 * sphere. */
static inline void surface_ball(struct surface *s, double radius, int halvings)
{
    static struct surface from;
    const double g = (1 + sqrt(5)) / 2, far = radius / sqrt(1 + g * g);
    *s = (struct surface){0};
    for (int axis = 0; axis < 3; axis++)
        for (int i = 0; i < 4; i++) {
            double x[3] = {0};
            x[axis] = i & 1 ? far : -far;
            x[(axis + 1) % 3] = i & 2 ? far * g : -far * g;
            surface_vertex(s, x[0], x[1], x[2]);
        }
    for (uint32_t a = 0; a < 12; a++)
        for (uint32_t b = a + 1; b < 12; b++)
            for (uint32_t c = b + 1; c < 12; c++) {
                const double *p = s->x[a], *q = s->x[b], *r = s->x[c];
                double pq = 0, qr = 0, rp = 0;
                for (int k = 0; k < 3; k++) {
                    pq = fmax(pq, 0) + (p[k] - q[k]) * (p[k] - q[k]);
                    qr += (q[k] - r[k]) * (q[k] - r[k]);
                    rp += (r[k] - p[k]) * (r[k] - p[k]);
                }
                if (fmax(pq, fmax(qr, rp)) > 4.1 * far * far)
                    continue;
                const double volume = p[0] * (q[1] * r[2] - q[2] * r[1]) +
                                      p[1] * (q[2] * r[0] - q[0] * r[2]) +
                                      p[2] * (q[0] * r[1] - q[1] * r[0]);
                surface_add(s, a, volume > 0 ? b : c, volume > 0 ? c : b);
            }
    for (int h = 0; h < halvings; h++) {
        from = *s;
        s->n_triangles = 0;
        for (uint32_t t = 0; t < from.n_triangles; t++) {
            const uint32_t *corner = from.triangle[t];
            uint32_t middle[3];
            for (int i = 0; i < 3; i++) {
                double x[3], square = 0;
                for (int k = 0; k < 3; k++) {
                    x[k] = s->x[corner[i]][k] + s->x[corner[(i + 1) % 3]][k];
                    square += x[k] * x[k];
                }
                const double part = radius / sqrt(square);
                middle[i] = surface_vertex(s, part * x[0], part * x[1], part * x[2]);
            }
            for (int i = 0; i < 3; i++)
                surface_add(s, corner[i], middle[i], middle[(i + 2) % 3]);
            surface_add(s, middle[0], middle[1], middle[2]);
        }
    }
}

/* A box with sides 2 x half. */
static inline void surface_box(struct surface *s, double x, double y, double z)
{
    static const uint32_t side[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                        {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    *s = (struct surface){.n = 8};
    for (uint32_t v = 0; v < 8; v++) {
        s->x[v][0] = v & 1 ? x : -x;
        s->x[v][1] = v & 2 ? y : -y;
        s->x[v][2] = v & 4 ? z : -z;
    }
    for (int i = 0; i < 6; i++) {
        surface_add(s, side[i][0], side[i][1], side[i][2]);
        surface_add(s, side[i][0], side[i][2], side[i][3]);
    }
}

/* The normal at the place (x, y, z) is along (to_x, to_y, to_z), of any length. */
static inline void body_check_normal(const struct contact_body *body, double x, double y, double z,
                                     double to_x, double to_y, double to_z)
{
    const phys_vec at = {x, y, z, 0};
    const double length = sqrt(to_x * to_x + to_y * to_y + to_z * to_z);
    struct contact_hit hit;
    contact_body_kind.closest(NULL, body, 1, &at, &hit);
    ck_assert_double_eq_tol(hit.normal[0], to_x / length, 1e-12);
    ck_assert_double_eq_tol(hit.normal[1], to_y / length, 1e-12);
    ck_assert_double_eq_tol(hit.normal[2], to_z / length, 1e-12);
}

/* A body of others, in decimetres, upright along y. It may be missing: tests of it are added where
 * the file is there. */
static inline const char *real_body_path(void)
{
    static char path[4096];
    const char *top = getenv("srcdir");
    snprintf(path, sizeof path, "%s/../shared/data/body/female_generic.obj", top ? top : ".");
    return path;
}

#endif
