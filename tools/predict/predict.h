#ifndef DUITE_TOOLS_PREDICT_PREDICT_H
#define DUITE_TOOLS_PREDICT_PREDICT_H

#include "tools/predict/platform.h"
#include "tools/trace/read.h"

#include <duite_policy.h>
#include <stdio.h>

/* How long a traced run would take on a described cluster. The predictor runs the main program
 * again in virtual time, with the functions of the mapping and of the scheduler. Bodies take as
 * long as in the trace. */

struct predict_cluster {
    uint32_t hosts;    /* each is a rank */
    uint32_t cores;    /* of each host: so many workers */
    double core_speed; /* times that of the traced run */
    double latency;    /* s, of a message */
    double bandwidth;  /* bytes/s of a network card, in each direction */
    double capacity;   /* bytes/s of the switch, all messages together; infinite: enough */
    const struct predict_platform *platform; /* in place of the five above; NULL: none */
    double bodies; /* they take this many times as long as in the trace; 0: as long */
    bool (*grows)(const char *kernel); /* which do; NULL: all */
    double overhead; /* s, of the runtime between two tasks; < 0: as it was seen */
    double message;  /* s of a core, to send or to take one; < 0: as it was seen, else 5e-7 */
    double look;     /* s of a core, to look for one; < 0: as it was seen, else `message`, at most
                        5e-7 */
    bool steady;     /* bodies take the median of their kernel, not their own time */
    bool
        packed; /* in replays a block sends a host no more than the hints of its blocks there say */
    const duite_scheduler *scheduler;
    const duite_mapping
        *mapping; /* NULL: the homes that were traced; as many hosts as ranks then */
    const duite_balancer *balance; /* NULL: none; one that moves blocks needs a mapping */
    uint64_t seed;
};

/* Sets only the network card (10 Gbit/s), the scheduler steal and the seed 1; all else is as seen
 * in the trace, or absent. Hosts, cores and latency are the caller's to fill in. */
struct predict_cluster predict_cluster_default(void);

/* Limits of a run: seconds along the chain of causes that ends with the last task. */
enum predict_limit {
    PREDICT_WORK,      /* tasks that waited for a worker */
    PREDICT_PATH,      /* tasks that began when the one before them ended */
    PREDICT_LATENCY,   /* messages on their way */
    PREDICT_BANDWIDTH, /* messages in cards and switch, and waiting for them */
    PREDICT_MAIN,      /* the main program, forking */
    PREDICT_OVERHEAD,  /* the runtime between tasks */
    PREDICT_LIMITS
};

struct predict_result {
    uint64_t tasks, messages, bytes, stolen, migrated; /* migrated: objects */
    double makespan;                                   /* s */
    double work;                                       /* s in bodies, all workers together */
    double critical_path; /* s: the longest chain of tasks, if messages and forks took no time */
    double bodies;        /* s that bodies took in the trace, */
    double medians;       /* and would have, had each taken the median of its kernel */
    double idle;          /* share of the workers' time without a task */
    double overhead, message, look; /* s between two tasks and of messages, as taken to be */
    double chain[PREDICT_LIMITS];
    enum predict_limit limit; /* the largest of them */
};

/* Further results of a prediction; all is the caller's. */
struct predict_more {
    FILE *paje;    /* the predicted run as a Paje trace; NULL: not written */
    double *chain; /* room for the trace's n_kernels: s of the bodies of each on the chain; NULL */
};

/* The names of the limits, for people. */
const char *predict_limit_name(enum predict_limit limit);

/* `more`: NULL, or the further results wanted. Deterministic. Errors: memory; DUITE_E_ARGUMENT for
 * a trace with losses or without a whole program, a mapping that fails, and an invalid cluster. */
int predict(const struct trace_run *run, const struct predict_cluster *cluster,
            struct predict_result *result, const struct predict_more *more);

/* Lower bounds of the seconds that any schedule of a run's bodies takes. That a writer waits for
 * the readers of the value before is left out: this depends on homes and memory. */
struct predict_bounds {
    double path;  /* the longest chain of tasks, each of which needs what the one before wrote */
    double lower; /* the larger of that and the bodies over all workers of the run */
    uint64_t *number; /* n: of the chain's tasks, the first one first: they rise */
    size_t n;
};

/* Errors as of predict; predict_bounds_free is due all the same. */
int predict_bounds(const struct trace_run *run, struct predict_bounds *bounds);
void predict_bounds_free(struct predict_bounds *bounds);

/* Writes the tasks, and the tasks that each waited for, in the language of Graphviz' dot; the homes
 * are the traced ones. Errors as of predict. */
int predict_write_dot(const struct trace_run *run, FILE *file);

/* The same tasks for schedulers that know nothing of the program: lines of tools/compare/graph.h,
 * whose costs are the seconds of the bodies. A task that ran on every rank is one task; waits of
 * the main program are left out. Errors as of predict. */
int predict_write_graph(const struct trace_run *run, FILE *file);

#endif
