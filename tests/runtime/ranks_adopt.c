/* Memory of the program's own: tasks work in it, values come back to it, and it is given back once.
 * Run under mpirun. */
#include "tests/negative/misuse.h"
#include "tests/support/ranks.h"

#include <stdatomic.h>
#include <stdint.h>
#include <string.h>

enum { WIDTH = 3000, LARGE = 5000000, ROUNDS = 7 };

static duite *rt;
static int giver;               /* the rank whose memory it is */
static int32_t values[WIDTH];   /* there; garbage on others */
static atomic_int given, wrong; /* back; by a call with something else */
static _Atomic(void *) seen;    /* where the last body of MARK found its object */

static void given_back(void *memory, void *user)
{
    atomic_fetch_add(&given, 1);
    if (user != &given || (memory != values && memory != values + 1))
        atomic_fetch_add(&wrong, 1);
}

/* Each value is one more, in one turn. */
KERNEL(MARK, "mark", .access = {DUITE_RW})
{
    for (size_t i = 0; i < duite_count(call, 0); i++)
        duite_out(call, 0, int32_t)[i] += 1;
    atomic_store(&seen, call->param[0].data);
    return 0;
}

KERNEL(HAND_ON, "hand on", .access = {DUITE_RWP})
{
    const duite_object object = call->param[0].object;

    for (int i = 0; i < ROUNDS; i++)
        duite_fork(call->rt, &MARK, NULL, 1, &object);
    return 0;
}

KERNEL(LEAVE, "leave", .access = {DUITE_WP})
{
    (void)call;
    return 0;
}

KERNEL(INSIDE, "inside", .access = {DUITE_RW}, .side_effects = 1)
{
    duite_object object;

    return duite_adopt(call->rt, 0, DUITE_I32, 1, values, NULL, NULL, &object) == DUITE_E_STATE &&
                   strstr(duite_message(), "duite_adopt is for the main thread")
               ? 0
               : 1;
}

static const duite_kernel *const KERNELS[] = {&SET,     &COPY,  &ADD,    &FAIL, &MARK,
                                              &HAND_ON, &LEAVE, &INSIDE, NULL};

/* All values become `first`, first + 1, ...; they are adopted. */
static int adopt(int32_t first, size_t count, duite_object *object)
{
    for (int32_t i = 0; i < WIDTH; i++)
        values[i] = rank == giver ? first + i : -1;
    atomic_store(&given, 0);
    atomic_store(&seen, NULL);
    return duite_adopt(rt, giver, DUITE_I32, count, rank == giver ? values : NULL, given_back,
                       &given, object);
}

/* True if the memory was given back once, with such values. */
static int is_back(int32_t first, size_t count)
{
    int right = !atomic_load(&wrong) && atomic_load(&given) == (rank == giver);

    for (size_t i = 0; rank == giver && i < count; i++)
        right = right && values[i] == first + (int32_t)i;
    return right;
}

static int frees(duite_object object)
{
    return duite_free(rt, object) | duite_wait(rt);
}

static int in_place(void)
{
    return rank != giver || atomic_load(&seen) == values;
}

/* Checking mode gives bodies copies. */
static void works_in_place(int check)
{
    duite_object object;
    int32_t got[WIDTH];
    int code = adopt(10, WIDTH, &object);
    int right = duite_home(rt, object) == giver;

    for (int i = 0; i < ROUNDS; i++)
        code |= duite_fork(rt, &MARK, NULL, 1, &object);
    code |= duite_get(rt, object, got);
    for (int32_t i = 0; i < WIDTH; i++)
        right = right && got[i] == 10 + ROUNDS + i;
    tap_case(!code && right && (check || in_place()),
             "tasks work in the memory one after the other");
    code = duite_fork(rt, &HAND_ON, NULL, 1, &object) | duite_wait(rt);
    tap_case(!code && (check || in_place()), "as do tasks that tasks fork");
    tap_case(!frees(object) && is_back(10 + 2 * ROUNDS, WIDTH), "it is given back with the value");
}

