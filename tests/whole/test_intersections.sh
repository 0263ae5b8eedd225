#!/bin/sh
# duite-cloth --check-intersections: what it finds, what it says, reports and returns.
. "${srcdir:-.}/tests/support/cloth.sh"
. "$srcdir/tests/support/bodies.sh"

# scene NAME CLOTHS MORE: of triangles that nothing moves, unless MORE says gravity.
scene() {
    cat > "$1.yaml" << END
schema: 1
name: $1
cloths:
$2
materials: {m: {density: 0.2, stretch: 500}}
contact: {mode: project}
time: {h: 0.01, end: 0.04, fps: 50}
$3
END
}
still='gravity: [0, 0, 0]'
piece() { # NAME VERTICES: one triangle
    printf '  - {name: %s, material: m, mesh: {inline: {vertices: [%s], triangles: [[0, 1, 2]]}}}\n' "$1" "$2"
}
flat=$(piece a '[0, 1, 0], [1, 1, 0], [0, 1, 1]')
scene cross "$flat
$(piece b '[0.2, 0, 0.2], [0.3, 2, 0.2], [0.2, 2, 0.3]')" "$still"
scene near "$flat
$(piece b '[0, 1.000000001, 0], [1, 1.000000001, 0], [0, 1.000000001, 1]')" "$still"
scene apart "$flat
$(piece b '[0, 1.001, 0], [1, 1.001, 0], [0, 1.001, 1]')" "$still"
scene welded "$flat
$(piece b '[0, 1, 0], [-1, 1, 0], [0, 1, 1]')" "$still
welds: [{from: {cloth: a, vertices: [0, 2]}, to: {cloth: b, vertices: [0, 2]}}]"
scene ball "$flat" "$still
obstacles: [{sphere: {centre: [0.25, 0.8, 0.25], radius: 0.3}}, {plane: {point: [0, 0, 0], normal: [0, 1, 0]}}]"
box_obj -2 -2 -2 2 2 2 > box.obj
scene inside "$(echo "$flat" | sed 's/material: m/&, pins: [{vertices: [0, 1, 2]}]/')" "$still
obstacles: [{body: {obj: box.obj}}]"
scene held "$(echo "$flat" | sed 's/material: m/&, pins: [{vertices: [0], follow: box}]/')" "$still
obstacles: [{body: {name: box, obj: box.obj}}]"
scene left "$(echo "$flat" | sed 's/material: m/&, pins: [{vertices: [0, 1, 2]}]/')
$(piece b '[0, 1, 0], [-1, 1, 0], [0, 1, 1]')" "$still
welds: [{from: {cloth: a, vertices: [0, 2]}, to: {cloth: b, vertices: [0, 2]}}]
obstacles: [{body: {name: box, obj: box.obj}}]"
sed 's/mode: project/&, ignore: [[a, box]]/' left.yaml > some.yaml && mv some.yaml left.yaml
scene through "$flat" "$still
obstacles: [{body: {obj: box.obj, translate: [2.5, 0, 0]}}]"
sheet='  - {name: sheet, material: m, mesh: {grid: {width: 0.3, height: 0.3, nx: 16, ny: 16}}, transform: {translate: [0, HIGH, 0], rotate: [1, TURN, 0, 0]}}'
floor='obstacles: [{plane: {point: [0, 0, 0], normal: [0, 1, 0]}}]'
scene fall "$(echo "$sheet" | sed 's/HIGH/0.1/; s/TURN/0/')" "$floor"
scene fold "$(echo "$sheet" | sed 's/HIGH/0.16/; s/TURN/1/')" "$floor"

# check STATUS SCENE OPTION...: with what is said in `said`
check() {
    check_status=$1 check_scene=$2
    shift 2
    limited "$DUITE_CLOTH" "$check_scene.yaml" --check-intersections --report report.json "$@" > printed 2> said
    check_got=$?
    cat said
    test $check_got = "$check_status" || { echo "exit status $check_got" && return 1; }
}
reports() { # PAIRS WITH_SHAPES FRAME
    set -- "$1 $2 $3" "$(value intersections) $(value intersections_shapes) $(value intersections_frame)"
    test "$1" = "$2" || { echo "the report has $2, not $1" && return 1; }
}

