#ifndef BENCH_SUBJECT_H
#define BENCH_SUBJECT_H

#include <stdbool.h>
#include <stddef.h>

/* The bench's side of the programs that it measures (bench/serve.h is theirs): our own, which is
 * duite-bench started again, and the rivals beside it. */

struct subject_shape {
    const char *kind; /* "duite", "sequential", or a rival's name */
    unsigned ranks;   /* started by mpirun; 0: one process without it */
    unsigned threads; /* of a rank, as its runtime is told; the cores wanted are ranks x threads */
};

bool subject_same(struct subject_shape a, struct subject_shape b);

/* Why there is no such subject ("not built: libstarpu-dev is missing"), or NULL. */
const char *subject_missing(const char *kind);

/* The same program in another setting, to be tried too; or NULL. */
const char *subject_other(const char *kind);

/* Cores that this process may use. */
unsigned subject_cores(void);

struct subject; /* started, and stopped by the bench except while it answers */

/* NULL: it did not start, which was said on stderr. */
struct subject *subject_start(struct subject_shape shape);
/* Its description and its settings. */
const char *subject_settings(const struct subject *subject);
/* Runs a command on every rank of it and waits for the answers. The largest number of all ranks; or
 * 1 and a sentence. */
int subject_ask(struct subject *subject, const char *command, double *value, char *why,
                size_t size);
/* Ends it. NULL is fine. 1, said on stderr, if it did not end well. */
int subject_stop(struct subject *subject);

#endif
