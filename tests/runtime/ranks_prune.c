/* A rank keeps nothing of other ranks' tasks that touch nothing of it, and copies until they are
 * overwritten; duite_is_local tells. */

#include "tests/negative/misuse.h"
#include "tests/support/ranks.h"

enum { OBJECTS = 20, LARGE = 1 << 18, FORKS = 100000 };

KERNEL(TOUCH, "touch", .access = {DUITE_R, DUITE_RW}, .args_size = sizeof(int32_t))
{
    duite_out(call, 1, int32_t)[0] += duite_in(call, 0, int32_t)[0] + *(const int32_t *)call->args;
    return 0;
}

/* The second parameter gets the first of the further ones, which is 3. */
KERNEL(CONTRIBUTE, "contribute", .access = {DUITE_RW, DUITE_CW}, .variadic = DUITE_R)
{
    duite_out(call, 0, int32_t)[0] += 1;
    duite_out(call, 1, int32_t)[0] += duite_in(call, 2, int32_t)[0];
    return 0;
}

KERNEL(SAME, "same", .access = {DUITE_W}, .replicated = 1)
{
    duite_out(call, 0, int32_t)[0] = 3;
    return 0;
}

/* The same after a wait, before any rank goes on: one that forks sends the others what they will
 * read. */
static double megabytes_at_rest(void)
{
    const double now = misuse_megabytes();

    MPI_Barrier(MPI_COMM_WORLD);
    return now;
}

/* The objects live on one rank; another reads them; they are overwritten where they live. */
static void copies(duite *rt, const duite_object *object, int home, int reader)
{
    for (int i = 0; i < OBJECTS; i++)
        duite_fork_at(rt, home, &SET, &(int32_t){i}, 1, &object[i]);
    duite_wait(rt);
    const double before = megabytes_at_rest();

    for (int i = 0; i < OBJECTS; i++)
        duite_fork_at(rt, reader, &MANY, NULL, 1, &object[i]);
    duite_wait(rt);
    const double with = megabytes_at_rest();
    const double all = 4e-6 * OBJECTS * LARGE;

    tap_case(rank != reader || before <= 0 || with - before > 0.9 * all, "who reads keeps copies");
    tap_case(rank == home || duite_is_local(rt, object[0]) == (rank == reader),
             "and is touched by what names them");
    for (int i = 0; i < OBJECTS; i++)
        duite_fork_at(rt, home, &SET, &(int32_t){i + 1}, 1, &object[i]);
    duite_wait(rt);
    tap_case(rank != reader || misuse_megabytes() - before < 0.1 * all,
             "which are dropped when the objects are overwritten");
    tap_case(rank == home || duite_is_local(rt, object[0]) == 0,
             "and then is not touched any more");
    tap_case(rank != home || duite_is_local(rt, object[0]) == 1, "the home always is");
}

/* Many forks, all of one rank's. */
static void forks(duite *rt, const duite_object *small, int home)
{
    int32_t value = 0;

    duite_wait(rt);
    const double before = misuse_megabytes();
    for (int i = 0; i < FORKS; i++)
        DUITE_FORK(rt, &TOUCH, DUITE_ARGS(int32_t, 1), small[i % 3], small[3 + i % 2]);
    tap_case(rank == home || misuse_megabytes() - before < 0.01,
             "they keep no memory on the others");
    tap_case(!duite_get(rt, small[3], &value) && value == FORKS / 2, "and run where they should");
    tap_case(duite_wait(rt) == DUITE_OK, "the ranks agree on what was forked");
}

/* Many forks, of all ranks in turn, that contribute to an object of one, read what all ranks have,
 * and, further, what lies on another one. */
