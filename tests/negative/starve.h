#ifndef TESTS_NEGATIVE_STARVE_H
#define TESTS_NEGATIVE_STARVE_H

/* Runs `run` again and again, and lets the first, the second, ... allocation on one rank fail,
 * until there are no more; then the same for the next rank. On more than two ranks it lets each
 * third one fail, where only the quick subset is wanted each seventh one, beginning with another
 * one on each rank; with DUITE_LONG=1 all. `run` starts and stops a runtime, is told by it or not,
 * and returns whether all ended as it may; without a failure it must be right. TAP cases say
 * `what`. Collective over MPI_COMM_WORLD. */
void starve(const char *what, int (*run)(void));

#endif
