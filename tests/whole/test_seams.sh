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
ok "the same bits of two threads" same pulled.yaml --threads 2
two() { ranks "$1" "$DUITE_CLOTH" pulled.yaml --quiet --report report.json --threads "$2" && test "$(value state_hash)" = "$(cat pulled.hash)"; }
ok "of two ranks" two 2 2
ok "of three ranks" two 3 1
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
