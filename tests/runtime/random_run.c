/* Runs a program on duite and compares. No answer of the runtime decides anything, so that
 * every rank goes through the same calls whatever it finds; the first thing found is kept. */

#include "tests/runtime/random_run.h"

#include "runtime/comm/internal.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

enum { UNTOUCHED = 0xa5 };

void prog_found(struct run *run, const char *format, ...)
{
    va_list list;

    if (run->report->text[0])
        return;
    va_start(list, format);
    vsnprintf(run->report->text, sizeof run->report->text, format, list);
    va_end(list);
    run->report->op = run->at;
}

void prog_expect_code(struct run *run, const char *call, int code, int expected)
{
    if (code != expected)
        prog_found(run, "%s returned %d (%s), expected %d", call, code,
                   code ? duite_message() : "ok", expected);
}

static void compare(struct run *run, unsigned number, const struct prog_expect *answer)
{
    const struct prog_object *object = &run->prog->objects[number];
    const size_t size = prog_size(object->type);
    char is[80] = "", should[80] = "";
    size_t i = 0, different = 0, first = 0;

    for (; i < answer->count; i++)
        if (memcmp(run->main.bytes + i * size, answer->bytes + i * size, size) != 0 &&
            different++ == 0)
            first = i;
    for (i *= size; i < run->main.largest; i++)
        if (run->main.bytes[i] != UNTOUCHED)
            prog_found(run, "object %u: byte %zu behind its %zu elements was written", number, i,
                       answer->count);
    if (!different)
        return;
    prog_print_element(object->type, run->main.bytes, first, is, sizeof is);
    prog_print_element(object->type, answer->bytes, first, should, sizeof should);
    prog_found(run, "object %u: %zu of %zu elements differ, first [%zu]: %s, expected %s", number,
               different, answer->count, first, is, should);
}

static void get(struct run *run, const struct prog_op *op, const struct prog_expect *answer)
{
    memset(run->main.bytes, UNTOUCHED, run->main.largest);
    const int here = op->kind == PROG_GET || op->rank == run->main.rank;
    void *values = here ? run->main.bytes : NULL;
    const int code = op->kind == PROG_GET
                         ? duite_get(run->main.rt, run->main.name[op->object], values)
                         : duite_get_at(run->main.rt, run->main.name[op->object], op->rank, values);

    prog_expect_code(run, op->kind == PROG_GET ? "get" : "get_at", code,
                     here ? answer->code : DUITE_OK);
    if (here && answer->bytes && code == answer->code)
        compare(run, op->object, answer);
}

static void get_count(struct run *run, const struct prog_op *op, const struct prog_expect *answer)
{
    const size_t none = (size_t)-3, expected = answer->bytes ? answer->count : none;
    size_t count = none;

    prog_expect_code(run, "get_count",
                     duite_get_count(run->main.rt, run->main.name[op->object], &count),
                     answer->code);
    if (count != expected)
        prog_found(run, "object %u has %zu elements, expected %zu", op->object, count, expected);
}

static void wait_for(struct run *run, const struct prog_op *op, const struct prog_expect *answer)
{
    duite_object objects[PROG_MAX_PARAMS];
    int there = 0, code = DUITE_OK;

    for (unsigned i = 0; i < op->n; i++)
        objects[i] = run->main.name[op->objects[i]];
    if (op->kind == PROG_WAIT_FOR)
        code = duite_wait_for(run->main.rt, op->n, objects);
    else
        do
            code = duite_test(run->main.rt, op->n, objects, &there);
        while (!there && op->count);
    prog_expect_code(run, op->kind == PROG_TEST ? "test" : "wait_for", code, answer->code);
}

static void get_later(struct run *run, const struct prog_op *op, const struct prog_expect *answer)
{
    struct run_scope *main = &run->main;
    const duite_object object = main->name[op->object];

    if (!prog_is_got(run->prog, op))
        return;
    if (op->kind == PROG_GET_BEGIN) {
        unsigned char *got = run->got[run->at] = prog_memory(main->largest, 1);

        memset(got, UNTOUCHED, main->largest);
        prog_expect_code(run, "get_begin", duite_get_begin(main->rt, object, got), DUITE_OK);
        return;
    }
    const int code = duite_get_end(main->rt, object);

    memcpy(main->bytes, run->got[op->body], main->largest);
    prog_expect_code(run, "get_end", code, answer->code);
    if (answer->bytes)
        compare(run, op->object, answer);
}

/* A kernel that contributes to one object is given it twice. */
static void wrong_fork(struct run *run, const struct prog_op *op, int expected)
{
    const duite_object objects[] = {run->main.name[op->object], run->main.name[op->object]};
    const struct prog_args args = {0};

    prog_expect_code(run, "fork",
                     duite_fork(run->main.rt, &run->prog->kernel[0], &args, 2, objects), expected);
}

