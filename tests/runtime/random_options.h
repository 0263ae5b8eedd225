#ifndef TESTS_RUNTIME_RANDOM_OPTIONS_H
#define TESTS_RUNTIME_RANDOM_OPTIONS_H

#include "tests/runtime/random_program.h"

/* The options of random_programs, and the way in which a program runs: the seed draws it, except
 * for given options. */

enum option_number {
    OPTION_SEED, /* of one program, which is shrunk if it is wrong */
    OPTION_BASE, /* the first seed of many */
    OPTION_RANKS,
    OPTION_PROGRAMS,
    OPTION_REPEAT,
    OPTION_THREADS,
    OPTION_WINDOW,
    OPTION_MEMO,
    OPTION_CHECK,
    N_OPTION_NUMBERS
};
enum option_text { OPTION_SCHEDULER, OPTION_MAPPING, OPTION_BALANCE, N_OPTION_TEXTS };

struct options {
    long long number[N_OPTION_NUMBERS]; /* -1: not given */
    const char *text[N_OPTION_TEXTS];   /* NULL: not given */
    int verbose;
    unsigned with, without; /* features, a bit each, ... */
    char forced[200];       /* ... and as options */
};

/* Returns whether they make sense on so many ranks. */
int options_read(struct options *options, int argc, char **argv, int n_ranks);
struct prog_setup options_setup(const struct options *options, uint64_t seed, MPI_Comm comm);

#endif