crossing() { # by the numbers of its vertices; no frame is written
    check 4 cross && reports 1 0 0 && grep -q '  intersections    in 3 of 3 frames, from frame 0 on' printed &&
        grep -qx "duite-cloth: frame 0, at 0 s: triangle 1 2 3 of cloth 'a' and triangle 1 2 3 of cloth 'b' intersect (vertices count from 1)" said &&
        grep -q '^duite-cloth: triangles intersect in 3 of 3 frames, from frame 0 on: at most 1 pairs of cloth, and 0 with obstacles$' said
}
ok "two triangles that cross" crossing
nothing() { check 0 apart --output out && reports 0 0 null && grep -q '  intersections    none in 3 frames' printed && test ! -s said; }
ok "two triangles that are apart" nothing
as_written() { # 1e-9 m are lost in floats
    check 0 near && reports 0 0 null && check 4 near --output out && reports 1 0 0 &&
        grep -q '^duite-cloth: frame 0 as written, at 0 s: triangle' said && ! grep -q 'frame 0, at' said
}
ok "two triangles that only floats have in one place" as_written
neighbours() { check 0 welded --output out && reports 0 0 null; }
ok "triangles that are welded" neighbours
entering() { check 4 ball && reports 0 1 0 && grep -q "triangle 1 2 3 of cloth 'a' enters obstacles\[0\], a sphere" said; }
ok "a sphere between the vertices" entering
within() { check 4 inside && reports 0 1 0 && grep -q "vertex 1 of cloth 'a' is inside obstacles\[0\]" said; }
ok "a cloth in a body" within
refused() { # SCENE VERTEX CLOTH: certified contact does not start there
    check 2 "$1" --set contact.mode=certified --set contact.self=on && grep -q "vertex $2 of cloth '$3' is inside obstacles\[0\]" said
}
# Vertices that follow the body may be in it, and so may the triangles that have them; the others of the cloth may not.
ok "a cloth in a body that one of its vertices follows" refused held 2 a
ok "a cloth in a body, welded to one that does not meet it" refused left 2 b
cutting() { # one side of the body, which has two triangles
    check 4 through && test "$(value intersections)" = 0 && test "$(value intersections_shapes)" -ge 1 &&
        grep -q "triangle 1 2 3 of cloth 'a' and triangle [1-8] [1-8] [1-8] of obstacles\[0\] intersect" said
}
ok "a cloth through a body" cutting
falling() { check 0 fall --set time.end=0.4 --output out && reports 0 0 null; }
ok "a sheet that falls flat" falling
folding() { # from the frame that is said, by as many as ranks and threads say, of frames as they are written: in float
    check 4 fold --set time.end=0.4 --grain 100 --output out --threads 1 && test "$(value intersections)" -gt 100 && test "$(value intersections_frame)" -gt 2 &&
        test "$(grep -c 'intersect (vertices' said)" = 5 && grep -q 'and [0-9]* more$' said || return 1
    set -- "$(value intersections) $(value intersections_frame)"
    ranks 2 "$DUITE_CLOTH" fold.yaml --check-intersections --report report.json --set time.end=0.4 --grain 100 --output out --threads 2 --quiet > printed 2> said
    folding_got=$?
    cat said
    test $folding_got = 4 && test "$(value intersections) $(value intersections_frame)" = "$1" &&
        grep -q '^duite-cloth: triangles intersect in ' said && test ! -s printed
}
ok "a sheet that folds onto itself, on one rank and on two" folding
certified() { # what folds does not go through itself then
    check 0 fold --set time.end=0.4 --set contact.mode=certified --set contact.self=on --output out && reports 0 0 null
}
ok "the same, where contact is certified" certified
again() { # STATUS: the folder of the run before, by the viewer
    limited "$DUITE_VIEW" out --check-intersections > printed 2> said
    again_got=$?
    cat printed said
    test $again_got = "$1"
}
folder() {
    check 4 fold --set time.end=0.4 --output out && again 4 && grep -q "at most $(value intersections) pairs of cloth, and 0 with obstacles" said &&
        grep -q '^duite-view: frame [0-9]* as written, at 0.[0-9]* s: triangle [0-9 ]* and triangle [0-9 ]* intersect (vertices count from 1)$' said &&
        check 0 welded --output out && again 0 && grep -qx 'no intersections in 3 frames' printed && test ! -s said &&
        check 4 ball --output out && again 4 && check 4 inside --output out && again 4 && grep -q '^duite-view: frame 0 as written, at 0 s: vertex 1 is inside obstacles\[0\]' said
}
if test -x "$DUITE_VIEW"; then
    ok "frames of earlier runs" folder
else
    skip "frames of earlier runs" "duite-view was not built"
fi
unasked() { limited "$DUITE_CLOTH" cross.yaml --report report.json --quiet > said 2>&1 && reports null null null && test ! -s said; }
ok "nothing is looked for unasked" unasked
