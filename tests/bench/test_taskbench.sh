#!/bin/sh
# Task Bench on duite: its 11 patterns, forked and replayed, on 1 to 4 ranks. Its core asserts that each input is the one that
# the graph names; the adapter looks at the last outputs. Needs configure --with-taskbench=DIR.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$PWD/bench/rivals/taskbench"
plan_later
patterns="trivial no_comm stencil_1d stencil_1d_periodic dom tree fft all_to_all nearest spread random_nearest"

# All of them are graphs of one run, of unlike widths and steps.
runs() { # RANKS OPTION...
    n=$1 width=5 options=
    shift
    for pattern in $patterns; do
        width=$((width + 1))
        options="$options ${options:+-and} -type $pattern -steps $((width + 9)) -width $width -output $((16 * width)) -kernel compute_bound -iter 4"
    done
    # shellcheck disable=SC2086 # a list of options
    DUITE_THREADS=2 ranks "$n" bench/rivals/taskbench $options "$@" > "$scratch/said" 2>&1 || { cat "$scratch/said" && return 1; }
    cat "$scratch/said"
    grep -qx "Total Tasks 2411" "$scratch/said" && test "$(grep -c 'Task Graph' "$scratch/said")" = 11
}
for n in 1 2 3 4; do
    ok "11 patterns on $n ranks" runs $n
    ok "... replayed" runs $n -replay
done
memory() { limited bench/rivals/taskbench -type spread -steps 9 -width 8 -kernel memory_bound -scratch 4096 -iter 8 -sample 4; }
ok "bodies have their scratch memory" memory
