#ifndef CLOTH_PHASES_CHECK_H
#define CLOTH_PHASES_CHECK_H

#include "cloth/model/model.h"

/* What all phases have in common, since one folder holds their frames: cloths and their vertices
 * and triangles, obstacles and their shapes, frames a second, columns of probes and forces of
 * contact. Compares the model of a phase, by its number from 0, with that of the first one. Error:
 * CLOTH_E_INPUT, which names the phase and what is different. Local. */
int phases_check(const struct model *first, const struct model *model, uint32_t phase,
                 struct cloth_error *error);

#endif
