#!/bin/sh
# make demo does what README says: the sheet falls on two ranks, and pictures, frames and a report lie in demo/.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"

report() { # KEY VALUE
    grep -qF "\"$1\": $2," demo/report.json || { cat demo/report.json; return 1; }
}

pictures() {
    for frame in 000 004 008; do
        test "$(wc -c < "demo/sheet-$frame.png")" -gt 100000 || return 1
    done
}

plan_later
unset MAKEFLAGS MFLAGS MAKELEVEL # a make of its own
rm -rf demo
ok "make demo" limited "${MAKE:-make}" demo
ok "it ran to its end" report steps 320
ok "on two ranks" report ranks 2
ok "with few iterations" awk -F': ' '/"cg_iterations_mean"/ { n = $2 + 0 } END { exit !(n >= 5 && n <= 120) }' demo/report.json
ok "nine frames" test "$(tail -n 1 demo/frames/frames.csv | cut -d , -f 1)" = 8
if test -x "$DUITE_VIEW"; then ok "three pictures" pictures; else skip "three pictures" "no viewer"; fi
