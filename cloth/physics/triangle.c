/* Triangles are worked on in order, four at a time (detail/lanes.h). The force on corner 0 is minus
 * the sum of the two others, so that a triangle's forces sum to zero but for rounding. */
#include "cloth/physics/triangle.h"

#include "cloth/base/vector.h"
#include "cloth/physics/detail/membrane.h"

#include <math.h>
#include <string.h>

int phys_membrane_make(double warp, double weft, double shear, double poisson, double damping,
                       struct phys_membrane *membrane)
{
    const double product = poisson != 0 ? poisson * poisson * weft / warp : 0; /* nu12 nu21 */
    if (!(warp >= 0) || !(weft >= 0) || !(shear >= 0) || !(product < 1) || !isfinite(poisson) ||
        !isfinite(warp + weft + shear) || !(damping >= 0) || !isfinite(damping))
        return -1;
    const double c11 = warp / (1 - product), c22 = weft / (1 - product);
    *membrane =
        (struct phys_membrane){.modulus = {c11, poisson * c22, c22, shear}, .damping = damping};
    return 0;
}

size_t phys_stiffening_make(size_t n, const double (*point)[2], int thread,
                            struct phys_stiffening *stiffening, double *modulus)
{
    double strain = 0, stress = 0, before = 0;
    for (size_t i = 0; i < n; i++) {
        const double slope = (point[i][1] - stress) / (point[i][0] - strain);
        if (!(point[i][0] > strain) || !(point[i][1] > stress) || !isfinite(slope))
            return i;
        if (i == 0) {
            *modulus = slope;
        } else {
            stiffening->at[thread][i - 1] = strain;
            stiffening->more[thread][i - 1] = slope - before;
        }
        before = slope;
        strain = point[i][0];
        stress = point[i][1];
    }
    return n;
}

/* The least of the sums of `more` from the first knee on, or 0. */
static double least_more(const double more[PHYS_KNEES])
{
    double sum = 0, least = 0;
    for (int k = 0; k < PHYS_KNEES; k++) {
        sum += more[k];
        least = fmin(least, sum);
    }
    return least;
}

int phys_membrane_stiffen(struct phys_membrane *membrane, const struct phys_stiffening *stiffening)
{
    const phys_vec c = membrane->modulus;
    membrane->stiffening = *stiffening;
    membrane->curved = 0;
    for (int d = 0; d < 2; d++)
        for (int k = 0; k < PHYS_KNEES; k++)
            membrane->curved |= stiffening->more[d][k] < 0 || stiffening->more[d][k] > 0;
    const double c11 = c[0] + least_more(stiffening->more[0]);
    const double c22 = c[2] + least_more(stiffening->more[1]);
    return !membrane->curved || (c11 > 0 && c22 > 0 && c11 * c22 > c[1] * c[1]) ? 0 : -1;
}

int phys_triangle_rest(const double uv[6], double gradient[4], double *area)
{
    const double au = uv[2] - uv[0], av = uv[3] - uv[1];
    const double bu = uv[4] - uv[0], bv = uv[5] - uv[1];
    const double det = au * bv - av * bu;
    gradient[0] = bv / det;
    gradient[1] = -bu / det;
    gradient[2] = -av / det;
    gradient[3] = au / det;
    *area = 0.5 * fabs(det);
    for (int i = 0; i < 4; i++)
        if (!isfinite(gradient[i]))
            return -1;
    return *area > 0 && isfinite(*area) ? 0 : -1;
}

/* R of the map from uv to x, as phys_frame_polar finds it; 0 if it has none. */
static int directions(const double e[2][3], const double uv[6], double ru[3], double rv[3])
{
    double g[4], area, f[2][3], normal[3], turned[2][3];
    if (phys_triangle_rest(uv, g, &area))
        return 0;
    for (int i = 0; i < 3; i++) {
        f[0][i] = e[0][i] * g[0] + e[1][i] * g[2];
        f[1][i] = e[0][i] * g[1] + e[1][i] * g[3];
    }
    cloth_cross(f[0], f[1], normal);
    const double det = sqrt(cloth_dot(normal, normal));
    for (int i = 0; i < 3; i++)
        normal[i] /= det;
    const double trace = sqrt(cloth_dot(f[0], f[0]) + cloth_dot(f[1], f[1]) + 2 * det);
    cloth_cross(f[1], normal, turned[0]);
    cloth_cross(normal, f[0], turned[1]);
    for (int i = 0; i < 3; i++) {
        ru[i] = (f[0][i] + turned[0][i]) / trace;
        rv[i] = (f[1][i] + turned[1][i]) / trace;
    }
    return det > 0 && isfinite(trace);
}

void phys_triangle_local(const double x[9], const double uv[6], double local[6])
{
    double e[2][3], ru[3], rv[3], normal[3];
    for (int i = 0; i < 3; i++) {
        e[0][i] = x[3 + i] - x[i];
        e[1][i] = x[6 + i] - x[i];
    }
    if (!directions((const double(*)[3])e, uv, ru, rv)) {
        const double length = sqrt(cloth_dot(e[0], e[0]));
        cloth_cross(e[0], e[1], normal);
        const double area = sqrt(cloth_dot(normal, normal));
        for (int i = 0; i < 3; i++)
            ru[i] = length > 0 ? e[0][i] / length : 0;
        cloth_cross(normal, ru, rv);
        for (int i = 0; i < 3; i++)
            rv[i] = area > 0 ? rv[i] / area : 0;
    }
    local[0] = local[1] = 0;
    for (int i = 0; i < 2; i++) {
        local[2 + 2 * i] = cloth_dot(e[i], ru);
        local[3 + 2 * i] = cloth_dot(e[i], rv);
    }
}