static int record(duite *runtime, void *object)
{
    return duite_fork(runtime, &MARK, NULL, 1, object);
}

static void replays(int check)
{
    duite_object object;
    duite_graph graph;
    int code = adopt(0, WIDTH, &object) | duite_graph_new(rt, record, &object, &graph);

    code |= duite_replay(rt, graph, ROUNDS) | duite_graph_free(rt, graph) | duite_wait(rt);
    tap_case(!code && (check || in_place()), "replays work in it");
    tap_case(!frees(object) && is_back(ROUNDS, WIDTH), "and leave their value there");
}

/* Values that lie elsewhere come to the memory. */
static void comes_home(void)
{
    const int32_t five = 5;
    int32_t many[WIDTH], *data;
    duite_object object;
    int code = adopt(0, WIDTH, &object);

    for (int32_t i = 0; i < WIDTH; i++)
        many[i] = 100 + i;
    code |= duite_set(rt, object, many) | duite_acquire(rt, object, DUITE_R, (void **)&data);
    int right = rank == giver ? data == values && values[WIDTH - 1] == 99 + WIDTH : !data;
    code |= duite_release(rt, object);
    code |= duite_fork_at(rt, ranks - 1 - giver, &MARK, NULL, 1, &object);
    code |= duite_acquire(rt, object, DUITE_RW, (void **)&data);
    right = right && (rank == giver ? data == values && values[1] == 102 : !data);
    for (int32_t i = 0; data && i < WIDTH; i++)
        data[i] += 1000;
    code |= duite_release(rt, object) | duite_fork(rt, &MARK, NULL, 1, &object) | duite_wait(rt);
    tap_case(!code && right, "a turn finds the value in the memory");
    tap_case(!frees(object) && is_back(1102, WIDTH), "and leaves it there");

    code = adopt(0, 1, &object) | duite_fork_at(rt, ranks - 1 - giver, &SET, &five, 1, &object);
    tap_case(!code && !frees(object) && is_back(5, 1),
             "another rank's value comes home at the end");
    code = adopt(0, 1, &object) | duite_fork(rt, &ADD, NULL, 1, &object);
    code |= duite_fork_at(rt, ranks - 1, &ADD, NULL, 1, &object);
    tap_case(!code && !frees(object) && is_back(2, 1), "as do contributions");
    code = adopt(7, 1, &object) | duite_fork(rt, &LEAVE, NULL, 1, &object);
    tap_case(!code && !frees(object) && is_back(0, 1), "and zeros that no child overwrote");
}

/* A failed task leaves no value, and the memory is given back; a w heals it. */
static void fails(void)
{
    const int32_t code = 17, five = 5;
    duite_object object;
    void *data;

    adopt(3, 1, &object);
    duite_fork(rt, &FAIL, &code, 1, &object);
    tap_case(frees(object) == code && atomic_load(&given) == (rank == giver),
             "after a failure, too");
    adopt(3, 1, &object);
    duite_fork(rt, &FAIL, &code, 1, &object);
    tap_case(duite_acquire(rt, object, DUITE_R, &data) == (rank == giver ? code : DUITE_OK) &&
                 !data && !duite_release(rt, object) && duite_wait(rt) == code,
             "which a turn tells");
    tap_case(!duite_fork(rt, &SET, &five, 1, &object) && !frees(object) && is_back(5, 1),
             "and a w heals");
}

