#ifndef CLOTH_SOLVE_CG_H
#define CLOTH_SOLVE_CG_H

#include "cloth/physics/vec.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Conjugate gradients on S A dv = S b, from dv = 0 or a guess, with one reduction an iteration. A
 * pass over all rows ends an iteration and begins the next one:
 *
 *     dv += alpha p,  r -= alpha q,  p = r + beta p,  q = S A p,  and the dots r.r, p.q, r.q, q.q
 *
 * From the dots come alpha = r.r / p.q and beta. The next r is not there yet, so beta takes its
 * square as |r - alpha q|^2 = r.r - 2 alpha r.q + alpha^2 q.q. A recurrence that goes on from this
 * number is unstable (Saad 1985). Here the number serves one iteration, and the next pass has the
 * true r.r (Meurant 1987). So the residual is as good as with two reductions. Rows of q and dots,
 * which other ranks need, are ready at the same time. */

/* With a preconditioner M, symmetric and positive definite, the vectors z = M^-1 r and s = M^-1 q
 * are kept beside r and q:
 *
 *     dv += alpha p,  r -= alpha q,  z -= alpha s,  p = z + beta p,  q = S A p,  s = M^-1 q
 *
 * with alpha = r.z / p.q and beta = (r.z - 2 alpha z.q + alpha^2 q.s) / r.z. This is one reduction
 * again, which may also carry the parts of q that a coarse part of M^-1 needs. Without a
 * preconditioner M is the identity: z is r and s is q, the same vectors. */

/* The recurrence gives r, which drifts from the residual S (b - A dv) by rounding. A solve that
 * ends by r alone may be wrong without noticing it. So `confirm` adds two passes. The first shows
 * dv to the neighbours (SOLVE_SHOW). The second has q = S A dv, and with it the true residual,
 * which takes the place of r (SOLVE_CHECK). If the true residual is too large, the solve goes on
 * from dv (SOLVE_AGAIN), at most SOLVE_RESTARTS times, and only while that helps. */

/* A solve may begin with a guess g instead of dv = 0; this costs a pass and a half. It makes q = S
 * A g first (SOLVE_OPEN), then begins again (SOLVE_AGAIN) from dv = alpha g with alpha = g.b / g.q.
 * This is the multiple of g that is nearest to the solution in the norm of A. It is never farther
 * from the solution than dv = 0 (Fischer 1998, for one vector). */

/* The sums of a pass. RQ is z.q, QQ is q.s; SIZE and BOUND are those of solve_norms, for stops by
 * norms only (mass_norm, normalised). DRIFT, in SOLVE_CHECK, is d.D^-1 d of the difference d of the
 * true residual and r. */
enum { SOLVE_RR, SOLVE_PQ, SOLVE_RQ, SOLVE_QQ, SOLVE_RZ, SOLVE_SIZE, SOLVE_BOUND, SOLVE_DOTS };
enum { SOLVE_DRIFT = SOLVE_PQ };

/* A residual with r.r below this ((kg m/s)^2) is zero: p.Ap is about r.r times a mass, and would
 * underflow before r.r does. */
#define SOLVE_NOTHING 1e-280

/* When to stop. */
struct solve_stop {
    bool count;      /* after exactly `max` iterations, without a look at the residual */
    bool relative;   /* tolerance is against |S b|, else absolute (kg m/s) */
    bool normalised; /* tolerance is against sqrt(r.D^-1 r / unit), below */
    bool mass_norm;  /* tolerance is of the error against dv, both in the mass norm */
    bool confirm; /* by the true residual, which may be twice as large as the tolerance says; with
                   * mass_norm its difference from r, in D^-1, may be as large as the error */
    double tolerance;
    uint32_t max; /* a solve that needs more iterations has failed */
};

/* A residual of no unit: Zara (2001) asks for one that is normalised by time step, masses and
 * distances. With D the masses, r.D^-1 r is the mass times the square of the velocity that r stands
 * for. Its unit is m (l/h)^2, with m the mass of all free rows and l a distance of the mesh. So the
 * root, e = (h / l) sqrt(r.D^-1 r / m), is how far r moves a row in the step, root mean square by
 * mass, against l. As A >= D, dv errs by no more than that. */

/* The error of dv, and when it is small. The mass norm is |y|^2 = y.D y, D the diagonal that A has
 * besides springs: masses, kg, with h times the drag. A - D is positive semidefinite. So the error
 * is at most r.D^-1 r, which is far too much unless r is nearly zero. It is also at most its norm
 * in A. After k iterations this norm is the sum over all j >= k of alpha_j r_j.z_j (Hestenes &
 * Stiefel 1952, theorem 6:1). After m more iterations S, the first m terms of this sum, are known.
 * They count as far as terms fall. With P the m terms before, the whole sum is estimated as the
 * geometric series S / (1 - S / P), if S is at most 0.9 P. The delay m is a sixth of all
 * iterations, at least 5: where conjugate gradients stagnate, a fixed delay (Strakos & Tichy 2002)
 * fails. The estimate is of the error m iterations ago; that of dv is smaller. */

