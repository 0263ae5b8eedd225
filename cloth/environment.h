#ifndef CLOTH_ENVIRONMENT_H
#define CLOTH_ENVIRONMENT_H

#include "cloth/base/error.h"
#include "cloth/simulate.h"

/* What counts where no option is given: the environment, else what is built in. What the
 * environment has wrong is found once the options are read, which may replace it. Local. */
void environment_begin(struct simulate_options *run);

/* Error: CLOTH_E_INPUT, which names the variable. Local. */
int environment_check(const struct simulate_options *run, struct cloth_error *error);

/* Of argp's form help_filter: SCHEDULERS, MAPPINGS and BALANCERS in a text become the names of the
 * policies. Local. */
char *environment_help(int key, const char *text, void *input);

#endif
