#!/bin/sh
# Phases: what passes from one to the next, to the last bit, against closed forms and against one run; frames, rows and reports that go
# on; obstacles in scene.json; what ends a phase; and bad input.
# shellcheck disable=SC2086 # lists of settings
. "${srcdir:-.}/tests/support/cloth.sh"

cat > sheet.yaml << 'END'
schema: 1
name: sheet
cloths:
  - name: sheet
    mesh: {grid: {width: 1, height: 1, nx: 12, ny: 12}}
    material: cloth
    pins: [{vertices: [0, 11]}]
materials:
  cloth: {density: 0.2, stretch: 100, shear: 10, bend: 0.001, damping: {mass: 1}}
obstacles:
  - plane: {point: [0, -3, 0], normal: [0, 1, 0]}
probes:
  - {name: corner, cloth: sheet, vertices: [143], values: [position, velocity]}
time: {h: 0.001, end: 0.1, fps: 100}
integrator: symplectic_euler
grain: 30
END
two='phases=[{name: one, set: {time.end: 0.04}}, {name: two, set: {time.end: 0.06}}]'

run() { "$DUITE_CLOTH" sheet.yaml --quiet --report report.json "$@"; }
hash() { value state_hash; }

# ---- What passes on ----
# Steps hand over only positions and velocities.
as_one() { # SETTING...
    run "$@" && one=$(hash) && run "$@" --set "$two" && echo "$one and $(hash)" && test "$one" = "$(hash)" && test "$(value steps)" = 100
}
for integrator in explicit_euler symplectic_euler rk4; do
    ok "two phases that change nothing are one run, $integrator" as_one --set integrator=$integrator
done
# A coarse space is made of where vertices start: without it, and without a guess, solves know nothing of the steps before.
implicit='--set integrator=implicit_euler --set solver.guess=zero --set solver.preconditioner=ic0'
three='phases=[{name: a, set: {time.end: 0.03}}, {name: b, set: {time.end: 0.03}}, {name: c, set: {time.end: 0.04}}]'
ok "three phases of implicit Euler are one run, too" eval 'run $implicit && one=$(hash) && run $implicit --set "$three" && test "$one" = "$(hash)"'

one_key() { # of a phase's set, from the command line: as if the phase had it
    run --set "$two" --set 'phases[1].set.time.end=0.01' --set 'phases[1].set.materials.cloth.damping.mass=3' && one=$(hash) && test "$(value steps)" = 50 &&
        run --set 'phases=[{name: one, set: {time.end: 0.04}}, {name: two, set: {time.end: 0.01, materials.cloth.damping.mass: 3}}]' && test "$one" = "$(hash)"
}
ok "one key of a phase's set is changed" one_key

# Free flight of a cloth that nothing strains, by symplectic Euler: after n steps of weight g x = x0 + n h v0 + g h^2 n (n + 1) / 2.
flies() {
    run --set 'cloths[0].pins=[]' --set 'cloths[0].velocity=[1, 2, 0]' --set materials.cloth.damping.mass=0 --output frames \
        --set 'phases=[{name: up, set: {time.end: 0.04}}, {name: away, set: {gravity: [3, 0, 0], time.end: 0.06}}]' &&
        awk -F, 'NR == 2 { x = $(NF - 5); y = $(NF - 4) } END { h = 1e-3; g = -9.81
            v = 2 + 40 * h * g; up = y + 40 * h * 2 + g * h * h * 40 * 41 / 2 + 60 * h * v; along = x + 0.1 + 3 * h * h * 60 * 61 / 2
            print $(NF - 5), along, $(NF - 4), up, $(NF - 2), 1 + 0.18, $(NF - 1), v
            d = ($(NF - 5) - along) ^ 2 + ($(NF - 4) - up) ^ 2 + ($(NF - 2) - 1.18) ^ 2 + ($(NF - 1) - v) ^ 2; exit !(NR == 102 && d < 1e-22) }' frames/probes.csv
}
stays() { # what a phase sets, until another one does; null is the default
    run --set 'phases=[{name: a, set: {time.end: 0.02, gravity: [1, 0, 0]}}, {name: b}, {name: c, set: {gravity: null}}]' && one=$(hash) &&
        run --set 'phases=[{name: a, set: {time.end: 0.02, gravity: [1, 0, 0]}}, {name: b, set: {time.end: 0.02, gravity: [1, 0, 0]}}, {name: c, set: {time.end: 0.02, gravity: [0, -9.81, 0]}}]' &&
        test "$one" = "$(hash)"
}
ok "what a phase sets stays set" stays
ok "free flight through two phases is the closed form" flies

