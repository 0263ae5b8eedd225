#!/bin/sh
# A run's words on the terminal: one line of progress, never wider than the terminal, and a last line that says what limited
# the run, in the words of duite-trace.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
sums=$srcdir/tools/trace/sums.c
trace=$PWD/duite-trace
page=$srcdir/docs/tracing.md
sheet=$srcdir/cloth/scenes/sheet.yaml
small="--set cloths[0].mesh.grid.nx=20 --set cloths[0].mesh.grid.ny=20 --end 0.05"

run() { # OPTION...
    # shellcheck disable=SC2086 # a list of options
    limited "$DUITE_CLOTH" "$sheet" $small --threads 1 --report report.json "$@" > said
}

names() { # FILE: the limits that it knows
    grep -o '{"\(work\|critical path\|messages\|too few ready tasks\|runtime and main program\)"' "$1" | sort -u
}
same_names() {
    names "$srcdir/cloth/app/report/summary_time.c" > ours && names "$sums" > theirs && cat ours && test "$(wc -l < ours)" = 5 && cmp ours theirs
}
documented() { names "$sums" | tr -d '{"' | while read -r name; do grep -qF "| $name |" "$page" || { echo "$name" && return 1; }; done; }

alone() { # one worker is busy all the time, whatever else the machine does
    run --trace run.trace && cat said && tail -n 1 said | grep -cx 'Limited by work: the workers were busy for [0-9]* % of the time, [0-9]* % of that in CG\.' &&
        test "$(value limited_by)" = work
}
trace_agrees() { "$trace" run.trace > table && grep 'limited by' table && grep -qx "  limited by    $(value limited_by)" table; }

# A job of Slurm that is not bound has one core of all that it may use (nothing lowers that of a machine or a container of one).
job() {
    # shellcheck disable=SC2086 # a list of options
    SLURM_CPUS_PER_TASK=1 OMP_NUM_THREADS=1 limited "$DUITE_CLOTH" "$sheet" $small --end 0.002 --report report.json > said && cat said &&
        test "$(value threads)" = 1 && test "$(value cores)" = 1 && grep -q '^  ran on           1 ranks x 1 threads, ' said &&
        grep -Fqx "  cores            1 a rank ($(value cores_from))" said && case $(value cores_from) in
        SLURM_CPUS_PER_TASK=1 | 'affinity, 1 core' | 'cgroup quota '[01]*) true ;; *) false ;; esac
}
whole_machine() { # more workers than the environment says, since an option says so
    # shellcheck disable=SC2086
    OMP_NUM_THREADS=1 limited "$DUITE_CLOTH" "$sheet" $small --end 0.002 --threads 2 --report report.json > said && cat said &&
        test "$(value threads)" = 2 && ! grep OMP_NUM_THREADS said
}

# A terminal of 60 columns: what stands between two returns of the carriage is at most 59 wide.
narrow() {
    # shellcheck disable=SC2086
    script -qec "stty cols 60 && '$DUITE_CLOTH' '$sheet' $small --threads 1 --output frames --set phases='[{name: a long name of the only phase, set: {}}]'" typed > all &&
        tr '\r' '\n' < all | grep -a 'step [0-9]* of 50' | sed 's/^.\[K//' > lines && cat lines && test -s lines &&
        ! grep -a '.\{60\}' lines && grep -aq '^a long name of the only phase: step 50 of 50, 0 s left, 2 f$' lines
}
wide() {
    # shellcheck disable=SC2086
    script -qec "stty cols 120 && '$DUITE_CLOTH' '$sheet' $small --threads 1 --output frames" typed > all &&
        tr '\r' '\n' < all | grep -a 'step 50 of 50, 0 s left, 2 frames, [0-9]* iterations$'
}

plan_later
cd "$scratch" || exit 99
ok "duite-cloth and duite-trace know the same limits" same_names
ok "docs/tracing.md has the rule of each" documented
ok "on one thread a run is limited by work" alone
if test -x "$trace"; then ok "its trace says the same" trace_agrees; else skip "its trace says the same" "no duite-trace"; fi
ok "a job's cores, and what said how many they are" job
ok "an option counts before the environment" whole_machine
if command -v script > /dev/null; then
    ok "progress is cut where the terminal ends" narrow
    ok "progress has steps, time left, frames and iterations" wide
else
    skip "progress on a terminal" "no script(1)"
fi
