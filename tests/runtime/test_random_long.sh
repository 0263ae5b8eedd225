#!/bin/sh
# The same as test_random.sh and test_nested.sh with other seeds and hundreds of times as many programs: a million, in about
# an hour and a half on two cores, and trees of tasks.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

DUITE_TIMEOUT=${DUITE_TIMEOUT:-3600}
for base in 1 2 3 4 5 6 7 8 9 10; do
    ok "100000 random programs from $base" ranks 4 tests/runtime/random_programs --base ${base}00000000 --programs 100000
done
for n in 5 8; do
    ok "10000 on $n ranks" ranks $n tests/runtime/random_programs --base 120${n}000000 --programs 10000
done
ok "200000 random trees of tasks" limited tests/runtime/nested_programs --seed 10000000 --programs 200000
ok "100000 on 2 ranks" ranks 2 tests/runtime/nested_programs --seed 20000000 --programs 100000
ok "50000 on 3 ranks" ranks 3 tests/runtime/nested_programs --seed 30000000 --programs 50000
