#ifndef TESTS_CLOTH_FLOW_KINDS_H
#define TESTS_CLOTH_FLOW_KINDS_H

#include "tests/cloth/flow/session.h"

/* Kinds of runs, for what must hold in all of them. */
enum { KINDS = 19 };

/* Fills the setup of a session that is then to be started; session_end frees it. */
void kind_setup(int kind, struct session *session);

#endif
