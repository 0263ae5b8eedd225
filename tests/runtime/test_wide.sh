#!/bin/sh
# Kernels with many listed parameters, on ranks, and in a trace.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless ./duite-trace
plan_later

for n in 1 2 3; do
    ok "40 listed parameters on $n ranks" ranks $n tests/runtime/ranks_wide
done
ok "... in checking mode" env DUITE_CHECK=accesses tests/runtime/ranks_wide
ok "... traced" ranks 2 tests/runtime/ranks_wide "$scratch/trace"
ok "the trace is whole" ./duite-trace --check "$scratch/trace"
both_are_there() { ./duite-trace "$scratch/trace" | tee "$scratch/table" && grep -q "wide" "$scratch/table" && grep -q "plain" "$scratch/table"; }
ok "... and names both kernels" both_are_there
ok "... and is predicted for other hosts" ./duite-predict "$scratch/trace" --hosts 3
