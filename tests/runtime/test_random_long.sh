#!/bin/sh
# The same as test_random.sh with other seeds and twenty times as many programs.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

DUITE_TIMEOUT=${DUITE_TIMEOUT:-3600}
for base in 1 2 3 4; do
    ok "50000 random programs from $base" ranks 4 tests/runtime/random_programs --base ${base}00000000 --programs 50000
done
