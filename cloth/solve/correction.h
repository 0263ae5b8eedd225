#ifndef CLOTH_SOLVE_CORRECTION_H
#define CLOTH_SOLVE_CORRECTION_H

#include "cloth/physics/vec.h"

#include <stdbool.h>
#include <stdint.h>

/* Velocity correction (Vassilev, Spanlang & Chrysanthou 2001; the idea is Provot's, 1995). An edge
 * of length L at rest that would end a step longer than l0 = (1 + at) L gets an impulse p along a
 * line e. Its two ends share p by their inverse masses w, and the edge ends as long as it may be.
 * With x = X + t v where the step ends,
 *
 *     d = x1 - x0,   g = w0 S0 e + w1 S1 e,   x0 += k w0 S0 e,   x1 -= k w1 S1 e,   v += dx / t
 *     |d - k g| = l,   k = (|d|^2 - l^2) / (d.g + sqrt((d.g)^2 - |g|^2 (|d|^2 - l^2)))
 *
 * S keeps the directions that pins leave free (solve_filter); w is 0 where a pin holds. If no k
 * makes the edge short enough, k = d.g / |g|^2 makes it as short as this line can. Momentum stays,
 * since the two impulses are opposite. The angular momentum of x and v changes by (X1 - X0) x p. e
 * = X1 - X0, the edge at x - t v, keeps it. An edge that turns by more than 60 degrees between X
 * and x has e = d in its place: along the old line it hardly gets shorter.
 *
 * The velocities with |d| <= l are a convex set. With e = d the impulse is the projection onto it
 * in the norm of the masses. So each correction, and each mean of corrections, comes nearer to
 * every motion that keeps all limits, and rounds converge to one if there is any (Bregman 1967).
 * With e = X1 - X0 it differs by the square of the angle by which the edge turns in the step. A
 * resting cloth within its limits is such a motion, so corrections take kinetic energy away.
 *
 * An edge may be too long where the step begins, by b > 0. To be back at l0 at once it would need
 * the velocity b / h. So it may end too long by b / (1 + h / 0.01 s), less the tolerance:
 *
 *     l = l0 + max(0, b / (1 + h / 0.01 s) - tolerance L)
 *
 * Rounds leave at most tolerance L more than l. The excess of an edge falls by this factor in each
 * step until it is below tolerance L, and stays there. Pure functions. */

/* An edge with a limit, m. */
struct solve_edge {
    uint32_t end[2];
    double length, most, slack; /* L; l0; tolerance L > 0 */
};

/* How a round corrects edges. */
struct solve_correction {
    double h, t;   /* s: the step; t of x = X + t v */
    double part;   /* edges are corrected that are over l by more than this part of their slack */
    bool measures; /* the round looks only */
};

/* An end of an edge. */
struct solve_end {
    phys_vec x, base, begin, filter; /* m: now; X; where the step began; S */
    double w;                        /* 1/kg; 0: held */
};

/* The largest findings of a round over all edges. most: (|d| - l) / L before its correction.
 * corrected: 1 if an edge was corrected, or would have been in a round that looks only. Edges that
 * pins keep from getting shorter do not count. */
struct solve_excess {
    double most, corrected;
};

/* True if an edge is longer than its limit now. */
PHYS_INLINE bool solve_is_over(const struct solve_edge *edge, const phys_vec *a, const phys_vec *b)
{
    const phys_vec d = *b - *a;
    return phys_dot(&d, &d) > edge->most * edge->most;
}

/* Corrects an edge that is over its limit: writes the move of each end, m, times share. Returns
 * false if nothing moves. */
bool solve_correct(const struct solve_correction *correction, const struct solve_edge *edge,
                   const struct solve_end end[2], double share, phys_vec move[2],
                   struct solve_excess *excess);

/* Velocities v += moved / t of n rows of these masses, kg. Returns the kinetic energy that this
 * takes away, J. */
double solve_correct_velocity(size_t n, double t, const double *mass, const phys_vec *moved,
                              phys_vec *v);

/* The rounds of a step. */
enum { SOLVE_ROUNDS_DONE = 0, SOLVE_ROUNDS_ON = 1, SOLVE_ROUNDS_LOOK = 2 };
struct solve_rounds {
    double phase;         /* not 0 while rounds go on; LOOK: the last one looks only */
    double rounds;        /* that corrected something */
    double excess, unmet; /* largest that the last round found; 1: edges were left to correct */
    double h, t, time;    /* s: of the step; time: at its end */
};

enum { SOLVE_ROUNDS_NUMBERS = sizeof(struct solve_rounds) / sizeof(double) };

struct solve_rounds solve_rounds_start(double h, double t, double time);
/* The first round corrects all edges over their limit, later ones those over by more than their
 * slack. So a round that corrects nothing changes nothing, and is the last. After `max` rounds that
 * corrected, one looks only. */
struct solve_correction solve_rounds_correction(const struct solve_rounds *now);
struct solve_rounds solve_rounds_next(const struct solve_rounds *before,
                                      const struct solve_excess *found, double max);

#endif
