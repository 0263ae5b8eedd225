/* The main program's turn on an object: a task of a kernel of the runtime's own, whose body hands
 * out its data and which an event holds until the program releases the object. So the turn has its
 * place in the order like any task. All ranks keep the same list of turns; the data are on one. */
#include "runtime/api/instance.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/task/event.h"

struct api_turn {
    struct api_turn *next;
    duite_object object;
    duite_event event; /* {0, 0}: the task is elsewhere, or over */
    void *data;
    _Atomic int begun;
};

static int acquire_body(const duite_call *call)
{
    struct api_turn *turn = *(struct api_turn *const *)call->args;
    const int code = duite_event_new(call, &turn->event);
    turn->data = code ? NULL : call->param[0].data;
    atomic_store_explicit(&turn->begun, 1, memory_order_release);
    queue_notify(call->own->graph->pool);
    return code;
}

#define TURN(mode_, name_)                                                                         \
    {                                                                                              \
        .name = name_, .body = acquire_body, .access = {mode_},                                    \
        .args_size = sizeof(struct api_turn *), .side_effects = 1, .events = 1                     \
    }
static const duite_kernel turn_kernels[] = {TURN(DUITE_R, "duite_acquire r"),
                                            TURN(DUITE_W, "duite_acquire w"),
                                            TURN(DUITE_RW, "duite_acquire rw")};
enum { TURNS = sizeof turn_kernels / sizeof *turn_kernels };

const duite_kernel **api_add_kernels(const duite_kernel *const *kernels)
{
    size_t n = 0;
    while (kernels[n])
        n++;
    const duite_kernel **all = base_alloc((n + TURNS + 1) * sizeof *all);
    for (size_t i = 0; all && i < n; i++)
        all[i] = kernels[i];
    for (size_t i = 0; all && i < TURNS; i++)
        all[n + i] = &turn_kernels[i];
    if (all)
        all[n + TURNS] = NULL;
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

static void turn_end(duite *rt, struct api_turn **place)
{
    struct api_turn *turn = *place;
    if (turn->event.slot)
        task_complete(&rt->graph, turn->event, DUITE_OK);
    *place = turn->next;
    base_free(turn);
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

/* Its task is over without a turn, if all tasks are. */
struct turn_wait {
    const duite *rt;
    const struct api_turn *turn;
};
static bool turn_is_settled(void *context)
{
    const struct turn_wait *wait = context;
    return atomic_load_explicit(&wait->turn->begun, memory_order_acquire) ||
           work_is_drained(wait->rt->pool);
}

/* The value is there and whole, for a turn that reads it: the task then runs. */
static int turn_wait_for_value(duite *rt, duite_object object, duite_mode mode, int home)
{
    size_t count;
    return mode == DUITE_W ? DUITE_OK : api_get(rt, object, home, NULL, &count, "duite_acquire");
}

static int turn_begin(duite *rt, struct api_turn *turn, duite_mode mode)
{
    const duite_kernel *kernel = &turn_kernels[mode - DUITE_R];
    const int home = duite_home(rt, turn->object);
    const int poisoned = home < 0 ? DUITE_OK : turn_wait_for_value(rt, turn->object, mode, home);
    if (rt->graph.broken || comm_is_broken(rt->comm))
        return poisoned;
    const int code = duite_fork(rt, kernel, &turn, 1, &turn->object);
    if (code || poisoned || home != rt->graph.rank)
        return code ? code : poisoned;
    work_until(rt->pool, &(struct work_why){"duite_acquire", "its turn on an object", NULL},
               turn_is_settled, &(struct turn_wait){rt, turn});
    if (turn->begun)
        return DUITE_OK;
    return comm_is_broken(rt->comm) ? comm_error(rt->comm) : base_no_memory("a turn on an object");
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
    turn->next = rt->turns;
    rt->turns = turn;
    code = turn_begin(rt, turn, mode);
    *data = turn->data;
    if (code == DUITE_E_OBJECT) /* on all ranks: nothing was forked */
        turn_end(rt, &rt->turns);
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
