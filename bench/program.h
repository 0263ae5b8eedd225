#ifndef BENCH_PROGRAM_H
#define BENCH_PROGRAM_H

#include <stdbool.h>
#include <stddef.h>

/* A program that can be measured: its file, its best settings, and why it may be missing. */
struct program {
    const char *kind;
    const char *file;    /* beside duite-bench; NULL: duite-bench itself */
    const char *missing; /* the package that configure did not find, or "" */
    const char *other;   /* the kind of the same program in another setting, or NULL */
    const char *tool;    /* a program that it calls, to be found as a shell does; NULL: none */
    bool hosts;          /* each rank on a host of its own, by tests/cluster/hosts.sh, or
                             without ranks: it starts runs on such hosts itself */
    /* NAME=VALUE words where each thread has a core, and where not; a user's own setting of a name
     * goes first */
    const char *settings[5], *crowded[5];
};

/* NULL: there is none of this kind. */
const struct program *program_find(const char *kind);

/* The folder of duite-bench, without a slash at its end; its length, as snprintf counts. */
size_t program_folder(char *folder, size_t size);

/* Why it cannot be run, or NULL. */
const char *program_missing(const struct program *program);

/* The environment for so many cores: NAME=VALUE words, ended by NULL. */
const char *const *program_settings(const struct program *program, unsigned cores);

/* Sets the environment for a child that wants so many cores; what a user chose for programs of
 * duite in general is removed. */
void program_environment(const struct program *program, unsigned cores);

/* The words of the command, ended by NULL; `ranks`: under mpirun, or NULL. `argv` has room for 16.
 * The strings are kept until the next call. */
void program_command(const struct program *program, const char *ranks, const char **argv);

#endif
