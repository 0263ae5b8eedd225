/* Calls that bodies make, most of them like the main program. A body mixes what its gets and waits
 * return into its hash, and so into its results. */

#include "tests/runtime/random_run.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int prog_call_new(struct run_scope *scope, const struct prog_op *op)
{
    duite_object *object = &scope->name[op->object];

    scope->shape[op->object] = (struct prog_object){op->type, op->count, op->max, -1, 0};
    return op->max ? duite_new_sized(scope->rt, op->type, op->count, op->max, object)
                   : duite_new(scope->rt, op->type, op->count, object);
}

int prog_call_set(struct run_scope *scope, const struct prog_op *op)
{
    const struct prog_object *shape = &scope->shape[op->object];
    const duite_object object = scope->name[op->object];
    const void *values = op->seed ? scope->bytes : NULL;
    const int whole = op->count == (shape->max ? shape->max : shape->count);

    int code;

    prog_values(shape->type, op->count, op->seed, scope->bytes);
    if (op->rank >= 0)
        code = duite_set_at(scope->rt, object, op->rank, op->rank == scope->rank ? values : NULL);
    else if (whole && op->count % 2)
        code = duite_set(scope->rt, object, values);
    else
        code = duite_set_sized(scope->rt, object, values, op->count);
    memset(scope->bytes, 0xee, scope->largest); /* the runtime has its copy */
    return code;
}

/* Priorities differ between ranks, which must not matter. */
int prog_call_fork(struct run_scope *scope, const struct prog_op *op)
{
    const duite_kernel *kernel = &scope->prog->kernel[op->kernel];
    duite_task_options how = {.priority = op->priority + scope->rank, .cost = op->cost};
    duite_object objects[PROG_MAX_PARAMS];
    struct prog_args args;
    int rank = op->rank, code;

    prog_args_fill(scope->prog, op, scope->shape, &args);
    for (unsigned i = 0; i < op->n; i++)
        objects[i] = scope->name[op->objects[i]];
    if (rank >= 0)
        how.at = &rank;
    if (op->cost >= 0)
        code = duite_fork_with(scope->rt, &how, kernel, &args, op->n, objects);
    else if (rank < 0)
        code = duite_fork(scope->rt, kernel, &args, op->n, objects);
    else
        code = duite_fork_at(scope->rt, rank, kernel, &args, op->n, objects);
    memset(&args, 0xee, sizeof args); /* the runtime has its copy */
    memset(objects, 0xee, sizeof objects);
    memset(&how, 0xee, sizeof how);
    rank = -1;
    return code;
}

int prog_call_split(struct run_scope *scope, const struct prog_op *op)
{
    const duite_type type = scope->shape[op->object].type;
    duite_object part[PROG_MAX_PARTS];
    const int code = duite_split(scope->rt, scope->name[op->object], op->n, op->part, part);

    for (unsigned i = 0; i < op->n; i++) {
        scope->name[op->objects[i]] = part[i];
        scope->shape[op->objects[i]] = (struct prog_object){type, op->part[i], 0, -1, 0};
    }
    return code;
}

/* ---- Bodies ---- */

static uint64_t get_count(struct run_scope *scope, const struct prog_op *op, uint64_t hash)
{
    size_t n = 0;
    const int code = duite_get_count(scope->rt, scope->name[op->object], &n);
    const uint64_t count = n;

    return prog_body_told(hash, code, &count, code ? 0 : sizeof count);
}

/* An object that changes its size is asked for that first; no task may come in between. */
static uint64_t get(struct run_scope *scope, const struct prog_op *op, uint64_t hash)
{
    const struct prog_object *shape = &scope->shape[op->object];
    const duite_object object = scope->name[op->object];
    size_t count = shape->count;
    int code = shape->max ? duite_get_count(scope->rt, object, &count) : DUITE_OK;

    if (!code)
        code = duite_get(scope->rt, object, scope->bytes);
    return prog_body_told(hash, code, scope->bytes, code ? 0 : count * prog_size(shape->type));
}

static int contribute(struct run_scope *scope, const struct prog_op *op)
{
    const struct prog_args *args = scope->call->args;
    const duite_param *param = &scope->call->param[op->object];
    const size_t bytes = param->count * prog_size(param->type);
    unsigned char *values = duite_contribute(scope->call, op->object);

    if (!values)
        return DUITE_E_MEMORY;
    prog_neutral((enum prog_law)args->law[op->object], param->type, param->count, scope->bytes);
    const int is_neutral = !memcmp(values, scope->bytes, bytes);

    prog_values(param->type, param->count, op->seed, values);
    return is_neutral ? DUITE_OK : DUITE_E_LAW;
}

