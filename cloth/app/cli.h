#ifndef CLOTH_APP_CLI_H
#define CLOTH_APP_CLI_H

#include "cloth/base/error.h"

#include <argp.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The command lines of duite-view, duite-garment and duite-mannequin: a row of a table for each
 * option, whose value goes to a member of the program's own struct. Wrong ones end the process with
 * exit code 2. */

enum cli_kind {
    CLI_FLAG,    /* bool: it is given */
    CLI_FILE,    /* const char *: a name, not empty */
    CLI_ABOVE_0, /* double: finite */
    CLI_OTHER    /* as `read` says */
};

struct cli_option {
    const char *name;
    int key; /* its letter, or a number above 255 */
    const char *value, *help;
    enum cli_kind kind;
    size_t to;         /* of the member */
    const char *takes; /* values that are right, for errors; of CLI_ABOVE_0 and CLI_OTHER */
    /* Reads CLI_OTHER into the program's struct. Returns false for a wrong value, or says more
     * about it by argp_error. */
    bool (*read)(const char *text, void *to, struct argp_state *state);
    unsigned marks; /* added to the program's marks where the option is given */
};

struct cli {
    const char *arguments, *about; /* for --help */
    const struct cli_option *option;
    size_t n_options;
    size_t marks, argument; /* members: unsigned; const char *, the only argument; CLI_NONE */
    const char *one;        /* said where there is one argument too many */
    void (*finish)(void *to, struct argp_state *state); /* refuses what does not go together */
};
#define CLI_NONE SIZE_MAX

/* Fills *to, which has the defaults. */
void cli_read(const struct cli *cli, int argc, char **argv, void *to);

/* A finite number above 0, and nothing else. */
bool cli_above_0(const char *text, double *number);

/* The path beside an output: without .obj, with another ending. To be freed; NULL: no memory. */
char *cli_beside(const char *output, const char *ending);

/* The exit code of a program that ends: standard output took everything, or the error is said. */
int cli_end(const char *program, struct cloth_error *error);

#endif
