#!/bin/sh
# duite-bench garments runs in tiny sizes; each metric has its line.
. "${srcdir:-.}/tests/support/tap.sh"
. "${srcdir:-.}/tests/bench/bench.sh"
plan_later

garments() { limited "$bench" garments "$@"; }

all_listed() {
    garments --quick --repeats 1 > "$scratch/lines" 2> "$scratch/said" || { cat "$scratch/said" && return 1; }
    cat "$scratch/lines"
    every_metric "$scratch/lines" "not built: " garments
}

targets_listed() {
    targets garments > "$scratch/targets"
    diff - "$scratch/targets" << 'END'
pattern_ms <= 900
pattern_below_30 <= 0.0001
pattern_least_angle >= 20
velocity_correction_cost <= 1.1
END
}

good_angles() { sed -n 's/^pattern_least_angle: \([0-9.]*\).*/\1/p' "$scratch/lines" | awk '{ exit !($1 >= 28 && $1 <= 60) }'; }

ok "runs every case, and every metric listed has its line" all_listed
ok "the metrics that have a target, and which" targets_listed
ok "triangles are good in tiny sizes, too" good_angles