static int wrong_fork(struct run_scope *scope, const struct prog_op *op)
{
    const int none = op->object == PROG_MAX_TABLE;
    const duite_object objects[] = {none ? DUITE_NO_OBJECT : scope->name[op->object]};
    const struct prog_args args = {0};
    const int code = duite_fork(scope->rt, &scope->prog->kernel[1], &args, 1, objects);

    return code == op->fails ? DUITE_OK : DUITE_E_STATE;
}

/* Returns what the body then knows. */
static uint64_t make_call(struct run_scope *scope, const struct prog_op *op, uint64_t hash)
{
    int code = DUITE_OK;

    if (op->kind == PROG_NEW)
        code = prog_call_new(scope, op);
    else if (op->kind == PROG_FREE)
        code = duite_free(scope->rt, scope->name[op->object]);
    else if (op->kind == PROG_SET)
        code = prog_call_set(scope, op);
    else if (op->kind == PROG_FORK)
        code = prog_call_fork(scope, op);
    else if (op->kind == PROG_SPLIT)
        code = prog_call_split(scope, op);
    else if (op->kind == PROG_JOIN)
        code = duite_join(scope->rt, scope->name[op->object]);
    else if (op->kind == PROG_CONTRIBUTE)
        code = contribute(scope, op);
    else if (op->kind == PROG_WRONG)
        code = wrong_fork(scope, op);
    else if (op->kind == PROG_GET)
        hash = get(scope, op, hash);
    else if (op->kind == PROG_COUNT)
        hash = get_count(scope, op, hash);
    else if (op->kind == PROG_WAIT)
        hash = prog_body_told(hash, duite_wait(scope->rt), NULL, 0);
    else if (op->kind == PROG_WAIT_FOR)
        hash =
            prog_body_told(hash, duite_wait_for(scope->rt, 1, &scope->name[op->object]), NULL, 0);
    if (code)
        prog_body_wrong(scope->call->context, (int)op->kind, code);
    return hash;
}

static uint64_t make_calls(const duite_call *call, uint64_t hash)
{
    const struct prog_context *context = call->context;
    const struct prog_args *args = call->args;
    const struct run *run = context->run;
    struct run_scope scope = {.rt = call->rt, .prog = run->prog, .call = call, .rank = call->rank};

    for (size_t i = 0; i < call->n_params; i++)
        scope.name[i] = call->param[i].object;
    prog_shapes(args, scope.shape);
    scope.largest = run->main.largest;
    scope.bytes = prog_memory(scope.largest, 1);
    for (size_t i = 0; i < args->n_inner; i++)
        hash = make_call(&scope, &run->prog->inner[args->body + i], hash);
    free(scope.bytes);
    return hash;
}

/* ---- Events ---- */

struct held {
    duite *rt;
    duite_event event;
    unsigned microseconds;
};

static void *complete(void *argument)
{
    struct held held = *(struct held *)argument;

    free(argument);
    usleep(held.microseconds);
    duite_complete(held.rt, held.event, 0);
    return NULL;
}

/* The task ends some time before or after its body; without memory or a thread it ends with it. */
static void hold(const duite_call *call, uint64_t hash)
{
    struct held *held = malloc(sizeof *held);
    pthread_t thread;

    if (!held)
        return;
    *held = (struct held){.rt = call->rt, .microseconds = (unsigned)(hash % 200)};
    if (duite_event_new(call, &held->event)) {
        prog_body_wrong(call->context, __LINE__, 0);
        free(held);
    } else if (hash % 3 && !pthread_create(&thread, NULL, complete, held)) {
        pthread_detach(thread);
    } else {
        held->microseconds = 0;
        complete(held);
    }
}

/* The same by requests of MPI, of this process to itself. */
static void hold_by_requests(const duite_call *call, const struct prog_args *args)
{
    const int tag = (int)(args->number % 1000);
    MPI_Request request[2];
    int code = duite_mpi_begin(call->rt);

    code |= MPI_Irecv(NULL, 0, MPI_BYTE, 0, tag, MPI_COMM_SELF, &request[0]);
    code |= MPI_Isend(NULL, 0, MPI_BYTE, 0, tag, MPI_COMM_SELF, &request[1]);
    code |= duite_mpi_end(call->rt) | duite_await_mpi(call, 2, request);
    if (code)
        prog_body_wrong(call->context, __LINE__, 0);
}

int prog_body(const duite_call *call)
{
    const struct prog_args *args = call->args;
    uint64_t hash = prog_body_begin(call);

    if (args->n_inner)
        hash = make_calls(call, hash);
    if (args->holds && hash % 4)
        hold(call, hash);
    else if (args->holds)
        hold_by_requests(call, args);
    return prog_body_end(call, hash);
}
