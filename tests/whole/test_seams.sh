#!/bin/sh
# Seams: a pillow of two panels that lie face to face is pulled shut, with contact certified, and then welded. The same bits on any ranks and
# threads, and from an OBJ file with its seams beside it.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later
DUITE_GARMENT=${DUITE_GARMENT:-$PWD/duite-garment}
cd "$scratch" || exit 99

rectangle='"vertices": [[0, 0], [20, 0], [20, 30], [0, 30]], "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]'
stitch() { printf '[{"panel": "front", "edge": %s}, {"panel": "back", "edge": %s}]' "$1" "$2"; }
cat > pillow.json << END
{"pattern": {"panels": {
  "front": {$rectangle, "translation": [0, 0, 3], "rotation": [0, 0, 0]},
  "back": {$rectangle, "translation": [20, 0, 0], "rotation": [0, 180, 0]}},
  "stitches": [$(stitch 0 0), $(stitch 1 3), $(stitch 2 2), $(stitch 3 1)]},
 "properties": {"curvature_coords": "relative", "units_in_meter": 100}}
END
scene() { # MESH SEAMS MORE
    cat << END
schema: 1
gravity: [0, 0, 0]
grain: 80
cloths:
  - name: pillow
    mesh: $1
    material: m
    seams: $2
    $3
materials:
  m: {model: triangles, density: 0.2, stretch: 1000, shear: 300, bending: {rigidity: 1.0e-5}, damping: {stiffness: 0.01, mass: 1}}
contact: {mode: certified, self: on, thickness: 0.002}
time: {h: 0.01, end: 0.5, fps: 25}
END
}
run() { limited "$DUITE_CLOTH" "$@" --quiet --check-intersections --report report.json; }
panels='{pattern: {file: pillow.json, edge: 0.02}}'
scene "$panels" '{}' '' > pulled.yaml
scene "$panels" '{state: welded, tolerance: 0.001}' 'from: {frames: pulled}' > welded.yaml
"$DUITE_GARMENT" pillow.json --edge 0.02 -o pillow.obj --quiet || exit 99
scene '{file: pillow.obj}' '{file: pillow.seams.json}' '' > obj.yaml

# Free partners come together by exp(-t / 0.1 s).
pulled() { run pulled.yaml --output pulled && value state_hash > pulled.hash && test "$(value intersections)" = 0 && "$DUITE_VIEW" -i pulled; }
ok "panels that lie face to face are sewn all around, certified, without an intersection" pulled
same() { run "$@" && test "$(value state_hash)" = "$(cat pulled.hash)" || { value state_hash; cat pulled.hash; return 1; }; }
quick || ok "the same bits of two threads" same pulled.yaml --threads 2
two() { ranks "$1" "$DUITE_CLOTH" pulled.yaml --quiet --report report.json --threads "$2" && test "$(value state_hash)" = "$(cat pulled.hash)"; }
ok "the same bits of two ranks" two 2 2
quick || ok "of three ranks" two 3 1
ok "of an OBJ file and its seams" same obj.yaml

# Once welded the partners are at one place in every frame, and no triangles meet.
welded() { run welded.yaml --output welded && test "$(value intersections)" = 0 && ! grep -q sewn welded/scene.json && "$DUITE_VIEW" -i welded; }
ok "welded where it was pulled to, nothing intersects" welded
far() { # nothing has pulled them yet
    scene "$panels" '{state: welded}' '' > far.yaml
    run far.yaml 2> said
    test $? = 2 && grep -q "far.yaml:8:12: seam 0 of cloth 'pillow' (edge 0 of panel 'front', edge 0 of panel 'back') is between .* which start 0.03 m from each other; at most 0.002 m" said
}
ok "partners that are too far apart are not welded" far

