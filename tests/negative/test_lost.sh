#!/bin/sh
# A rank that stops for good is lost: whatever the others wait in, they are told which one, and can leave. One that only works
# long, stops for a moment, or copies a large message, is not. With DUITE_LONG=1: all calls that wait, and messages of 2.4 GB.
. "${srcdir:-.}/tests/support/tap.sh"

lost() { # HOW: both ranks that are left are right; that mpirun ends the job is the test's doing
    ranks 3 tests/negative/ranks lost "$1" > "$scratch/lost" 2>&1
    cat "$scratch/lost"
    test "$(grep -c "^rank [02] is right: $1: " "$scratch/lost")" = 2
}

plan_later
ways="get send later subtree"
if test "${DUITE_LONG:-}" = 1; then ways="get send later subtree body wait replay count stop window"; fi
for how in $ways; do ok "lost during: $how" lost "$how"; done
ok "not lost: all its workers are in long bodies" ranks 3 tests/negative/ranks lost bodies
ok "not lost: MPI copies a large message slowly" ranks 2 tests/negative/ranks large
if test "${DUITE_LONG:-}" = 1; then
    ok "not lost: stopped for a while" ranks 3 tests/negative/ranks lost stopped
    # On each rank the object, and what a recorded graph sends or receives it in.
    if test "$(sed -n 's/^MemAvailable: *\([0-9]*\) kB/\1/p' /proc/meminfo)" -lt 12000000; then
        skip "not lost: a message of 2.4 GB" "12 GB of memory are needed"
    else
        ok "not lost: a message of 2.4 GB" ranks 2 tests/negative/ranks large 300000000
    fi
fi
