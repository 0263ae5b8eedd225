#!/bin/sh
# A rank that stops for good is lost: whatever the others wait in, they are told which one, and can leave. One that only works
# long, or stops for a moment, is not. With DUITE_LONG=1: all calls that wait.
. "${srcdir:-.}/tests/support/tap.sh"

lost() { # HOW: both ranks that are left are right; that mpirun ends the job is the test's doing
    ranks 3 tests/negative/ranks_lost "$1" > "$scratch/lost" 2>&1
    cat "$scratch/lost"
    test "$(grep -c "^rank [02] is right: $1: " "$scratch/lost")" = 2
}

plan_later
ways="get send later subtree"
if test "${DUITE_LONG:-}" = 1; then ways="get send later subtree body wait replay count stop window"; fi
for how in $ways; do ok "lost during: $how" lost "$how"; done
ok "not lost: all its workers are in long bodies" ranks 3 tests/negative/ranks_lost bodies
if test "${DUITE_LONG:-}" = 1; then ok "not lost: stopped for a while" ranks 3 tests/negative/ranks_lost stopped; fi
