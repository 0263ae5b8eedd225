#ifndef TESTS_CLOTH_FLOW_KINDS_H
#define TESTS_CLOTH_FLOW_KINDS_H

#include "tests/cloth/flow/session.h"

/* Kinds of runs, for what must hold in all of them. Each fills the setup of a session that is then
 * to be started; session_end frees it. */
enum { KINDS = 19 };
extern void (*const kinds[KINDS])(struct session *);

#endif