static void hint(struct run *run, const struct prog_op *op)
{
    duite_object neighbours[PROG_MAX_PARAMS];
    double weights[PROG_MAX_PARAMS];

    for (unsigned i = 0; i < op->n; i++) {
        neighbours[i] = run->main.name[op->objects[i]];
        weights[i] = i;
    }
    prog_expect_code(run, "hint",
                     duite_hint(run->main.rt, run->main.name[op->object], op->weight, op->n,
                                neighbours, weights),
                     DUITE_OK);
}

static void ask_home(struct run *run, unsigned number)
{
    const int home = duite_home(run->main.rt, run->main.name[number]);
    const int adopted = run->main.shape[number].adopted;

    if (adopted && home != adopted - 1)
        prog_found(run, "object %u, adopted on rank %d, has home %d", number, adopted - 1, home);
    if (run->moves)
        return;
    if (home < 0 || home >= run->prog->n_ranks)
        prog_found(run, "object %u has home %d", number, home);
    if (run->home[number] >= 0 && run->home[number] != home)
        prog_found(run, "object %u moved from %d to %d", number, run->home[number], home);
    run->home[number] = home;
}

static void split(struct run *run, const struct prog_op *op)
{
    ask_home(run, op->object);
    prog_expect_code(run, "split", prog_call_split(&run->main, op), DUITE_OK);
    for (unsigned i = 0; i < op->n; i++)
        ask_home(run, op->objects[i]);
}

static void free_object(struct run *run, const struct prog_op *op)
{
    ask_home(run, op->object);
    run->memory[op->object].freed = run->at + 1;
    prog_expect_code(run, "free", duite_free(run->main.rt, run->main.name[op->object]), DUITE_OK);
}

/* Kernels, hints and homes of a program; and its graphs. */
static void steering(struct run *run, const struct prog_op *op, const struct prog_expect *answer)
{
    duite_object *object = &run->main.name[op->object];

    switch (op->kind) {
    case PROG_KERNEL:
        prog_expect_code(run, "kernel_add",
                         duite_kernel_add(run->main.rt, &run->prog->kernel[op->kernel]), DUITE_OK);
        break;
    case PROG_HINT:
        hint(run, op);
        break;
    case PROG_FOLLOW:
        prog_expect_code(run, "follow",
                         duite_colocate(run->main.rt, *object, run->main.name[op->objects[0]]),
                         DUITE_OK);
        break;
    case PROG_HOME:
        ask_home(run, op->object);
        break;
    case PROG_WRONG:
        wrong_fork(run, op, answer->code);
        break;
    default:
        prog_call_graph(run, op, answer);
    }
}

static void operation(struct run *run, const struct prog_op *op, const struct prog_expect *answer)
{
    duite_object *object = &run->main.name[op->object];

    switch (op->kind) {
    case PROG_NEW:
        prog_expect_code(run, "new",
                         op->rank < 0 ? prog_call_new(&run->main, op) : prog_call_adopt(run, op),
                         DUITE_OK);
        break;
    case PROG_FREE:
        free_object(run, op);
        break;
    case PROG_ACQUIRE:
        prog_call_acquire(run, op, answer);
        break;
    case PROG_RELEASE:
        prog_call_release(run, op);
        break;
    case PROG_SPLIT:
        split(run, op);
        break;
    case PROG_JOIN:
        prog_expect_code(run, "join", duite_join(run->main.rt, *object), DUITE_OK);
        break;
    case PROG_SET:
        prog_expect_code(run, "set", prog_call_set(&run->main, op), DUITE_OK);
        break;
    case PROG_FORK:
        prog_expect_code(run, "fork", prog_call_fork(&run->main, op), DUITE_OK);
        break;
    case PROG_GET:
    case PROG_GET_AT:
        get(run, op, answer);
        break;
    case PROG_COUNT:
        get_count(run, op, answer);
        break;
    case PROG_WAIT:
        prog_expect_code(run, "wait", duite_wait(run->main.rt), answer->code);
        prog_check_memory(run, 1);
        break;
    case PROG_WAIT_FOR:
    case PROG_TEST:
        wait_for(run, op, answer);
        break;
    case PROG_GET_BEGIN:
    case PROG_GET_END:
        get_later(run, op, answer);
        break;
    case PROG_SKIP:
    case PROG_CONTRIBUTE:
    case PROG_GRAPH_FORK:
    case PROG_GRAPH_SET:
        break;
    default:
        steering(run, op, answer);
    }
}

/* Bytes of the pieces of large messages: small ones, but at most so many of the largest object,
 * since MPI looks through all that wait. */
enum { MOST_PIECES = 200 };

