/* The least number of iterations after which an error is small enough. Each count that is tried is
 * a solve from the beginning, so few are. */
#include "bench/cg/cg.h"

#include <math.h>

/* Between two counts: too few, and enough. */
struct bracket {
    uint32_t low, high;
    double at_low, at_high; /* their errors; before the first iteration it is 1 */
};

/* Tries a count, which becomes one end. */
static int try(const struct cg_solver *solver, double wanted, uint32_t count, struct bracket *to)
{
    double error = INFINITY;
    const int code = solver->error_after(solver->context, count, &error);
    if (!(error <= wanted)) { /* nor is what is no number */
        to->low = count;
        to->at_low = fmin(error, 1);
    } else {
        to->high = count;
        to->at_high = error;
    }
    return code;
}

/* Where the error is as wanted if its logarithm falls evenly between the ends; inside of them. */
static uint32_t estimate(const struct bracket *b, double wanted)
{
    const double part = log(b->at_low / wanted) / log(b->at_low / fmax(b->at_high, 1e-12));
    const uint32_t width = b->high - b->low, more = (uint32_t)(part * width);
    return b->low + (more < 1 ? 1 : more < width - 1 ? more : width - 1);
}

/* How many more are to be tried than what was too few: with a guess, as many as it takes if the
 * logarithm falls on as it did, between an eighth and all of them. */
static uint32_t more(const struct bracket *b, double wanted, uint32_t guess)
{
    const double part = log(wanted) / log(fmin(b->at_low, 0.99)) - 1;
    return guess ? 1 + (uint32_t)(fmin(fmax(part, 0.125), 1) * b->low) : b->low;
}

int cg_search(const struct cg_solver *solver, double wanted, uint32_t guess, uint32_t *needed)
{
    enum { MOST = 40000, HALVED = 4 };
    struct bracket b = {.at_low = 1};
    int code = 0;
    for (uint32_t n = guess ? guess : 1; !code && !b.high && n < MOST; n += more(&b, wanted, guess))
        code = try(solver, wanted, n, &b);
    if (!code && !b.high)
        return serve_fail("there is no error of %g after so many iterations", wanted);
    for (int i = 1; !code && b.high - b.low > 1 + b.high / 100; i++) {
        const bool halves = !guess || i % HALVED == 0;
        code =
            try(solver, wanted, halves ? b.low + (b.high - b.low) / 2 : estimate(&b, wanted), &b);
    }
    *needed = b.high;
    return code;
}
