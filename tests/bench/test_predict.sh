#!/bin/sh
# duite-bench compare runs in tiny sizes, and has its figures.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless bench/duite-bench
plan_later

rows() { # each metric with a number
    limited bench/duite-bench compare --quick --repeats 1 > "$scratch/said" 2>&1 || { cat "$scratch/said"; return 1; }
    cat "$scratch/said"
    for metric in trace_slowdown predict_1e6_seconds predict_1e6_bytes predict_error_median predict_error_worst rank_order_agrees rank_order_pairs compare_overhead; do
        grep -q "^$metric: [0-9]" "$scratch/said" || return 1
    done
}

none_left() { # the traces of the rows above
    ls -A "$scratch/temporary" > "$scratch/left" && cat "$scratch/left" && test ! -s "$scratch/left"
}
mkdir "$scratch/temporary"
export TMPDIR="$scratch/temporary"
ok "traces and predictions are measured" rows
ok "traces are removed at the end" none_left
