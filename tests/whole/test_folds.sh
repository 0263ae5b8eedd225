#!/bin/sh
# Folds: hinges whose angle at rest the scene says, within a mesh, across a weld and along a seam of a pattern.
. "${srcdir:-.}/tests/support/probes.sh"

# A flap of 1 m on a hinge along z, its front upwards. It is at rest where it hangs down by the angle.
cat > flap.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
cloths:
  - mesh: {inline: {vertices: [[0, 0, 0], [0, 0, 1], [-1, 0, 0.5], [1, 0, 0.5]], triangles: [[1, 0, 2], [0, 1, 3]]}}
    material: sheet
    folds: [{vertices: [0, 1], angle: 30}]
    mass_per_vertex: 0.1
    pins: [{vertices: [0, 1, 2]}]
materials: {sheet: {stretch: 5000, bending: {rigidity: 10}, damping: {stiffness: 0.05}}}
time: {h: 0.01, end: 12}
newton: {steps: 10, tolerance: 1.0e-10}
solver: {stop: {relative: 1.0e-12}}
probes: [{name: p, vertices: [3], values: [position, velocity]}]
END
sine() { awk -v a="$1" 'BEGIN { printf "%.15g\n", sin(a * atan2(0, -1) / 180) }'; }
comes() { # ANGLE SETTING...: to hang down by it
    angle=$1
    shift
    run flap.yaml "$@" || return 1
    below "height of a flap folded by $angle degrees" "$(awk -v y="$(last p.3.y)" -v s="$(sine "$angle")" 'BEGIN { d = y + s; print d < 0 ? -d : d }')" 1e-9 &&
        below "its velocity" "$(awk -v v="$(last p.3.vy)" 'BEGIN { print v < 0 ? -v : v }')" 1e-8
}
ok "a ridge on the front" comes 30
ok "a valley" comes -100 --set 'cloths[0].folds[0].angle=-100' --set materials.sheet.damping.stiffness=0.3
ok "a flat one" comes 0 --set 'cloths[0].folds[0].angle=0'
ok "named from its other end" comes 30 --set 'cloths[0].folds[0].vertices=[1, 0]'
ok "in a mesh whose first triangle is the other one" comes 30 --set 'cloths[0].mesh.inline.triangles=[[0, 1, 3], [1, 0, 2]]'
ok "in a mesh whose front is below" comes -30 --set 'cloths[0].mesh.inline.triangles=[[0, 1, 2], [1, 0, 3]]'
renumbered='cloths[0].mesh.inline={vertices: [[0, 0, 1], [0, 0, 0], [-1, 0, 0.5], [1, 0, 0.5]], triangles: [[0, 1, 2], [1, 0, 3]]}'
ok "in a mesh that is numbered the other way" comes 30 --set "$renumbered"

# Bent by the angle as it is at rest: no force, to the last bits, and none where the mesh has another shape.
still() { # ANGLE SETTING...
    angle=$1
    shift
    run flap.yaml --set 'cloths[0].pins=[{vertices: [0, 1]}]' --set "cloths[0].folds[0].angle=$angle" --set time.end=0.1 --set materials.sheet.damping.stiffness=0 \
        --set "cloths[0].start=[{vertices: [3], translate: [$(awk -v a="$angle" 'BEGIN { printf "%.17g, %.17g", cos(a * atan2(0, -1) / 180) - 1, -sin(a * atan2(0, -1) / 180) }'), 0]}]" "$@" || return 1
    below "velocity of a flap that is at rest at $angle degrees" "$(rows '{ v = c("p.3.vy"); if (v < 0) v = -v; if (v > most) most = v } END { print most + 0 }')" 1e-14 &&
        below "energy" "$(rows '{ e = c("elastic") + c("kinetic"); if (e > most) most = e } END { print most + 0 }')" 1e-25
}
for angle in 90 -45 135; do ok "no force at $angle degrees" still $angle; done
moves() { still 90 --set cloths[0].folds=[] 2> /dev/null; [ $? != 0 ]; }
ok "a force there without the fold" moves

