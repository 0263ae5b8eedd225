/* The main program's turn on an object: a task of a kernel of the runtime's own, whose body hands
 * out its data and which an event holds until the program releases the object. So the turn has its
 * place in the order like any task. All ranks keep the same list of turns; the data are on one.
 *
 * A turn is held by the list, by its task until that is over, and by the call that makes it. When
 * communication breaks, all turns leave the list: a task that begins afterwards, or was about to,
 * finds `released` and ends by itself. */
#include "runtime/api/instance.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/check/check.h"
#include "runtime/data/adopted.h"
#include "runtime/task/event.h"
#include "runtime/task/parts.h"

#include <string.h>

struct api_turn {
    struct api_turn *next;
    duite_object object;
    duite_event event; /* written before `begun`, as are: */
    void *data;
    size_t bytes;
    struct data_version *version;
    struct data_packet *kept; /* adopted memory that it reads and no version has, or NULL */
    bool writes;
    struct check_region lent;           /* checking mode: the copy that the program has instead */
    const struct data_failure *failure; /* of its task, written before `over` */
    _Atomic int holders, begun, over, released;
};

static void turn_drop(struct api_turn *turn)
{
    if (atomic_fetch_sub_explicit(&turn->holders, 1, memory_order_acq_rel) == 1)
        base_free(turn);
}

/* The task and the program may both find that the other one is done: then one of them is late, and
 * its event is gone. */
static void turn_complete(struct task_graph *graph, struct api_turn *turn)
{
    if (atomic_load(&turn->begun) && atomic_load(&turn->released))
        task_complete(graph, turn->event, DUITE_OK);
}

static int acquire_body(const duite_call *call)
{
    struct api_turn *turn = *(struct api_turn *const *)call->args;
    const int code = duite_event_new(call, &turn->event);
    if (code)
        return code;
    turn->data = call->param[0].data;
    turn->bytes = call->param[0].count * data_type_size(call->param[0].type);
    turn->version = call->own->task->access[0].waiter.version;
    atomic_store(&turn->begun, 1);
    turn_complete(call->own->graph, turn);
    queue_notify(call->own->graph->pool);
    return DUITE_OK;
}

/* The task is over, with or without its body. */
static void acquire_over(struct task_graph *graph, const void *args,
                         const struct data_failure *failure)
{
    struct api_turn *turn = *(struct api_turn *const *)args;
    turn->failure = failure;
    atomic_store(&turn->over, 1);
    queue_notify(graph->pool);
    turn_drop(turn);
}

#define TURN(mode_, name_)                                                                         \
    {                                                                                              \
        .name = name_, .body = acquire_body, .access = {mode_},                                    \
        .args_size = sizeof(struct api_turn *), .side_effects = 1, .events = 1                     \
    }
static const duite_kernel turn_kernels[] = {TURN(DUITE_R, "duite_acquire r"),
                                            TURN(DUITE_W, "duite_acquire w"),
                                            TURN(DUITE_RW, "duite_acquire rw")};
enum { TURNS = sizeof turn_kernels / sizeof *turn_kernels, OWN = TURNS + 2 };

void api_watch_turns(struct task_graph *graph)
{
    graph->n_own = graph->n_kernels < OWN ? 0 : OWN;
    graph->own_kernels = graph->n_kernels - graph->n_own;
    graph->own_over = acquire_over;
}

const duite_kernel **api_add_kernels(const duite_kernel *const *kernels)
{
    size_t n = 0;
    while (kernels[n])
        n++;
    const duite_kernel **all = base_alloc((n + OWN + 1) * sizeof *all);
    for (size_t i = 0; all && i < n; i++)
        all[i] = kernels[i];
    for (size_t i = 0; all && i < TURNS; i++)
        all[n + i] = &turn_kernels[i];
    if (all) {
        all[n + TURNS] = &task_split_kernel;
        all[n + TURNS + 1] = &task_join_kernel;
        all[n + OWN] = NULL;
    }
    return all;
}

/* ---- Turns ---- */

static struct api_turn **turn_find(duite *rt, duite_object object)
{
    struct api_turn **turn = &rt->turns;
    while (*turn &&
           ((*turn)->object.slot != object.slot || (*turn)->object.generation != object.generation))
        turn = &(*turn)->next;
    return turn;
}

/* The list holds it no more, and the program has it no more. */
static void turn_end(duite *rt, struct api_turn **place)
{
    struct api_turn *turn = *place;
    *place = turn->next;
    if (turn->lent.base)
        check_take_back(rt->check, &turn->lent, turn->writes ? turn->data : NULL);
    data_packet_free(turn->kept);
    turn->kept = NULL;
    atomic_store(&turn->released, 1);
    turn_complete(&rt->graph, turn);
    turn_drop(turn);
}

void api_release_all(duite *rt)
{
    while (rt->turns)
        turn_end(rt, &rt->turns);
}

