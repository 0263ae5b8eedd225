/* A refusal is checked where it is told, so that a test is a row of calls and codes. */

#include "tests/negative/refused.h"

#include <string.h>

duite *rt;
duite_object a, b, c;

void refused_begin(void)
{
    rt = misuse_start(MPI_COMM_WORLD, 2);
    ck_assert_ptr_nonnull(rt);
    a = misuse_new(rt, 4);
    b = misuse_new(rt, 4);
    c = misuse_new(rt, 4);
}

void refused_end(void)
{
    duite_free(rt, a);
    duite_free(rt, b);
    duite_free(rt, c);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
    ck_assert_ptr_null(rt);
}

void says(const char *sentence)
{
    unit_says(duite_message(), sentence);
}

void refused(int code, int expected)
{
    char sentence[1024];

    ck_assert_int_eq(code, expected);
    strncpy(sentence, duite_message(), sizeof sentence - 1);
    sentence[sizeof sentence - 1] = '\0';
    ck_assert_str_ne(sentence, "");
    ck_assert_int_eq(duite_wait(rt), expected);
    says(sentence);
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
}
