#!/bin/sh
# The same as test_random.sh with other seeds and hundreds of times as many programs: a million, in about an hour and a half on two
# cores that are free. A case is 10000 of them, so that one sees how far it is.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

DUITE_TIMEOUT=${DUITE_TIMEOUT:-3600}
random() { # RANKS BASE OPTIONS...
    n=$1 base=$2
    shift 2
    ok "10000 random programs on $n ranks from $base $*" \
        ranks "$n" tests/runtime/random_programs --base "$base" --programs 10000 "$@"
}
for part in 0 1 2 3 4 5 6 7 8 9; do # a group runs fewer than 10000 seeds from its first one on
    for base in 1 2 3 4; do
        random 4 ${base}000${part}0000
        random 1 1${base}000${part}0000 --with nests
    done
    random 1 51000${part}0000 --with nests --with repeats --memo 2
    random 1 130000${part}0000 --with repeats --memo 2
    random 2 2100${part}0000 --with nests
    random 3 3100${part}0000 --with nests
done
for n in 5 8; do
    random $n 120${n}000000
done
