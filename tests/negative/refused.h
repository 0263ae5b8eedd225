#ifndef TESTS_NEGATIVE_REFUSED_H
#define TESTS_NEGATIVE_REFUSED_H

/* Unit tests of misuse on one rank share a runtime, its objects, and the meaning of a refusal: a
 * code and a sentence, and both once more with the next wait. */

#include "tests/negative/misuse.h"
#include "tests/support/unit.h"

extern duite *rt;
extern duite_object a, b, c; /* of four integers each */

/* A fixture: starts the runtime with two threads and makes the objects; frees them and stops. */
void refused_begin(void);
void refused_end(void);

/* duite_message() contains the sentence. */
void says(const char *sentence);
/* The call's code is the expected one; a wait returns it once more, and the next one DUITE_OK. */
void refused(int code, int expected);

#endif