/* Kinds of the next pass. Numbers are doubles: the structure is a shared object. */
enum {
    SOLVE_DONE,
    SOLVE_LAST,  /* dv and r only */
    SOLVE_ON,    /* all of a pass */
    SOLVE_SHOW,  /* neighbours get dv for q */
    SOLVE_CHECK, /* solve_residual */
    SOLVE_AGAIN, /* dv += alpha p, r -= alpha q, then solve_again */
    SOLVE_OPEN   /* solve_open: the first one of a solve with a guess */
};
enum { SOLVE_PAST = 64 };
struct solve_scalars {
    double phase; /* first: not zero while there is something to do */
    double alpha, beta;
    double iterations;  /* that dv has had after the next pass since the solve began (again) */
    double spent;       /* before that */
    double restarts;    /* how often it began again */
    double wanted;      /* (kg m/s)^2: r.r at which to stop; negative: not known yet */
    double unit;        /* kg m^2/s^2: the caller's, of a normalised residual */
    double square;      /* r.r of the last pass */
    double curvature;   /* p.q of the last pass */
    double outcome;     /* of the solve: SOLVE_OK ..., below */
    double step, last;  /* the caller's */
    double first;       /* r.r before the first pass, or b.b, if that is more */
    double size, bound; /* dv.D dv, r.D^-1 r of the last pass */
    double drift;       /* SOLVE_DRIFT of the last check, kg m^2/s^2 */
    double refused;     /* by the last check: r.r, or with mass_norm the drift */
    double energy;      /* sum of alpha r.z over all iterations, (kg m^2/s^2) */
    double stride;      /* past[i] is what it was after i stride iterations, i > 0 */
    double past[SOLVE_PAST];
};
enum { SOLVE_SCALARS = sizeof(struct solve_scalars) / sizeof(double) };

/* Before the first pass, which is SOLVE_ON, or with a guess SOLVE_OPEN; `last` is zero. */
struct solve_scalars solve_scalars_start(double step, double phase);

/* Finds the next pass from the dots of one. Returns SOLVE_OK, or why there is no next pass: p.Ap is
 * not positive; the iterations were not enough; or the true residual stays above the tolerance.
 * `after` has the numbers in any case, and keeps the outcome. */
enum { SOLVE_OK, SOLVE_BREAKDOWN, SOLVE_NOT_CONVERGED, SOLVE_STALLED };
int solve_scalars_next(const struct solve_stop *stop, const double dots[SOLVE_DOTS],
                       const struct solve_scalars *before, struct solve_scalars *after);

/* Passes besides the iterations that a solve has at most. */
enum { SOLVE_RESTARTS = 3, SOLVE_EXTRA = 3 + 4 * (1 + SOLVE_RESTARTS) };

/* An upper estimate of the square of the error of dv in the mass norm; bound: r.D^-1 r. */
double solve_scalars_error(const struct solve_scalars *scalars, double bound);

/* Iterations of the whole solve. */
static inline double solve_scalars_iterations(const struct solve_scalars *scalars)
{
    return scalars->spent + scalars->iterations;
}

/* dv.D dv and r.D^-1 r of n rows; r is zero in held ones. */
struct solve_norms {
    double size, bound;
};
struct solve_norms solve_norms(size_t n, const double *diagonal, const phys_vec *dv,
                               const phys_vec *r);

/* Vectors of a block before the first pass, n rows: dv = r = p = 0, q = - S b. With alpha = 1 and
 * beta = 0 the first pass makes r = p = S b of them. */
void solve_start(size_t n, const double *free, const phys_vec *b, phys_vec *dv, phys_vec *r,
                 phys_vec *p, phys_vec *q);

/* z -= alpha s, p = z + beta p of one row: the recurrence of the first half of a pass. All code
 * that advances a row or a ghost calls this function, so that all of them have the same bits. */
PHYS_INLINE void solve_advance(double alpha, double beta, const phys_vec *s, phys_vec *z,
                               phys_vec *p)
{
    const phys_vec left = *z - alpha * *s;
    *z = left;
    *p = left + beta * *p;
}

/* The work of the last pass (SOLVE_LAST): dv += alpha p, r -= alpha q. Returns r.r. */
double solve_finish(size_t n, double alpha, const phys_vec *q, const phys_vec *p, phys_vec *dv,
                    phys_vec *r);

/* r = S b - q, with q = S A dv. Writes r.r and the drift from the old r. */
void solve_renew(size_t n, const double *free, const double *diagonal, const phys_vec *b,
                 const phys_vec *q, phys_vec *r, double dots[SOLVE_DOTS]);

/* Starts a solve with a guess in dv: multiplies dv by `part` S, sets r = S b, p = q = 0. filter:
 * that of the matrix (cloth/solve/block.h), or NULL. */
void solve_start_guess(size_t n, const double *free, const phys_vec *filter, const phys_vec *b,
                       double part, phys_vec *dv, phys_vec *r, phys_vec *p, phys_vec *q);

/* Begins a solve again from dv, with the true residual in r: makes the vectors as solve_start does,
 * except for dv. */
void solve_again(size_t n, phys_vec *r, phys_vec *p, phys_vec *q);

/* z and p of ghosts of another block's rows: n rows, row i has its s in s[3 at[i]] and the two
 * numbers behind it. */
void solve_advance_ghosts(size_t n, double alpha, double beta, const double *s, const uint32_t *at,
                          phys_vec *z, phys_vec *p);

/* Those rows alone: y[i] has the three numbers from packed[3 at[i]] on. */
void solve_unpack(size_t n, const double *packed, const uint32_t *at, phys_vec *y);

/* Rows at[0] .. at[n - 1] of q, three numbers each, for the neighbours. */
void solve_pack(size_t n, const uint32_t *at, const phys_vec *q, double *packed);

#endif
