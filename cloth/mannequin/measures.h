#ifndef CLOTH_MANNEQUIN_MEASURES_H
#define CLOTH_MANNEQUIN_MEASURES_H

#include "cloth/mannequin/mannequin.h"

/* Puts in what is 0, and checks ranges and what goes together. Errors: CLOTH_E_INPUT, with the
 * measure's name. */
int mannequin_complete(struct mannequin *mannequin, struct cloth_error *error);

#endif