static size_t piece_bytes(const struct prog *prog, uint64_t seed)
{
    static const size_t PIECES[] = {40, 100, 300, COMM_PIECE_BYTES};
    size_t bytes = PIECES[seed % (sizeof PIECES / sizeof *PIECES)];

    for (size_t i = 0; i < prog->n_objects; i++) {
        const struct prog_object *object = &prog->objects[i];
        const size_t most = object->max ? object->max : object->count;

        if (most * prog_size(object->type) / MOST_PIECES > bytes)
            bytes = most * prog_size(object->type) / MOST_PIECES;
    }
    return bytes;
}

static void run_operations(struct run *run, const struct prog_setup *setup,
                           struct prog_context *context, volatile size_t *where)
{
    const struct prog *prog = run->prog;
    duite_options options = duite_options_default();

    options.comm = setup->comm;
    options.kernels = prog->list;
    options.laws = prog_own_laws;
    options.context = context;
    options.threads = setup->threads;
    options.scheduler = duite_scheduler_find(setup->scheduler);
    options.mapping = duite_mapping_find(setup->mapping);
    options.balance = duite_balancer_find(setup->balance);
    options.seed = setup->seed;
    options.spin_seconds = setup->spin;
    options.bind = 0;
    options.window = setup->window;
    options.memo = setup->memo;
    options.check = setup->check;
    comm_piece_bytes = piece_bytes(prog, setup->seed);
    run->moves = options.balance->migrate || options.mapping->map_tasks;
    const int code = duite_start(&run->main.rt, &options);

    prog_expect_code(run, "start", code, DUITE_OK);
    if (code)
        return;
    for (run->at = 0; run->at < prog->n_ops; run->at++) {
        *where = run->at;
        if (setup->verbose && run->main.rank == 0)
            prog_print(stdout, prog, run->at);
        operation(run, &prog->ops[run->at], &run->answers->op[run->at]);
    }
    for (unsigned i = 0; i < prog->n_objects; i++)
        if (run->moves)
            run->home[i] = duite_home(run->main.rt, run->main.name[i]);
        else if (run->home[i] < 0)
            ask_home(run, i);
    duite_counters counters = {0};

    prog_expect_code(run, "count_all", duite_count_all(run->main.rt, &counters), DUITE_OK);
    run->report->recognised = counters.recognised;
    if (counters.recognised && (!setup->memo || setup->check || prog->n_ranks > 1))
        prog_found(run, "forks were recognised");
    if (counters.graphs_recorded != run->answers->n_recorded)
        prog_found(run, "%llu graphs recorded, expected %llu",
                   (unsigned long long)counters.graphs_recorded,
                   (unsigned long long)run->answers->n_recorded);
    prog_expect_code(run, "stop", duite_stop(&run->main.rt), run->answers->stop);
    if (run->main.rt)
        prog_found(run, "stop left *rt");
    prog_check_memory(run, 0);
    prog_check_places(run, context, setup);
}

static size_t most_bytes(const struct prog_op *ops, size_t n, size_t most)
{
    for (size_t i = 0; i < n; i++) {
        const size_t max = ops[i].max ? ops[i].max : ops[i].count;

        if (ops[i].kind == PROG_NEW && max * prog_size(ops[i].type) > most)
            most = max * prog_size(ops[i].type);
    }
    return most;
}

void prog_run(const struct prog *prog, const struct prog_answers *answers,
              const struct prog_setup *setup, struct prog_report *report, volatile size_t *where)
{
    struct run run = {.prog = prog, .answers = answers, .report = report, .check = setup->check};
    struct prog_context context = {.threads = setup->threads, .run = &run};
    struct run_scope *main = &run.main;

    *report = (struct prog_report){0};
    main->prog = prog;
    MPI_Comm_rank(setup->comm, &main->rank);
    context.rank = main->rank;
    memcpy(main->shape, prog->objects, sizeof main->shape);
    main->largest = most_bytes(prog->ops, prog->n_ops, 1);
    main->largest = most_bytes(prog->inner, prog->n_inner, main->largest);
    main->bytes = prog_memory(main->largest, 1);
    memset(run.home, 0xff, sizeof run.home);
    run.graph = prog_memory(prog->n_graphs, sizeof *run.graph);
    run.got = prog_memory(prog->n_ops, sizeof *run.got);
    context.ran = prog_memory(prog->n_forks, sizeof *context.ran);
    run_operations(&run, setup, &context, where);
    if (context.code)
        prog_found(&run, "a call in a body (kind %d) returned %d", context.wrong, context.code);
    else if (context.wrong)
        prog_found(&run, "a body was called wrongly: random_bodies.c:%d", context.wrong);
    free(main->bytes);
    for (size_t i = 0; i < prog->n_ops; i++)
        free(run.got[i]);
    free(run.got);
    free(run.graph);
    free(context.ran);
}
