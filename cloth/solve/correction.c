/* Sums of two are the same in either order, and so is every product here. So two blocks that have
 * the same edge from different ends find the same bits. */
#include "cloth/solve/correction.h"

#include "cloth/solve/block.h"

#include <math.h>

/* s: in this time an edge that is too long falls to half of its excess, in one step. */
static const double RETURN = 0.01;

/* l, how long the edge may end. */
static double target_of(const struct solve_correction *c, const struct solve_edge *edge,
                        const struct solve_end end[2])
{
    const phys_vec begin = end[1].begin - end[0].begin;
    const double before = sqrt(phys_dot(&begin, &begin)) - edge->most;
    const double after = before / (1 + c->h / RETURN) - edge->slack;
    return edge->most + (after > 0 ? after : 0);
}

/* True if the edge turned by more than 60 degrees, or had no length. */
static bool correction_is_turned(const phys_vec *base, const phys_vec *d, double square)
{
    const double along = phys_dot(base, d);
    return !(along > 0 && 4 * along * along >= phys_dot(base, base) * square);
}

static double root_of(double p, double q, double beyond)
{
    const double square = p * p - q * beyond;
    return square >= 0 ? beyond / (p + sqrt(square)) : p / q;
}

bool solve_correct(const struct solve_correction *c, const struct solve_edge *edge,
                   const struct solve_end end[2], double share, phys_vec move[2],
                   struct solve_excess *excess)
{
    const phys_vec d = end[1].x - end[0].x, base = end[1].base - end[0].base;
    const double target = target_of(c, edge, end), square = phys_dot(&d, &d);
    const double over = sqrt(square) - target;
    const phys_vec line = correction_is_turned(&base, &d, square) ? d : base;
    for (int i = 0; i < 2; i++) {
        move[i] = line;
        solve_filter(&end[i].filter, move + i);
        move[i] *= end[i].w;
    }
    const phys_vec g = move[0] + move[1];
    const double p = phys_dot(&d, &g);
    if (!(over > 0) || !(p > 0))
        return false;
    if (over / edge->length > excess->most)
        excess->most = over / edge->length;
    if (!(over > c->part * edge->slack))
        return false;
    excess->corrected = 1;
    const double k = share * root_of(p, phys_dot(&g, &g), square - target * target);
    move[0] *= k;
    move[1] *= -k;
    return !c->measures;
}

double solve_correct_velocity(size_t n, double t, const double *mass, const phys_vec *moved,
                              phys_vec *v)
{
    double lost = 0;
    for (size_t i = 0; i < n; i++) {
        const phys_vec dv = moved[i] / t, mean = v[i] + 0.5 * dv;
        lost -= mass[i] * phys_dot(&mean, &dv);
        v[i] += dv;
    }
    return lost;
}

struct solve_rounds solve_rounds_start(double h, double t, double time)
{
    return (struct solve_rounds){.phase = SOLVE_ROUNDS_ON, .h = h, .t = t, .time = time};
}

struct solve_correction solve_rounds_correction(const struct solve_rounds *now)
{
    return (struct solve_correction){.h = now->h,
                                     .t = now->t,
                                     .part = now->rounds > 0,
                                     .measures = !(now->phase < SOLVE_ROUNDS_LOOK)};
}

struct solve_rounds solve_rounds_next(const struct solve_rounds *before,
                                      const struct solve_excess *found, double max)
{
    struct solve_rounds after = *before;
    const bool looks = !(before->phase < SOLVE_ROUNDS_LOOK), corrects = found->corrected > 0;
    if (!(before->phase > 0))
        return after;
    after.excess = found->most;
    after.unmet = looks && corrects;
    after.rounds += !looks && corrects;
    after.phase = SOLVE_ROUNDS_DONE;
    if (!looks && corrects)
        after.phase = after.rounds < max ? SOLVE_ROUNDS_ON : SOLVE_ROUNDS_LOOK;
    return after;
}