int api_check_turns(const duite *rt, const char *call)
{
    const struct api_turn *turn = rt->turns;
    if (!turn)
        return DUITE_OK;
    return base_error(DUITE_E_STATE,
                      "%s: the program has acquired object %u.%u; tasks may wait for it until "
                      "duite_release",
                      call, turn->object.slot, turn->object.generation);
}

/* ---- Their begin ---- */

static bool turn_is_settled(void *context)
{
    struct api_turn *turn = context;
    return atomic_load(&turn->begun) || atomic_load(&turn->over);
}

static bool turn_memory_rests(void *memory)
{
    return data_adopted_rests(memory);
}

/* The turn has begun. A value whose object has adopted memory, and that lies elsewhere, comes
 * there; a reader gets a copy, since others may read the value meanwhile. Tasks that still use the
 * memory come earlier, so they end. */
static int turn_come_home(duite *rt, struct api_turn *turn, duite_mode mode)
{
    struct data_object *object = data_object_here(&rt->graph.table, turn->object);
    struct data_adopted *memory = object ? object->memory : NULL;
    struct data_packet *packet = turn->version->packet;
    if (!memory || memory->packet.elsewhere == data_nowhere || packet == &memory->packet)
        return DUITE_OK;
    work_until(rt->pool,
               &(struct work_why){"duite_acquire", "earlier tasks on adopted memory", NULL},
               turn_memory_rests, memory);
    if (!data_adopted_rests(memory))
        return comm_error(rt->comm);
    turn->data = data_payload(data_adopted_take(memory));
    if (mode != DUITE_W)
        memcpy(turn->data, data_payload(packet), packet->bytes);
    if (mode == DUITE_R) {
        turn->kept = &memory->packet;
    } else {
        turn->version->packet = &memory->packet;
        data_packet_free(packet);
    }
    return DUITE_OK;
}

/* The data that the program gets. In checking mode, and unless they are its own memory, a copy. */
static void *turn_data(duite *rt, struct api_turn *turn)
{
    const struct data_object *object = data_object_here(&rt->graph.table, turn->object);
    void *copy = NULL;
    if (rt->check && turn->data && object && !object->memory)
        copy = check_lend(&turn->lent, turn->object, turn->data, turn->bytes);
    return copy ? copy : turn->data;
}

/* On the object's home: works until the turn begins, or its task is over without it. */
static int turn_wait(duite *rt, struct api_turn *turn, duite_mode mode)
{
    work_until(rt->pool, &(struct work_why){"duite_acquire", "its turn on an object", NULL},
               turn_is_settled, turn);
    if (atomic_load(&turn->begun))
        return turn_come_home(rt, turn, mode);
    if (atomic_load(&turn->over))
        return task_failure_error(&rt->graph, turn->failure);
    return comm_error(rt->comm);
}

/* The turn is new, and held once. It stays in the list if its task was forked. */
static int turn_begin(duite *rt, struct api_turn *turn, duite_mode mode)
{
    const int home = duite_home(rt, turn->object);
    const bool here = home == rt->graph.rank;
    turn->holders = here ? 3 : 2;
    turn->next = rt->turns;
    rt->turns = turn;
    const int code = duite_fork(rt, &turn_kernels[mode - DUITE_R], &turn, 1, &turn->object);
    if (!code)
        return here ? turn_wait(rt, turn, mode) : DUITE_OK;
    if (here)
        turn_drop(turn); /* its task never was */
    if (rt->turns == turn)
        turn_end(rt, &rt->turns);
    return code;
}

int duite_acquire(duite *rt, duite_object object, duite_mode mode, void **data)
{
    if (data)
        *data = NULL;
    int code = api_enter(rt, "duite_acquire");
    if (code)
        return code;
    if (!data || mode < DUITE_R || mode > DUITE_RW)
        return api_remember(rt, base_error(DUITE_E_ARGUMENT, "duite_acquire: %s",
                                           data ? "the mode is not DUITE_R, DUITE_W or DUITE_RW"
                                                : "nowhere to put the data"));
    if (*turn_find(rt, object))
        return api_remember(rt, base_error(DUITE_E_STATE,
                                           "duite_acquire: object %u.%u is acquired already",
                                           object.slot, object.generation));
    struct api_turn *turn = base_alloc_zero(sizeof *turn);
    if (!turn)
        return api_remember(rt, base_no_memory("a turn on an object"));
    turn->object = object;
    turn->writes = mode != DUITE_R;
    code = turn_begin(rt, turn, mode);
    if (!code && rt->turns == turn)
        *data = turn_data(rt, turn);
    turn_drop(turn);
    return code;
}

int duite_release(duite *rt, duite_object object)
{
    const int code = api_enter(rt, "duite_release");
    struct api_turn **turn = code ? NULL : turn_find(rt, object);
    if (code)
        return code;
    if (!*turn)
        return api_remember(rt,
                            base_error(DUITE_E_STATE, "duite_release: object %u.%u is not acquired",
                                       object.slot, object.generation));
    turn_end(rt, turn);
    return DUITE_OK;
}
