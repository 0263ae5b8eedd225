#!/bin/sh
# Each allocation on each of 3 ranks fails once; test_ranks.sh has each third, on one rank and on two.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later
DUITE_LONG=1
export DUITE_LONG

ok "out of memory" ranks 3 tests/negative/ranks_memory
ok "out of memory with graphs" ranks 3 tests/negative/ranks_memory_graphs
ok "out of memory while objects move" ranks 3 tests/negative/ranks_memory_graphs wander
ok "out of memory with graphs on 5 ranks, whose sums go from rank to rank" ranks 5 tests/negative/ranks_memory_graphs
