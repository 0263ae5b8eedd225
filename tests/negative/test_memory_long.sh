#!/bin/sh
# Each allocation on each of 3 ranks fails once; test_ranks.sh has each third, on one rank and on two.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later
DUITE_LONG=1
export DUITE_LONG

cases tests/negative/starved << 'END'
memory               | 3 | out of memory
memory_graphs        | 3 | out of memory with graphs
memory_graphs wander | 3 | out of memory while objects move
memory_graphs        | 5 | out of memory with graphs whose sums go from rank to rank
END
