#ifndef DUITE_TOOLS_COMMAND_H
#define DUITE_TOOLS_COMMAND_H

#include <argp.h>

/* Shared by the command lines of duite-predict and duite-trace: one argument, the file of a trace.
 */

/* The cases of an argp parser that are no options. Writes the argument to *file, which is NULL
 * before. Ends the program with a message if there is none, or more than one. */
static inline error_t predict_trace_argument(int key, char *value, struct argp_state *state,
                                             const char **file)
{
    switch (key) {
    case ARGP_KEY_ARG:
        if (*file)
            argp_error(state, "%s: a second trace; one is expected", value);
        *file = value;
        return 0;
    case ARGP_KEY_NO_ARGS:
        argp_error(state, "the file of a trace is expected");
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

#endif
