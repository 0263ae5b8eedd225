/* Velocity correction of single edges and of random nets of edges: lengths, momentum, angular
 * momentum and kinetic energy by their definitions, what pins hold, and the rounds of a step. */
#include "cloth/solve/block.h"
#include "cloth/solve/correction.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const phys_vec FREE = {0, 0, 0, 1};

static double within(double low, double high)
{
    return low + (high - low) * rand() / RAND_MAX;
}

static void random_vec(double size, phys_vec *x)
{
    *x = (phys_vec){within(-size, size), within(-size, size), within(-size, size), 0};
}

static double length_of(const phys_vec *d)
{
    return sqrt(phys_dot(d, d));
}

static void add_cross(const phys_vec *x, const phys_vec *p, double sum[3])
{
    for (int c = 0; c < 3; c++)
        sum[c] += (*x)[(c + 1) % 3] * (*p)[(c + 2) % 3] - (*x)[(c + 2) % 3] * (*p)[(c + 1) % 3];
}

/* An edge of about 1 m that began within its limit and would end up to a half too long, turned by
 * some 0.3. */
static void random_edge(struct solve_edge *edge, struct solve_end end[2], double t)
{
    phys_vec far, at, by;
    *edge = (struct solve_edge){.end = {0, 1}, .length = 1, .most = 1.1, .slack = 0.01};
    random_vec(5, &at);
    for (int i = 0; i < 2; i++) {
        phys_vec v;
        random_vec(0.1, &by);
        far = (phys_vec){i ? 1.0 : 0.0, 0, 0, 0};
        end[i].base = end[i].begin = at + far;
        v = (by + (phys_vec){i ? 0.3 : -0.3, 0, 0, 0}) / t;
        end[i].x = end[i].base + t * v;
        end[i].w = within(0.5, 20);
        end[i].filter = FREE;
    }
}

/* Without pins it ends at its limit, with the momentum and the angular momentum that it had. */
UNIT_TEST(an_edge_ends_at_its_limit)
{
    const double t = 0.01;
    const struct solve_correction correction = {.h = t, .t = t};
    srand(1);
    for (int n = 0; n < 1000; n++) {
        struct solve_edge edge;
        struct solve_end end[2];
        struct solve_excess excess = {0, 0};
        phys_vec move[2], sum = {0};
        double turn[3] = {0};
        random_edge(&edge, end, t);
        phys_vec d = end[1].x - end[0].x;
        const double before = length_of(&d);
        ck_assert(solve_is_over(&edge, &end[0].x, &end[1].x));
        ck_assert(solve_correct(&correction, &edge, end, 1, move, &excess));
        d += move[1] - move[0];
        ck_assert_double_eq_tol(length_of(&d), 1.1, 1e-14);
        ck_assert_double_eq_tol(excess.most, before - 1.1, 1e-14);
        for (int i = 0; i < 2; i++) {
            const phys_vec p = move[i] / (end[i].w * t), x = end[i].x + move[i];
            const phys_vec v = (end[i].x + move[i] - end[i].base) / t / end[i].w;
            const phys_vec u = (end[i].x - end[i].base) / t / end[i].w, back = -1 * u;
            sum += p;
            add_cross(&x, &v, turn);
            add_cross(&end[i].x, &back, turn);
        }
        for (int c = 0; c < 3; c++) {
            ck_assert_double_le(fabs(sum[c]), 1e-12);
            ck_assert_double_le(fabs(turn[c]), 1e-11);
        }
    }
}

/* One that turns by more than 60 degrees in the step is pulled along where it is. */
UNIT_TEST(an_edge_that_turns_far_ends_at_its_limit)
{
    const struct solve_edge edge = {.length = 1, .most = 1.1, .slack = 0.01};
    const struct solve_correction correction = {.h = 0.01, .t = 0.01};
    const struct solve_end end[2] = {
        {.w = 1, .filter = FREE},
        {.base = {1, 0, 0, 0}, .begin = {1, 0, 0, 0}, .x = {0.1, 2, 0, 0}, .w = 3, .filter = FREE}};
    struct solve_excess excess = {0, 0};
    phys_vec move[2];
    ck_assert(solve_correct(&correction, &edge, end, 1, move, &excess));
    const phys_vec d = end[1].x + move[1] - move[0];
    ck_assert_double_eq_tol(length_of(&d), 1.1, 1e-14);
    ck_assert_double_eq_tol(d[0] * 2, d[1] * 0.1, 1e-14);
}

