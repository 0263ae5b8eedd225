#ifndef CLOTH_APP_RUN_PHASES_CHECK_H
#define CLOTH_APP_RUN_PHASES_CHECK_H

#include "cloth/model/model.h"

/* Compares the model of a phase, by its number from 0, with the first one. One folder holds the
 * frames of all phases, so they share cloths, vertices and triangles, obstacles and their shapes,
 * frames a second, columns of probes, and forces of contact. Error: CLOTH_E_INPUT, which names the
 * phase and the difference. Local. */
int phases_check(const struct model *first, const struct model *model, uint32_t phase,
                 struct cloth_error *error);

#endif
