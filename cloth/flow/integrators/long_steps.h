#ifndef CLOTH_FLOW_INTEGRATORS_LONG_STEPS_H
#define CLOTH_FLOW_INTEGRATORS_LONG_STEPS_H

#include "cloth/base/error.h"

struct flow;

/* Warns, before a run, of steps that are too long: for the fastest vibration (explicit), for the
 * solve (implicit), or for the push of the air. To flow->warning, on rank 0, when the source is
 * made. Error: CLOTH_E_MEMORY. Local. */
int flow_warn_of_steps(struct flow *flow, struct cloth_error *error);

#endif
