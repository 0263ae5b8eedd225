#!/bin/sh
# Random programs against the interpreter: on one rank, where repeated forks are recognised; on groups of 1 to 4 ranks; on 2, where
# a sanitizer looks for leaks; and on 5, 7, 8 and 16, where small sums go from rank to rank. Threads, schedulers, mappings, balancers,
# windows, recognition and checking mode follow from the seeds. A program that goes wrong is printed with the options that run it again.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

programs=2000
if quick; then programs=150; fi
random() { # RANKS PROGRAMS BASE OPTIONS...
    n=$1 m=$2 base=$3
    shift 3
    ok "$m random programs on $n ranks $*" ranks "$n" tests/runtime/random_programs --base "$base" --programs "$m" "$@"
}
random 1 $programs 9000000
recognised() {
    ranks 1 tests/runtime/random_programs --base 9100000 --programs $programs --with repeats --memo 2 > "$scratch/recognised" &&
        grep -x '# [1-9][0-9]* tasks recognised' "$scratch/recognised" || { cat "$scratch/recognised"; false; }
}
ok "$programs whose repeated forks are recognised" recognised
random 4 $((programs * 2 / 3)) 1
random 2 $((programs / 10)) 802000
for n in 5 7 8 16; do
    random $n $((programs / 150)) 80${n}000
done
