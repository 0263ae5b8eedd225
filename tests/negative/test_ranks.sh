#!/bin/sh
# Misuse and failures with several ranks: the programs print TAP of their own; here they must end well, on time.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

ok "out of memory on 1 rank" ranks 1 tests/negative/ranks_memory
ok "out of memory on 1 rank with graphs" ranks 1 tests/negative/ranks_memory_graphs
ok "the system refuses on 1 rank" ranks 1 tests/negative/ranks_system
for n in 2 3; do
    if test $n = 2; then # 3: test_memory_long.sh
        ok "out of memory on $n ranks" ranks $n tests/negative/ranks_memory
        ok "out of memory on $n ranks with graphs" ranks $n tests/negative/ranks_memory_graphs
        ok "out of memory on $n ranks while objects move" ranks $n tests/negative/ranks_memory_graphs wander
    fi
    ok "the system refuses on one of $n ranks" ranks $n tests/negative/ranks_system
    ok "failures on $n ranks" ranks $n tests/negative/ranks_failures
    ok "different programs on $n ranks" ranks $n tests/negative/ranks_different
    ok "different calls on $n ranks" ranks $n tests/negative/ranks_blocking
    ok "groups of $n ranks" ranks $n tests/negative/ranks_groups
done
quick || ok "groups of 4 ranks" ranks 4 tests/negative/ranks_groups