# Free where it starts and where it is welded, but not on the way, which is 15 mm long.
way() { # WITH SENTENCE...: what is between the front panel's lower edge and where it is welded
    scene "$panels" '{state: welded, tolerance: 0.031}' '' > free.yaml
    run free.yaml --set time.end=0.02 || return 1
    { sed '/^materials/,$d' free.yaml && echo "$1" && sed -n '/^materials/,$p' free.yaml; } > way.yaml
    run way.yaml --set time.end=0.02 2> said
    test $? = 2 && cat said && grep -q "way.yaml: the welds of seams would move cloth through $2, .* at vertices .* of 'pillow'" said
}
ok "a weld does not go through an obstacle" way 'obstacles: [{box: {centre: [0.1, -0.002, 0.0225], size: [0.02, 0.006, 0.002]}}]' 'obstacles\[0\]'
cat > plate.obj << END
v 0.09 -0.005 0.0215
v 0.11 -0.005 0.0215
v 0.11 0.001 0.0215
v 0.09 0.001 0.0215
v 0.09 -0.005 0.0235
v 0.11 -0.005 0.0235
v 0.11 0.001 0.0235
v 0.09 0.001 0.0235
f 4 3 2 1
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
END
ok "nor through a body" way 'obstacles: [{body: {obj: plate.obj}}]' 'obstacles\[0\]'
ok "nor through other cloth" way '  - {name: other, mesh: {grid: {width: 0.02, height: 0.006, nx: 5, ny: 3}}, material: m, transform: {rotate: [1, 1, 0, 0], translate: [0.1, -0.002, 0.0225]}}' 'the cloth'

# Sewn in a phase that ends when all seams are closed, then welded.
scene "$panels" '{}' '' > phases.yaml
cat >> phases.yaml << END
phases:
  - {name: sew, set: {time.sewn: {distance: 0.001}, time.end: 1}}
  - {name: wear, set: {'cloths[0].seams.state': welded, time.sewn: null, time.end: 0.1}}
END
phases() {
    run phases.yaml --output phases && test "$(value intersections)" = 0 && "$DUITE_VIEW" -i phases || return 1
    value state_hash > pulled.hash
    grep '"ended": "sewn"' report.json && grep '"name": "wear"' report.json && test "$(value seams_open)" = 0 || return 1
    grep '"panel_from": "front", "edge_from": 1, "panel_to": "back", "edge_to": 3, "pairs": 16, "reversed": 1' report.json || return 1
    # 30 mm come down to 1 mm by exp(-t / 0.1 s) after 0.34 s; steps of implicit Euler are slower
    awk -v d="$(value seam_distance)" -v t="$(value sewn_seconds)" 'BEGIN { print d, t; exit !(d > 0 && d <= 0.001 && t >= 0.34 && t <= 0.40) }'
}
ok "a run ends when all seams are closed; what is welded then does not intersect" phases
sewn_alike() { ranks "$1" "$DUITE_CLOTH" phases.yaml --quiet --report report.json --threads "$2" && test "$(value state_hash)" = "$(cat pulled.hash)"; }
ok "the same bits of three ranks" sewn_alike 3 1
if ! quick; then
    ok "of two threads" sewn_alike 1 2
    ok "of two ranks" sewn_alike 2 2
fi
# One side is shut first, and welded while the others are pulled.
scene "$panels" "{state: open, some: [{of: [f*, back], damping: 10}, {numbers: [1], state: pulled}]}" '' > order.yaml
cat >> order.yaml << END
phases:
  - {name: side, set: {time.sewn: {distance: 0.001}, time.end: 1}}
  - name: rest
    set: {'cloths[0].seams.state': pulled, 'cloths[0].seams.some[1].state': welded}
  - {name: wear, set: {'cloths[0].seams': {state: welded}, time.sewn: null, time.end: 0.1}}
