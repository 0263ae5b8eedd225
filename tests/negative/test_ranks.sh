#!/bin/sh
# Misuse and failures with several ranks: each case prints TAP of its own; here it must end well, on time. On 3 ranks without memory:
# test_memory_long.sh.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

cases tests/negative/starved << 'END'
memory               | 1       | out of memory
memory               | 2       | out of memory
memory pieces        | 2       | out of memory while messages go in pieces
memory_graphs        | 1       | out of memory with graphs
memory_graphs        | 2       | out of memory with graphs
memory_graphs wander | 2       | out of memory while objects move
system               | 1       | the system refuses
system               | 2 3+    | the system refuses one rank
END
cases tests/negative/ranks << 'END'
groups               | 2 3 4+  | groups
failures             | 2 5 3+  | failures
different            | 2 3+    | different programs
blocking             | 2 3+    | different calls
END
