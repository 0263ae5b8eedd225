#!/bin/sh
# Random programs and trees of tasks that run anywhere. One that goes wrong is printed with the options that run it again.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

programs=120
if quick; then programs=40; fi
ok "random programs" ranks 4 tests/runtime/random_programs --base 500000 --programs $programs --balance scatter
ok "random trees of tasks on 2 ranks" ranks 2 tests/runtime/nested_programs --seed 500000 --programs $programs --balance scatter
ok "random trees of tasks on 3 ranks" ranks 3 tests/runtime/nested_programs --seed 500000 --programs $((programs / 2)) --balance scatter
ok "random trees of tasks on 4 ranks" ranks 4 tests/runtime/nested_programs --seed 600000 --programs $((programs / 4)) --balance scatter
ok "random trees of tasks in checking mode" eval 'DUITE_CHECK=accesses ranks 2 tests/runtime/nested_programs --seed 700000 \
    --programs $((programs / 4)) --balance scatter'
