#!/bin/sh
# Thickness and pressure by material and by obstacle: two sides rest (a + b) / 2 apart, in both modes; what is compressed pushes by the law of both
# halves; sewn cloths of unlike thickness stay at rest; nothing goes through anything; one state_hash, also from a
# checkpoint. With DUITE_LONG=1: over ranks, threads and schedulers, and by more integrators.
. "${srcdir:-.}/tests/support/probes.sh"

materials='materials:
  felt: {density: 0.4, stretch: 1000, shear: 300, bend: 1, thickness: 0.004, damping: {stiffness: 0.004, mass: 5}}
  silk: {density: 0.1, stretch: 1000, shear: 300, bend: 1, thickness: 0.0006, damping: {stiffness: 0.004, mass: 5}}
  own: {density: 0.2, stretch: 1000, shear: 300, bend: 1, damping: {stiffness: 0.004, mass: 5}}'
sheet() { # NAME MATERIAL HEIGHT VERTICES MORE
    printf '  - {name: %s, material: %s, mesh: {grid: {width: 0.06, height: 0.06, nx: %s, ny: %s}}, transform: {translate: [0.001, %s, 0.002]}%s}\n' "$1" "$2" "$4" "$4" "$3" "$5"
}

# Felt of 4 mm on a floor of 2 mm is 3 mm above it, silk of 0.6 mm 2.3 mm above the felt, cloth of contact.thickness 0.8 mm above the silk.
cat > pile.yaml << END
schema: 1
cloths:
$(sheet a felt 0.0031 7)
$(sheet b silk 0.0055 8)
$(sheet c own 0.0064 6)
$materials
obstacles: [{plane: {point: [0, 0, 0], normal: [0, 1, 0], thickness: 0.002}}]
contact: {mode: certified, thickness: 0.001}
probes: [{name: a, cloth: a, vertices: [24], values: [position]}, {name: b, cloth: b, vertices: [27], values: [position]}, {name: c, cloth: c, vertices: [14], values: [position]}]
time: {h: 0.004, end: 0.6, fps: 50}
grain: 30
END
rests() { # OPTION...
    run pile.yaml --report report.json --check-intersections "$@" || return 1
    test "$(value intersections)" = 0 && near "felt above the floor" "$(last a.24.y)" 0.003 0.02 &&
        near "silk above the felt" "$(less "$(last b.27.y)" "$(last a.24.y)")" 0.0023 0.02 &&
        near "cloth above the silk" "$(less "$(last c.14.y)" "$(last b.27.y)")" 0.0008 0.02
}
ok "three cloths on a floor" rests
test -z "${DUITE_LONG:-}" || ok "three cloths on a floor, BDF2, one block each" rests --set integrator=bdf2 --set grain=1000
test -z "${DUITE_LONG:-}" || ok "three cloths on a floor, springs" rests --set contact.mode=repulsion --set contact.stiffness=200
block() { # a body in place of the floor
    box_obj -1 -1 -1 1 0 1 > block.obj
    rests --set 'obstacles[0]={body: {obj: block.obj, thickness: 0.002}}' "$@"
}
. "$srcdir/tests/support/bodies.sh"
test -z "${DUITE_LONG:-}" || ok "three cloths on a body" block
ok "three cloths on a body, springs" block --set contact.mode=repulsion --set contact.stiffness=200

# A vertex rests m g / k below the sum of halves, one inside a sheet of cells of 2 cm.
light() { # OPTION...
    run pile.yaml --set contact.mode=repulsion --set contact.stiffness=10 --set 'materials.felt={density: 0.4, stretch: 10, shear: 3, thickness: 0.004}' \
        --set 'cloths=[{name: a, material: felt, mesh: {grid: {width: 0.06, height: 0.06, nx: 4, ny: 4}}, transform: {translate: [0, 0.0029, 0]}}]' \
        --set 'probes=[{name: a, cloth: a, vertices: [5], values: [position]}]' --set time.end=1 "$@" &&
        near "felt on springs" "$(last a.5.y)" "$(awk 'BEGIN { printf "%.17g", 0.003 - 0.4 * 0.0004 * 9.81 / 10 }')" 1e-4
}
ok "felt on springs" light
test -z "${DUITE_LONG:-}" || ok "felt on springs, Verlet" light --set integrator=verlet --set time.h=0.001

