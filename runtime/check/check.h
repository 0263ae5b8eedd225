#ifndef DUITE_CHECK_CHECK_H
#define DUITE_CHECK_CHECK_H

#include "runtime/check/region.h"

/* Checking mode: bodies work on private copies between guards, which are taken away afterwards.
 * Violations of a body's declaration are found where they happen:
 *
 * - Some accesses fault, and the fault becomes the failure of the task. They are a write to an r
 *   parameter or to the arguments, an access beyond either end of a parameter, and an access
 *   through a stale or undeclared pointer, to the parameters of an earlier task.
 * - A body runs twice, with different fills under w. A byte that keeps its fill was not written; a
 *   byte that differs otherwise shows that the kernel is not deterministic. Kernels with side
 *   effects or postponed modes, and bodies that fork, run once.
 * - The main program's turns on objects are on copies, too: what it, or a body, uses after the
 *   release faults.
 *
 * Memory that is none of duite's (globals, heap, stack) is not watched. A body that faults is left
 * by a jump: memory and locks that it held stay held. */
struct check;

/* The task whose body is called. */
struct check_task {
    const duite_kernel *kernel;
    uint64_t number;
};

/* Takes over SIGSEGV and SIGBUS; a fault that is none of a checked body goes on to the handler that
 * was there before. Errors: memory; DUITE_E_STATE if the process has a runtime in checking mode
 * already. */
int check_start(struct check **check);
/* No body runs. Gives the signals back. NULL is fine. */
void check_stop(struct check *check);

/* Calls the body on copies; its results are copied back if it kept to its declaration. Returns its
 * code, or DUITE_E_CHECK or DUITE_E_MEMORY with the message set (duite_fail). Any thread; bodies
 * may nest. */
int check_call(struct check *check, const struct check_task *task, duite_call *call);

/* A copy of an object's value for a turn of the main program; NULL without memory. At the end of
 * the turn `values`, unless it is NULL, gets what the copy has. Main thread. */
void *check_lend(struct check_region *region, duite_object object, const void *values,
                 size_t bytes);
void check_take_back(struct check *check, struct check_region *region, void *values);

#endif
