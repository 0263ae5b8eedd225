#!/bin/sh
# Where nothing is installed but what a bare Debian and ./bootstrap have, what looks for an optional program says which is missing, and
# skips. A PATH like that of such a machine stands for it here; tests/bare_long.sh makes one.
. "${srcdir:-.}/tests/support/tap.sh"
command -v dpkg-query > "$scratch/output" || skip_all "no dpkg-query, which knows what a bare Debian has"
skip_unless bench/duite-bench
plan_later

bare=$scratch/sbin # hosts.sh adds root's folders to a PATH without them
bare_path() {
    mkdir "$bare" || return 1
    # shellcheck disable=SC2046 # names of packages
    dpkg-query -L $(dpkg-query -W -f '${Priority} ${Package}\n' | sed -n 's/^required //p') | grep '^\(/usr\)\{0,1\}/s\{0,1\}bin/.' |
        xargs ln -sft "$bare" || return 1
    for tool in awk make cc gcc c++ g++ as ld pkg-config mpirun ssh; do
        ! at=$(command -v $tool) || ln -sf "$at" "$bare" || return 1
    done
}

# bench_says METRIC... -- BENCH OPTION...: the bench goes on without what these want, and says what that is.
bench_says() {
    metrics=
    while test "$1" != --; do
        metrics="$metrics $1"
        shift
    done
    shift
    limited bench/duite-bench "$@" --quick --repeats 1 > "$scratch/said" 2>&1 || { cat "$scratch/said" && return 1; }
    cat "$scratch/said"
    for metric in $metrics; do
        grep -Eq "^$metric: (not installed: |not built: |hosts.sh: (ip is missing|only root))" "$scratch/said" || { echo "(not said of $metric)" && return 1; }
    done
}

skips() { # TEST: whole, with a reason
    limited sh "$srcdir/tests/$1" > "$scratch/said" 2>&1 && status=0 || status=$?
    cat "$scratch/said"
    test $status = 77 && grep -q '^1\.\.0 # SKIP .' "$scratch/said"
}

table_skips() {
    limited sh "$srcdir/bench/experiments" --quick link > "$scratch/said" 2>&1 && status=0 || status=$?
    cat "$scratch/said"
    test $status = 77 && grep -q ': hosts.sh: ' "$scratch/said"
}

ok "a PATH like that of a bare Debian" bare_path
PATH=$bare
ok "instructions, without valgrind" bench_says instructions_per_task_fib instructions_per_task_replay -- tasks --only instructions
ok "runs on hosts, without ip" bench_says messages_per_iteration_r8 wait_messages_r8 prediction_error_r2 prediction_error_r2_from_r1 -- \
    scale --only messages --only wait --only runs --states "$scratch/states"
ok "iterations on hosts, without ip" bench_says cg_hosts2_us cg_hosts2_twin_us cg_hosts2_vs_twin -- ranks --only cg
ok "a film, without ffmpeg" bench_says film_seconds -- output --only film --states "$scratch/states"
ok "a sphere in Blender, without it" bench_says sphere_blender_seconds_per_frame -- contact --only frames --states "$scratch/states"
ok "a table of runs on hosts, without ip" table_skips
for test in tools/test_vite runtime/test_memcheck cluster/test_hosts cluster/test_same cluster/test_slurm cloth/view/test_window whole/test_blender_long \
    whole/test_paraview_long; do
    ok "$test.sh" skips $test.sh
done
