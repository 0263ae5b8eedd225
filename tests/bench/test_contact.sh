#!/bin/sh
# duite-bench contact runs every case in tiny sizes and checks the answers; each metric has its line.
. "${srcdir:-.}/tests/support/tap.sh"
. "${srcdir:-.}/tests/bench/bench.sh"
plan_later

# In place of valgrind, which takes ten seconds: a million instructions a step, a tenth more with a map `contact`.
mkdir "$scratch/tools"
cat > "$scratch/tools/valgrind" << 'END'
#!/bin/sh
end=$(echo "$*" | sed 's/.*--end \([0-9.]*\).*/\1/')
case $* in *certified*) rate=1100 ;; *) rate=1000 ;; esac
awk -v end="$end" -v rate=$rate 'BEGIN { printf "==1== I   refs:      %d,%03d,%03d\n", 5 + end * rate, (end * rate * 1000) % 1000, 0 }'
END
chmod +x "$scratch/tools/valgrind"
PATH=$scratch/tools:$PATH

contact() { limited "$bench" contact "$@"; }

all_listed() {
    contact --quick --repeats 1 > "$scratch/lines" 2> "$scratch/said" || { cat "$scratch/said" && return 1; }
    cat "$scratch/lines"
    every_metric "$scratch/lines" "not built: |not installed: " contact
}

targets_listed() {
    targets contact > "$scratch/targets"
    diff - "$scratch/targets" << 'END'
certify_ns_per_pair <= 35
certified_uncut >= 0.85
detect_ns_per_vertex_waves <= 130
detect_vs_embree_waves <= 0.45
detect_ns_per_vertex_draped <= 400
detect_ns_per_vertex_six_layers <= 1600
detect_vs_embree_six_layers <= 1.2
map_ms <= 20
collision_speedup_t2 >= 1.9
collision_speedup_r2 >= 1.7
iterations_with_contact <= 1.2
self_on_vs_off <= 1.5
sphere_seconds_per_frame <= 0.25
sphere_vs_blender <= 0.02
stack_seconds_per_frame <= 1.5
twist_balance_vs_none <= 0.95
peers_drape <= 0.9
peers_curtain <= 0.35
peers_twist <= 4.5
peers_needle <= 1.8
peers_stack <= 8
peers_ribbon <= 0.8
peers_layers <= 3
ring_solves_per_step <= 2.5
ring_seconds <= 4
pinch_force_growth <= 1.01
pinch_force_h1_vs_h10 <= 1.1
memory_cross_vs_still <= 2
instructions_nothing_to_touch <= 1.01
intersections <= 0
END
}

# The line of all frames is there whatever ran before it; without anything there is no figure.
intersections_added() {
    grep -q '^intersections: 0 pairs' "$scratch/lines" && contact --quick --repeats 1 --only intersections > "$scratch/alone" 2>&1 &&
        grep -q '^intersections: no case before it ran scenes' "$scratch/alone"
}
# A case that calls valgrind says so where there is none, and the rest is measured.
without_tools() {
    mkdir -p "$scratch/empty" && (PATH=$scratch/empty && export PATH && "$bench" contact --quick --repeats 1 --only instructions) > "$scratch/bare" 2>&1 &&
        grep -q '^instructions_nothing_to_touch: not installed: valgrind' "$scratch/bare"
}
counted() { # 1.1 times as many with the map
    grep -q '^instructions_per_step: 1 millions' "$scratch/lines" && grep -q '^instructions_nothing_to_touch: 1.1 x' "$scratch/lines"
}
# Counts are of the run whose seconds are told: those of a second bench are equal.
counted_again() {
    contact --quick --repeats 1 --only peers --threads 3 > "$scratch/again" 2>&1 || { cat "$scratch/again" && return 1; }
    for bench in lines again; do grep -E '^(intersections_)?peers_[a-z_]*: ' "$scratch/$bench" | grep -vE '^peers_[a-z]*(_vs_published)?: ' > "$scratch/$bench.counts"; done
    test "$(wc -l < "$scratch/lines.counts")" = 63 && diff "$scratch/lines.counts" "$scratch/again.counts"
}
distribution_printed() { contact --list | grep -c '^certify: .*corners in a cube of 10 mm, ways of up to 2 mm'; }

ok "runs every case, and every metric listed has its line" all_listed
ok "the metrics that have a target, and which" targets_listed
ok "what the pairs are is said" distribution_printed
ok "intersections are added up over the cases" intersections_added
ok "a tool that is not installed is said" without_tools
ok "instructions a step are the difference of two runs" counted
ok "the counts of the peers' scenes are equal on two threads and on three" counted_again