# ---- Ranks and threads: a runtime and a flow for each phase ----
if quick; then others=; else others="1,1 1,2 2,1 3,2"; fi
same_everywhere() { # SETTING...
    run --set "$two" "$@" && one=$(hash) || return 1
    for run in 2,2 3,1 $others; do # RANKS,THREADS
        ranks ${run%,*} "$DUITE_CLOTH" sheet.yaml --quiet --report report.json --threads ${run#*,} --set "$two" "$@" || return 1
        echo "$run ranks and threads: $(hash), 1 rank: $one"
        test "$(hash)" = "$one" || return 1
    done
}
ok "the same bits on ranks 1 to 3 and threads 1 and 2" same_everywhere
in_full "also by BDF2, with frames and an obstacle that is met" same_everywhere --set integrator=bdf2 --output frames \
    --set 'obstacles[0].plane.point=[0, -0.005, 0]' --set 'contact.mode=certified' --set time.fps=1000

# ---- Frames, rows, times ----
frames() { awk -F, 'NR > 1 { line = line (NR > 2 ? " " : "") $1 " " sprintf("%.6g", $2) } END { print line }' frames/frames.csv; }
shown() { # WANTED SETTING...
    want=$1
    shift
    run --output frames "$@" && frames && test "$(frames)" = "$want" && test "$(od -An -tu4 -j28 -N4 frames/cloth.pc2 | tr -d ' ')" = "$(($(wc -l < frames/frames.csv) - 1))"
}
ok "frames go on, the end of a phase is the start of the next" shown "0 0 1 0.02 2 0.04 3 0.06 4 0.08 5 0.1" --set "$two" --set time.fps=50
on_the_clock="0 0 1 0.03 2 0.06 3 0.09"
ok "frames stay on their clock where a phase ends between two" shown "$on_the_clock" --set "$two" --set time.fps=33.333333333
ok "also where one shows none" shown "$on_the_clock" --set time.fps=33.333333333 \
    --set 'phases=[{name: a, set: {time.end: 0.04}}, {name: b, set: {time.end: 0.01}}, {name: c, set: {time.end: 0.05, time.h: 0.0025}}]'
counts_rows() { run --output frames --set "$two" && awk -F, 'NR > 1 { if ($1 != NR - 2 || ($2 - $1 * 1e-3) ^ 2 > 1e-24) bad = 1 } END { exit bad || NR != 102 }' frames/probes.csv; }
ok "rows of probes go on, each step once" counts_rows
same_rows() { run --output one && run --output frames --set "$two" && cut -d, -f3- one/probes.csv > a && cut -d, -f3- frames/probes.csv > b && cmp a b; }
ok "and have the numbers of one run" same_rows
reports() { run --set "$two" && cat report.json && grep -q '{"name": "one", "steps": 40, "cg_iterations_mean": null, "simulated_seconds": 0.04.*"ended": "end"}' report.json &&
    grep -q '{"name": "two", "steps": 60, .*"ended": "end"}' report.json && test "$(value steps)" = 100 && test "$(grep -c '"name": ' report.json)" = 2; }
ok "the report lists the phases" reports
reports_iterations() { # those of both phases are those of the run
    run --set "$two" --set integrator=implicit_euler && grep -A 3 phases report.json &&
        sed -n 's/.*"steps": \([0-9]*\), "cg_iterations_mean": \([^,]*\),.*/\1 \2/p' report.json |
        awk -v mean="$(value cg_iterations_mean | tail -n 1)" '{ steps += $1; sum += $1 * $2 } END { exit !(NR == 2 && sum > 0 && (sum / steps - mean) ^ 2 < 1e-18 * mean ^ 2) }'
}
ok "and the iterations of each" reports_iterations
ok "one without phases has no such key" eval 'run && ! grep phases report.json'

# ---- Obstacles in scene.json ----
keys() {
    sed -n 's/.*"time": \([^,]*\), "translate": \[[^,]*, \([^,]*\),.*/\1 \2/p' frames/scene.json |
        awk '{ line = line (NR > 1 ? ", " : "") sprintf("%.9g %g", $1, $2) } END { print line }'
}
moves() { # KEYS SETTING...: time and height of each key frame
    want=$1
    shift
    run --output frames "$@" && cat frames/scene.json && keys && test "$(keys)" = "$want"
}
up='{times: [0, 0.02], translate: [[0, 0, 0], [0, 0.1, 0]]}'
ok "scene.json has the motion of a later phase at its time" moves "0 0, 0.04 0, 0.06 0.1" \
    --set "phases=[{name: one, set: {time.end: 0.04}}, {name: two, set: {time.end: 0.06, 'obstacles[0].plane.motion': $up}}]"
ok "that of an earlier one where it ended, then back at its place" moves "0 0, 0.02 0.05, 0.02 0" \
    --set "phases=[{name: one, set: {time.end: 0.02, 'obstacles[0].plane.motion': {times: [0, 0.04], translate: [[0, 0, 0], [0, 0.1, 0]]}}}, {name: two, set: {'obstacles[0].plane.motion': null}}]"
ok "and one of both phases twice" moves "0 0, 0.02 0.1, 0.04 0.1, 0.04 0, 0.06 0.1" --set "obstacles[0].plane.motion=$up" --set "$two"

# ---- How phases end ----
rests() { run --output frames --set 'materials.cloth.damping.mass=2000' --set time.fps=1000 --set "phases=[{name: one, set: {time.end: 1000, time.rest: {speed: 0.1, hold: 0.01}}}, {name: two, set: {time.end: 0.06, time.rest: null}}]" &&
    cat report.json && grep -q '"name": "one".*"ended": "rest"' report.json && grep -q '"name": "two", "steps": 60,.*"ended": "end"' report.json; }
ok "a phase may come to rest before its end" rests

fails() { # the second phase; frames 0 to 4 stay
    status=0
    "$DUITE_CLOTH" sheet.yaml --output frames --quiet 2> said --set "phases=[{name: one, set: {time.end: 0.04}}, {name: two, set: {time.end: 0.06, gravity: [0, 1e300, 0]}}]" || status=$?
    cat said
    echo "status $status, $(frames)"
    test $status = 1 && grep -q "^duite-cloth: phase 'two': .*diverged.*; the last frame is 4$" said && test "$(frames)" = "0 0 1 0.01 2 0.02 3 0.03 4 0.04"
}
ok "a phase that fails is named and keeps the frames so far" fails

stops() {
    rm -rf frames
    "$DUITE_CLOTH" sheet.yaml --output frames --quiet --report report.json --set "phases=[{name: one, set: {time.end: 0.04}}, {name: long, set: {time.end: 5000, time.fps: 100}}, {name: never, set: {time.end: 1}}]" 2> said &
    job=$!
    awaits $job eval 'test "$(wc -l < frames/probes.csv 2> /dev/null || echo 0)" -gt 60' && kill -USR1 $job
    status=0
    wait $job || status=$?
    cat said report.json
    test $status = 5 && grep -q "stopped as asked by a signal after step .*, in phase 'long'" said && grep -q '"name": "long",.*"ended": "stopped"' report.json && ! grep -q never report.json
}
ok "SIGUSR1 ends the whole run" stops

# ---- What looks at all phases, or at the last ----
# A sheet that is held everywhere, 0.4 m above a ball, which rises by 0.5 m in the first 0.05 s of the second phase: it is through from 0.08 s on.
sed -e 's/pins: .*/pins: [{box: [[-9, -9, -9], [9, 9, 9]]}]/' -e 's/- plane: .*/- sphere: {centre: [0, -0.5, 0], radius: 0.1}/' sheet.yaml > ball.yaml
looked() { # FIRST BAD PHASES...: the ball meets the sheet in so many of 11 frames
    first=$1 many=$2 status=0
    shift 2
    "$DUITE_CLOTH" ball.yaml --quiet --report report.json --output frames --check-intersections --set contact.mode=project "$@" 2> said || status=$?
    cat said
    test $status = 4 && test "$(value intersections_frame)" = "$first" && grep -q "intersect in $many of 11 frames, from frame $first on" said &&
        { status=0 && "$DUITE_VIEW" frames --check-intersections > said.view 2>&1 || status=$?; } && cat said.view && test $status = 4 &&
        grep "intersect in $many of 11 frames, from frame $first on" said.view
}
through() {
    looked 9 2 --set "phases=[{name: one, set: {time.end: 0.04}}, {name: two, set: {time.end: 0.06, 'obstacles[0].sphere.motion': {times: [0, 0.05], translate: [[0, 0, 0], [0, 0.5, 0]]}}}]" &&
        grep -q 'frame 9, at 0.09 s' said
}
ok "intersections are looked for in all phases, the first frame counts" through
ok "those of a phase that is over are not forgotten" looked 0 5 \
    --set "phases=[{name: one, set: {time.end: 0.04, 'obstacles[0].sphere.motion': {times: [0], translate: [[0, 0.5, 0]]}}}, {name: two, set: {time.end: 0.06, 'obstacles[0].sphere.motion': null}}]"
systems() {
    run $implicit --save-system one && run $implicit --set "$two" --save-system frames/system && for file in matrix rhs solution position; do cmp one/$file.mtx frames/system/$file.mtx || return 1; done
}
ok "--save-system is of the last step of the last phase" systems
tools=$(dirname "$DUITE_CLOTH")
tasks() { "$tools/duite-trace" --csv=tables trace && awk -F, '$21 == "task" { n[$22]++ } END { for (name in n) print name, n[name] }' tables/paje.worker_state.csv | sort; }
traces() { # the tasks of a run of the second phase's length, on each of two ranks
    ranks 2 "$DUITE_CLOTH" sheet.yaml --quiet --trace trace --end 0.06 && tasks > one.tasks && cat one.tasks && test "$(wc -l < one.tasks)" -gt 3 &&
        ranks 2 "$DUITE_CLOTH" sheet.yaml --quiet --report report.json --set "$two" --trace trace && tasks > two.tasks && cmp one.tasks two.tasks &&
        "$tools/duite-trace" --check trace && grep lower_bound report.json && ! grep 'lower_bound_seconds": null' report.json
}
ok "the trace is of the last phase, of all ranks" traces
drapes() { run --set "phases=[{name: one, set: {time.end: 0.04}}, {name: two, set: {time.end: 0.06, drape: {radius: 0.1}}}]" && value drape_coefficient_percent && grep drape_coeff report.json && ! grep 'drape_coefficient_percent": null' report.json; }
ok "a drape test of the last phase" drapes
room() {
    run --output frames --set "$two" --set time.fps=11000 2> said && cat said && grep -q 'gives 1101 frames of 144 vertices up to 0.1 s, but there are 100 steps' said
}
ok "frames of all phases are what the disk has room for" room
warns() {
    run --output frames --set contact.thickness=0.002 --set "phases=[{name: one}, {name: two, set: {integrator: explicit_euler, solver.patches: 2}}]" 2> said
    cat said
    test "$(grep -c 'contact.thickness means nothing' said)" = 1 && grep -q "^duite-cloth: warning: phase 'two': .*solver means nothing: it needs integrator" said
}
ok "a warning names a later phase, one of both is said once" warns

# A start that is not free is found when the phase begins: two pieces that cross, which the first phase lets be.
cat > cross.yaml << 'END'
schema: 1
cloths:
  - {name: a, material: m, mesh: {inline: {vertices: [[0, 1, 0], [1, 1, 0], [0, 1, 1]], triangles: [[0, 1, 2]]}}}
  - {name: b, material: m, mesh: {inline: {vertices: [[0.2, 0, 0.2], [0.3, 2, 0.2], [0.2, 2, 0.3]], triangles: [[0, 1, 2]]}}}
materials: {m: {density: 0.2, stretch: 500}}
contact: {mode: project}
gravity: [0, 0, 0]
time: {h: 0.01, end: 0.04, fps: 50}
phases: [{name: sew}, {name: wear, set: {contact.mode: certified}}]
END
crossed() {
    status=0
    "$DUITE_CLOTH" cross.yaml --quiet --output frames > said 2>&1 || status=$?
    cat said
    test $status = 2 && grep -q "^duite-cloth: phase 'wear': cross.yaml: where the run starts 1 pairs" said && test "$(frames)" = "0 0 1 0.02 2 0.04"
}
ok "a phase whose start is not free is named, and the frames so far stay" crossed

# ---- Bad input: tests/cloth/scene/sentences.txt has all that is said of it ----
before() { rm -rf none && refuses "$1" "$DUITE_CLOTH" sheet.yaml --output none --set "phases=[{name: one}, {name: two, set: {$2}}]" && ! test -e none; }
ok "a value out of range" before "time.end is -1; a finite number > 0 (s) is expected; in phase 'two'" "time.end: -1"
ok "other obstacles" before "phase 'two' has other obstacles, or motions about other points, than" "'obstacles[0].plane.point': [0, -4, 0]"
