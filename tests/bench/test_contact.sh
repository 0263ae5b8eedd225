#!/bin/sh
# duite-bench contact runs every case in tiny sizes and checks the answers; each metric has its line.
. "${srcdir:-.}/tests/support/tap.sh"
. "${srcdir:-.}/tests/bench/bench.sh"
plan_later

contact() { limited "$bench" contact "$@"; }

all_listed() {
    contact --quick --repeats 1 > "$scratch/lines" 2> "$scratch/said" || { cat "$scratch/said" && return 1; }
    cat "$scratch/lines"
    every_metric "$scratch/lines" "not built: " contact
}

targets_listed() {
    targets contact > "$scratch/targets"
    diff - "$scratch/targets" << 'END'
certify_ns_per_pair <= 35
certified_uncut >= 0.85
detect_ns_per_vertex_waves <= 130
detect_ns_per_vertex_draped <= 400
detect_ns_per_vertex_six_layers <= 2000
END
}

distribution_printed() { contact --list | grep -q '^certify: .*corners in a cube of 10 mm, ways of up to 2 mm'; }

ok "runs every case, and every metric listed has its line" all_listed
ok "the metrics that have a target, and which" targets_listed
ok "what the pairs are is said" distribution_printed
