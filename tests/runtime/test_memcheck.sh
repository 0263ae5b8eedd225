#!/bin/sh
# Random programs, each with a start and a stop, under valgrind: no byte is used wrongly, and none is left when the process
# ends but what MPI keeps. `--long`: more of them, and on two ranks.
. "${srcdir:-.}/tests/support/tap.sh"

command -v valgrind > "$scratch/valgrind" || skip_all "there is no valgrind"
test -z "${SANITIZER:-}" || skip_all "built with sanitizers, which valgrind cannot run"
plan_later

# memcheck RANKS BASE PROGRAMS
memcheck() {
    ok "$3 random programs on $1 ranks" ranks "$1" valgrind --quiet --leak-check=full --show-leak-kinds=all \
        --errors-for-leak-kinds=all --num-callers=40 --keep-debuginfo=yes --error-exitcode=9 \
        --suppressions="$srcdir/tests/support/valgrind.supp" tests/runtime/random_programs --base "$2" --programs "$3"
}

if test "${1:-}" = --long; then
    memcheck 1 41000000 2000
    memcheck 2 42000000 1000
else
    programs=20
    if quick; then programs=10; fi
    memcheck 1 1 $programs
fi