PHYS_KERNEL(phys_triangles_force,
            (const struct phys_elements *t, const struct phys_air *air,
             const struct phys_sight *sight, phys_vec *f),
            (t, air, sight, f))
{
    (void)air;
    struct phys_moduli moduli = PHYS_NO_MODULI;
    for (size_t first = 0; first < t->n; first += PHYS_WIDE) {
        struct phys_four four;
        struct phys_frame frame;
        struct phys_wide vu, vv;
        struct phys_plane2 e, d, ds, s, stress, q;
        phys_vec w, c;
        phys_four_from(first, t->n, &four);
        phys_frame_make(t, &four, sight, &moduli, &frame);
        phys_frame_slope(t, &four, &frame, sight->n, sight->v, sight->v_ghost, &vu, &vv);
        phys_frame_inside(&frame, &vu, &vv, &d);
        phys_frame_change(&frame, &d, &w, &ds);
        phys_frame_strain(&frame, &e);
        e.uu += moduli.damping * ds.uu;
        e.uv += moduli.damping * ds.uv;
        e.vv += moduli.damping * ds.vv;
        phys_frame_stress(&frame, &e, &stress);
        phys_frame_stiffen(&frame, &stress, NULL);
        phys_frame_s(&frame, &s);
        phys_frame_twist(&frame, &stress, &s, &c);
        c *= moduli.corrected;
        phys_frame_untwist(&stress, &c, &q);
        phys_frame_push(t, &four, &frame, &q, NULL, sight->n, f);
    }
}

/* ---- Energy and strain of a state ---- */

PHYS_KERNEL_OF(double, phys_triangles_energy,
               (const struct phys_elements *t, const struct phys_sight *sight), (t, sight))
{
    double sum = 0;
    struct phys_moduli moduli = PHYS_NO_MODULI;
    for (size_t first = 0; first < t->n; first += PHYS_WIDE) {
        struct phys_four four;
        struct phys_frame frame;
        struct phys_plane2 e, s;
        phys_four_from(first, t->n, &four);
        phys_frame_make(t, &four, sight, &moduli, &frame);
        phys_frame_strain(&frame, &e);
        phys_frame_stress(&frame, &e, &s);
        phys_vec energy = 0.5 * frame.area * (s.uu * e.uu + s.vv * e.vv + 2 * s.uv * e.uv);
        phys_frame_stiffening_energy(&frame, &energy);
        sum = phys_sum_own(&four, t->corner, sight->n, &energy, sum);
    }
    return sum;
}

/* The larger eigenvalue of a symmetric matrix. */
PHYS_INLINE void larger_of(const struct phys_plane2 *e, phys_vec *largest)
{
    const phys_vec half = 0.5 * (e->uu - e->vv), square = half * half + e->uv * e->uv;
    phys_sqrt(&square, largest);
    *largest += 0.5 * (e->uu + e->vv);
}

PHYS_KERNEL(phys_triangles_strain,
            (const struct phys_elements *t, const struct phys_sight *sight, double *largest,
             double (*stress)[3]),
            (t, sight, largest, stress))
{
    struct phys_moduli moduli = PHYS_NO_MODULI;
    for (size_t first = 0; first < t->n; first += PHYS_WIDE) {
        struct phys_four four;
        struct phys_frame frame;
        struct phys_plane2 e, s;
        phys_vec larger;
        phys_four_from(first, t->n, &four);
        phys_frame_make(t, &four, sight, &moduli, &frame);
        phys_frame_strain(&frame, &e);
        phys_frame_stress(&frame, &e, &s);
        phys_frame_stiffen(&frame, &s, NULL);
        larger_of(&e, &larger);
        for (size_t i = 0; i < PHYS_WIDE && first + i < t->n; i++) {
            largest[first + i] = larger[i];
            if (stress)
                memcpy(stress[first + i], (double[3]){s.uu[i], s.vv[i], s.uv[i]}, sizeof *stress);
        }
    }
}

PHYS_KERNEL(phys_triangles_torque,
            (const struct phys_elements *t, const struct phys_sight *sight, double torque[3]),
            (t, sight, torque))
{
    struct phys_moduli moduli = PHYS_NO_MODULI;
    for (size_t first = 0; first < t->n; first += PHYS_WIDE) {
        struct phys_four four;
        struct phys_frame frame;
        struct phys_plane2 e, stress, s;
        phys_vec c;
        phys_four_from(first, t->n, &four);
        phys_frame_make(t, &four, sight, &moduli, &frame);
        phys_frame_strain(&frame, &e);
        phys_frame_stress(&frame, &e, &stress);
        phys_frame_stiffen(&frame, &stress, NULL);
        phys_frame_s(&frame, &s);
        phys_frame_twist(&frame, &stress, &s, &c);
        c *= -frame.area * frame.trace * (1 - moduli.corrected);
        for (int k = 0; k < 3; k++) {
            const phys_vec part = c * frame.normal.c[k];
            torque[k] = phys_sum_own(&four, t->corner, sight->n, &part, torque[k]);
        }
    }
}
