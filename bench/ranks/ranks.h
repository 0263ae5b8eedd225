#ifndef BENCH_RANKS_RANKS_H
#define BENCH_RANKS_RANKS_H

#include "bench/bench.h"
#include "bench/ranks/sheet.h"
#include "bench/tasks/tasks.h"

/* Shared by the cases of the bench "ranks". Each case is a file. Runs of ours and of the twin are
 * in one program, started by mpirun as one or the other. */

struct ranks_session {
    struct tasks_session tasks; /* first: runs of the bench "tasks" find theirs */
    struct sheet sheet;
};

/* Ours and the twin's: so many ranks of so many threads; 0 ranks: without mpirun. On hosts of their
 * own: one rank each. */
struct subject_shape ranks_ours(unsigned ranks, unsigned threads);
struct subject_shape ranks_twin(unsigned ranks);
struct subject_shape ranks_ours_on_hosts(unsigned hosts);
struct subject_shape ranks_twin_on_hosts(unsigned hosts);

/* True if this process is on a host of its own. */
bool ranks_on_hosts(void);

/* Starts a runtime (threads=, scheduler=; the rest as `options` has it), the session's of the bench
 * "tasks" being ended before; the same for the cloth. Ends it, if there is one; gives `code` or why
 * it did not end. */
int ranks_start(struct ranks_session *session, struct serve_request *request,
                duite_options *options, duite **rt);
int ranks_start_cloth(struct ranks_session *session, struct serve_request *request, duite **rt);
int ranks_stop(duite **rt, int code);

/* Forks the kernel on a number that is zero. *value: s until that task and all that it forks are
 * over. Fails unless the number is `expected` then. */
int ranks_time_sum(duite *rt, const duite_kernel *kernel, const void *args, int64_t expected,
                   double *value);

/* ---- The twin's solve ---- */

/* The twin's messages in an iteration. */
struct twin_traffic {
    double bytes, messages;
};
/* Solves by so many iterations, on this rank's part of the blocks; compares with the answer. */
int twin_solve(struct sheet *sheet, uint32_t count, double *seconds, struct twin_traffic *traffic);

extern const struct bench_case ranks_cg, ranks_stencil, ranks_loaded, ranks_forks, ranks_memory,
    ranks_delegate, ranks_tree, ranks_migrate, ranks_await;

#endif
