#!/bin/sh
# Features that are near each other at rest, along the cloth, do not push: cloth at rest stays there for any thickness of contact, slivers
# and seams included. Cloth that is near but not at rest does.
. "${srcdir:-.}/tests/support/probes.sh"

# Sheets of 5 mm a cell, 60 mm wide.
rest() { # NAME CLOTHS MORE
    cat > "$1.yaml" << END
schema: 1
name: $1
cloths:
$2
materials:
  m: {density: 0.2, stretch: 1000, shear: 300, bend: 1, damping: {stiffness: 0.004}}
  t: {density: 0.2, model: triangles, stretch: 1000, shear: 300, poisson: 0.3, bending: {model: hinge, rigidity: 1e-5}}
contact: {mode: certified, self: on, thickness: 0.0042}
gravity: [0, 0, 0]
time: {h: 0.004, end: 0.04, fps: 50}
grain: 60
$3
END
}
grid='mesh: {grid: {width: 0.06, height: 0.06, nx: 13, ny: 13}}'
rest flat "  - {name: a, material: m, $grid}"
stays() { # SCENE OPTION...: nothing is stretched, no step is halved, nothing touches
    limited "$DUITE_CLOTH" "$1.yaml" --report report.json --quiet --set "contact.thickness=$2" "$3" "$4" "$5" "$6" > said 2>&1
    stays_got=$?
    cat said
    test $stays_got = 0 && test "$(value steps_halved)" = 0 && test "$(value contacts)" = 0 &&
        below "stretch of $1 by $2 m" "$(less "$(value stretch_highest)" 1)" 1e-9
}
for thickness in 0.0025 0.0042 0.005 0.01 0.015; do
    ok "a sheet, $thickness m" stays flat $thickness --set cloths[0].material=m --set integrator=implicit_euler
done
unseen() { # what is flat has no pairs to look at
    stays flat 0.01 --set cloths[0].material=m --set grain=1000 && test "$(value contact_pairs)" = 0
}
ok "a sheet in one block, 0.01 m" unseen
ok "triangles, bdf2" stays flat 0.01 --set cloths[0].material=t --set integrator=bdf2
ok "springs that push apart" stays flat 0.01 --set contact.mode=repulsion --set integrator=implicit_euler

# A point 20 um beside the middle of a diagonal cuts the triangle there, and a vertex lies 0.3 mm from the next one.
awk 'BEGIN { for (j = 0; j < 13; j++) for (i = 0; i < 13; i++) print "v", (i == 9 && j == 9 ? 0.0497 : i * 0.005), 0, j * 0.005
    print "v", 0.022514, 0, 0.022486
    for (j = 0; j < 12; j++) for (i = 0; i < 12; i++) { a = 13 * j + i + 1; b = a + 1; c = a + 14; d = a + 13; print "f", a, d, c
        if (i != 4 || j != 4) { print "f", a, c, b; continue }
        print "f", a, c, 170; print "f", c, b, 170; print "f", b, a, 170 } }' > sliver.obj
rest sliver '  - {name: a, material: t, mesh: {file: sliver.obj}}'
for thickness in 0.001 0.0025 0.01; do
    ok "a mesh with slivers, $thickness m" stays sliver $thickness --set cloths[0].material=t --set integrator=implicit_euler
done
ok "they are counted" says '  low triangles    6 of a, triangle ' sliver.yaml --set contact.thickness=0.0025

# Two halves that a weld joins, and two that a joint of no length pulls.
half='mesh: {grid: {width: 0.03, height: 0.06, nx: 7, ny: 13}}'
column() { # FIRST: 13 vertices of a column, 7 from each other
    awk -v first="$1" 'BEGIN { for (j = 0; j < 13; j++) printf "%s%d", j ? ", " : "", first + 7 * j }'
}
rest welded "  - {name: a, material: m, $half}
  - {name: b, material: m, $half, transform: {translate: [0.03, 0, 0]}}" \
    "welds: [{from: {cloth: a, vertices: [$(column 6)]}, to: {cloth: b, vertices: [$(column 0)]}, tolerance: 1e-6}]"
ok "two cloths with a weld" stays welded 0.01 --set cloths[0].material=m --set integrator=implicit_euler

# Layers keep the whole thickness, which is three cells.
rest layers "  - {name: a, material: m, $grid, pins: [{box: [[-1, -1, -1], [1, 1, 1]]}]}
  - {name: b, material: m, $grid, transform: {translate: [0.001, 0.02, 0.002]}}" 'probes: [{name: p, cloth: b, vertices: [84], values: [position]}]'
keep() {
    run layers.yaml --set contact.thickness=0.015 --set 'gravity=[0, -9.81, 0]' --set time.end=0.4 || return
    near "height of the upper one" "$(last p.84.y)" 0.015 0.02
}
ok "layers keep it" keep

# A sheet that falls on its edge folds with cells a third as large as the thickness.
rest folds "  - {name: a, material: m, $grid, transform: {translate: [0, 0.04, 0], rotate: [1, 1, 0.05, 0]}}" \
    'obstacles: [{plane: {point: [0, 0, 0], normal: [0, 1, 0]}}]'
folds() { # THICKNESS
    limited "$DUITE_CLOTH" folds.yaml --set "contact.thickness=$1" --set 'gravity=[0, -9.81, 0]' --set time.end=0.3 --check-intersections \
        --report report.json --quiet > said 2>&1
    folds_got=$?
    cat said
    test $folds_got = 0 && test "$(value intersections)" = 0 && test "$(value contacts)" -gt 0 &&
        below "stretch by $1 m" "$(less "$(value stretch_highest)" 1)" 0.05
}
ok "a sheet that folds, 0.0042 m" folds 0.0042
ok "a sheet that folds, 0.015 m" folds 0.015
