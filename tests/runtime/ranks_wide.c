/* Kernels that list many parameters: forked, pruned, replayed and traced; the last listed ones
 * count as the first do. Run under mpirun. An argument is the file of a trace. */
#include "tests/negative/misuse.h"
#include "tests/support/ranks.h"

#include <string.h>

enum { READS = 37, WRITE = READS, SUM, LARGEST, WIDTH, ROUNDS = 7 };

#define READ_5  DUITE_R, DUITE_R, DUITE_R, DUITE_R, DUITE_R
#define READ_37 READ_5, READ_5, READ_5, READ_5, READ_5, READ_5, READ_5, DUITE_R, DUITE_R

/* writes += sum of i + 1 times what it reads; that is contributed to a sum and to a maximum. */
KERNEL(WIDE, "wide", .access = {READ_37, DUITE_RW, DUITE_CW, DUITE_CW},
       .law = DUITE_LAWS([LARGEST] = &duite_max))
{
    int64_t all = 0;

    for (int i = 0; i < READS; i++)
        all += (i + 1) * *duite_in(call, i, int64_t);
    *duite_out(call, WRITE, int64_t) += all;
    *duite_out(call, SUM, int64_t) += all;
    if (*duite_out(call, LARGEST, int64_t) < all)
        *duite_out(call, LARGEST, int64_t) = all;
    return 0;
}

/* Only reads and writes: the ranks on which nothing of it is drop it at once. */
KERNEL(PLAIN, "plain", .access = {READ_37, DUITE_RW})
{
    for (int i = 0; i < READS; i++)
        *duite_out(call, WRITE, int64_t) += (i + 1) * *duite_in(call, i, int64_t);
    return 0;
}

KERNEL(CLEAR, "clear", .access = {DUITE_W})
{
    *duite_out(call, 0, int64_t) = 0;
    return 0;
}

KERNEL(ADD_ONE, "add_one", .access = {DUITE_RW})
{
    *duite_out(call, 0, int64_t) += 1;
    return 0;
}

/* The last mode that can be listed: bits and places behind the 63 others. */
KERNEL(LAST, "last", .access = {READ_37, READ_5, READ_5, READ_5, READ_5, READ_5, DUITE_R, DUITE_RW})
{
    for (size_t i = 0; i + 1 < DUITE_MAX_ACCESS; i++)
        *duite_out(call, DUITE_MAX_ACCESS - 1, int64_t) += *duite_in(call, i, int64_t);
    return 0;
}

static const duite_kernel FULL = {
    .name = "full",
    .body = PLAIN_body,
    .access = {READ_37, READ_5, READ_5, READ_5, READ_5, READ_5, DUITE_R, DUITE_R}};

struct wide {
    duite_object object[WIDTH], other; /* `other` is written in place of WRITE by PLAIN */
    int64_t all;                       /* that a task adds */
};

static int wide_round(duite *rt, void *context)
{
    const struct wide *w = context;
    duite_object object[WIDTH];

    memcpy(object, w->object, sizeof object);
    duite_fork(rt, &WIDE, NULL, WIDTH, object);
    object[WRITE] = w->other;
    return duite_fork(rt, &PLAIN, NULL, WRITE + 1, object);
}

static int64_t value_of(duite *rt, duite_object object)
{
    int64_t value = -1;

    return duite_get(rt, object, &value) ? -1 : value;
}

/* True if so many rounds ran. */
static int wide_is(duite *rt, const struct wide *w, int64_t rounds)
{
    return value_of(rt, w->object[WRITE]) == rounds * w->all &&
           value_of(rt, w->other) == rounds * w->all &&
           value_of(rt, w->object[SUM]) == rounds * w->all &&
           value_of(rt, w->object[LARGEST]) == w->all;
}

/* Objects wherever the mapping wants them, or all on one rank, so that others drop the forks. */
static struct wide wide_make(duite *rt, int together)
{
    struct wide w = {.all = 0};
    const int64_t zero = 0;