/* Each is refused with its sentence, on all ranks. */
static void refused(void)
{
    duite_object object, other;
    const size_t negative = (size_t)-3;

    tap_case(adopt(0, negative, &object) == DUITE_E_ARGUMENT &&
                 strstr(duite_message(), "the number of elements is negative: -3") &&
                 duite_wait(rt) == DUITE_E_ARGUMENT,
             "a negative count");
    tap_case(adopt(0, 0, &object) == DUITE_E_ARGUMENT && duite_wait(rt) == DUITE_E_ARGUMENT,
             "none");
    tap_case(duite_adopt(rt, ranks, DUITE_I32, 1, values, NULL, NULL, &object) ==
                     DUITE_E_ARGUMENT &&
                 strstr(duite_message(), "there is no rank") && duite_wait(rt) == DUITE_E_ARGUMENT,
             "no such rank");
    int code = duite_adopt(rt, giver, DUITE_I32, 1, NULL, given_back, &given, &object);
    tap_case(code == (rank == giver ? DUITE_E_ARGUMENT : DUITE_OK) &&
                 duite_wait(rt) == DUITE_E_ARGUMENT &&
                 strstr(duite_message(), "no memory (NULL)") && !frees(object),
             "no memory");
    code = duite_adopt(rt, giver, DUITE_I32, 1, (char *)values + 2, given_back, &given, &object);
    tap_case(code == (rank == giver ? DUITE_E_ARGUMENT : DUITE_OK) &&
                 duite_wait(rt) == DUITE_E_ARGUMENT && strstr(duite_message(), "not aligned") &&
                 !frees(object),
             "memory that is not aligned");
    code = adopt(0, 2, &object);
    code |= duite_adopt(rt, giver, DUITE_I32, 2, values + 1, given_back, &given, &other) !=
            (rank == giver ? DUITE_E_ARGUMENT : DUITE_OK);
    tap_case(!code && duite_wait(rt) == DUITE_E_ARGUMENT && strstr(duite_message(), "overlap"),
             "memory that is still in use");
    tap_case(!duite_free(rt, other) && !frees(object) && is_back(0, 2), "which goes on");
    code = duite_adopt(rt, giver, DUITE_I32, 2, values + 1, given_back, &given, &other);
    tap_case(!code && !frees(other) && !atomic_load(&wrong), "and can be adopted once it is back");
    object = misuse_new(rt, 1);
    tap_case(!duite_fork(rt, &INSIDE, NULL, 1, &object) && !frees(object), "in a body");
}

/* Values that one rank alone has: few, and in pieces. */
static void one_has(void)
{
    const duite_object small = misuse_new(rt, 3), large = misuse_new(rt, LARGE);
    static int32_t sent[LARGE], got[LARGE];
    int right = 1;

    for (int round = 0; round < ranks; round++) {
        const int32_t own[] = {round, rank, 3};
        int32_t three[3];

        right = right && !duite_set_at(rt, small, round, rank == round ? own : NULL) &&
                !duite_get(rt, small, three) && three[0] == round && three[1] == round;
    }
    tap_case(right, "each rank sets what it has");
    for (int32_t i = 0; rank == giver && i < LARGE; i++)
        sent[i] = i;
    right = !duite_set_at(rt, large, giver, sent) && !duite_get(rt, large, got);
    for (int32_t i = 0; i < LARGE; i++)
        right = right && got[i] == i;
    tap_case(right && !duite_set_at(rt, small, 0, NULL) && !duite_get(rt, small, got) && !got[2],
             "many values, and zeros");
    tap_case(duite_set_at(rt, small, -1, NULL) == DUITE_E_ARGUMENT &&
                 duite_wait(rt) == DUITE_E_ARGUMENT,
             "but no rank that there is not");
    duite_free(rt, small);
    frees(large);
}

/* The runtime ends: all is given back, and who was forgotten is told. */
static void ends(void)
{
    duite_object object;

    int code = adopt(20, WIDTH, &object) | duite_fork(rt, &MARK, NULL, 1, &object);
    code |= duite_stop(&rt) != DUITE_E_NOT_FREED;
    tap_case(!code && is_back(21, WIDTH), "a stop gives back what was not freed");
}

RANKS_CASE(adopt)
{
    misuse_mpi();
    for (unsigned threads = 1; threads < 3; threads++)
        for (int check = 0; check < 2; check++) {
            duite_options options = misuse_options(MPI_COMM_WORLD);

            giver = threads == 1 ? 0 : ranks - 1;
            options.kernels = KERNELS;
            options.threads = threads;
            options.check = check;
            rt = misuse_start_with(&options);
            works_in_place(check);
            replays(check);
            comes_home();
            fails();
            refused();
            if (!check)
                one_has();
            ends();
        }
    return tap_done();
}
