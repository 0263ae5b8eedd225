#!/bin/sh
# A program that ends without a stop, in the middle of its work: its status is kept and nothing hangs.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

times=2
if quick; then times=1; fi
for round in $(seq $times); do
    exits 3 "one process" limited tests/runtime/ranks exit 3
    exits 0 "one process, without a failure" limited tests/runtime/ranks exit 0
    exits 4 "one rank of two" ranks 2 tests/runtime/ranks exit 4
    exits 5 "both ranks" ranks 2 tests/runtime/ranks exit 5 --all
done
if is_openmpi; then
    not_ok_expected "both ranks without a failure: mpirun tells" ranks 2 tests/runtime/ranks exit 0 --all
else
    skip "both ranks without a failure: mpirun tells" "not Open MPI's, which alone does"
fi

# A body that does not return leaves a task that can never end, and the process ends with a sentence in place of a hang.
ends_with() { # STATUS SENTENCE COMMAND...; STATUS signal: a rank's, of which Open MPI's mpirun makes 134, MPICH's 6
    expected=$1 sentence=$2
    shift 2
    status=0
    "$@" 2> "$scratch/said" || status=$?
    cat "$scratch/said"
    echo "exit status $status"
    if test "$expected" = signal; then
        if is_openmpi; then expected=134; else expected=6; fi
    fi
    test $status = "$expected" && grep -q "^duite: $sentence" "$scratch/said"
}
left="the body of kernel step was left by a C++ exception or the end of its thread (rank [01], worker [01])"
ok "a body ends its thread" ends_with 134 "$left" limited tests/runtime/ranks exit 0 --thread
ok "a body ends its thread on 2 ranks" ends_with signal "$left" ranks 2 tests/runtime/ranks exit 0 --thread

# A policy must not end the program: its exit becomes a failure that names the policy.
leaves() { ends_with 1 "$@"; }
ok "exit in a scheduler" leaves "scheduler leaving: its place called exit (rank 0, worker [0-9]*); this process ends with status 1" \
    limited tests/runtime/ranks exit 0 --place
ok "exit in a scheduler on 2 ranks" leaves "scheduler leaving: its place called exit (rank [01], worker" \
    ranks 2 tests/runtime/ranks exit 0 --place
ok "exit in a mapping on 2 ranks" leaves "mapping leaving: its map called exit (rank [01], worker 0)" \
    ranks 2 tests/runtime/ranks exit 0 --map
ok "exit in a scheduler with a status" leaves "scheduler leaving: its place called exit" limited tests/runtime/ranks exit 3 --place
