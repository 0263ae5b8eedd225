#!/bin/sh
# The tests of runs and their failures once more, with the cloth spread over two ranks: what one rank finds wrong, or has no memory
# for, all say. With DUITE_LONG=1 in their place the tests of motion, and those of test_checked that see each kernel once: that two ranks
# move a cloth like one, to the bit, is what test_same_hash.sh says.
. "${srcdir:-.}/tests/support/tap.sh"
programs="test_run test_failures test_memory test_stops"
if test "${DUITE_LONG:-}" = 1; then programs="test_halving test_sliders test_solvers test_motion test_integrators"; fi
for program in $programs test_checked test_late; do
    skip_unless "tests/cloth/flow/$program"
done
plan_later

for program in $programs; do
    ok "$program on 2 ranks" ranks 2 "tests/cloth/flow/$program"
done
if test "${DUITE_LONG:-}" = 1; then
    # As in run.sh.
    ok "test_checked on 2 ranks" ranks 2 env ASAN_OPTIONS="${ASAN_OPTIONS:-}:fast_unwind_on_malloc=1:detect_leaks=0" \
        tests/cloth/flow/test_checked quick
else
    ok "test_late on 3 ranks" ranks 3 tests/cloth/flow/test_late
fi
