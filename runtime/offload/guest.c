/* Guests: the body works on what came and on what goes back, without versions. The top of its
 * scopes is the guest's own, so that its failures get their place from home and are told there;
 * what its children do is its alone. It is over when all of them are; then it turns into the
 * message with what it left. */
#include "runtime/offload/parcel.h"

#include "runtime/base/pool.h"
#include "runtime/data/mode.h"

#include <string.h>

static const struct parcel *parcel_of(const struct offload_guest *guest)
{
    return data_payload(guest->parcel);
}

static const struct parcel_param *param_of(const struct offload_guest *guest)
{
    return (const void *)(parcel_of(guest) + 1);
}

int offload_guest_home(const struct task *guest)
{
    return (int)guest->guest->parcel->key.slot;
}

/* ---- Arriving ---- */

static void init(struct offload_guest *guest, struct task_graph *graph, struct data_packet *packet)
{
    const struct parcel *parcel = data_payload(packet);
    *guest = (struct offload_guest){
        .above = {.graph = graph, .top = &guest->above},
        .place = {.number = parcel->number, .path_length = parcel->path_length},
        .parcel = packet};
    memcpy(guest->place.path, parcel->path, sizeof parcel->path);
    guest->above.place = &guest->place;
}

bool offload_guest_arrived(struct task_graph *graph, struct worker *worker,
                           struct data_packet *packet)
{
    const struct parcel *parcel = data_payload(packet);
    struct offload_guest *guest = base_pool_take(sizeof *guest);
    if (!guest)
        return false;
    init(guest, graph, packet);
    struct task *task = task_make(&guest->above, TASK_GUEST, parcel->n, 0);
    if (!task) {
        base_pool_give(guest, sizeof *guest);
        return false;
    }
    guest->task = task;
    task->guest = guest;
    task->number = parcel->index;
    task->kernel = parcel->kernel;
    task->block = parcel->block;
    task->priority = parcel->priority;
    task->cost = parcel->cost;
    for (uint32_t i = 0; i < task->n; i++) {
        task->access[i].waiter.mode = data_mode_of(graph->kernels[task->kernel], i);
        task->access[i].sized = param_of(guest)[i].sized;
    }
    atomic_fetch_add_explicit(&graph->guests, 1, memory_order_relaxed);
    work_ready(graph->pool, worker, task);
    return true;
}

/* ---- Running ---- */

static size_t room(const struct task *task, size_t i)
{
    const struct parcel_param *param = &param_of(task->guest)[i];
    return task->access[i].waiter.mode == DUITE_R
               ? 0
               : param->most * data_type_size((duite_type)param->type);
}

/* What the body finds under w is unspecified; under rw it is what came, under cw the law's neutral
 * element. */
static void fill(const struct task *task, size_t i, const void *came, void *data)
{
    const struct parcel_param *param = &param_of(task->guest)[i];
    const duite_kernel *kernel = task->scope->graph->kernels[task->kernel];
    if (task->access[i].waiter.mode == DUITE_RW && param->bytes)
        memcpy(data, came, param->bytes);
    else if (task->access[i].waiter.mode == DUITE_CW)
        data_law_neutral(data_law_of(kernel, i), data, param->most, (duite_type)param->type);
}

/* Gives the body its parameters. False without memory. */
static bool lay_out(const struct task *task, duite_param *param, const void **args)
{
    struct offload_guest *guest = task->guest;
    uint32_t stamp = task->n ? task_new_stamp() : 0;
    size_t bytes = parcel_counts(task->n) + sizeof(struct data_failure);
    for (size_t i = 0; i < task->n; i++)
        bytes += parcel_lines(room(task, i));
    guest->result = data_packet_new(bytes, false);
    if (!guest->result)
        return false;
    char *in = (char *)data_payload(guest->parcel) + parcel_head(task->n);
    char *out = (char *)data_payload(guest->result) + parcel_counts(task->n);
    *args = in;
    in += parcel_lines(task->scope->graph->kernels[task->kernel]->args_size);
    for (uint32_t i = 0; i < task->n; i++) {
        const struct parcel_param *came = &param_of(guest)[i];
        duite_type type = (duite_type)came->type;
        duite_mode mode = (duite_mode)task->access[i].waiter.mode;
        bool fresh = !came->sized || mode == DUITE_W;
        param[i] = (duite_param){.data = mode == DUITE_R ? in : out,
                                 .count = fresh ? came->most : came->bytes / data_type_size(type),
                                 .type = type,
                                 .most = came->most,
                                 .object = {TASK_LOCAL_NAME | i, stamp}};
        fill(task, i, in, out);
        in += parcel_value(mode, came->bytes);
        out += parcel_lines(room(task, i));
    }
    return true;
}

