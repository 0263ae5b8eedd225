/* Tasks with postponed rights that run on other ranks with all that they fork: what comes home of
 * them, also of failures, of nothing and of other sizes. All objects of a case live on one rank. */
#include "tests/negative/misuse.h"
#include "tests/runtime/delegation.h"
#include "tests/support/ranks.h"

#include <stdatomic.h>
#include <string.h>

enum { ROUNDS = 16 };

static atomic_int wholes; /* on this rank */

/* All that it may touch its children do. */
KERNEL(WHOLE, "whole", .access = {DUITE_RP, DUITE_RWP, DUITE_WP, DUITE_CWP},
       .args_size = sizeof(int32_t))
{
    const int32_t i = *(const int32_t *)call->args;
    duite_object lent[4];
    atomic_fetch_add(&wholes, 1);
    for (size_t k = 0; k < 4; k++)
        lent[k] = call->param[k].object;
    for (int32_t times = 1; times <= 3; times++)
        duite_fork(call->rt, &MIX, &(int32_t){times * i}, 4, lent);
    return 0;
}

KERNEL(ONE_MORE, "one_more", .access = {DUITE_RW})
{
    duite_out(call, 0, int32_t)[0] += 1;
    return 0;
}

/* Its first child fails, its second one does not. */
KERNEL(TORN, "torn", .access = {DUITE_RWP, DUITE_RWP})
{
    DUITE_FORK(call->rt, &FAIL, DUITE_ARGS(int32_t, 41), call->param[0].object);
    DUITE_FORK(call->rt, &ONE_MORE, NULL, call->param[1].object);
    return 0;
}

/* A contribution of 1, or one that fails. */
KERNEL(DROP, "drop", .access = {DUITE_CW}, .args_size = sizeof(int32_t))
{
    duite_out(call, 0, int32_t)[0] = 1;
    return *(const int32_t *)call->args;
}

KERNEL(SPILL, "spill", .access = {DUITE_CWP})
{
    DUITE_FORK(call->rt, &DROP, DUITE_ARGS(int32_t, 0), call->param[0].object);
    DUITE_FORK(call->rt, &DROP, DUITE_ARGS(int32_t, 43), call->param[0].object);
    return 0;
}

/* No task contributes, overwrites, or changes the third. */
KERNEL(IDLE, "idle", .access = {DUITE_CWP, DUITE_WP, DUITE_RWP})
{
    (void)call;
    return 0;
}

/* The body itself fails, after a child that does not. */
KERNEL(FALL, "fall", .access = {DUITE_RWP})
{
    DUITE_FORK(call->rt, &ONE_MORE, NULL, call->param[0].object);
    return duite_fail(call, 44, "falls");
}

KERNEL(GROWS, "grows", .access = {DUITE_RWP})
{
    for (int i = 0; i < 3; i++)
        DUITE_FORK(call->rt, &GROW, NULL, call->param[0].object);
    return 0;
}

/* Contributes 1 if it went on from another rank than home, and WENT_HOME more if it went there. */
enum { WENT_HOME = 1 << 16 };
struct origin {
    int32_t home, parent, depth;
};
KERNEL(STEP, "step", .access = {DUITE_CW}, .args_size = sizeof(struct origin))
{
    const struct origin *from = call->args;
    if (from->parent != rank && from->parent != from->home)
        duite_out(call, 0, int32_t)[0] = rank == from->home ? WENT_HOME + 1 : 1;
    return 0;
}

/* All below it is over when it ends, wherever that ran. */
KERNEL(WALK, "walk", .access = {DUITE_CWP}, .args_size = sizeof(struct origin))
{
    const struct origin *from = call->args;
    const struct origin own = {from->home, rank, from->depth - 1};
    for (int i = 0; i < 4; i++)
        duite_fork(call->rt, own.depth ? &WALK : &STEP, &own, 1, &call->param[0].object);
    return duite_wait(call->rt);
}

static const duite_kernel *const LIST[] = {&MIX,  &WHOLE, &ONE_MORE, &TORN, &DROP, &SPILL, &IDLE,
                                           &FALL, &GROW,  &GROWS,    &FAIL, &STEP, &WALK,  NULL};

static duite *start(const char *balance)
{
    atomic_store(&wholes, 0);
    return delegation_start(LIST, balance);
}

static void whole(duite *rt, int32_t number, const duite_object object[4])
{
    duite_fork(rt, &WHOLE, &number, 4, object);
}

static void values(const char *balance)
{
    duite *rt = start(balance);
    delegation_values(rt, balance, &(struct delegation_values){whole, 3 * 7, 6, 3, &wholes});
    delegation_say(balance, "stop", duite_stop(&rt) == DUITE_OK);
}

/* The tasks that a subtree forks go on, and home, while bodies wait for it everywhere. */
static void onward(void)
{
    duite *rt = start("scatter");
    duite_object sum = misuse_new(rt, 1);
    const int32_t home = duite_home(rt, sum);
    for (int i = 0; i < ROUNDS; i++)
        DUITE_FORK(rt, &WALK, (&(struct origin){home, home, 4}), sum);
    const int32_t went = delegation_value(rt, sum);
    tap_case(duite_ranks(rt) == 1 ? !went : went > WENT_HOME, "parts of a subtree go home");
    tap_case(duite_ranks(rt) < 3 || went % WENT_HOME > went / WENT_HOME, "and to third ranks");
    duite_free(rt, sum);
    tap_case(duite_stop(&rt) == DUITE_OK, "stop after that");
}

