#!/bin/sh
# Random trees of tasks on 1, 2 and 3 ranks with 1 to 4 threads and every scheduler, against the interpreter. A program
# that goes wrong is printed with the options that run it again.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

programs=300
if quick; then programs=100; fi
ok "$programs random trees of tasks" limited tests/runtime/nested_programs --programs $programs
ok "the same, every repeated round recognised" limited env DUITE_MEMO=always tests/runtime/nested_programs \
  --seed 400000 --programs $programs
ok "random trees of tasks on 2 ranks" ranks 2 tests/runtime/nested_programs --seed 100000 --programs $((programs / 4))
ok "random trees of tasks on 3 ranks" ranks 3 tests/runtime/nested_programs --seed 200000 --programs $((programs / 8))
ok "random trees of tasks in checking mode" limited env DUITE_CHECK=accesses tests/runtime/nested_programs \
  --seed 300000 --programs $((programs / 8))