/* An end that is held does not move, one in a plane stays there, and an edge that nothing can make
 * shorter does not count. */
UNIT_TEST(pins_hold)
{
    const struct solve_edge edge = {.length = 1, .most = 1.1, .slack = 0.01};
    const struct solve_correction correction = {.h = 0.01, .t = 0.01};
    struct solve_end end[2] = {
        {.w = 0, .filter = FREE},
        {.base = {0.6, 0.8, 0, 0}, .begin = {0.6, 0.8, 0, 0}, .x = {0.9, 1, 0, 0}, .w = 3}};
    struct solve_excess excess = {0, 0};
    phys_vec move[2];
    end[1].filter = (phys_vec){0, 1, 0, 1};
    ck_assert(solve_correct(&correction, &edge, end, 1, move, &excess));
    const phys_vec d = end[1].x + move[1];
    ck_assert_double_eq(length_of(move), 0);
    ck_assert_double_eq(move[1][1], 0);
    ck_assert_double_eq_tol(length_of(&d), 1.1, 1e-14);
    end[1].w = 0;
    excess = (struct solve_excess){0, 0};
    ck_assert(!solve_correct(&correction, &edge, end, 1, move, &excess));
    ck_assert_double_eq(excess.most, 0);
}

/* b falls to b / (1 + h / 0.01 s) in a step, or to less than the tolerance. */
UNIT_TEST(what_is_too_long_comes_back)
{
    const struct solve_correction correction = {.h = 0.005, .t = 0.005, .part = 1};
    const struct solve_edge edge = {.length = 1, .most = 1.1, .slack = 0.01};
    double length = 1.7;
    for (int step = 0; step < 30; step++) {
        const phys_vec at = {0, length, 0, 0};
        struct solve_end end[2] = {{.w = 1, .filter = FREE},
                                   {.base = at, .begin = at, .x = at, .w = 1, .filter = FREE}};
        struct solve_excess excess = {0, 0};
        phys_vec move[2];
        const bool moves = solve_correct(&correction, &edge, end, 1, move, &excess);
        const double most = (length - 1.1) / 1.5;
        ck_assert_int_eq(moves, length - 1.1 > 0.01);
        if (moves)
            length += move[1][1] - move[0][1];
        ck_assert_double_eq_tol(length, 1.1 + (moves ? fmax(most - 0.01, 0) : length - 1.1), 1e-14);
    }
    ck_assert_double_le(length, 1.11);
}

/* ---- Nets ---- */

enum { NODES = 30, EDGES = 90 };
struct net {
    struct solve_edge edge[EDGES];
    struct solve_end node[NODES];
    phys_vec moved[NODES], v[NODES];
    double mass[NODES];
};

/* Another node, so far away that the edge does not turn by 60 degrees in a step. */
static uint32_t far_from(const struct net *net, uint32_t a)
{
    while (true) {
        const uint32_t b = (uint32_t)rand() % NODES;
        const phys_vec d = net->node[b].begin - net->node[a].begin;
        if (length_of(&d) > 0.5)
            return b;
    }
}

static void random_net(struct net *net, double t)
{
    *net = (struct net){0};
    for (int i = 0; i < NODES; i++) {
        random_vec(1, &net->node[i].base);
        random_vec(1.5, net->v + i);
        net->node[i].begin = net->node[i].base;
        net->node[i].x = net->node[i].base + t * net->v[i];
        net->node[i].filter = FREE;
        net->mass[i] = within(0.1, 2);
        net->node[i].w = 1 / net->mass[i];
    }
    for (uint32_t e = 0; e < EDGES; e++) {
        const uint32_t a = e % NODES, b = far_from(net, a);
        const phys_vec d = net->node[b].begin - net->node[a].begin;
        net->edge[e] = (struct solve_edge){.end = {a, b},
                                           .length = length_of(&d),
                                           .most = 1.05 * length_of(&d),
                                           .slack = 0.01 * length_of(&d)};
    }
}

