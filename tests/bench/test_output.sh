#!/bin/sh
# duite-bench output runs every case in tiny sizes and checks the answers; what it reads is made once; a wrong answer is told.
. "${srcdir:-.}/tests/support/tap.sh"
. "${srcdir:-.}/tests/bench/bench.sh"
plan_later

output() { limited "$bench" output --states "$scratch/states" "$@"; }

all_listed() {
    output --quick --repeats 1 > "$scratch/lines" 2> "$scratch/said" || { cat "$scratch/said" && return 1; }
    cat "$scratch/lines"
    cp "$scratch/said" "$scratch/first"
    every_metric "$scratch/lines" "not built: |not installed: " output
}

targets_listed() {
    targets output > "$scratch/targets"
    diff - "$scratch/targets" << 'END'
frames_slowdown <= 1.03
live_slowdown <= 1.03
live_stopped_slowdown <= 1.01
checkpoint_slowdown <= 1.02
usd_slowdown <= 1.05
checkpoint_vs_write <= 1.5
offscreen_frame_ms <= 150
offscreen_vs_plain <= 2.5
film_seconds <= 10
END
}

made_once() {
    output --quick --repeats 1 --only write > "$scratch/said" 2>&1 || { cat "$scratch/said" && return 1; }
    grep -q "making frames" "$scratch/first" && ! grep -q "making frames" "$scratch/said"
}

nothing_left() { ! ls -d "$scratch"/states/quick/output.*; }

damaged_told() {
    for file in "$scratch"/states/quick/sheet-frames/checkpoints/*; do
        echo damaged > "$file"
    done
    status=0
    output --quick --repeats 1 --only write > "$scratch/said" 2>&1 || status=$?
    cat "$scratch/said"
    test $status = 1 && grep -q "no checkpoint of the sheet: " "$scratch/said"
}

ok "runs every case, and every metric listed has its line" all_listed
ok "the metrics that have a target, and which" targets_listed
ok "what it reads is made once" made_once
ok "runs leave no folders behind" nothing_left
ok "a damaged checkpoint is an error" damaged_told
