#!/bin/sh
# DUITE_REPORT: rank 0 leaves flat JSON at the stop; a file that cannot be written is told before work starts.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later
dot=$PWD/tests/examples/dot report=$scratch/report.json
DUITE_REPORT=$report
export DUITE_REPORT

has() { test "$(value "$1" "$report")" = "$2" || { cat "$report" && echo "$1 is not $2" && return 1; }; }
above() { value "$1" "$report" | awk '{ exit !($1 > 0) }'; }
one() {
    DUITE_THREADS=2 DUITE_SEED=7 limited "$dot" fifo && cat "$report" && has code 0 && has ranks 1 && has threads 2 && has workers 2 && has seed 7 &&
        has scheduler fifo && has mapping metis && has balance none && has tasks 39 && has messages 0 && above wall_seconds &&
        above busy_seconds && above busy_fraction
}
json() { python3 -c 'import json, sys; report = json.load(open(sys.argv[1])); assert len(report) > 20 and report["tasks"] == 39' "$report"; }
two() { # the sums of both ranks, in one file
    DUITE_THREADS=1 ranks 2 "$dot" && has ranks 2 && has threads 1 && has workers 2 && has tasks 39 && above messages && test ! -e "$report.1"
}
by_rank_0() { # mpirun may hand a variable to its own host alone
    rm -f "$report"
    limited "${MPIRUN:-mpirun}" -n 1 "$dot" : -n 1 env -u DUITE_REPORT "$dot" && has tasks 39
}
fails() { # SENTENCE FILE COMMAND...
    sentence=$1 status=0 DUITE_REPORT=$2
    shift 2
    "$@" > "$scratch/said" 2>&1 || status=$?
    DUITE_REPORT=$report
    cat "$scratch/said"
    test $status != 0 && grep -qx "$sentence" "$scratch/said"
}

ok "one rank" one
if command -v python3 > /dev/null; then ok "it is JSON" json; else skip "it is JSON" "python3 is missing"; fi
ok "two ranks" two
ok "rank 0 decides" by_rank_0
ok "a folder that is not there" fails "dot: the report $scratch/no/report cannot be written: No such file or directory" "$scratch/no/report" \
    limited "$dot"
ok "... on two ranks, of which one tries" fails \
    "dot: duite_start failed on rank 0: the report $scratch/no/report cannot be written: No such file or directory" "$scratch/no/report" ranks 2 "$dot"
ok "an empty name" fails "dot: duite_start: report (or DUITE_REPORT in the environment) is an empty name" "" limited "$dot"
ok "a disk that is full at the stop" fails "dot: the report /dev/full cannot be written: No space left on device" /dev/full limited "$dot"
