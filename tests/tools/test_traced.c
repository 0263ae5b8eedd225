/* Where the recording of steps ends, the trace says that the main program waited there: what a step
 * that is recorded alone took is the time of its tasks, not of the forks before them. With one
 * thread bodies run while the main program waits, and never else. And a get in two calls is in the
 * trace where it begins and where it ends. */
#include "tests/negative/misuse.h"
#include "tests/support/unit.h"
#include "tools/trace/read.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { TASKS = 5 };

/* Entries of the main program, as far as these programs have any. */
struct span {
    uint64_t from, to;
};

static struct {
    const struct trace_run *run;
    size_t at;
    unsigned forks;   /* since the recording began */
    struct span wait; /* the first one after all of these; to 0: there was none */
    uint64_t end;     /* of the recording, which ended so often: */
    unsigned ends;
    char calls[16]; /* a letter for each: f fork, b, e begin and end of a get, w wait */
    uint32_t get;   /* the number of the get that begins */
} seen;

static uint32_t word(void)
{
    ck_assert_uint_lt(seen.at, seen.run->n_words);
    return seen.run->word[seen.at++];
}

static uint64_t word2(void)
{
    const uint64_t low = word();
    return low | (uint64_t)word() << 32;
}

/* All bodies of the step lie in the wait. */
static void check_end(void)
{
    const struct trace_rank *traced = &seen.run->rank[0];
    unsigned bodies = 0;

    ck_assert_uint_eq(seen.forks, TASKS);
    ck_assert_uint_ne(seen.wait.to, 0);
    ck_assert_uint_ge(seen.end, seen.wait.to);
    for (size_t p = 0; p < traced->n_pieces; p++)
        for (size_t i = 0; i < traced->piece[p].n; i++) {
            const struct trace_event *event = &traced->piece[p].event[i];

            if (event->kind != TRACE_TASK)
                continue;
            bodies++;
            ck_assert_uint_ge(event->begin, seen.wait.from);
            ck_assert_uint_le(event->begin + event->took, seen.wait.to);
        }
    ck_assert_uint_eq(bodies, TASKS);
}

static void call(char letter)
{
    const size_t n = strlen(seen.calls);

    ck_assert_uint_lt(n + 1, sizeof seen.calls);
    seen.calls[n] = letter;
}

static void entry(void)
{
    const uint32_t first = word();
    const size_t n = first >> 8;

    switch (first & 0xff) {
    case TRACE_OBJECT:
        seen.at += 3;
        break;
    case TRACE_FREE:
        seen.at += 1;
        break;
    case TRACE_HOMES:
        seen.at += 2 * n;
        break;
    case TRACE_FORK:
        seen.at += 1 + n;
        seen.forks++;
        seen.wait = (struct span){0, 0};
        call('f');
        break;
    case TRACE_GET_BEGIN:
        seen.get = word();
        seen.at += 1;
        call('b');
        break;
    case TRACE_GET_END:
        ck_assert_uint_eq(word(), seen.get);
        seen.at += 4;
        call('e');
        break;
    case TRACE_WAIT: {
        struct span wait = {.from = word2()};

        call('w');
        wait.to = word2();
        seen.wait = seen.wait.to ? seen.wait : wait;
        break;
    }
    case TRACE_ON:
        seen.at += 6;
        break;
    case TRACE_OFF:
        seen.at += 4;
        seen.end = word2();
        seen.ends++;
        break;
    default:
        ck_abort_msg("entry %u at word %zu", first, seen.at - 1);
    }
}

/* Reads the program of a trace, and calls back before the trace goes. */
static void check_trace(const char *file, void (*check)(void))
{
    struct trace_run *run;

    ck_assert_msg(!trace_read(&run, file, false), "%s", duite_message());
    unlink(file);
    memset(&seen, 0, sizeof seen);
    seen.run = run;
    while (seen.at < run->n_words)
        entry();
    ck_assert_uint_eq(seen.ends, 1);
    check();
    trace_run_free(run);
}

static void fork_step(duite *rt, duite_object object)
{
    for (int i = 0; i < TASKS; i++)
        ck_assert_int_eq(duite_fork(rt, &ADD, NULL, 1, &object), DUITE_OK);
}

static char file[400];

/* A runtime of one thread, which records these steps. */
static duite *traced_start(uint64_t first, uint64_t end)
{
    const char *const folder = getenv("TMPDIR") ? getenv("TMPDIR") : "/tmp";
    duite_options options = misuse_options(MPI_COMM_WORLD);
    duite *rt;

    misuse_mpi();
    snprintf(file, sizeof file, "%s/duite-traced.%d", folder, (int)getpid());
    options.threads = 1;
    options.trace = file;
    options.trace_first = first;
    options.trace_end = end;
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_OK);
    return rt;
}

enum { NEXT_STEP, TRACE_END, STOP, ENDS };

/* One step is recorded, and ended by the next one, by the end of the trace, or by that of the run.
 */
UNIT_LOOP(last_wait, 0, ENDS)
{
    duite *rt = traced_start(1, _i == NEXT_STEP ? 2 : 3);
    duite_object object = misuse_new(rt, 1);
    ck_assert_int_eq(duite_trace_step(rt, 1), DUITE_OK);
    fork_step(rt, object);
    if (_i == NEXT_STEP) {
        ck_assert_int_eq(duite_trace_step(rt, 2), DUITE_OK);
        fork_step(rt, object); /* of which nothing is written */
    }
    if (_i == TRACE_END)
        ck_assert_int_eq(duite_trace_end(rt), DUITE_OK);
    duite_free(rt, object);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
    check_trace(file, check_end);
}

static void check_gets(void)
{
    ck_assert_str_eq(seen.calls, "fbfeww");
}

/* The value that a get has is that of its begin, so the second task comes behind it. */
UNIT_TEST(gets_in_two_calls)
{
    duite *rt = traced_start(0, UINT64_MAX);
    const duite_object object = misuse_new(rt, 1);
    int32_t value = 0;
    ck_assert_int_eq(duite_fork(rt, &SET, &(int32_t){1}, 1, &object), DUITE_OK);
    ck_assert_int_eq(duite_get_begin(rt, object, &value), DUITE_OK);
    ck_assert_int_eq(duite_fork(rt, &SET, &(int32_t){2}, 1, &object), DUITE_OK);
    ck_assert_int_eq(duite_get_end(rt, object), DUITE_OK);
    ck_assert_int_eq(value, 1);
    duite_free(rt, object);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
    check_trace(file, check_gets);
}