    duite_new(rt, DUITE_I64, 1, &w.other);
    for (int i = 0; i < WIDTH; i++) {
        duite_new(rt, DUITE_I64, 1, &w.object[i]);
        if (together)
            duite_colocate(rt, w.object[i], w.other);
    }
    for (int64_t i = 0; i < WIDTH; i++) {
        const int64_t value = 1000 + i * i;

        duite_set(rt, w.object[i], i < READS ? &value : &zero);
        w.all += i < READS ? (i + 1) * value : 0;
    }
    duite_set(rt, w.other, &zero);
    return w;
}

static void wide_free(duite *rt, struct wide *w)
{
    for (int i = 0; i < WIDTH; i++)
        duite_free(rt, w->object[i]);
    duite_free(rt, w->other);
}

/* The next rank writes what a task then overwrites at home; the last rank, on which nothing of that
 * task is, reads it: it must know that it is at home again. */
static void wide_moves(duite *rt, struct wide *w)
{
    const int home = duite_home(rt, w->other), n_ranks = duite_ranks(rt);
    duite_object object[WIDTH];

    duite_fork_at(rt, (home + 1) % n_ranks, &CLEAR, NULL, 1, &w->other);
    memcpy(object, w->object, sizeof object);
    object[WRITE] = w->other;
    duite_fork(rt, &PLAIN, NULL, WRITE + 1, object);
    duite_fork_at(rt, (home + n_ranks - 1) % n_ranks, &ADD_ONE, NULL, 1, &w->other);
    tap_case(value_of(rt, w->other) == w->all + 1, "a rank knows where a written one is");
}

static void wide_run(duite *rt, int together)
{
    struct wide w = wide_make(rt, together);
    duite_graph graph;

    for (int i = 0; i < ROUNDS; i++)
        wide_round(rt, &w);
    tap_case(wide_is(rt, &w, ROUNDS), "forks with 40 listed parameters");
    tap_case(!duite_graph_new(rt, wide_round, &w, &graph), "record");
    tap_case(!duite_replay(rt, graph, ROUNDS), "replay");
    tap_case(wide_is(rt, &w, 2 * ROUNDS), "replays leave what forks leave");
    wide_moves(rt, &w);
    tap_case(duite_fork(rt, &WIDE, NULL, WIDTH - 1, w.object) == DUITE_E_ACCESS, "one too few");
    tap_case(duite_fork(rt, &FULL, NULL, WIDTH, w.object) == DUITE_E_ACCESS,
             "as many as can be listed are wanted");
    duite_wait(rt); /* tells the error again */
    duite_graph_free(rt, graph);
    wide_free(rt, &w);
}

/* A task of as many objects as can be listed, on all ranks alike. */
static void full_run(duite *rt)
{
    duite_object object[DUITE_MAX_ACCESS];
    int64_t expected = 0;
    for (int64_t i = 0; i < DUITE_MAX_ACCESS; i++) {
        const int64_t value = i * i + 1;
        duite_new(rt, DUITE_I64, 1, object + i);
        duite_set(rt, object[i], &value);
        expected += value;
    }
    tap_case(!duite_fork(rt, &LAST, NULL, DUITE_MAX_ACCESS, object), "a fork of 64 objects");
    tap_case(value_of(rt, object[DUITE_MAX_ACCESS - 1]) == expected, "its last one is written");
    for (int i = 0; i < DUITE_MAX_ACCESS; i++)
        duite_free(rt, object[i]);
}

RANKS_CASE(wide)
{
    const duite_kernel *const list[] = {&WIDE, &PLAIN, &FULL, &LAST, &CLEAR, &ADD_ONE, NULL};
    duite_options options = misuse_options(MPI_COMM_WORLD);
    options.kernels = list;
    options.trace = argc > 1 ? argv[1] : NULL;
    duite *rt = misuse_start_with(&options);
    if (!rt)
        return 1;
    wide_run(rt, 0);
    wide_run(rt, 1);
    full_run(rt);
    tap_case(duite_stop(&rt) == DUITE_OK, "stop");
    return tap_done();
}
