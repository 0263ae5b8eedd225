#!/bin/sh
# The same as test_random.sh and test_nested.sh with other seeds and hundreds of times as many programs, and trees of tasks: a
# million programs, in about an hour and a half on two cores that are free. A case is 10000 of them, so that one sees how far it is.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

DUITE_TIMEOUT=${DUITE_TIMEOUT:-3600}
for base in 1 2 3 4 5 6 7 8 9 10; do
    for part in 0 1 2 3 4 5 6 7 8 9; do # a group runs fewer than 10000 seeds from its first one on
        ok "10000 random programs from $base, part $part" \
            ranks 4 tests/runtime/random_programs --base ${base}000${part}0000 --programs 10000
    done
done
for n in 5 8; do
    ok "10000 on $n ranks" ranks $n tests/runtime/random_programs --base 120${n}000000 --programs 10000
done
for seed in 1 2 3 4; do
    ok "50000 random trees of tasks, part $seed" limited tests/runtime/nested_programs --seed 1${seed}000000 --programs 50000
    ok "50000 whose repeated rounds are recognised, part $seed" \
        limited env DUITE_MEMO=always tests/runtime/nested_programs --seed 5${seed}000000 --programs 50000
    ok "25000 on 2 ranks, part $seed" ranks 2 tests/runtime/nested_programs --seed 2${seed}000000 --programs 25000
    ok "12500 on 3 ranks, part $seed" ranks 3 tests/runtime/nested_programs --seed 3${seed}000000 --programs 12500
done
for part in 0 1 2 3 4 5 6 7; do
    ok "10000 on one rank, repeated forks recognised, part $part" \
        limited env DUITE_MEMO=always tests/runtime/random_programs --base 13${part}00000 --programs 10000
done
