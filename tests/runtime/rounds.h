#ifndef TESTS_RUNTIME_ROUNDS_H
#define TESTS_RUNTIME_ROUNDS_H

#include "runtime/plan/passes.h"

/* Rounds of recorded graphs made by hand from a text, and the output of passes as text. */

enum { ROUNDS_MAX = 64, ROUNDS_ACCESSES = 256, ROUNDS_TEXT = 8192 };

struct rounds_made {
    struct plan_source source;
    struct plan_source_fork fork[ROUNDS_MAX];
    struct plan_access access[ROUNDS_ACCESSES];
    size_t bytes[ROUNDS_MAX];
};

/* Two laws that differ. */
extern const duite_law rounds_law[2];

/* objects: their bytes: "8 8 4096". forks, ended by `;`: accesses
 * r, w, u (rw), c and C (cw of two laws) with an object, in front of them R (replicated), = (a
 * set), @ and a rank: "w0; r0 c1; R r0 w2; @1 r2; =0". */
void rounds_make(struct rounds_made *made, const char *objects, const char *forks);
/* Adds a fork, without accesses, and an access to the last one; rounds_own then says what the last
 * one runs for. */
void rounds_fork(struct rounds_made *made);
void rounds_access(struct rounds_made *made, uint32_t object, duite_mode mode, int law);
void rounds_own(struct rounds_made *made);

/* "task(r0 w3) sum(u1 r3 r4 | 1+2)": uses by place, and merges by parameter. Of channels: "send to
 * 1 in 0(...)". All text is valid until the next call of the same function. */
const char *rounds_nodes(const struct plan_round *round);
/* "0>1 1~>0": within the round; to the next one. */
const char *rounds_edges(const struct plan_round *round);
/* "0 01 - 1": by node, the ranks that run it. */
const char *rounds_ranks(const struct plan_assignment *assignment);
/* "0:1 5:01": by version that some rank needs, these ranks. */
const char *rounds_needs(const struct plan_assignment *assignment);
/* "0>1 in 0: v4 p0 2+1; ...": from, to, phase, items by version or piece; of what goes from rank to
 * rank its first leaf and their number. */
const char *rounds_messages(const struct plan_messages *messages);
/* "0 0 1": by node. */
const char *rounds_phases(const struct plan_messages *messages);

#endif
