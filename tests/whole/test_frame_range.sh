#!/bin/sh
# --frames A:B: the folder has the frames A to B of the run without it, byte for byte, numbered from 0; the run ends with B, in whatever
# phase; on ranks, after a restart, with checks and forecasts; and bad ranges.
# shellcheck disable=SC2086 # lists of settings
build=$PWD
. "${srcdir:-.}/tests/support/cloth.sh"

cat > sheet.yaml << 'END'
schema: 1
name: sheet
cloths:
  - name: sheet
    mesh: {grid: {width: 0.4, height: 0.4, nx: 12, ny: 12}}
    transform: {translate: [0, 0.01, 0]}
    material: cloth
    pins: [{vertices: [0, 11]}]
materials: {cloth: {density: 0.2, stretch: 100, shear: 10, bend: 0.001, damping: {mass: 1}}}
obstacles: [{sphere: {name: ball, centre: [0, -0.1, 0.1], radius: 0.1, motion: {times: [0, 0.2], translate: [[0, 0, 0], [0, 0.02, 0]]}}}]
contact: {mode: certified, self: on, thickness: 0.002, force: on}
probes: [{name: corner, vertices: [143]}]
time: {h: 0.01, end: 0.2, fps: 50}
grain: 40
END
POINTS=144
run() { limited "$DUITE_CLOTH" sheet.yaml --quiet --report report.json "$@"; }
floats() { # FOLDER FILE FROM N: so many frames of a cache
    head -c $((32 + ($3 + $4) * POINTS * 12)) "$1/$2" | tail -c $(($4 * POINTS * 12))
}
count() { od -An -tu4 -j28 -N4 "$1/cloth.pc2" | tr -d ' '; }
is_part() { # PART WHOLE A B: frames, times, forces
    n=$(($4 - $3 + 1))
    echo "$(count "$1") of $n frames" && test "$(count "$1")" = $n || return 1
    for file in cloth.pc2 contact.pc2; do
        floats "$1" $file 0 $n > part && floats "$2" $file "$3" $n > whole && test -s part && cmp part whole || return 1
    done
    sed 1d "$1/frames.csv" > part && awk -F, -v a="$3" -v b="$4" 'NR > 1 && $1 >= a && $1 <= b { print $1 - a "," $2 }' "$2/frames.csv" | diff - part
}
ends_at() { echo "$(value simulated_seconds) s" && awk -v is="$(value simulated_seconds)" -v wanted="$1" 'BEGIN { d = is - wanted; exit !(d * d < 1e-20) }'; }

run --output all || exit 99
some() { # A B: the state is that of a run up to B
    run --output some --frames "$1:$2" --check-intersections && is_part some all "$1" "$2" && ends_at "$(awk -v b="$2" 'BEGIN { print b / 50 }')" && hash=$(value state_hash) &&
        test "$(value intersections)" = 0 && test "$(wc -l < some/probes.csv)" = $((2 + 2 * $2)) || return 1
    test "$2" = 0 || { run --set "time.end=$(awk -v b="$2" 'BEGIN { print b / 50 }')" && test "$(value state_hash)" = "$hash"; }
}
ok "frames 3 to 7" some 3 7
ok "the first one alone" some 0 0
open_ends() { run --output some --frames 8: && is_part some all 8 10 && run --output some --frames :2 && is_part some all 0 2; }
ok "one end left out" open_ends
ok "of three ranks" eval 'ranks 3 "$DUITE_CLOTH" sheet.yaml --quiet --output some --frames 3:7 && is_part some all 3 7'
ok "the folder is one that is shown and checked" eval 'test ! -x "$DUITE_VIEW" || "$DUITE_VIEW" --check-intersections some'
fast='--set time.fps=250' # more frames than steps
ok "more frames than steps" eval 'run --output fast $fast && run --output some $fast --frames 6:9 && is_part some fast 6 9'

again() { # CHECKPOINT_RANGE RANGE A B: goes on to a later B, in the same folder
    run --output some --frames "$1" --checkpoint 100 && ranks 2 "$DUITE_CLOTH" sheet.yaml --quiet --restart some --frames "$2" && is_part some all "$3" "$4" && cmp some/probes.csv all/probes.csv
}
ok "goes on after a restart" again 3:5 3: 3 10
ok "goes on from before its first frame" eval 'run --output some --frames 3:3 --checkpoint 100 --end 0.2 && run --restart some --frames 3:6 && is_part some all 3 6'
ok "another first frame is refused" refuses 'first of --frames is 3 there, here it is 4' run --restart some --frames 4:8

scientific() { # every second one, counted in the folder
    run --output some --frames 3:7 --set 'output.hdf5={every: 2, fields: [velocity]}' && ls some/hdf5 && test "$(find some/hdf5 -name '*.vtkhdf' | wc -l)" = 3
}
if grep -q '^#define HAVE_HDF5 1' "$build/config.h"; then ok "frames in HDF5" scientific; else skip "frames in HDF5" "built without HDF5"; fi

# ---- Phases ----
two="phases=[{name: one, set: {time.end: 0.08}}, {name: two, set: {time.end: 0.12, gravity: [1, -9, 0]}}]"
run --output both --set "$two" || exit 99
phases() { # A B PHASES: how many of them begin
    run --output some --set "$two" --frames "$1:$2" && is_part some both "$1" "$2" && ends_at "$(awk -v b="$2" 'BEGIN { print b / 50 }')" &&
        began=$(grep -c '"ended"' report.json) && echo "$began phases" && test "$began" = "$3"
}
ok "ends in the second phase" phases 3 7 2
ok "and with the first, whose end is its frame" phases 2 4 1
ok "begins in the second" phases 6 8 2
still='--set obstacles[0].sphere.motion=null' # what moves is not at rest
rest='phases=[{name: one, set: {time.rest: {speed: 1e9, hold: 0.01}}}, {name: two, set: {time.rest: null}}]'
ok "a phase that ends early leaves time to the next" eval 'run $still --output both --set "$rest" && run $still --output some --set "$rest" --frames 1:8 && grep -q "\"rest\"" report.json && is_part some both 1 8'
none() { run $still --output some --set 'time.rest={speed: 1e9, hold: 0.01}' --frames 8: 2> said; test $? = 0 && cat said && grep -q 'before frame 8, where --frames begins: no frame was made' said && test "$(count some)" = 0; }
ok "a run that ends before the first frame says so" none

# ---- Forecasts, and bad ranges ----
forecast() {
    run --check --frames 3:7 > said && cat said && test "$(value check_frames)" = 5 && test "$(value check_steps)" = 14 && part=$(value check_disk_bytes) &&
        run --check > said && awk -v part="$part" -v all="$(value check_disk_bytes)" -v n=$((6 * POINTS * 24)) 'BEGIN { exit !(all - part >= n && all - part < n + 1e4) }'
}
ok "--check counts them" forecast
for range in 7:3 a:b 5 : :5x -1:2 3:9999999999999999999; do
    if test "$range" = :; then ok "no ends are all" eval 'run --output some --frames : && is_part some all 0 10'; else ok "$range" refuses "frames $range: two numbers" run "--frames=$range"; fi
done
ok "frames beyond the end" refuses 'no frame 11, as the scene ends at 0.2 s, with frame 10' run --frames 3:11
ok "that begin there" refuses 'no frame 11' run --frames 11:
