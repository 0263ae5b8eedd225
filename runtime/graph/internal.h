#ifndef DUITE_GRAPH_INTERNAL_H
#define DUITE_GRAPH_INTERNAL_H

#include "runtime/graph/graph.h"

/* Shared by the files of this folder only. */

/* A task with n accesses and `extra` bytes behind them (in task->args); pending is n + 1; counted
 * as unfinished. NULL without memory: then the graph is broken. */
struct graph_task *graph_task_new(struct graph *graph, enum graph_kind kind, size_t n,
                                  size_t extra);

/* Takes `done` and the hold of the fork from pending; the task is ready if nothing is left. */
void graph_settled(struct graph *graph, void *worker, struct graph_task *task, uint32_t done);

/* What the waiter waited for is there. NULL is fine. */
void graph_wake(struct graph *graph, void *worker, struct data_waiter *waiter);

/* Releases a hold and wakes the heir. */
void graph_release(struct graph *graph, void *worker, struct data_version *version);

/* The version is there: wakes its readers, releases the producer's hold. */
void graph_publish(struct graph *graph, void *worker, struct data_version *version);

/* Makes access i of the task a reader of `version`, or its heir that writes the new version
 * returned by graph_overwrite. *done grows by one if there is nothing to wait for. */
void graph_read(struct graph_task *task, size_t i, struct data_version *version, uint32_t *done);
int graph_overwrite(struct graph *graph, struct graph_task *task, size_t i,
                    struct data_object *object, struct data_version *version, uint32_t *done);

/* A w is about to overwrite the current version on this rank: returns the version to be
 * overwritten, or NULL if there are to be fresh bytes. */
struct data_version *graph_rename(struct graph *graph, void *worker, struct data_object *object);

/* This rank's copy of the current version, which is to be here or on its way (graph_fetch); zeros
 * if it was never written. NULL: out of memory, broken. */
struct data_version *graph_local(struct graph *graph, struct data_object *object);

/* Sees to it that rank `to` gets the current version: sends, awaits, or notes that others do. */
int graph_fetch(struct graph *graph, void *worker, struct data_object *object, int to);

/* The object has a new version on another rank: this rank's copy is stale. */
void graph_forget(struct graph *graph, void *worker, struct data_object *object);

/* Contributions: adds a leaf for access i (task NULL: it runs elsewhere, on rank `at`) after ending
 * a run of another law, and ends the run of them. */
int graph_contribute(struct graph *graph, void *worker, struct data_object *object,
                     const duite_law *law, int at, struct graph_task *task, size_t i);
int graph_close(struct graph *graph, void *worker, struct data_object *object);
void graph_run_combine(struct graph *graph, struct graph_task *task);
void graph_run_pieces(struct graph *graph, struct graph_task *task);

/* Access i of an object whose size changes has this packet: tells the body its size; the body is
 * over: what it wrote has the sizes it said. */
void graph_size_open(struct graph_task *task, size_t i, struct data_packet *packet);
void graph_size_close(struct graph_task *task);

/* Keeps a failure until stop; `report`: the next wait tells it. Never NULL. */
const struct data_failure *graph_fail(struct graph *graph, const struct data_failure *failure,
                                      bool report);
/* The failure of a task for want of memory. */
const struct data_failure *graph_fail_memory(struct graph *graph, const struct graph_task *task);
struct data_packet *graph_poison_packet(struct data_key key, const struct data_failure *failure);

/* Fits a fork kernel, arguments and objects? Then *index is the kernel's. The objects are marked as
 * named by the next fork; graph_unmark takes this back. */
int graph_check(struct graph *graph, int at, const duite_kernel *kernel, const void *args, size_t n,
                const duite_object *objects, uint32_t *index);
void graph_unmark(struct graph *graph, size_t n, const duite_object *objects);

/* May the object be set to so many elements? */
int graph_set_check(const struct data_object *object, duite_object name, size_t count);

/* Memory ran out at access `made`: the accesses before it are kept, or others would wait for ever.
 */
void graph_void(struct graph *graph, void *worker, struct graph_task *task, size_t made,
                uint32_t done);

/* Why nothing runs any more, or NULL. */
const struct data_failure *graph_given_up(struct graph *graph);

/* A replay: binds the objects; starts the first round. */
void graph_replay_run(struct graph *graph, struct graph_task *task);
void graph_replay_start(struct graph *graph, void *worker, struct graph_task *task);
/* A node of a replay: runs it, returns whether a body ran; tells its successors. */
bool graph_node_run(struct graph *graph, struct graph_task *task, duite_call *call);
void graph_node_finish(struct graph *graph, void *worker, struct graph_task *task);

/* Publishes what a task wrote, releases what it read, frees it. */
void graph_over(struct graph *graph, void *worker, struct graph_task *task);

static inline struct data_key graph_key(const struct graph *graph, const struct data_object *object)
{
    duite_object name = data_object_name(&graph->table, object);
    return (struct data_key){name.slot, name.generation, object->number};
}

/* Out of memory in the middle of a fork: the ranks no longer agree on what was forked. */
static inline int graph_break(struct graph *graph)
{
    graph->broken = DUITE_E_MEMORY;
    return DUITE_E_MEMORY;
}

#endif
