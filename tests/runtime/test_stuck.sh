#!/bin/sh
# A program that stands still tells who waits for what, and goes on unharmed.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

stuck="tests/runtime/ranks stuck" # THREADS WINDOW NAP HELD get|wait|stop|replay
nothing="and for [0-9.]* s no task of this rank began or ended and no message came"
DUITE_STUCK_SECONDS=0.2
export DUITE_STUCK_SECONDS

# NAME COMMAND...: passes when COMMAND does; `tells` then looks at what it printed.
case_of() {
    ok "$@"
    cp "$scratch/output" "$scratch/told"
}
found() { grep -q "^duite: rank $1\$" "$scratch/told" || ! cat "$scratch/told"; }
tells() { ok "tells: rank $1" found "$1"; }
seldom() { test "$(grep -c "^duite: rank 0: duite_get" "$scratch/told")" -le 2; } # once, or a start was slow as well
quiet() { ! grep "^duite:" "$scratch/told"; }

case_of "a body that naps, two ranks" ranks 2 $stuck 2 0 2 0 get
tells "0: duite_get waits for object 2\.1, version 1, $nothing"
tells "0: worker [01].* runs task 1 (kernel nap)"
tells "0: task 3 (kernel take) (and 1 more) waits for what task 1 (kernel nap) writes to parameter 0"
tells "0: .* waits for object 2\.1, version 1, which has not come from rank 1"
ok "tells it once" seldom
tells "1: duite_get waits for object 2\.1, version 1, $nothing"
tells "1: no worker runs a task"
tells "1: task 2 (kernel take) waits for object 1\.1, version 1, which has not come from rank 0"
tells "1: unfinished tasks of this rank: [0-9]*"

case_of "the main thread naps itself, one rank" limited $stuck 1 0 2 0 stop
tells "0: duite_stop waits for all tasks of this rank, $nothing"
tells "0: worker 0 (the main thread) runs task 1 (kernel nap)"
tells "0: task 2 (kernel take) (and 1 more) waits for what task 1 (kernel nap) writes to parameter 0"

case_of "a full window" limited $stuck 2 1 2 0 wait
tells "0: duite_fork waits for room in its window, $nothing"

case_of "a message that is late" ranks 2 $stuck 2 0 0 2 wait
tells "1: duite_wait waits for all tasks of this rank, $nothing"
tells "1: no worker runs a task"
tells "1: task 2 (kernel take) waits for object 1\.1, version 1, which has not come from rank 0"
tells "0: duite_wait waits for the tasks of other ranks, $nothing"
tells "0: unfinished tasks of this rank: 0"

case_of "a body that naps in a replay" ranks 2 $stuck 2 0 2 0 replay
tells "0: worker [01].* runs task [0-9]* (kernel nap)"
tells "1: kernel take of a recorded graph waits for a message that has not come from rank 0"

ok "a policy's function that does not return on one of 2 ranks is named there" ranks 2 tests/runtime/ranks stuck_policies

# A body overwrote a task beyond its object, so its waits are unknown.
overrun() {
    tests/runtime/overrun &
    job=$!
    awaits $job grep -q "unfinished tasks of this rank" "$scratch/output" || return 1
    kill -KILL $job
    wait $job || true
}
case "${SANITIZER:-}" in
    ?*) skip "a body that writes beyond its object" "the sanitizer stops it" ;;
    *)
        case_of "a body that writes beyond its object" overrun
        tells "0: no worker runs a task"
        tells "0: they wait for nothing that duite knows of: a body may have written beyond its objects .* DUITE_CHECK=accesses .*" ;;
esac
named() {
    status=0
    DUITE_CHECK=accesses limited tests/runtime/overrun || status=$?
    test $status = 1
}
case_of "checking mode fails it" named
ok "and names the body" grep -q "kernel step.* goes beyond parameter 0: to byte 64 of 64" "$scratch/told"

DUITE_STUCK_SECONDS=0
case_of "nobody watches" ranks 2 $stuck 2 0 0.5 0 get
ok "tells nothing" quiet
DUITE_STUCK_SECONDS=60
case_of "not for so long" ranks 2 $stuck 2 0 0.5 0.5 get
ok "tells nothing" quiet

DUITE_STUCK_SECONDS=0.001
programs=100
if quick; then programs=20; fi
ok "looked at all the time, one rank" limited tests/runtime/random_programs --base 500000 --programs $programs --with nests
ok "looked at all the time, three ranks" ranks 3 tests/runtime/random_programs --base 400000 --programs $programs

DUITE_STUCK_SECONDS=soon
exits 3 "seconds that are none" limited $stuck 1 0 0 0 get
unset DUITE_STUCK_SECONDS
exits 3 "seconds of policies are refused" env DUITE_POLICY_SECONDS=1 $stuck 1 0 0 0 get
cp "$scratch/output" "$scratch/told"
ok "... and it is said what there is instead" grep "DUITE_POLICY_SECONDS .* DUITE_STUCK_SECONDS" "$scratch/told"
