/* The vectors of a solve and its factors. Rows are worked on one by one, ascending. */
#include "cloth/solve/block.h"

#include <math.h>
#include <string.h>

struct solve_scalars solve_scalars_start(double step, double phase)
{
    return (struct solve_scalars){
        .phase = phase, .alpha = 1, .wanted = -1, .step = step, .stride = 1};
}

/* A residual is noise when its square is less than this fraction of the right side's: only rounding
 * is left, whose r.z may be anything. */
#define NOISE 1e-26

/* NaN never counts as converged. The square of a small tolerance may be zero: then nothing is small
 * enough. */
static bool small_enough(double square, double wanted)
{
    return isfinite(square) && (square <= wanted || square < SOLVE_NOTHING);
}

static double solve_cg_wanted(const struct solve_stop *stop, double square)
{
    const double tolerance = stop->tolerance * stop->tolerance;
    return stop->relative ? tolerance * square : tolerance;
}

/* The delay of the error's estimate: at least so many iterations, and this share of all. */
enum { WINDOW = 5, SHARE = 6 };

/* Terms that do not fall by this factor give no estimate. */
#define FALLING 0.9

double solve_scalars_error(const struct solve_scalars *scalars, double bound)
{
    const int stride = (int)scalars->stride, now = (int)(scalars->iterations / scalars->stride);
    const int share = now / SHARE, least = (WINDOW + stride - 1) / stride;
    const int window = share > least ? share : least;
    if (now < 2 * window)
        return bound;
    const double middle = scalars->past[now - window];
    const double known = scalars->energy - middle;
    const double before = middle - scalars->past[now - 2 * window];
    if (!(known <= FALLING * before))
        return bound;
    const double error = known / (1 - known / before);
    return error < bound ? error : bound;
}

/* Adds a term to the energy. The past keeps every stride-th sum. */
static void remember(double term, struct solve_scalars *after)
{
    after->energy += term;
    if (after->iterations == SOLVE_PAST * after->stride) {
        for (int i = 0; i < SOLVE_PAST / 2; i++)
            after->past[i] = after->past[2 * i];
        after->stride *= 2;
    }
    const int at = (int)(after->iterations / after->stride);
    if (at * after->stride == after->iterations)
        after->past[at] = after->energy;
}

/* The largest r.D^-1 r that ends a solve. */
static double normalised(const struct solve_stop *stop, const struct solve_scalars *now)
{
    return stop->tolerance * stop->tolerance * now->unit;
}

/* True if dv is good enough. */
static bool reached(const struct solve_stop *stop, const struct solve_scalars *now)
{
    if (stop->count)
        return false;
    if (stop->normalised)
        return small_enough(now->square, 0) || now->bound <= normalised(stop, now);
    if (!stop->mass_norm || now->square < SOLVE_NOTHING)
        return small_enough(now->square, stop->mass_norm ? 0 : now->wanted);
    return isfinite(now->square) &&
           solve_scalars_error(now, now->bound) <= stop->tolerance * stop->tolerance * now->size;
}

/* alpha and beta of the next pass. Both are 0 if r is zero. */
static int next_factors(const double dots[SOLVE_DOTS], struct solve_scalars *after)
{
    const double product = dots[SOLVE_RZ];
    after->alpha = after->beta = 0;
    if (after->square < SOLVE_NOTHING)
        return SOLVE_OK;
    const double alpha = product / after->curvature;
    if (!isfinite(after->curvature) || !isfinite(product) || product <= 0 || !(alpha > 0)) {
        const double rubbish = NOISE * after->first;
        return isfinite(rubbish) && after->square <= rubbish ? SOLVE_OK : SOLVE_BREAKDOWN;
    }
    after->alpha = alpha;
    const double next = product - 2 * alpha * dots[SOLVE_RQ] + alpha * alpha * dots[SOLVE_QQ];
    after->beta = next > 0 ? next / product : 0; /* rounding may make a zero negative */
    return SOLVE_OK;
}

/* Ends a solve that came to nothing. */
static int solve_cg_fail(int code, struct solve_scalars *after)
{
    after->outcome = code;
    if (code)
        after->phase = SOLVE_DONE;
    return code;
}

/* A residual may be so much larger than its recurrence, squares. */
#define ALIKE 4

/* A restart is the last one if it leaves more than this part of the residual refused before. */
#define HELPS 0.25

