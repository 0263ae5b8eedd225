#!/bin/sh
# Random programs whose objects and leaves move anywhere, or by what was measured: a hundred thousand, in about ten
# minutes on two cores, and half as many of which only leaves move.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

DUITE_TIMEOUT=${DUITE_TIMEOUT:-3600}
ok "100000 random programs" ranks 4 tests/runtime/random_programs --base 1100000000 --programs 100000 --balance wander
ok "20000 programs that nest" ranks 3 tests/runtime/random_programs --with nests --base 40000000 --programs 20000 --balance wander
ok "20000 random programs, by what was measured" ranks 4 tests/runtime/random_programs --base 1200000000 --programs 20000 --balance migrate
ok "50000 random programs whose leaves run anywhere" ranks 4 tests/runtime/random_programs --base 1300000000 --programs 50000 --balance scatter
ok "20000 that nest likewise" ranks 4 tests/runtime/random_programs --with nests --base 50000000 --programs 20000 --balance scatter
