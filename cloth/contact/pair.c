/* Ways between features are found from differences against corner 0, so that where the pair is in
 * the room costs no digits. */
#include "cloth/contact/direction.h"

#include <math.h>

/* Makes it 1 long; false for nothing, or what is too short for that. */
static bool make_unit(double n[3])
{
    const double length = sqrt(contact_dot(n, n));
    if (!(length > CONTACT_TINY) || isinf(length))
        return false;
    for (int c = 0; c < 3; c++)
        n[c] /= length;
    return true;
}

/* ---- The best of all directions ---- */

struct best {
    enum contact_pair pair;
    const struct contact_lanes *lanes;
    double apart, n[3];
};

static void best_try(struct best *best, const double n[3])
{
    double unit[3] = {n[0], n[1], n[2]};
    phys_vec along;
    if (!make_unit(unit))
        return;
    contact_along(best->lanes, unit, &along);
    const double apart = contact_apart(best->pair, &along);
    if (!(apart > best->apart))
        return;
    best->apart = apart;
    for (int c = 0; c < 3; c++)
        best->n[c] = unit[c];
}

/* Takes out of a direction what it has along an edge: where the way is short, the rounding of its
 * ends. */
static void best_try_across(struct best *best, const struct contact_ends *ends, int lane)
{
    double edge[3], n[3];
    for (int c = 0; c < 3; c++)
        edge[c] = ends->edge.c[c][lane];
    contact_ends_way(best->pair, ends, lane, n);
    if (!make_unit(n) || !make_unit(edge))
        return;
    const double slope = contact_dot(n, edge);
    for (int c = 0; c < 3; c++)
        n[c] -= slope * edge[c];
    best_try(best, n);
}

double contact_direction_best(enum contact_pair pair, const phys_vec x[4], double n[3])
{
    struct contact_lanes lanes;
    struct contact_across across;
    struct contact_ends ends;
    struct best best = {.pair = pair, .lanes = &lanes, .apart = -INFINITY};
    double way[3];
    contact_lanes_of(x, x, &lanes);
    contact_across_of(pair, x, &across);
    contact_ends_of(pair, &lanes, &ends);
    contact_turn(pair, &across, way);
    best_try(&best, way);
    for (int lane = 0; lane < 4; lane++) {
        contact_ends_way(pair, &ends, lane, way);
        best_try(&best, way);
        best_try_across(&best, &ends, lane);
    }
    for (int c = 0; c < 3; c++)
        n[c] = best.n[c];
    return best.apart > -INFINITY ? best.apart : 0;
}

/* ---- The closest points ---- */

static void weigh_inside(enum contact_pair pair, const struct contact_across *a,
                         struct contact_nearest *to)
{
    const double u = a->u / a->square, v = a->v / a->square;
    double *weight = to->weight;
    if (pair == CONTACT_VT) {
        weight[0] = 1;
        weight[1] = -fmax(1 - u - v, 0);
        weight[2] = -u;
        weight[3] = -v;
        return;
    }
    weight[0] = 1 - u;
    weight[1] = u;
    weight[2] = -(1 + v);
    weight[3] = v;
}

/* Of VT, lane k is the edge from corner 1 + k to the next; of EE it is vertex k, against the edge
 * that it is not of. */
static void weigh_end(enum contact_pair pair, double part, int lane, struct contact_nearest *to)
{
    double *weight = to->weight;
    for (int k = 0; k < 4; k++)
        weight[k] = 0;
    if (pair == CONTACT_VT) {
        weight[0] = 1;
        weight[1 + lane % 3] = -(1 - part);
        weight[1 + (lane + 1) % 3] = -part;
        return;
    }
    const double sign = lane < 2 ? 1 : -1;
    const int edge = lane < 2 ? 2 : 0;
    weight[lane] = sign;
    weight[edge] = -sign * (1 - part);
    weight[edge + 1] = -sign * part;
}

/* A direction across both features where they touch. */
static void find_normal(enum contact_pair pair, const struct contact_across *across,
                        const struct contact_ends *ends, int lane, double n[3])
{
    double edge[3];
    contact_turn(pair, across, n);
    if (!across->flat && make_unit(n))
        return;
    int least = 0;
    for (int c = 0; c < 3; c++)
        edge[c] = ends->edge.c[c][lane];
    for (int c = 1; c < 3; c++)
        if (fabs(edge[c]) < fabs(edge[least]))
            least = c;
    const double axis[3] = {least == 0, least == 1, least == 2};
    contact_product(axis, edge, n);
    if (make_unit(n))
        return;
    for (int c = 0; c < 3; c++)
        n[c] = axis[c];
}

void contact_nearest_of(enum contact_pair pair, const phys_vec x[4], struct contact_nearest *to)
{
    static const double ROUNDING = 1e-14; /* of the size: what differences of points are off */
    struct contact_lanes lanes;
    struct contact_across across;
    struct contact_ends ends;
    double n[3];
    contact_lanes_of(x, x, &lanes);
    contact_across_of(pair, x, &across);
    contact_ends_of(pair, &lanes, &ends);
    const int lane = contact_ends_least(&ends);
    if (contact_inside(pair, &across)) {
        weigh_inside(pair, &across, to);
        contact_turn(pair, &across, n);
        to->gap = fabs(across.height) / sqrt(across.square);
        make_unit(n);
    } else {
        weigh_end(pair, ends.part[lane], lane, to);
        contact_ends_way(pair, &ends, lane, n);
        to->gap = sqrt(contact_dot(n, n));
        const phys_vec size =
            lanes.c[0] * lanes.c[0] + lanes.c[1] * lanes.c[1] + lanes.c[2] * lanes.c[2];
        if (!(to->gap > ROUNDING * sqrt(phys_lanes(&size))) || !make_unit(n))
            find_normal(pair, &across, &ends, lane, n);
    }
    to->normal = (phys_vec){n[0], n[1], n[2], 0};
}