END
order() {
    run order.yaml --output order && test "$(value intersections)" = 0 && "$DUITE_VIEW" -i order || return 1
    value state_hash > pulled.hash
    test "$(grep -c '"ended": "sewn"' report.json)" = 2 && test "$(grep -c '"state": "welded"' report.json)" = 4
}
ok "one seam is shut and welded before the others" order
order_alike() { ranks "$1" "$DUITE_CLOTH" order.yaml --quiet --report report.json --threads "$2" && test "$(value state_hash)" = "$(cat pulled.hash)"; }
ok "the same bits of two ranks with one seam welded and three pulled" order_alike 2 2
held() { # in its first phase
    sed '/^phases/,$d; s/^time: {/time: {sewn: {}, /; s/end: 0.5/end: 1/' order.yaml > held.yaml
    run held.yaml && test "$(value seams_open)" = 0 &&
        test "$(grep -c '"state": "open"' report.json)" = 3 && test "$(grep -c '"state": "pulled"' report.json)" = 1
}
ok "seams that are open stay so" held
unclosed() { # one panel is pinned, and of the other a vertex in the middle of a seam, but for which all come near
    scene "$panels" '{}' 'pins: [{box: [[-1, -1, -1], [1, 1, 0.001]]}]' | sed 's/^time: {/time: {sewn: {}, /; s/end: 0.5/end: 0.1/' > unclosed.yaml
    run unclosed.yaml --output unclosed 2> said
    test $? = 1 && test -s unclosed/cloth.pc2 && cat said || return 1
    grep -q "seams are not closed at time.end, 0.1 s: 4 of 4 are open by more than 0.001 m (time.sewn.distance); seams.reversed turns one that is the wrong way round; the worst: seam [0-3] of cloth 'pillow' (edge [0-3] of panel 'front', edge [0-3] of panel 'back') by 0.0[0-9]* m;" said
}
ok "seams that are not closed in time are named" unclosed
unsure() { # SEAMS EXPECTED: numbers of the seams whose direction draws a warning
    scene "{pattern: {file: $srcdir/tests/cloth/garment/patterns/hood.json, edge: 0.05}}" "$1" '' > unsure.yaml
    run unsure.yaml --end 0.01 2> said && cat said || return 1
    test "$(sed -n "s/.* of the seams of cloth 'pillow' may be sewn the wrong way round, the first are\( [0-9 ]*\): .*; .*seams.reversed turns a seam$/\1/p" said)" = "$2"
}
ok "directions that are not clear" unsure '{}' ' 2 3'
ok "those that the scene turns are" unsure '{reversed: [2]}' ' 3'
ok "and those that nothing joins" unsure '{state: open}' ''
idle() { # nothing is pulled
    scene "$panels" '{state: open}' '' | sed 's/^time: {/time: {sewn: {}, /' > idle.yaml
    run idle.yaml 2> said
    test $? = 2 && grep -q 'idle.yaml:[0-9:]*: time.sewn waits for pulled seams, and the scene has none' said || { cat said; return 1; }
}
ok "a run that waits for seams has some" idle

file() { # CHANGE SENTENCE
    sed "$1" pillow.seams.json > changed.seams.json && ! cmp -s pillow.seams.json changed.seams.json || return 1
    scene '{file: pillow.obj}' '{file: changed.seams.json}' '' > changed.yaml
    run changed.yaml 2> said
    test $? = 2 && grep -q "$2" said || { cat said; return 1; }
}
ok "seams of another mesh" file 's/"vertices": [0-9]*, "tri/"vertices": 3, "tri/' 'changed.seams.json:2:[0-9]*: it is of a mesh of 3 vertices, but the OBJ file has'
ok "seams of another schema" file 's/"schema": 1/"schema": 0/' 'schema is 0; it has to be 1'
ok "an unknown key of seams" file 's/"pairs"/"couples"/' 'unknown key "couples" in a seam, which may have sides, pairs, reversed, distances'
ok "a vertex that is not there" file 's/"pairs": \[\[[0-9]*/"pairs": [[99999/' 'a vertex is 99999, but there are [0-9]* vertices, counted from 0'
ok "a side without an edge" file 's/"edge": [0-9]*, "length"/"length"/' 'a side has to have both panel and edge'
