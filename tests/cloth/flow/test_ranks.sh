#!/bin/sh
# The tests of runs and of their failures once more, on two ranks: what one rank finds wrong, or has no memory for, all say.
. "${srcdir:-.}/tests/support/tap.sh"
for program in test_run test_failures test_halving test_contact test_guides test_memory test_checked test_late; do
    skip_unless "tests/cloth/flow/$program"
done
plan_later

for program in test_run test_failures test_halving test_contact test_guides test_memory test_checked; do
    ok "$program on 2 ranks" ranks 2 "tests/cloth/flow/$program"
done
ok "test_late on 3 ranks" ranks 3 tests/cloth/flow/test_late
