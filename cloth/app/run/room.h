#ifndef CLOTH_APP_RUN_ROOM_H
#define CLOTH_APP_RUN_ROOM_H

#include "cloth/base/error.h"

#include <stdint.h>

struct flow;
struct model;

/* Checks, before the first write, that frames and probes of a run in n phases fit into the folder's
 * file system. Warns on standard error if there are unusually many. On rank 0. Error:
 * CLOTH_E_INPUT, they do not fit. Local. */
int room_check(uint32_t n, const struct model *phases, const struct flow *flow, const char *folder,
               struct cloth_error *error);

#endif
