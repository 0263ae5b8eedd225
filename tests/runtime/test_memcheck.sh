#!/bin/sh
# Random programs, each with a start and a stop, under valgrind: no byte is used wrongly, and none is left when the process
# ends but what MPI keeps. `--long`: more of them, and on two ranks.
. "${srcdir:-.}/tests/support/tap.sh"

command -v valgrind > "$scratch/valgrind" || skip_all "there is no valgrind"
test -z "${SANITIZER:-}" || skip_all "built with sanitizers, which valgrind cannot run"
plan_later

# memcheck RANKS COMMAND...
memcheck() {
    n=$1
    shift
    ok "$* on $n ranks" ranks "$n" valgrind --quiet --leak-check=full --show-leak-kinds=all --errors-for-leak-kinds=all \
        --num-callers=40 --keep-debuginfo=yes --error-exitcode=9 --suppressions="$srcdir/tests/support/valgrind.supp" "$@"
}

if test "${1:-}" = --long; then
    for n in 1 2; do
        memcheck $n tests/runtime/random_programs --base 4${n}000000 --programs $((1000 / n))
        memcheck $n tests/runtime/nested_programs --seed 4${n}000000 --programs $((1000 / n))
    done
else
    programs=10
    if quick; then programs=5; fi
    memcheck 1 tests/runtime/random_programs --base 1 --programs $programs
    memcheck 1 tests/runtime/nested_programs --seed 1 --programs $programs
fi
