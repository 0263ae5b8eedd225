#ifndef TESTS_CLOTH_FLOW_SESSION_H
#define TESTS_CLOTH_FLOW_SESSION_H

#include "cloth/flow/state/state.h"
#include "tests/cloth/flow/models.h"

/* A run on one worker whose main program the test is. It begins as zero, with `setup` filled. */
struct session {
    struct setup setup;
    struct flow *flow;
    duite *rt;
    struct flow_report report;
    struct flow_state state;
    struct cloth_error error;
};

/* Starts the runtime and makes the objects of the run. */
void session_start(struct session *s);
/* Frees all of it, the setup, too. */
void session_end(struct session *s);

#endif