/* Checks the true residual: done if it is small enough, else another start, or failure if starts do
 * not help. */
static int judge(const struct solve_stop *stop, const double dots[SOLVE_DOTS],
                 struct solve_scalars *after)
{
    double left = dots[SOLVE_RR], max = ALIKE * after->wanted;
    if (stop->mass_norm) {
        left = dots[SOLVE_DRIFT];
        max = stop->tolerance * stop->tolerance * dots[SOLVE_SIZE];
    } else if (stop->normalised) {
        left = dots[SOLVE_BOUND];
        max = ALIKE * normalised(stop, after);
    }
    after->drift = dots[SOLVE_DRIFT];
    after->phase = SOLVE_DONE;
    if (small_enough(left, max))
        return SOLVE_OK;
    const bool helps = after->restarts == 0 || left < HELPS * after->refused;
    after->refused = left;
    if (!helps || after->restarts == SOLVE_RESTARTS)
        return solve_cg_fail(SOLVE_STALLED, after);
    after->phase = SOLVE_AGAIN;
    after->alpha = 0;
    after->restarts += 1;
    after->spent += after->iterations;
    after->iterations = after->energy = 0;
    after->stride = 1;
    return SOLVE_OK;
}

/* How much of a guess to take. */
static int open(const struct solve_stop *stop, const double dots[SOLVE_DOTS],
                struct solve_scalars *after)
{
    after->first = dots[SOLVE_RR];
    after->wanted = solve_cg_wanted(stop, dots[SOLVE_RR]);
    after->alpha = dots[SOLVE_PQ] > 0 ? dots[SOLVE_RQ] / dots[SOLVE_PQ] : 0;
    after->phase = SOLVE_AGAIN;
    return SOLVE_OK;
}

/* dv is good enough by r. One that is nothing is as it was taken to be. */
static int arrive(const struct solve_stop *stop, struct solve_scalars *after)
{
    const bool known = after->iterations + after->restarts == 0;
    after->phase = stop->confirm && !known ? SOLVE_SHOW : SOLVE_DONE;
    return SOLVE_OK;
}

/* Looks at the residual. Returns true if that ends the solve, or its iterations: *code says how. */
static bool ends(const struct solve_stop *stop, struct solve_scalars *after, int *code)
{
    if (after->iterations == 0)
        after->first = fmax(after->first, after->square);
    if (after->wanted < 0)
        after->wanted = solve_cg_wanted(stop, after->square);
    if (reached(stop, after)) {
        *code = arrive(stop, after);
        return true;
    }
    if (solve_scalars_iterations(after) < stop->max)
        return false;
    *code = solve_cg_fail(stop->count ? SOLVE_OK : SOLVE_NOT_CONVERGED, after);
    return true;
}

/* Takes the factors of the next pass from one of SOLVE_ON. */
static int solve_cg_iterate(const struct solve_stop *stop, const double dots[SOLVE_DOTS],
                            struct solve_scalars *after)
{
    int code;
    if (ends(stop, after, &code))
        return code;
    after->iterations += 1;
    after->phase = stop->count && after->iterations == stop->max ? SOLVE_LAST : SOLVE_ON;
    code = next_factors(dots, after);
    remember(after->alpha * dots[SOLVE_RZ], after);
    return solve_cg_fail(code, after);
}

int solve_scalars_next(const struct solve_stop *stop, const double dots[SOLVE_DOTS],
                       const struct solve_scalars *before, struct solve_scalars *after)
{
    *after = *before;
    if (before->phase == SOLVE_DONE)
        return SOLVE_OK;
    if (before->phase == SOLVE_SHOW || before->phase == SOLVE_AGAIN) { /* sum nothing */
        after->phase = before->phase == SOLVE_SHOW ? SOLVE_CHECK : SOLVE_ON;
        after->alpha = 1;
        after->beta = 0;
        return SOLVE_OK;
    }
    after->square = dots[SOLVE_RR];
    after->size = dots[SOLVE_SIZE];
    after->bound = dots[SOLVE_BOUND];
    if (before->phase == SOLVE_CHECK)
        return judge(stop, dots, after);
    if (before->phase == SOLVE_OPEN)
        return open(stop, dots, after);
    after->phase = SOLVE_DONE;
    after->curvature = dots[SOLVE_PQ];
    return before->phase == SOLVE_LAST ? SOLVE_OK : solve_cg_iterate(stop, dots, after);
}

