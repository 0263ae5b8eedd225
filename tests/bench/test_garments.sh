#!/bin/sh
# duite-bench garments runs in tiny sizes; each metric has its line; the T-shirt that is worn is put on once and kept.
. "${srcdir:-.}/tests/support/tap.sh"
. "${srcdir:-.}/tests/bench/bench.sh"
plan_later

garments() { limited "$bench" garments --states "$scratch/states" "$@"; }

all_listed() {
    garments --quick --repeats 1 > "$scratch/lines" 2> "$scratch/said" || { cat "$scratch/said" && return 1; }
    cat "$scratch/lines"
    cp "$scratch/said" "$scratch/first"
    every_metric "$scratch/lines" "not built: " garments
}

targets_listed() {
    targets garments > "$scratch/targets"
    diff - "$scratch/targets" << 'END'
pattern_ms <= 900
pattern_below_30 <= 0.0001
pattern_least_angle >= 20
avatar_seconds <= 2
map_ms <= 20
body_ns_per_vertex <= 200
self_ns_per_vertex <= 700
open_mesh_vs_body <= 1.3
jeans_repulsion_seconds <= 1.2
jeans_certified_seconds <= 2
walk_seconds_per_frame <= 0.35
velocity_correction_cost <= 1.1
intersections <= 0
END
}

good_angles() { sed -n 's/^pattern_least_angle: \([0-9.]*\).*/\1/p' "$scratch/lines" | awk '{ exit !($1 >= 28 && $1 <= 60) }'; }

ok "runs every case, and every metric listed has its line" all_listed
ok "the metrics that have a target, and which" targets_listed
ok "triangles are good in tiny sizes, too" good_angles

worn=$scratch/states/quick/worn.obj
only_worn() { garments --quick --repeats 1 --only=worn > "$scratch/said" 2>&1; }
kept() {
    grep -q "putting on the T-shirt" "$scratch/first" && cp "$worn" "$scratch/before" && only_worn && cat "$scratch/said" &&
        ! grep -q "putting on" "$scratch/said" && cmp "$worn" "$scratch/before"
}
# Euler: six panels that nothing joins yet, so that V - E + F = 6; each edge of a triangle has its reverse in another, or is at a border.
whole() {
    awk '$1 == "v" { v++ }
        $1 == "f" { f++; for (i = 2; i < 5; i++) { a = $i; b = $(i < 4 ? i + 1 : 2); if ((a, b) in side) bad = 1; side[a, b]; if (!((b, a) in side)) e++ } }
        END { print v, e, f; exit !(!bad && v - e + f == 6) }' "$worn"
}
put_on_again() { rm "$worn" && only_worn && cmp "$worn" "$scratch/before"; }
broken() { # what cannot be read is told
    head -n 100 "$worn" > "$scratch/half" && echo "f 1 2 3000" >> "$scratch/half" && cp "$scratch/half" "$worn"
    ! only_worn && cat "$scratch/said" && grep -q "worn.obj:101" "$scratch/said"
}
ok "the T-shirt is put on once and kept" kept
ok "it is the panels, with middles of edges" whole
ok "it is the same when it is put on again" put_on_again
ok "one that cannot be read is told" broken
