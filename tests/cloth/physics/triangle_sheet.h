#ifndef TESTS_CLOTH_PHYSICS_TRIANGLE_SHEET_H
#define TESTS_CLOTH_PHYSICS_TRIANGLE_SHEET_H

#include "cloth/physics/triangle.h"
#include "tests/cloth/physics/elements.h"
#include "tests/support/unit.h"

#include <math.h>
#include <string.h>

/* A sheet of membrane triangles, for tests. */

static const double WARP = 1000, WEFT = 300, SHEAR = 50, POISSON = 0.4;

/* ---- A sheet ---- */

/* A rectangle of 4 x 4 vertices in the u-v plane, inner ones displaced, and its triangles. */
enum { NX = 4, NY = 4, VERTICES = NX * NY, TRIANGLES = 2 * (NX - 1) * (NY - 1) };

struct sheet {
    double uv[VERTICES][2];
    uint32_t corner[TRIANGLES][4];
    phys_vec gradient[TRIANGLES];
    double area[TRIANGLES];
    struct phys_membrane membrane[2];
    struct phys_elements triangles;
};

static inline int is_inner(int i)
{
    return i % NX > 0 && i % NX < NX - 1 && i / NX > 0 && i / NX < NY - 1;
}

static inline void make_sheet(struct sheet *s, double damping)
{
    static const double shift[][2] = {{0.11, -0.07}, {-0.09, 0.13}, {0.05, 0.08}, {-0.12, -0.03}};
    int inner = 0;
    for (int i = 0; i < VERTICES; i++) {
        s->uv[i][0] = 0.4 * (i % NX);
        s->uv[i][1] = 0.3 * (i / NX);
        for (int c = 0; is_inner(i) && c < 2; c++)
            s->uv[i][c] += shift[inner][c];
        inner += is_inner(i);
    }
    uint32_t t = 0;
    for (uint32_t j = 0; j + 1 < NY; j++)
        for (uint32_t i = 0; i + 1 < NX; i++) {
            const uint32_t a = j * NX + i, b = a + 1, c = a + NX, d = c + 1;
            memcpy(s->corner[t], ((uint32_t[]){a, b, d, t % 2}), sizeof s->corner[t]);
            t++;
            memcpy(s->corner[t], ((uint32_t[]){d, c, a, 0}), sizeof s->corner[t]);
            t++;
        }
    ck_assert_int_eq(phys_membrane_make(WARP, WEFT, SHEAR, POISSON, damping, s->membrane), 0);
    s->membrane[1] = s->membrane[0];
    for (t = 0; t < TRIANGLES; t++) {
        double uv[6], gradient[4];
        for (int k = 0; k < 3; k++)
            memcpy(uv + 2 * k, s->uv[s->corner[t][k]], 2 * sizeof *uv);
        ck_assert_int_eq(phys_triangle_rest(uv, gradient, s->area + t), 0);
        s->gradient[t] = (phys_vec){gradient[0], gradient[1], gradient[2], gradient[3]};
    }
    s->triangles = (struct phys_elements){.n = TRIANGLES,
                                          .corner = s->corner,
                                          .vector = s->gradient,
                                          .number = {[PHYS_TRIANGLE_AREA] = s->area},
                                          .material = s->membrane};
}

/* The sheet under the map (u, v) -> fu u + fv v. */
static inline void place(const struct sheet *s, const phys_vec *fu, const phys_vec *fv,
                         struct elements_state *state)
{
    *state = (struct elements_state){.n = VERTICES};
    for (int i = 0; i < VERTICES; i++)
        state->x[i] = s->uv[i][0] * *fu + s->uv[i][1] * *fv;
}

static inline void forces(const struct sheet *s, const struct elements_state *state, phys_vec *f)
{
    const struct phys_sight sight = {VERTICES, state->x, state->v, NULL, NULL};
    memset(f, 0, VERTICES * sizeof *f);
    phys_triangles_force(&s->triangles, NULL, &sight, f);
}

static inline void stiffness(const void *of, int full, double scale, const struct phys_sight *sight,
                             phys_vec *y)
{
    const struct phys_step step = {sqrt(scale), full};
    struct phys_pair pair[3 * TRIANGLES];
    phys_triangles_system(of, 0, TRIANGLES, &step, 0, sight, NULL, y, pair);
}
static inline void matrix(const void *of, const struct phys_step *step,
                          const struct phys_sight *sight, struct phys_pair *pair)
{
    const struct phys_elements *t = of;
    phys_triangles_matrix(t, 0, 5, step, sight, NULL,
                          pair); /* in two parts, neither a multiple of 4 */
    phys_triangles_matrix(t, 5, t->n, step, sight, NULL, pair + 15);
}

/* Bent, stretched and shaken. */
static inline void shaken(const struct sheet *s, double size, struct elements_state *state)
{
    const phys_vec fu = {0.9, 0.3, 0.2, 0}, fv = {-0.2, 1.1, 0.3, 0};
    place(s, &fu, &fv, state);
    elements_shake(state, size, 7);
}

#endif
