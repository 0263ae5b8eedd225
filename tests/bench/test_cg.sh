#!/bin/sh
# duite-bench cg makes its states and runs every case in tiny sizes, against every rival that was built, and checks the answers; each
# metric has its line; states are kept, and are the same wherever they are made; a wrong answer is told.
. "${srcdir:-.}/tests/support/tap.sh"
. "${srcdir:-.}/tests/bench/bench.sh"
plan_later

bench_cg() { limited "$bench" cg --states "$scratch/states" "$@"; }

all_listed() {
    bench_cg --quick --repeats 1 > "$scratch/lines" 2> "$scratch/said" || { cat "$scratch/said" && return 1; }
    cat "$scratch/lines"
    every_metric "$scratch/lines" "not built: " bench_cg
}

targets_listed() {
    targets bench_cg > "$scratch/targets"
    diff - "$scratch/targets" << 'END'
spring_150_vs_petsc <= 0.26
spring_150_vs_twin <= 1.05
spring_400_vs_petsc <= 0.155
bandwidth_fraction_400 >= 0.9
half_150_vs_petsc <= 0.42
solve_vs_petsc_cg <= 0.067
solve_vs_petsc_icc <= 0.2
iterations_vs_jacobi_geo <= 0.18
iterations_vs_jacobi_worst <= 0.6
solve_time_vs_jacobi_geo <= 0.45
solve_time_vs_jacobi_worst <= 1
mass_norm_error <= 0.01
step_speedup_t2 >= 1.85
step_speedup_r2 >= 1.85
realtime_ms_per_frame <= 40
realtime_ms_per_frame_p95 <= 60
END
}

hashes() { sed -n 's/^# \(state_.*\)/\1/p' "$1"; }
# other_step NAME: the state is of a step of half the length.
other_step() {
    head -c 64 "$scratch/states/quick/$1.state" > "$scratch/other" && printf '\173\024\256\107\341\172\204\077' >> "$scratch/other" && # 0.01
        tail -c +73 "$scratch/states/quick/$1.state" >> "$scratch/other" && mv "$scratch/other" "$scratch/states/quick/$1.state"
}
kept() { # nothing is made again; what is damaged, or of another step, is
    : > "$scratch/states/quick/falling_h8.state"
    other_step crumpled_h20 || return 1
    bench_cg --quick --repeats 1 --only spring_150 --threads 3 > "$scratch/again" 2> "$scratch/said" || return 1
    cat "$scratch/said"
    test "$(grep -c 'making the state' "$scratch/said")" = 2 &&
        grep -q 'making the state falling_h8: .*falling_h8.state is not a state of this version$' "$scratch/said" &&
        grep -q 'making the state crumpled_h20: .* has the system of a step of 10 ms, not of one of 20 ms$' "$scratch/said" &&
        hashes "$scratch/lines" > "$scratch/first" && hashes "$scratch/again" | diff "$scratch/first" - &&
        test "$(wc -l < "$scratch/first")" -ge 17
}

no_folder() {
    status=0
    bench_cg --quick --states "$scratch/lines/states" > "$scratch/said" 2>&1 || status=$?
    cat "$scratch/said"
    test $status = 1 && grep -q "cannot be written to" "$scratch/said"
}

ok "runs every case, and every metric listed has its line" all_listed
ok "the metrics that have a target, and which" targets_listed
ok "states are kept, and the same from three threads" kept
ok "a wrong answer is an error" lie_told petsc spring_150 cg --quick --repeats 1 --only spring_150 --states "$scratch/states"
ok "a folder that cannot be" no_folder
