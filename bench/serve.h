#ifndef BENCH_SERVE_H
#define BENCH_SERVE_H

#include <stddef.h>
#include <stdint.h>

/* The side of a program that is measured. duite-bench starts it, every rank of it connects to the
 * bench, runs what it is told ("stencil points=64 steps=200"), one command after the other, and
 * answers with a number: seconds, bytes, whatever the case measures. Between commands the bench
 * stops the process, so that nothing it does disturbs the others. */

struct serve_request {
    const char *text;    /* the name of the run, then KEY=VALUE words */
    const char *missing; /* a key that was asked for and is not there: the run has failed */
};

/* The value of a key; 0, and the run fails afterwards, if there is none. */
uint64_t serve_number(struct serve_request *request, const char *key);
/* The word after a key, at most size - 1 bytes of it; empty if there is none. */
void serve_word(const struct serve_request *request, const char *key, char *word, size_t size);

/* Something that can be run. Returns 0 and the value, or what serve_fail returns. */
struct serve_run {
    const char *name; /* NULL ends a list */
    int (*run)(void *context, struct serve_request *request, double *value);
};

/* Why a run failed; above all: that its answer is wrong. Returns 1. */
int serve_fail(const char *format, ...) __attribute__((format(printf, 1, 2)));
int serve_no_memory(void);
/* The sentence that was said last. */
const char *serve_failure(void);

/* Seconds since some fixed moment. */
double serve_seconds(void);
/* The most memory that the process ever had; 0 if the system does not say. */
uint64_t serve_most_bytes(void);

/* Rank r takes the r-th of the cores that it may use, as a binding mpirun would. */
void serve_bind(int rank);

/* True if the bench started this process. */
int serve_wanted(void);
/* As what: the kind of subject, "" if there is no bench. */
const char *serve_kind(void);

/* Serves until the bench has no more commands. `settings`: what the program is and how it is set
 * up, one line. `runs`: lists, ended by NULL. Returns the exit status. */
int serve(const char *settings, const struct serve_run *const *runs, void *context);

#endif
