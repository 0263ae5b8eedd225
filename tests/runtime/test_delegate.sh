#!/bin/sh
# Random programs whose tasks run anywhere. One that goes wrong is printed with the options that run it again.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

programs=120
if quick; then programs=40; fi
ok "random programs" ranks 4 tests/runtime/random_programs --base 500000 --programs $programs --balance scatter
ok "programs that nest on 2 ranks" ranks 2 tests/runtime/random_programs --with nests --base 500000 --programs $programs --balance scatter
ok "programs that nest on 3 ranks" ranks 3 tests/runtime/random_programs --with nests --base 500000 --programs $((programs / 2)) --balance scatter
ok "programs that nest on 4 ranks" ranks 4 tests/runtime/random_programs --with nests --base 600000 --programs $((programs / 4)) --balance scatter
ok "programs that nest in checking mode" ranks 2 tests/runtime/random_programs --with nests --base 700000 \
    --programs $((programs / 4)) --balance scatter --check 1