/* The values move together: those of objects that change their size may be smaller than their room.
 */
static void close_up(const struct task *task, const duite_param *param)
{
    struct data_packet *result = task->guest->result;
    uint64_t *bytes = data_payload(result);
    size_t at = parcel_counts(task->n);
    memset(bytes, 0, at);
    for (uint32_t i = 0; i < task->n; i++) {
        if (task->access[i].waiter.mode == DUITE_R)
            continue;
        bytes[i] = param[i].count * data_type_size(param[i].type);
        at = parcel_put(result, at, param[i].data, bytes[i]);
    }
    data_packet_resize(result, at);
}

static bool run(struct task_graph *graph, struct worker *worker, struct task *task,
                duite_param *param, const duite_call *call)
{
    struct offload_guest *guest = task->guest;
    const void *args = NULL;
    guest->failure = task_given_up(graph);
    if (!guest->failure && !lay_out(task, param, &args))
        guest->failure = task_fail_memory(task);
    if (guest->failure)
        return false;
    if (!graph->kernels[task->kernel]->args_size)
        args = NULL;
    guest->failure = task_call_body(graph, worker, task, args, param, &guest->inner, call);
    if (!guest->failure)
        close_up(task, param);
    return true;
}

bool offload_guest_run(struct task_graph *graph, struct worker *worker, struct task *task,
                       const duite_call *call)
{
    enum { FEW = 8 };
    duite_param few[FEW];
    size_t bytes = task->n * sizeof few[0];
    duite_param *param = task->n <= FEW ? few : base_pool_take(bytes);
    if (!param) {
        task->guest->failure = task_fail_memory(task);
        return false;
    }
    bool ran = run(graph, worker, task, param, call);
    if (param != few)
        base_pool_give(param, bytes);
    return ran;
}

/* ---- Going home ---- */

void offload_guest_finish(struct worker *worker, struct task *task)
{
    struct offload_guest *guest = task->guest;
    if (guest->inner)
        task_scope_end(guest->inner, worker);
    else
        offload_guest_over(&guest->above, worker);
}

/* NULL without memory. */
static struct data_packet *failures(const struct offload_guest *guest,
                                    const struct data_failure *told)
{
    struct data_packet *packet = data_packet_new(2 * sizeof *told, true);
    if (!packet)
        return NULL;
    struct data_failure *both = data_payload(packet);
    both[0] = *guest->failure;
    if (told)
        both[1] = *told;
    packet->pieces = PARCEL_FAILED | (told ? PARCEL_TOLD : 0);
    return packet;
}

static void append(struct data_packet *packet, const struct data_failure *told)
{
    size_t at = packet->bytes;
    data_packet_resize(packet, at + sizeof *told);
    parcel_put(packet, at, told, sizeof *told);
    packet->pieces = PARCEL_TOLD;
}

void offload_guest_over(struct task_scope *above, struct worker *worker)
{
    struct offload_guest *guest = (struct offload_guest *)above;
    struct task_graph *graph = above->graph;
    struct task *task = guest->task;
    const struct data_failure *told = task_first_failure(above);
    if (guest->failure) {
        data_packet_free(guest->result);
        guest->result = failures(guest, told);
    } else if (told) {
        append(guest->result, told);
    }
    struct data_packet *result = guest->result;
    guest->send = (struct task_send){
        .key = guest->parcel->key, .to = offload_guest_home(task), .packet = result};
    if (result) {
        result->kind = DATA_RESULT;
        result->key = guest->send.key;
    }
    task->kind = TASK_RESULT;
    task->n = 0; /* nothing of what it read is sent */
    task->send = &guest->send;
    work_ready(graph->pool, worker, task);
}

void offload_guest_gone(struct task_graph *graph, struct task *task)
{
    struct offload_guest *guest = (struct offload_guest *)task->scope;
    data_packet_free(guest->parcel);
    base_pool_give(guest, sizeof *guest);
    base_pool_give(task, (size_t)task->grains * TASK_GRAIN);
    atomic_fetch_sub_explicit(&graph->guests, 1, memory_order_acq_rel);
}
