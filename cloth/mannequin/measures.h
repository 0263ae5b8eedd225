#ifndef CLOTH_MANNEQUIN_MEASURES_H
#define CLOTH_MANNEQUIN_MEASURES_H

#include "cloth/mannequin/mannequin.h"

/* Replaces 0 by defaults; checks ranges and ratios of measures. Errors: CLOTH_E_INPUT, with the
 * measure's name. */
int mannequin_complete(struct mannequin *mannequin, struct cloth_error *error);

#endif