static void net_round(struct net *net, const struct solve_correction *correction,
                      struct solve_excess *excess)
{
    for (int e = 0; e < EDGES; e++) {
        const uint32_t *at = net->edge[e].end;
        const struct solve_end end[2] = {net->node[at[0]], net->node[at[1]]};
        phys_vec move[2];
        if (!solve_is_over(net->edge + e, &end[0].x, &end[1].x) ||
            !solve_correct(correction, net->edge + e, end, 1, move, excess))
            continue;
        for (int i = 0; i < 2; i++) {
            net->node[at[i]].x += move[i];
            net->moved[at[i]] += move[i];
        }
    }
}

static void sums_of(const struct net *net, double sum[7])
{
    memset(sum, 0, 7 * sizeof *sum);
    for (int i = 0; i < NODES; i++) {
        const phys_vec p = net->mass[i] * net->v[i];
        for (int c = 0; c < 3; c++)
            sum[c] += p[c];
        add_cross(&net->node[i].x, &p, sum + 3);
        sum[6] += 0.5 * phys_dot(&p, net->v + i);
    }
}

/* Rounds end with every edge within its limit and the tolerance; momentum and angular momentum
 * stay, and the kinetic energy falls by what is said. */
UNIT_TEST(rounds_of_a_net_end)
{
    const double t = 0.05;
    double most_rounds = 0, turned = 0;
    srand(2);
    for (int n = 0; n < 50; n++) {
        struct net net;
        double before[7], after[7], longest = 0;
        random_net(&net, t);
        sums_of(&net, before);
        struct solve_rounds rounds = solve_rounds_start(t, t, t);
        while (rounds.phase > 0) {
            const struct solve_correction correction = solve_rounds_correction(&rounds);
            struct solve_excess excess = {0, 0};
            net_round(&net, &correction, &excess);
            rounds = solve_rounds_next(&rounds, &excess, 2000);
        }
        const double lost = solve_correct_velocity(NODES, t, net.mass, net.moved, net.v);
        sums_of(&net, after);
        for (int e = 0; e < EDGES; e++) {
            const phys_vec d = net.node[net.edge[e].end[1]].x - net.node[net.edge[e].end[0]].x;
            longest = fmax(longest, (length_of(&d) - net.edge[e].most) / net.edge[e].length);
        }
        ck_assert_double_eq(rounds.unmet, 0);
        ck_assert_double_le(longest, 0.01 + 1e-14);
        ck_assert_double_eq_tol(fmax(longest, 0), rounds.excess, 1e-13);
        for (int c = 0; c < 6; c++)
            turned = fmax(turned, fabs(after[c] - before[c]));
        ck_assert_double_eq_tol(before[6] - after[6], lost, 1e-10);
        ck_assert_double_gt(lost, 0);
        most_rounds = fmax(most_rounds, rounds.rounds);
    }
    printf("# at most %.0f rounds; momentum and angular momentum off by %.1e\n", most_rounds,
           turned);
    ck_assert_double_le(turned, 1e-11);
}

/* The first round corrects all, later ones what is over by more than the tolerance. One that
 * corrects nothing is the last; after as many as are allowed one looks. */
UNIT_TEST(rounds_are_counted)
{
    const struct solve_excess some = {0.3, 1}, none = {0.004, 0};
    struct solve_rounds rounds = solve_rounds_start(0.1, 0.2, 3);
    ck_assert_double_eq(solve_rounds_correction(&rounds).part, 0);
    rounds = solve_rounds_next(&rounds, &some, 2);
    ck_assert_double_eq(rounds.phase, SOLVE_ROUNDS_ON);
    ck_assert_double_eq(solve_rounds_correction(&rounds).part, 1);
    ck_assert_double_eq(solve_rounds_correction(&rounds).t, 0.2);
    struct solve_rounds other = solve_rounds_next(&rounds, &none, 2);
    ck_assert_double_eq(other.phase, SOLVE_ROUNDS_DONE);
    ck_assert_double_eq(other.rounds, 1);
    ck_assert_double_eq(other.excess, 0.004);
    rounds = solve_rounds_next(&rounds, &some, 2);
    ck_assert_double_eq(rounds.phase, SOLVE_ROUNDS_LOOK);
    ck_assert(solve_rounds_correction(&rounds).measures);
    rounds = solve_rounds_next(&rounds, &some, 2);
    ck_assert_double_eq(rounds.phase, SOLVE_ROUNDS_DONE);
    ck_assert_double_eq(rounds.rounds, 2);
    ck_assert_double_eq(rounds.unmet, 1);
    other = solve_rounds_next(&rounds, &none, 2);
    ck_assert_double_eq(other.unmet, 1);
}
