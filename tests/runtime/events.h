#ifndef TESTS_RUNTIME_EVENTS_H
#define TESTS_RUNTIME_EVENTS_H

/* Shared by the tests of events and of requests of MPI: a runtime, its objects, and the report of a
 * standstill. */
#include "tests/negative/misuse.h"
#include "tests/support/unit.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

static duite *rt;

static inline void start_with(const duite_kernel *const *kernels, unsigned threads, int check,
                              size_t window)
{
    duite_options options = misuse_options(MPI_COMM_WORLD);

    misuse_mpi();
    options.kernels = kernels;
    options.threads = threads;
    options.check = check;
    options.window = window;
    ck_assert_msg(!duite_start(&rt, &options), "%s", duite_message());
}

static inline duite_object number(void)
{
    duite_object object;

    ck_assert_int_eq(duite_new(rt, DUITE_I64, 1, &object), DUITE_OK);
    return object;
}

/* Gets the object for longer than a standstill: the report has the sentence. */
static inline void reports(duite_object object, void *value, const char *sentence)
{
    const int standard_error = dup(STDERR_FILENO);
    FILE *said = tmpfile();
    char text[2000] = "";

    ck_assert_ptr_nonnull(said);
    dup2(fileno(said), STDERR_FILENO);
    const int code = duite_get(rt, object, value);
    dup2(standard_error, STDERR_FILENO);
    ck_assert_int_eq(code, DUITE_OK);
    rewind(said);
    ck_assert_uint_gt(fread(text, 1, sizeof text - 1, said), 0);
    ck_assert_msg(strstr(text, sentence), "%s", text);
    fclose(said);
    close(standard_error);
}

#endif