# ---- Compression

# Pinned cloth and a sheet that pins lead down to it, shifted against it, so that 16 vertices of each press on the other: 16 cm^2. Each half
# follows its own law: a / 2 / (1 + q / p). Both together are half as thick by q.
cat > pinch.yaml << END
schema: 1
gravity: [0, 0, 0]
cloths:
  - {name: a, material: felt, mesh: {grid: {width: 0.04, height: 0.04, nx: 5, ny: 5}}, pins: [{box: [[-1, -1, -1], [1, 1, 1]]}]}
  - {name: b, material: silk, mesh: {grid: {width: 0.05, height: 0.05, nx: 6, ny: 6}}, transform: {translate: [-0.002, 0.003, -0.001]}, pins: [{box: [[-1, -1, -1], [1, 1, 1]], motion: {times: [0, 0.1], translate: [[0, 0, 0], [0, -0.00185, 0]]}}]}
$materials
contact: {mode: certified, self: off, thickness: 0.001}
probes: [{name: a, cloth: a, box: [[-1, -1, -1], [1, 1, 1]], values: [contact_total]}]
time: {h: 0.004, end: 1, fps: 10}
END
law() { # FELT SILK: pressures; half of 2.3 mm is left
    awk -v p="$1" -v r="$2" 'BEGIN { for (high = p + r; i < 200; i++) { q = (low + high) / 2; if (0.002 / (1 + q / p) + 0.0003 / (1 + q / r) > 0.00115) low = q; else high = q }
        printf "%.17g", -0.0016 * q }'
}
presses() { # FELT SILK OPTION...
    felt=$1
    silk=$2
    shift 2
    run pinch.yaml --set "materials.felt.pressure=$felt" --set "materials.silk.pressure=$silk" "$@" &&
        near "force of felt of $felt Pa on silk of $silk Pa, N" "$(last a.total.cy)" "$(law "$felt" "$silk")" 0.02
}
ok "felt is compressed, not silk" presses 1000 20000
test -z "${DUITE_LONG:-}" || ok "both are compressed, h = 1 ms" presses 3000 3000 --set time.h=0.001
test -z "${DUITE_LONG:-}" || ok "silk is compressed, not felt" presses 20000 1000
# An obstacle is as hard as the cloth on it: (4 + 2) mm / 2 of felt in 1.5 mm.
on_box() {
    run pinch.yaml --set materials.felt.pressure=1000 --set 'cloths[1].pins=[]' --set 'cloths[1].transform.translate=[0, 1, 0]' \
        --set 'obstacles=[{box: {centre: [0, 0.0535, 0], size: [0.2, 0.1, 0.2], thickness: 0.002, motion: {times: [0, 0.1], translate: [[0, 0, 0], [0, -0.002, 0]]}}}]' &&
        near "force of felt under a box, N" "$(last a.total.cy)" -1.6 0.02
}
ok "felt under a box" on_box

# ---- Sewn cloths, of cells of 5 mm

half='mesh: {grid: {width: 0.03, height: 0.06, nx: 7, ny: 13}}'
column() { # FIRST: 13 vertices of a column, 7 from each other
    awk -v first="$1" 'BEGIN { for (j = 0; j < 13; j++) printf "%s%d", j ? ", " : "", first + 7 * j }'
}
cat > sewn.yaml << END
schema: 1
gravity: [0, 0, 0]
cloths:
  - {name: a, material: felt, $half}
  - {name: b, material: silk, $half, transform: {translate: [0.03, 0, 0]}}
  - {name: c, material: own, $half, transform: {translate: [0, 0.02, 0]}}
