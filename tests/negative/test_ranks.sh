#!/bin/sh
# Misuse and failures with several ranks: the programs print TAP of their own; here they must end well, on time.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

ok "out of memory on 1 rank" ranks 1 tests/negative/ranks_memory
ok "out of memory on 1 rank with graphs" ranks 1 tests/negative/ranks_memory_graphs
ok "the system refuses on 1 rank" ranks 1 tests/negative/ranks_system
# On 3 ranks: test_memory_long.sh.
ok "out of memory on 2 ranks" ranks 2 tests/negative/ranks_memory
ok "out of memory on 2 ranks, whose messages go in pieces" ranks 2 tests/negative/ranks_memory pieces
ok "out of memory on 2 ranks with graphs" ranks 2 tests/negative/ranks_memory_graphs
ok "out of memory on 2 ranks while objects move" ranks 2 tests/negative/ranks_memory_graphs wander
for n in 2 3; do
    ok "groups of $n ranks" ranks $n tests/negative/ranks_groups
    if quick && test $n = 3; then continue; fi # on 2 ranks leaks are looked for, too
    ok "the system refuses on one of $n ranks" ranks $n tests/negative/ranks_system
    ok "failures on $n ranks" ranks $n tests/negative/ranks_failures
    ok "different programs on $n ranks" ranks $n tests/negative/ranks_different
    ok "different calls on $n ranks" ranks $n tests/negative/ranks_blocking
done
ok "failures on 5 ranks" ranks 5 tests/negative/ranks_failures
quick || ok "groups of 4 ranks" ranks 4 tests/negative/ranks_groups
