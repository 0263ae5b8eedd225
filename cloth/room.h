#ifndef CLOTH_ROOM_H
#define CLOTH_ROOM_H

#include "cloth/base/error.h"

#include <stdint.h>

struct flow;
struct model;

/* Before anything is written: whether the frames and probes of a run in n phases fit into the file
 * system of the folder, and whether so many are meant, of which warnings on standard error doubt.
 * On rank 0. Error: CLOTH_E_INPUT, they do not fit. Local. */
int room_check(uint32_t n, const struct model *phases, const struct flow *flow, const char *folder,
               struct cloth_error *error);

#endif