welds: [{from: {cloth: a, vertices: [$(column 6)]}, to: {cloth: b, vertices: [$(column 0)]}, tolerance: 1e-6}]
$materials
contact: {mode: certified, thickness: 0.001}
time: {h: 0.004, end: 0.04, fps: 50}
grain: 60
END
stays() { # FELT OPTION...
    felt=$1
    shift
    run sewn.yaml --report report.json --set "materials.felt.thickness=$felt" "$@" && test "$(value steps_halved)" = 0 && test "$(value contacts)" = 0 &&
        below "stretch" "$(less "$(value stretch_highest)" 1)" 1e-9
}
test -z "${DUITE_LONG:-}" || for felt in 0.003 0.02; do ok "felt of $felt m that is sewn on silk" stays $felt; done
test -z "${DUITE_LONG:-}" || ok "in one block" stays 0.012 --set grain=1000
ok "felt of 0.012 m that is sewn on silk" stays 0.012
ok "springs" stays 0.012 --set contact.mode=repulsion
refused() {
    ! limited "$DUITE_CLOTH" sewn.yaml --quiet --set 'cloths[0].mesh.grid={width: 0.03, height: 0.06, nx: 61, ny: 121}' --set 'welds=[]' --set materials.felt.thickness=0.02 > said 2>&1 &&
        cat said && grep "cloth 'a': more than 1024 triangles are nearer at rest than 0.026 m .*of a material, 0.02 m, should be smaller" said
}
ok "a mesh that is far too fine for a material" refused

# ---- Nothing goes through anything

cat > ball.yaml << END
schema: 1
cloths:
  - {name: a, material: silk, mesh: {grid: {width: 0.25, height: 0.25, nx: 15, ny: 15}}, transform: {translate: [0.01, 0.103, 0.02]}}
  - {name: b, material: felt, mesh: {grid: {width: 0.25, height: 0.25, nx: 14, ny: 14}}, transform: {translate: [0, 0.109, 0]}}
  - {name: c, material: own, mesh: {grid: {width: 0.2, height: 0.2, nx: 13, ny: 13}}, transform: {translate: [0, 0.114, 0.01]}, velocity: [0, -1, 0]}
$materials
obstacles: [{sphere: {centre: [0, 0, 0], radius: 0.1, thickness: 0.003}}, {plane: {point: [0, -0.05, 0], normal: [0, 1, 0]}}]
contact: {mode: certified, self: on, thickness: 0.001, friction: 0.3}
time: {h: 0.004, end: 0.3, fps: 50}
grain: 60
END
holds() { # OPTION...
    limited "$DUITE_CLOTH" ball.yaml --check-intersections --report report.json --quiet "$@" && test "$(value intersections)" = 0 &&
        test "$(value intersections_shapes)" = 0 && test "$(value contacts)" -gt 0
}
ok "three cloths on a ball" holds
test -z "${DUITE_LONG:-}" || ok "three cloths on a ball, BDF2, h = 10 ms" holds --set integrator=bdf2 --set time.h=0.01
goes_on() {
    set -- ball.yaml --quiet
    limited "$DUITE_CLOTH" "$@" --end 0.2 --report whole.json && rm -rf part && ranks 2 "$DUITE_CLOTH" "$@" --end 0.12 --output part --checkpoint 10 &&
        ranks 2 "$DUITE_CLOTH" "$@" --end 0.2 --restart part --report report.json || return 1
    echo "$(value state_hash), $(value state_hash whole.json)"
    test "$(value state_hash)" = "$(value state_hash whole.json)" && test "$(value contacts)" -gt 0
}
in_full "they go on from a checkpoint, on two ranks" goes_on
cd "$OLDPWD" || exit 99
test -z "${DUITE_LONG:-}" || ok "one hash: three cloths on a ball" ranks 3 tests/whole/same_hash "$scratch/ball.yaml" few 0 time.end=0.12
test -z "${DUITE_LONG:-}" || ok "one hash: springs" ranks 3 tests/whole/same_hash "$scratch/ball.yaml" few 0 time.end=0.12 contact.mode=repulsion
