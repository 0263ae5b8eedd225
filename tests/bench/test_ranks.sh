#!/bin/sh
# duite-bench ranks runs every case in tiny sizes and checks the answers (of CG: test_sheet); each metric has its line, on hosts too
# where there can be any; a wrong answer is told.
. "${srcdir:-.}/tests/support/tap.sh"
. "${srcdir:-.}/tests/bench/bench.sh"
plan_later

bench_ranks() { limited "$bench" ranks "$@"; }

all_listed() {
    bench_ranks --quick --repeats 1 > "$scratch/lines" || return 1
    cat "$scratch/lines"
    every_metric "$scratch/lines" "not built: |hosts.sh: |no hosts" bench_ranks
}

targets_listed() {
    targets bench_ranks > "$scratch/targets"
    diff - "$scratch/targets" << 'END'
cg_r2_vs_twin <= 1.1
cg_hosts2_vs_twin <= 1.1
cg_bytes_vs_twin <= 1.03
cg_messages_vs_twin <= 1
stencil_step_vs_twin <= 2
loaded_r2_vs_twin <= 1.2
record_us_per_task <= 0.6
prune_ns_per_task <= 20
memory_r4_vs_r1 <= 0.35
delegate_speedup_r2 >= 1.7
tree_speedup_r2 >= 1.5
migrate_vs_balanced <= 1.15
migrate_steps <= 20
await_mpi_vs_twin <= 1.1
END
}

ok "runs every case, and every metric listed has its line" all_listed
ok "the metrics that have a target, and which" targets_listed
ok "a wrong answer is an error" lie_told mpi stencil ranks --quick --repeats 1 --only stencil
