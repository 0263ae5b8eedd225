#ifndef BENCH_PHYSICS_PHYSICS_H
#define BENCH_PHYSICS_PHYSICS_H

#include "bench/bench.h"
#include "cloth/flow/state/state.h"

/* The bench "physics": what forces and matrices cost. bench.c has the plans, ours.c what our
 * process runs for them. */

/* One sheet at a time, kept while the same is asked for. */
struct physics_session {
    struct model model;
    duite *rt;
    struct flow *flow;
    struct flow_state run;
    struct flow_report report;
    char settings[120]; /* that it is ready for; empty: for none */
    uint64_t expected;  /* hash of what is made without wide instructions; 0: not known yet */
};

/* Ends what runs have left. 1 if the runtime did not stop well. */
int physics_end(struct physics_session *session);

/* assemble sheet=springs|triangles rounds=: seconds of making the system of an implicit step, of
 * forces and matrix. iterate sheet= count=: of an iteration of conjugate gradients on it.
 * explicit side= steps=: of an explicit step of a sheet of springs. Each with threads=, scheduler=,
 * quick=. */
extern const struct serve_run physics_runs[];

#endif