static void failures(void)
{
    duite *rt = start("scatter");
    duite_object a = misuse_new(rt, 1), b = delegation_beside(rt, a);
    int torn = 1, spilt = 1, fallen = 1;
    for (int i = 0; i < ROUNDS; i++) {
        duite_set(rt, a, NULL);
        duite_set(rt, b, NULL);
        DUITE_FORK(rt, &TORN, NULL, a, b);
        torn &= duite_get(rt, a, &(int32_t){0}) == 41 &&
                strstr(duite_message(), ".1 (kernel fail)") && delegation_value(rt, b) == 1;
        torn &= duite_wait(rt) == 41 && duite_wait(rt) == DUITE_OK;
        duite_set(rt, a, NULL);
        DUITE_FORK(rt, &SPILL, NULL, a);
        spilt &= duite_get(rt, a, &(int32_t){0}) == 43 && duite_wait(rt) == 43;
        DUITE_FORK(rt, &FALL, NULL, b);
        fallen &= duite_get(rt, b, &(int32_t){0}) == 44 && strstr(duite_message(), "falls");
        fallen &= duite_wait(rt) == 44;
    }
    tap_case(torn, "a child's failure poisons what it wrote, and no more");
    tap_case(spilt, "so does a contribution that fails");
    tap_case(fallen, "the body's own failure poisons all that it was lent");
    duite_free(rt, a);
    duite_free(rt, b);
    tap_case(duite_stop(&rt) == DUITE_OK, "stop after failures");
}

static void nothing(void)
{
    duite *rt = start("scatter");
    duite_object sum = misuse_new(rt, 1), over = delegation_beside(rt, sum),
                 kept = delegation_beside(rt, sum);
    int right = 1;
    for (int i = 0; i < ROUNDS; i++) {
        duite_set(rt, sum, &(int32_t){3});
        duite_set(rt, over, &(int32_t){4});
        duite_set(rt, kept, &(int32_t){5});
        DUITE_FORK(rt, &IDLE, NULL, sum, over, kept);
        right &= delegation_value(rt, sum) == 3 && delegation_value(rt, over) == 0 &&
                 delegation_value(rt, kept) == 5;
    }
    tap_case(right, "a subtree that does nothing leaves the sum, zeros, and the old value");
    duite_free(rt, sum);
    duite_free(rt, over);
    duite_free(rt, kept);
    tap_case(duite_stop(&rt) == DUITE_OK, "stop after nothing");
}

static void sizes(void)
{
    duite *rt = start("scatter");
    duite_object object;
    int32_t value[3 * ROUNDS] = {0};
    size_t count = 0;
    duite_new_sized(rt, DUITE_I32, 0, 3 * ROUNDS, &object);
    for (int i = 0; i < ROUNDS; i++) {
        DUITE_FORK(rt, &GROWS, NULL, object);
        duite_wait(rt); /* what the next one's children read is there */
    }
    const int code = duite_get_count(rt, object, &count);
    tap_case(!code && count == 3 * ROUNDS && !duite_get(rt, object, value) &&
                 value[count - 1] == 3 * ROUNDS,
             "sizes come home");
    DUITE_FORK(rt, &GROWS, NULL, object);
    tap_case(duite_get(rt, object, value) == DUITE_E_SIZE, "too large a size is an error");
    duite_free(rt, object);
    duite_wait(rt);
    tap_case(duite_stop(&rt) == DUITE_OK, "stop after sizes");
}

/* Large subtrees, one after another: no rank keeps anything of one that is over, but for the last
 * one's packets, which may still be on their way. */
static void memory(void)
{
    enum { LARGE = 1 << 16, BEFORE = 8 /* that run first, for what stays */ };
    const double one = 4e-6 * LARGE;
    duite *rt = start("scatter");
    duite_object object[4];
    double before = 0;
    for (int i = 0; i < 4; i++)
        object[i] = misuse_new(rt, LARGE);
    for (int i = 1; i < 4; i++)
        duite_colocate(rt, object[i], object[0]);
    for (int32_t i = 0; i < BEFORE + ROUNDS; i++) {
        duite_fork(rt, &WHOLE, &i, 4, object);
        duite_set(rt, object[3], NULL); /* its contributions go, too */
        duite_wait(rt);
        MPI_Barrier(MPI_COMM_WORLD);
        if (i == BEFORE - 1)
            before = misuse_megabytes();
    }
    const double grown = misuse_megabytes() - before;
    tap_case(before <= 0 || grown < ROUNDS / 2 * one, "what was lent is given back");
    for (int i = 0; i < 4; i++)
        duite_free(rt, object[i]);
    tap_case(duite_stop(&rt) == DUITE_OK, "stop after that");
}

RANKS_CASE(subtrees)
{
    misuse_mpi();
    values("none");
    values("scatter");
    onward();
    failures();
    nothing();
    sizes();
    memory();
    return tap_done();
}
