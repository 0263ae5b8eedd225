#ifndef CLOTH_APP_RUN_ENVIRONMENT_H
#define CLOTH_APP_RUN_ENVIRONMENT_H

#include "cloth/app/run/options.h"
#include "cloth/base/error.h"

/* Sets the defaults of options: the environment, else the built-in values. environment_check looks
 * for errors after the options, which may replace a value. Local. */
void environment_begin(struct simulate_options *run);

/* Error: CLOTH_E_INPUT, which names the variable. Local. */
int environment_check(const struct simulate_options *run, struct cloth_error *error);

/* A help_filter of argp: replaces SCHEDULERS, MAPPINGS and BALANCERS in a text by the names of the
 * policies. Local. */
char *environment_help(int key, const char *text, void *input);

#endif
