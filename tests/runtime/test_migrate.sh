#!/bin/sh
# Random programs whose objects and leaves move anywhere at any replay, or by what was measured. One that goes wrong is printed with the
# options that run it again.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

programs=60
if quick; then programs=30; fi
for n in 2 3 4; do
    ok "random programs on up to $n ranks" ranks $n tests/runtime/random_programs --base 90${n}000 --programs $programs --balance wander
done
ok "random programs, by what was measured" ranks 4 tests/runtime/random_programs --base 950000 --programs $programs \
    --balance migrate
