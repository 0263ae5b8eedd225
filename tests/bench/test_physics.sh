#!/bin/sh
# duite-bench physics runs every case in tiny sizes and checks the answers; each metric has its line; a wrong answer is told.
. "${srcdir:-.}/tests/support/tap.sh"
. "${srcdir:-.}/tests/bench/bench.sh"
plan_later

physics() { limited "$bench" physics "$@"; }

all_listed() {
    physics --quick --repeats 1 > "$scratch/lines" 2> "$scratch/said" || { cat "$scratch/said" && return 1; }
    cat "$scratch/lines"
    every_metric "$scratch/lines" "not built: " physics
}

targets_listed() {
    targets physics > "$scratch/targets"
    diff - "$scratch/targets" << 'END'
assembly_springs_vs_iteration <= 3
assembly_triangles_vs_iteration <= 8
physics_speedup_t2 >= 1.9
explicit_step_vs_triad >= 0.6
END
}

formula_printed() { physics --list | grep -c '^explicit: .*5 x 24 + 3 x 8 a vertex .* and 4 x 8 a spring'; }

lied_to() { # the loop that the triad is part of is the liar
    liars_bench bench && mkdir -p "$scratch/bench/cg" && cp tests/bench/liar "$scratch/bench/cg/twin" || return 99
    status=0
    LIAR=wrong limited "$scratch/bench/duite-bench" physics --quick --repeats 1 --only explicit > "$scratch/said" 2>&1 ||
        status=$?
    cat "$scratch/said"
    test $status = 1 && grep -q "explicit, openmp.*: wrong answer" "$scratch/said"
}

ok "runs every case, and every metric listed has its line" all_listed
ok "the metrics that have a target, and which" targets_listed
ok "the bytes of an explicit step are said" formula_printed
ok "a wrong answer is an error" lied_to
