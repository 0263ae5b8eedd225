#!/bin/sh
# Random programs on groups of 1 to 4 ranks with 1 to 4 threads, every scheduler, mapping and balancer, against the
# interpreter; some on 2 ranks, where a sanitizer looks for leaks, and on 5, 7, 8 and 16,
# where small sums go from rank to rank.
# A program that goes wrong is printed with the options that run it again.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

programs=1500
if quick; then programs=200; fi
ok "$programs random programs" ranks 4 tests/runtime/random_programs --base 1 --programs $programs
ok "$((programs / 10)) on 2 ranks" ranks 2 tests/runtime/random_programs --base 802000 --programs $((programs / 10))
for n in 5 7 8 16; do
    ok "$((programs / 100)) on $n ranks" ranks $n tests/runtime/random_programs --base 80${n}000 --programs $((programs / 100))
done

# On one rank half of the programs fork the same tasks again and again.
repeated() {
    limited env DUITE_MEMO="$1" tests/runtime/random_programs --base "$2" --programs $programs > "$scratch/repeated" &&
        cat "$scratch/repeated" && if [ "$1" = 0 ]; then grep -x '# 0 tasks recognised' "$scratch/repeated"
        else grep -x '# [1-9][0-9]* tasks recognised' "$scratch/repeated"; fi
}
ok "$programs whose repeated forks are recognised" repeated always 9000000
ok "$programs where bodies are short" repeated 1 9100000
ok "the same, which stay forks" repeated 0 9100000
