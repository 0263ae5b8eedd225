#!/bin/sh
# duite-bench ranks runs every case in tiny sizes and checks the answers (of CG: test_sheet); each metric has its line, on hosts too
# where there can be any; a wrong answer is told.
. "${srcdir:-.}/tests/support/tap.sh"
bench=$PWD/bench/duite-bench
skip_unless "$bench"
plan_later

bench_ranks() { DUITE_TIMEOUT=120 limited "$bench" ranks "$@"; }

# Every metric that --list names has a line: a figure, or why there is none.
all_listed() {
    bench_ranks --quick --repeats 1 > "$scratch/lines" || return 1
    cat "$scratch/lines"
    for metric in $(bench_ranks --list | sed -n 's/^    \([a-z0-9_]*\) (.*/\1/p'); do
        grep -Eq "^$metric: ([-0-9]|not built: |hosts.sh: |no hosts)" "$scratch/lines" || { echo "no line of $metric" && return 1; }
    done
}

targets_listed() {
    bench_ranks --list | sed -n 's/^    \([a-z0-9_]*\) ([a-z_]*), target /\1 /p' > "$scratch/targets"
    diff - "$scratch/targets" << 'END'
cg_r2_vs_twin <= 1.1
cg_hosts2_vs_twin <= 1.1
cg_bytes_vs_twin <= 1.03
cg_messages_vs_twin <= 1
stencil_step_vs_twin <= 2
record_us_per_task <= 1
prune_ns_per_task <= 20
memory_r4_vs_r1 <= 0.35
delegate_speedup_r2 >= 1.7
migrate_vs_balanced <= 1.15
migrate_steps <= 20
END
}

# A bench of its own with a twin that is wrong.
refused() {
    mkdir -p "$scratch/bench/rivals" && cp "$bench" "$scratch/bench" && cp tests/bench/liar "$scratch/bench/rivals/mpi" || return 99
    LIAR=wrong DUITE_TIMEOUT=60 limited "$scratch/bench/duite-bench" ranks --quick --repeats 1 --only stencil > "$scratch/said" 2>&1
    status=$?
    cat "$scratch/said"
    test $status = 1 && grep -q "stencil, mpi.*: wrong answer" "$scratch/said"
}

ok "runs every case, and every metric listed has its line" all_listed
ok "the metrics that have a target, and which" targets_listed
ok "a wrong answer is an error" refused
