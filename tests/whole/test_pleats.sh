#!/bin/sh
# Gathers and pleats: a curtain that is twice as wide as its band is sewn to it, with contact certified, and worn: all partners meet, and
# nothing goes through anything. The same bits on any ranks and threads. (tests/cloth/garment/test_mesh.c has where partners are.)
. "${srcdir:-.}/tests/support/cloth.sh"

rectangle() { # WIDTH HEIGHT TRANSLATION
    printf '{"vertices": [[0, 0], [%s, 0], [%s, %s], [0, %s]], "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}], "translation": %s, "rotation": [0, 0, 0]}' "$1" "$1" "$2" "$2" "$3"
}
cat > curtain.json << END
{"pattern": {"panels": {"curtain": $(rectangle 40 12 '[-20, -14, 0]'), "band": $(rectangle 20 4 '[-10, 0, 0]')},
  "stitches": [[{"panel": "curtain", "edge": 2}, {"panel": "band", "edge": 0}]]},
 "properties": {"curvature_coords": "relative", "units_in_meter": 100}}
END
cat > curtain.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
grain: 40
cloths:
  - name: curtain
    mesh: {pattern: {file: curtain.json, edge: 0.025, pleats: [{panel: curtain, edge: 2, count: 2}]}}
    material: m
    seams: {stiffness: 3000}
    pins: [{group: band}]
    start: [{group: curtain, wave: {vector: [5, 0, 0], translate: [0, 0, 0.01]}}] # a wave a pleat says which way it folds
materials: {m: {model: triangles, density: 0.2, stretch: 500, shear: 100, bending: {rigidity: 1.0e-5}, damping: {stiffness: 0.01, mass: 2}}}
contact: {mode: certified, self: on, thickness: 0.002}
time: {h: 0.01, end: 3, fps: 25}
phases:
  - {name: sew, set: {time.sewn: {}}}
  - {name: wear, set: {'cloths[0].seams.state': welded, time.sewn: null, time.end: 0.1, gravity: [0, -9.81, 0]}}
END
run() { limited "$DUITE_CLOTH" curtain.yaml --quiet --report report.json "$@"; }
sewn() { # PAIRS SETTING...
    pairs=$1 && shift && run --check-intersections --output out "$@" && grep '"pairs"' report.json && grep -q "\"pairs\": $pairs," report.json &&
        test "$(value intersections)" = 0 && test "$(value seams_open)" = 0 && awk -v far="$(value seam_distance)" 'BEGIN { print far; exit !(far <= 0.001) }'
}
ok "two pleats are sewn and worn" sewn 17
ok "their frames have no intersections either" eval 'test ! -x "$DUITE_VIEW" || "$DUITE_VIEW" --check-intersections out'
ok "two that take half, the rest is gathered" sewn 15 --set 'cloths[0].mesh.pattern.pleats[0].depth=0.025'
ok "gathers are sewn and worn" sewn 13 --set cloths[0].seams.stiffness=6000 --set 'cloths[0].mesh.pattern.pleats=[]' --set 'cloths[0].start[0].wave.vector=[10, 0, 0]'

# ---- What does not fit
pleats() { run --set "cloths[0].mesh.pattern.pleats=[$1]"; }
ok "a pleat of too much cloth" refuses 'are 0.06 m deep take 0.24 m, but the edge is only 0.2 m longer than the one that it is sewn to; a depth of at most 0.05 m' pleats '{panel: curtain, edge: 2, count: 2, depth: 0.06}'
ok "of the shorter edge" refuses 'pleats need cloth: the edge is 0.2 m long, and the one that it is sewn to 0.4 m' pleats '{panel: band, edge: 0, count: 2}'
ok "of an edge that is free" refuses "edge 1 of panel 'curtain' is not stitched, so it has no pleats" pleats '{panel: curtain, edge: 1, count: 2}'
ok "of a stitch that has some" refuses "edge 2 of panel 'curtain' is of a stitch that has pleats already" pleats '{panel: curtain, edge: 2, count: 2}, {panel: curtain, edge: 2, count: 1}'
sed 's/\[40, /[80, /g' curtain.json > wide.json
ok "pleats that overlap" refuses 'are 0.15 m deep overlap, as there is one in each 0.1 m' run --set cloths[0].mesh.pattern.file=wide.json

# ---- The same bits
short='--set phases=null --set time.end=0.05'
hash() { value state_hash; }
# shellcheck disable=SC2086 # settings
same() { # COMMAND...
    "$@" curtain.yaml --quiet --report report.json $short && echo "$(hash), $one" && test "$(hash)" = "$one"
}
# shellcheck disable=SC2086
run $short && one=$(hash) || exit 99
ok "the same bits of two threads" same limited "$DUITE_CLOTH" --threads 2
for n in 2 4; do ok "of $n ranks" same ranks $n "$DUITE_CLOTH" --threads 1; done
