/* migrate: blocks get other homes when a rank's tasks take longer than those of the others.
 * Measured loads are never quite even, so small differences move nothing. A difference that comes
 * back after a move was not due to the blocks, so it moves ever less. */
#include "runtime/balance/balance.h"
#include "runtime/balance/refine.h"
#include "runtime/base/memory.h"

#include <string.h>

#define LEAST_SLACK                                                                                \
    0.05 /* a rank may have so much more than the mean; grows if moves are in vain */
#define MAX_SLACK  0.4
#define LEAST_LOAD 1e-3 /* seconds a worker: less is not yet significant */
#define LOOK_SHARE 0.01 /* of the time may go into deciding and moving */
#define ANEW       0.95 /* of a few moves' cost: a new map, which moves many, must be below */

enum { LONGEST = 32, MAX_REPLAYS = 1 << 20 };

/* All zero at first. */
struct migrate_state {
    double slack, before; /* before: the measured excess at the last move, or 0 */
    uint64_t interval;
};

/* The cost of the homes over the time to come. */
static double bill_total(const struct balance_bill *bill, double periods)
{
    return (bill->max + bill->cut) * periods + bill->move;
}

/* Takes the better of refined and new homes if they are better than the present ones. Assumes that
 * the program goes on for as long as it has run. Returns whether `home` changed. */
static bool homes_improve(const duite_blocks *blocks, const struct balance_bill *now,
                          double periods, int *home)
{
    size_t n = blocks->graph.n;
    struct balance_bill refined, anew;
    int *tried = base_alloc(2 * n * sizeof *tried + 1), *other = tried + n;
    bool fine = tried != NULL, changed = false;
    if (fine) {
        memcpy(tried, home, n * sizeof *tried);
        memcpy(other, home, n * sizeof *other);
    }
    fine = fine && balance_refine(blocks, periods, tried) &&
           balance_bill(blocks, home, tried, &refined);
    if (fine && balance_anew(blocks, periods, other) && balance_bill(blocks, home, other, &anew) &&
        bill_total(&anew, periods) < ANEW * bill_total(&refined, periods)) {
        memcpy(tried, other, n * sizeof *tried);
        refined = anew;
    }
    if (fine && bill_total(&refined, periods) < bill_total(now, periods)) {
        changed = memcmp(home, tried, n * sizeof *home) != 0;
        memcpy(home, tried, n * sizeof *home);
    }
    base_free(tried);
    return changed;
}

/* A difference that a move did not change is noise. */
static void slack_learn(struct migrate_state *own, double excess)
{
    if (own->before > 0 && excess > 0.75 * own->before)
        own->slack = own->slack < MAX_SLACK / 2 ? 2 * own->slack : MAX_SLACK;
    else if (own->slack > LEAST_SLACK && excess < own->slack / 2)
        own->slack /= 2;
    own->before = 0;
}

/* Rarely enough that decisions and moves take only LOOK_SHARE of the time. */
static uint64_t migrate_next_look(const struct migrate_state *own, const duite_blocks *blocks)
{
    double replay = blocks->seconds / (double)blocks->since;
    double least = replay > 0 ? blocks->migrate_seconds / (LOOK_SHARE * replay) : 1;
    if (least > MAX_REPLAYS)
        return MAX_REPLAYS;
    return (uint64_t)least > own->interval ? (uint64_t)least : own->interval;
}

static uint64_t migrate_blocks(void *state, const duite_blocks *blocks, int *home)
{
    struct migrate_state *own = state;
    struct balance_bill now;
    if (!own->interval)
        *own = (struct migrate_state){.slack = LEAST_SLACK, .interval = 1};
    if (blocks->replays < 2) /* the first replay has cold caches */
        return 1;
    double periods = (double)blocks->replays / (double)blocks->since;
    bool moved = false;
    if (balance_bill(blocks, home, home, &now) && now.even > LEAST_LOAD) {
        double excess = now.max / now.even - 1;
        slack_learn(own, excess);
        moved = excess > own->slack && homes_improve(blocks, &now, periods, home);
        own->before = moved ? excess : 0;
    }
    if (moved)
        own->interval = 1;
    else if (own->interval < LONGEST)
        own->interval *= 2;
    return migrate_next_look(own, blocks);
}

const duite_balancer balance_migrate = {
    .size = sizeof(duite_balancer),
    .name = "migrate",
    .summary = "blocks of objects move from ranks whose tasks take longer",
    .state_size = sizeof(struct migrate_state),
    .migrate = migrate_blocks,
};
