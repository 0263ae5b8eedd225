#!/bin/sh
# Random programs and trees of tasks whose objects and leaves move anywhere: a hundred thousand, in about ten minutes on two
# cores.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

DUITE_TIMEOUT=${DUITE_TIMEOUT:-3600}
ok "100000 random programs" ranks 4 tests/runtime/random_programs --base 1100000000 --programs 100000 --balance wander
ok "20000 random trees of tasks" ranks 3 tests/runtime/nested_programs --seed 40000000 --programs 20000 --balance wander