static void asking_nothing(duite *rt, const duite_object *small)
{
    enum { TURNS = 3 };
    const duite_object sum = misuse_new(rt, 1), same = misuse_new(rt, 1);
    const duite_object turn[TURNS] = {misuse_new(rt, 1), misuse_new(rt, 1), misuse_new(rt, 1)};
    int32_t value = 0;

    duite_fork(rt, &SAME, NULL, 1, &same);
    duite_fork(rt, &SET, &(int32_t){0}, 1, &sum);
    for (int i = 0; i < FORKS / 2; i++) {
        const duite_object objects[4] = {turn[i % TURNS], sum, same, small[4]};

        duite_fork(rt, &CONTRIBUTE, NULL, 3 + (size_t)(i % 2), objects);
    }
    tap_case(!duite_get(rt, sum, &value) && value == 3 * (FORKS / 2), "each contribution counts");
    for (int i = 0; i < TURNS; i++)
        tap_case(!duite_get(rt, turn[i], &value) && value == (FORKS / 2 + TURNS - 1 - i) / TURNS,
                 "as each task does");
    tap_case(duite_wait(rt) == DUITE_OK, "the ranks agree on these, too");
    for (int i = 0; i < TURNS; i++)
        duite_free(rt, turn[i]);
    duite_free(rt, sum);
    duite_free(rt, same);
}

/* Wrong forks are refused as everywhere else. */
static void misuse(duite *rt, const duite_object *small)
{
    const duite_object twice[2] = {small[0], small[0]}, none[2] = {small[0], DUITE_NO_OBJECT};
    const duite_object far[2] = {{UINT32_MAX, 1}, small[0]};

    duite_prefetch(rt, 2, none);
    duite_prefetch(rt, 2, far);
    duite_prefetch(NULL, 2, none);
    tap_case(duite_wait(rt) == DUITE_OK, "what is fetched ahead need not exist");

    tap_case(duite_fork(rt, &TOUCH, &(int32_t){0}, 2, twice) == DUITE_E_ACCESS, "one object twice");
    tap_case(duite_fork(rt, &TOUCH, &(int32_t){0}, 2, none) == DUITE_E_OBJECT, "no object");
    tap_case(duite_fork(rt, &TOUCH, &(int32_t){0}, 1, small) == DUITE_E_ACCESS, "too few");
    tap_case(duite_fork(rt, &TOUCH, NULL, 2, small) == DUITE_E_ARGUMENT, "no arguments");
    tap_case(duite_fork(rt, &COPY, &(int32_t){0}, 2, small) == DUITE_E_ARGUMENT &&
                 duite_fork(rt, &CONTRIBUTE, &(int32_t){0}, 3, small) == DUITE_E_ARGUMENT,
             "arguments that no body finds");
    tap_case(duite_fork(rt, &UNLISTED, NULL, 1, small) == DUITE_E_KERNEL, "a kernel not listed");
    tap_case(duite_wait(rt) == DUITE_E_ACCESS, "and told once more");
    tap_case(duite_is_local(rt, DUITE_NO_OBJECT) == 1, "nothing is everybody's business");
    tap_case(duite_wait(rt) == DUITE_OK, "the ranks agree still");
}

/* Forks that differ where they touch nothing of one rank. */
static void different(duite *rt, const duite_object *small, int home)
{
    DUITE_FORK(rt, &TOUCH, DUITE_ARGS(int32_t, 0), small[rank == home ? 0 : 1], small[2]);
    tap_case(duite_wait(rt) == (duite_ranks(rt) > 1 ? DUITE_E_DIFFERENT : DUITE_OK),
             "forks that differ are found");
}

RANKS_CASE(prune)
{
    const duite_kernel *const list[] = {&SET, &MANY, &TOUCH, &CONTRIBUTE, &SAME, &COPY, NULL};
    duite_object large[OBJECTS], small[6];
    duite_options options = misuse_options(MPI_COMM_WORLD);
    options.kernels = list;
    duite *rt = misuse_start_with(&options);
    if (!rt)
        return 1;
    for (int i = 0; i < OBJECTS; i++) {
        large[i] = misuse_new(rt, LARGE);
        duite_colocate(rt, large[i], large[0]);
    }
    for (int i = 0; i < 6; i++) {
        small[i] = misuse_new(rt, 1);
        duite_colocate(rt, small[i], large[0]);
    }
    const int home = duite_home(rt, large[0]), n_ranks = duite_ranks(rt);

    if (n_ranks > 1)
        copies(rt, large, home, (home + 1) % n_ranks);
    forks(rt, small, home);
    asking_nothing(rt, small);
    misuse(rt, small);
    different(rt, small, home);
    const int code = duite_stop(&rt);
    tap_case(code == DUITE_E_NOT_FREED || code == DUITE_E_DIFFERENT, "stop");
    return tap_done();
}
