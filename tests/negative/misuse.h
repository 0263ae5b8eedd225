#ifndef TESTS_NEGATIVE_MISUSE_H
#define TESTS_NEGATIVE_MISUSE_H

/* Shared by the tests of misuse: a few kernels, a runtime started with them, and TAP over ranks. */

#include "tests/support/kernel.h"

#include <duite.h>

/* Kernels: SET writes its argument; COPY adds 1 to what it reads; ADD contributes 1; FAIL writes
 * and fails with its argument; MANY reads one and any number more; EMPTY has no parameters.
 * EVERYWHERE is COPY, replicated; UNLISTED is not listed. */
extern const duite_kernel SET, COPY, ADD, FAIL, MANY, EMPTY, EVERYWHERE, UNLISTED;

/* This process in the world, and how many there are; misuse_mpi finds them. */
extern int rank, ranks;

/* Initialises MPI unless it is, to be finalised at exit; with MPI_THREAD_MULTIPLE, since tap_case
 * calls MPI while workers do, or with another level of thread support. */
void misuse_mpi(void);
void misuse_mpi_at(int level);
/* Options with all kernels listed on a communicator. */
duite_options misuse_options(MPI_Comm comm);
/* Initialises MPI and starts a runtime with such options; NULL if it does not start, which it says.
 */
duite *misuse_start_with(const duite_options *options);
/* The same with all kernels and this many threads. */
duite *misuse_start(MPI_Comm comm, unsigned threads);
/* An object of count integers (DUITE_I32). */
duite_object misuse_new(duite *rt, size_t count);

/* Megabytes of this process' heap; 0: malloc is a sanitizer's, which does not say. */
double misuse_megabytes(void);

/* Prints one TAP line on rank 0 of the world, ok if `right` on every rank; the others say on stderr
 * that they are wrong. Collective over MPI_COMM_WORLD. */
void tap_case(int right, const char *name);
/* "rank 2", "ranks 0 and 1", "ranks 0-2": ranks 0 to n - 1. The text is the function's. */
const char *misuse_first_ranks(int n);
/* Keeps duite_message() for misuse_all_told, which calls MPI: when the runtime is stopped. */
void misuse_keep_message(void);
/* True if the kept message contains the text on this rank, and is the same on all; else this rank
 * says on stderr what it is. Collective over MPI_COMM_WORLD. */
int misuse_all_told(const char *text);

/* Prints the plan; returns the exit status, the same on every rank. */
int tap_done(void);

#endif