PHYS_KERNEL_OF(struct solve_norms, solve_norms,
               (size_t n, const double *restrict diagonal, const phys_vec *restrict dv,
                const phys_vec *restrict r),
               (n, diagonal, dv, r))
{
    phys_vec size = {0}, bound = {0};
    for (size_t a = 0; a < n; a++) {
        size += diagonal[a] * (dv[a] * dv[a]);
        bound += (r[a] * r[a]) / diagonal[a];
    }
    return (struct solve_norms){phys_lanes(&size), phys_lanes(&bound)};
}

PHYS_KERNEL(solve_start,
            (size_t n, const double *restrict free, const phys_vec *restrict b,
             phys_vec *restrict dv, phys_vec *restrict r, phys_vec *restrict p,
             phys_vec *restrict q),
            (n, free, b, dv, r, p, q))
{
    for (size_t a = 0; a < n; a++)
        q[a] = -(free[a] * b[a]);
    memset(dv, 0, n * sizeof *dv);
    memset(r, 0, n * sizeof *r);
    memset(p, 0, n * sizeof *p);
}

PHYS_KERNEL(solve_start_guess,
            (size_t n, const double *restrict free, const phys_vec *restrict filter,
             const phys_vec *restrict b, double part, phys_vec *restrict dv, phys_vec *restrict r,
             phys_vec *restrict p, phys_vec *restrict q),
            (n, free, filter, b, part, dv, r, p, q))
{
    for (size_t a = 0; a < n; a++) {
        dv[a] = (part * free[a]) * dv[a];
        r[a] = free[a] * b[a];
    }
    for (size_t a = 0; a < n && filter; a++)
        solve_filter(filter + a, dv + a);
    memset(p, 0, n * sizeof *p);
    memset(q, 0, n * sizeof *q);
}

PHYS_KERNEL_OF(double, solve_finish,
               (size_t n, double alpha, const phys_vec *restrict q, const phys_vec *restrict p,
                phys_vec *restrict dv, phys_vec *restrict r),
               (n, alpha, q, p, dv, r))
{
    phys_vec dot = {0};
    for (size_t a = 0; a < n; a++) {
        dv[a] += alpha * p[a];
        r[a] -= alpha * q[a];
        dot += r[a] * r[a];
    }
    return phys_lanes(&dot);
}

PHYS_KERNEL(solve_renew,
            (size_t n, const double *restrict free, const double *restrict diagonal,
             const phys_vec *restrict b, const phys_vec *restrict q, phys_vec *restrict r,
             double dots[SOLVE_DOTS]),
            (n, free, diagonal, b, q, r, dots))
{
    phys_vec square = {0}, drift = {0};
    for (size_t a = 0; a < n; a++) {
        const phys_vec before = r[a];
        r[a] = free[a] * b[a] - q[a];
        square += r[a] * r[a];
        drift += ((r[a] - before) * (r[a] - before)) / diagonal[a];
    }
    dots[SOLVE_RR] = phys_lanes(&square);
    dots[SOLVE_DRIFT] = phys_lanes(&drift);
}

PHYS_KERNEL(solve_again,
            (size_t n, phys_vec *restrict r, phys_vec *restrict p, phys_vec *restrict q),
            (n, r, p, q))
{
    for (size_t a = 0; a < n; a++)
        q[a] = -r[a];
    memset(r, 0, n * sizeof *r);
    memset(p, 0, n * sizeof *p);
}

PHYS_KERNEL(solve_advance_ghosts,
            (size_t n, double alpha, double beta, const double *restrict s,
             const uint32_t *restrict at, phys_vec *restrict z, phys_vec *restrict p),
            (n, alpha, beta, s, at, z, p))
{
    for (size_t i = 0; i < n; i++) {
        const double *row = s + 3 * (size_t)at[i];
        const phys_vec value = PHYS_VEC(row);
        solve_advance(alpha, beta, &value, z + i, p + i);
    }
}

void solve_unpack(size_t n, const double *packed, const uint32_t *at, phys_vec *y)
{
    for (size_t i = 0; i < n; i++) {
        const double *row = packed + 3 * (size_t)at[i];
        y[i] = PHYS_VEC(row);
    }
}

void solve_pack(size_t n, const uint32_t *at, const phys_vec *q, double *packed)
{
    for (size_t i = 0; i < n; i++)
        memcpy(packed + 3 * i, q + at[i], 3 * sizeof *packed);
}
