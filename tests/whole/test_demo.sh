#!/bin/sh
# make demo does what README says: on two ranks the sheet falls and the mannequin is dressed, and pictures, a film, frames and
# reports lie in demo/.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"

pictures() {
    for frame in 000 004 008; do
        test "$(wc -c < "demo/sheet-$frame.png")" -gt 100000 || return 1
    done
    test "$(wc -c < demo/dressing.png)" -gt 20000
}
film() { # of all frames
    ffprobe -v error -count_frames -select_streams v:0 -show_entries stream=nb_read_frames -of csv=p=0 demo/dressing.mp4 > "$scratch/films" &&
        cat "$scratch/films" && test "$(tr -d ',' < "$scratch/films")" = $(($(tail -n 1 demo/dressing/frames.csv | cut -d , -f 1) + 1))
}

plan_later
unset MAKEFLAGS MFLAGS MAKELEVEL # a make of its own
rm -rf demo
ok "make demo" limited "${MAKE:-make}" demo
ok "the sheet ran to its end" test "$(value steps demo/report.json)" = 320
ok "on two ranks" test "$(value ranks demo/report.json)" = 2
ok "with few iterations" awk -F': ' '/"cg_iterations_mean"/ { n = $2 + 0 } END { exit !(n >= 5 && n <= 120) }' demo/report.json
ok "nine frames" test "$(tail -n 1 demo/frames/frames.csv | cut -d , -f 1)" = 8
ok "the shirt is sewn" grep -q '"seams_open": 0,' demo/dressing.json
ok "and at rest" grep -q '"rest_seconds": [0-9]' demo/dressing.json
if test -x "$DUITE_VIEW"; then ok "four pictures" pictures; else skip "four pictures" "no viewer"; fi
if test -x "$DUITE_VIEW" && command -v ffmpeg ffprobe > /dev/null; then ok "a film of the dressing" film; else skip "a film" "no viewer or no ffmpeg"; fi
