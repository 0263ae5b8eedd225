#!/bin/sh
# What a kernel declares wrongly does not compile (cloth/flow/state/kernel.h).
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

wrong() {
    # shellcheck disable=SC2086
    ${CC:-cc} -std=c17 -fsyntax-only -Werror -DHAVE_CONFIG_H -I. -I"$srcdir" -I"$srcdir/runtime" ${MPI_CFLAGS:-} -DWRONG="$1" \
        "$srcdir/tests/cloth/flow/kernels_wrong.c"
}

ok "a right declaration compiles" wrong 0
for number in 1 2 3 4 5 6 7 8; do
    not_ok_expected "wrong declaration $number does not compile" wrong $number
done
