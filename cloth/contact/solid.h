#ifndef CLOTH_CONTACT_SOLID_H
#define CLOTH_CONTACT_SOLID_H

#include "cloth/contact/certificate.h"
#include "cloth/contact/shape.h"

/* Convex shapes (all kinds but bodies) against triangles of cloth, over a step. Pure functions of
 * + - * / and sqrt; nothing is allocated.
 *
 * Time s goes from 0, the begin of a step, to 1, its end. Each corner of a triangle moves straight
 * from x to y. Each point p of a shape's core moves straight, too, between its places F p and T p
 * by the poses at the begin and at the end: to (1-s) F p + s T p. The shape at s is all points
 * within its radius of the core at s. Balls and capsules keep their radius while they turn; points
 * of boxes and cylinders move along chords. A plane at s goes through the chord of its point and
 * has the normal (1-s) n0 + s n1 of its normals at both ends. At s = 0 and s = 1 these are the
 * shapes of contact_closest, so that a motion has no jump from step to step.
 *
 * The certificate. Let n(s) = (1-s) n0 + s n1 with directions n0, n1 of length 1. Along n(s), the
 * triangle minus the shape is at least the minimum, over corners k and points p of the core, of
 *     n(s) . ((1-s) x_k + s y_k - (1-s) F p - s T p) - radius,    for |n(s)| <= 1.
 * This is a polynomial of degree 2 in s. Its coefficients in Bernstein's basis are
 *     c0 = n0.(x_k - F p),  c1 = (n0.(y_k - T p) + n1.(x_k - F p)) / 2,  c2 = n1.(y_k - T p),
 * each minus the radius. Their minima over k and p bound it from below. The minima over p are the
 * support function of the core: along F' n0, (T' n0 + F' n1) / 2, T' n1 in the core's own axes. All
 * three above 0: the triangle never touches the shape, and is never nearer to it than the least.
 * With n0 = n1, a fixed normal, c1 >= (c0 + c2) / 2 follows of itself. A plane has only its own
 * normals. f(0) = c0 and f(1) = c2 must satisfy certificate.h. */

/* A convex shape over a step, as the functions below take it. */
struct contact_place {
    double axis[3][3]; /* of the core, by the room's */
    phys_vec at;       /* m: the core's middle */
};
struct contact_solid {
    struct contact_place place[2]; /* at the begin and at the end of the step */
    double half[3], radius;        /* as of struct contact_core */
    bool round, endless, moves;
    double rate; /* 1/s: as of struct contact_pose */
    double size; /* m: of the largest numbers that its places were made of */
};
enum contact_end { CONTACT_BEGIN, CONTACT_END };

/* A body gives the box around it, which serves contact_solid_apart alone. */
void contact_solid_make(const struct contact_shape *shape, const struct contact_pose *pose,
                        struct contact_solid *solid);

/* Where a point of a triangle lies: on corner k (+ k); edge k (+ k), which goes from corner k to
 * the next one; inside. */
enum { CONTACT_ON_CORNER = 0, CONTACT_ON_EDGE = 3, CONTACT_IN_TRIANGLE = 6 };

/* The point of a triangle that is nearest to a shape at one end of a step. */
struct contact_solid_point {
    double weight[3];  /* of the corners, >= 0, their sum 1 */
    phys_vec normal;   /* out of the shape, of length 1 */
    phys_vec velocity; /* m/s: of the shape there, by the chord of its way in the step */
    double gap;        /* m: below 0 where the triangle is in the shape */
    uint32_t feature;  /* where on the triangle */
};
/* Finds it for a triangle x (m) that is there at that end. To rounding, where the triangle does not
 * meet the core. It is one of several equally near points. If the triangle meets the core, normal
 * and gap are those of a way out that is short but need not be the shortest. */
void contact_solid_nearest(const struct contact_solid *solid, enum contact_end end,
                           const phys_vec x[3], struct contact_solid_point *to);

/* True if a triangle, its corners moving from x to y (m), provably never touches the shape in the
 * step. thickness: m. False for NaN. */
bool contact_solid_certify(const struct contact_solid *solid, const phys_vec x[3],
                           const phys_vec y[3], double thickness);

/* The same; CONTACT_PASSES_BY: the triangle is farther than reach (m, >= 0) from the shape at all
 * times of the step. Most such triangles are found at no extra cost. */
enum contact_passing contact_solid_pass(const struct contact_solid *solid, const phys_vec x[3],
                                        const phys_vec y[3], double thickness, double reach);

/* Lowers t, the parts (0 to 1) of the corners' ways, to certify the triangle from x to x + t (y -
 * x). It leaves t if it is certified already. A triangle that other pairs cut further must be
 * certified again: a direction that divided the longer ways mostly, but not always, divides the
 * shorter ones. held: bit k: corner k cannot be cut. Returns false, t unchanged, if it finds no
 * such parts: the shape goes where the triangle begins, or a corner that is held goes into it. */
bool contact_solid_cut(const struct contact_solid *solid, const phys_vec x[3], const phys_vec y[3],
                       double thickness, unsigned held, double t[3]);

/* True if no point of a box (m) is within reach (m) of the shape at any time of the step. The box
 * of a moving thing holds both ends of its way. False: some may be. */
bool contact_solid_apart(const struct contact_solid *solid, const double low[3],
                         const double high[3], double reach);

/* The most, m, that a point of the shape goes in the step; of a plane that moves INFINITY. */
double contact_solid_way(const struct contact_solid *solid);

#endif
