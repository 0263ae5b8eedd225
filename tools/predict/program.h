#ifndef DUITE_TOOLS_PREDICT_PROGRAM_H
#define DUITE_TOOLS_PREDICT_PROGRAM_H

#include "runtime/data/object.h"
#include "runtime/plan/passes.h"
#include "tools/predict/graph.h"

/* The main program while the predictor reads it. The files program.c, fork.c, objects.c, move.c,
 * record.c, round.c, part.c and replay.c share it. */

/* A fork, or (kernel NONE) a set; `object` are places in graph->object, or of a recorded graph in
 * its list of objects. */
struct predict_fork {
    uint64_t number;
    uint32_t kernel;
    int at, priority;
    float cost;
    size_t n;
    uint32_t *object;
};

struct predict_recorded {
    struct predict_fork *fork;
    uint32_t *use;
    struct plan_source source;  /* the same without bytes and flag, which rounds add */
    struct plan_access *access; /* of source */
    size_t n_forks, n_objects, n_calls;
    uint64_t replays, map_at;    /* so far; at this many the mapping is called again */
    uint64_t rounds;             /* since the last call of the balancer */
    uint32_t *bound;             /* n_objects: of the last replay, this one among them; or NULL */
    struct predict_round *round; /* of the last replay, or NULL */
    double *seconds;             /* n_forks: of the bodies of one round */
};

/* A compiled round, and its inputs: the nodes of all hosts. Numbers, seconds and objects are added
 * when it is replayed. */
struct predict_round {
    struct plan_source source; /* the record has its forks */
    struct plan_round lowered;
    struct plan_assignment assignment;
    int *home;      /* by object of the source */
    uint32_t flag;  /* an object of the program, or NONE */
    size_t n_hints; /* of the graph, when it was compiled: messages have their bytes */
    bool forked;    /* it has no plan: nothing that follows is there */
    struct predict_node *node;
    uint32_t *fork;      /* by node: in the record; NONE: the runtime's own */
    bool *begins, *ends; /* by node: none of its round comes before it, after it */
    size_t n_nodes, nodes_capacity, forks_capacity;
    struct plan_round_edge *edge;
    size_t n_edges, edges_capacity;
};

/* A balancer's data for changing homes, as in api/migrate.c. Seconds are those since its last call.
 */
struct predict_moves {
    double *spent; /* by slot of `table`: in bodies of tasks that ran for it */
    size_t spent_capacity;
    double *other; /* by host: in other bodies */
    uint64_t replays, due, looked;
    void *state; /* of the balancer */
};

/* A get that was begun: its number, and the node after which its value is there, or NONE. */
struct predict_begun {
    uint32_t number, node;
};

struct predict_program {
    struct predict_graph *graph;
    struct predict_times *times;
    struct data_table table; /* for the mapping; of one rank if there is none */
    uint32_t *block;         /* on their hosts, by their numbers in `table`: see number_there */
    size_t n_blocks, blocks_capacity;
    uint32_t *blocks_on; /* by host: how many */
    struct trace_words words;
    bool damaged;
    int code;
    uint32_t *slot; /* object by slot of the trace */
    size_t slots_capacity;
    duite_object *name; /* by object: in `table` */
    size_t names_capacity;
    uint32_t *prepared, *objects; /* of one fork */
    size_t prepared_capacity, objects_capacity;
    struct predict_recorded *recorded;
    size_t n_recorded, recorded_capacity;
    struct predict_moves moves;
    struct predict_begun *begun; /* gets that were begun and not ended */
    size_t n_begun, begun_capacity;
    uint64_t forks, tasks;
    uint64_t replayed,
        max_replayed; /* tasks of replays; the most that can be, since each left an event */
    uint64_t since;   /* ticks: when the main program last went on */
    size_t first_op;  /* since then */
    uint64_t forked;  /* nodes since then, those of replays left out */
};

/* The object that a slot names. */
uint32_t predict_object_at(struct predict_program *p, uint32_t slot);
/* Entries of the program; n: their count. */
void predict_make(struct predict_program *p);
void predict_drop(struct predict_program *p);
void predict_hint(struct predict_program *p, size_t n);
void predict_follow(struct predict_program *p);
void predict_homes(struct predict_program *p, size_t n);

/* An entry of a fork on n objects. */
void predict_take_fork(struct predict_program *p, size_t n, bool has_options);
/* Room for the objects of a fork. */
bool predict_room(struct predict_program *p, size_t n);
void predict_fork(struct predict_program *p, const struct predict_fork *fork);
/* The access of a recorded graph's fork to its object k; a set writes. */
duite_mode predict_fork_mode(const struct predict_program *p, const struct predict_fork *fork,
                             size_t k);
/* A body is part of the run, by the fork's number: for the object that it runs for (NONE: none).
 * Returns its seconds. */
double predict_body(struct predict_program *p, const struct predict_fork *fork, uint32_t own);

/* The object that a task runs for, by the owner rule (task/owner.h), or NONE. */
uint32_t predict_owner(const struct predict_graph *graph, const struct predict_fork *fork,
                       const uint32_t *objects);

/* The main program waits for all. */
void predict_op_wait(struct predict_program *p);
/* A replay begins, or all of its nodes are there. They take the main program no time. */
void predict_op_replays(struct predict_program *p, bool begins);

void predict_take_graph(struct predict_program *p, size_t n_objects);
void predict_replay(struct predict_program *p, size_t n_objects);
/* The place of a round's object in graph->object. */
static inline uint32_t predict_round_object(const struct predict_recorded *recorded, size_t i)
{
    return i < recorded->n_objects ? recorded->bound[i] : recorded->round->flag;
}
/* The record has a compiled round for the homes and sizes of its objects, and for this flag or
 * NONE. False without memory. The record owns the round. */
bool predict_round_prepare(struct predict_program *p, struct predict_recorded *recorded,
                           uint32_t flag);
/* part.c: the nodes of all hosts in a round that was assigned, and their edges. False without
 * memory; predict_parts_free is due all the same. */
bool predict_parts_make(const struct predict_program *p, const struct predict_recorded *recorded,
                        struct predict_round *round);
void predict_parts_free(struct predict_round *round);
/* NULL is fine. */
void predict_round_free(struct predict_round *round);

/* A body took so many seconds for the object (NONE: for none) on a host (ALL: on each). */
void predict_spend(struct predict_program *p, uint32_t object, int host, double seconds);
bool predict_moves_start(struct predict_program *p);
void predict_moves_stop(struct predict_program *p);
/* At the beginning of a replay: homes change, if the mapping or the balancer is due. */
void predict_move(struct predict_program *p, struct predict_recorded *recorded);

void predict_graphs_free(struct predict_program *p);

#endif