# Two flaps of two cloths, welded at the hinge: from either side.
cat > welded.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
grain: 2
cloths:
  - {name: left, mesh: {inline: {vertices: [[-1, 0, 0.5], [0, 0, 0], [0, 0, 1]], triangles: [[2, 1, 0]]}}, material: sheet, mass_per_vertex: 0.05,
     pins: [{vertices: [0, 1, 2]}], folds: []}
  - {name: right, mesh: {inline: {vertices: [[0, 0, 1], [1, 0, 0.5], [0, 0, 0]], triangles: [[2, 0, 1]]}}, material: sheet, mass_per_vertex: 0.1, folds: []}
welds: [{from: {cloth: left, vertices: [1, 2]}, to: {cloth: right, vertices: [2, 0]}}]
materials: {sheet: {stretch: 5000, bending: {rigidity: 10}, damping: {stiffness: 0.05}}}
time: {h: 0.01, end: 12}
newton: {steps: 10, tolerance: 1.0e-10}
solver: {stop: {relative: 1.0e-12}}
probes: [{name: p, cloth: right, vertices: [1], values: [position]}]
END
across() { # SETTING
    run welded.yaml --set "$1" || return 1
    below "height of a flap folded across a weld" "$(awk -v y="$(last p.1.y)" 'BEGIN { d = y + 0.5; print d < 0 ? -d : d }')" 1e-9
}
ok "across a weld, by its first side" across 'cloths[0].folds=[{vertices: [1, 2], angle: 30}]'
ok "by its second side" across 'cloths[1].folds=[{vertices: [0, 2], angle: 30}]'

# Two panels of a pattern, side by side: the second one turns about the seam as a whole.
cat > book.json << 'END'
{"pattern": {"panels": {
   "cover": {"vertices": [[0, 0], [10, 0], [10, 10], [0, 10]], "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}],
     "translation": [0, 0, 0], "rotation": [0, 0, 0]},
   "page": {"vertices": [[0, 0], [10, 0], [10, 10], [0, 10]], "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}],
     "translation": [10, 0, 0], "rotation": [0, 0, 0]}},
  "stitches": [[{"panel": "cover", "edge": 1}, {"panel": "page", "edge": 3}]]},
 "properties": {"curvature_coords": "relative", "units_in_meter": 100}}
END
cat > book.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
contact: {mode: project}
cloths:
  - mesh: {pattern: {file: book.json, edge: 0.025}}
    material: card
    seams: {state: welded}
    folds: [{edge: {panel: cover, edge: 1}, angle: 60}]
    pins: [{group: cover}]
materials: {card: {model: triangles, density: 0.2, stretch: 500, shear: 200, bending: {rigidity: 1.0e-2}, damping: {stiffness: 0.02}}}
time: {h: 0.01, end: 12}
newton: {steps: 10, tolerance: 1.0e-9}
solver: {stop: {relative: 1.0e-12}}
probes: [{name: p, nearest: [0.2, 0.1, 0], values: [position]}]
END
turns() { # SETTING...: the corner is 0.1 m from the seam, 60 degrees behind the front, which is +z
    run book.yaml "$@" || return 1
    below "corner of a page folded by 60 degrees, m" "$(awk -F, -v s="$(sine 60)" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i ~ /\.z/) at = i } END { d = $at + 0.1 * s; print d < 0 ? -d : d }' out/probes.csv)" 1e-6
}
ok "along an edge of a panel" turns
ok "along the edge of the other panel" turns --set 'cloths[0].folds[0].edge={panel: page, edge: 3}'
waits() { # pulled, it is no hinge yet
    run book.yaml --set 'phases=[{name: sew, set: {"cloths[0].seams.state": pulled, time.end: 0.1}}, {name: fold, set: {"cloths[0].seams.state": welded, time.end: 4}}]' 2> said || { cat said; return 1; }
    below "corner of a page folded in a second phase, m" "$(awk -F, -v s="$(sine 60)" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i ~ /\.z/) at = i } END { d = $at + 0.1 * s; print d < 0 ? -d : d }' out/probes.csv)" 1e-6
}
ok "a seam that is welded in a later phase" waits

same() {
    run book.yaml --grain 9 --end 0.3 && cp out/probes.csv one.csv && ranks 2 "$DUITE_CLOTH" book.yaml --grain 9 --end 0.3 --quiet --output out --threads 2 && cmp out/probes.csv one.csv
}
ok "the same on any ranks and threads" same
