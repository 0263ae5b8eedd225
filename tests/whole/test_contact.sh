#!/bin/sh
# Cloth with certified contact goes through nothing: scenes by step length, material and integrator, each looked at in every frame by
# --check-intersections. And one state_hash over ranks, threads, schedulers, mappings and balancers. With DUITE_LONG=1: all products.
. "${srcdir:-.}/tests/support/cloth.sh"

# 256 to 545 vertices.
scene() { # NAME CLOTHS MORE END
    cat > "$1.yaml" << END
schema: 1
name: $1
cloths:
$2
materials:
  m: {density: 0.2, stretch: 1000, shear: 300, bend: 1, damping: {viscous: 2e-5, stiffness: 0.004}}
contact: {mode: certified, self: on, thickness: 0.002, friction: 0.3}
time: {h: 0.004, end: $4, fps: 50}
grain: 150
$3
END
}
sheet() { # NAME SIZE VERTICES TRANSFORM MORE
    printf '  - {name: %s, material: m, mesh: {grid: {width: %s, height: %s, nx: %s, ny: %s}}, transform: {%s}%s}\n' "$1" "$2" "$2" "$3" "$3" "$4" "$5"
}
floor='{plane: {point: [0, 0, 0], normal: [0, 1, 0]}}'
scene ball "$(sheet a 0.3 16 'translate: [0.01, 0.105, 0.02]')" 'obstacles: [{sphere: {centre: [0, 0, 0], radius: 0.1}}]' 0.3
scene fold "$(sheet a 0.3 16 'translate: [0, 0.16, 0], rotate: [1, 1, 0, 0]')" "obstacles: [$floor]" 0.4
scene pair "$(sheet a 0.3 16 'translate: [0, 0.065, 0]')
$(sheet b 0.3 17 'translate: [0.02, 0.1, 0.03], rotate: [0.924, 0, 0.383, 0]')" "obstacles: [$floor, {box: {centre: [0, 0.03, 0], size: [0.1, 0.06, 0.1]}}]" 0.3
scene edge "$(sheet a 0.3 16 'translate: [0.06, 0.2, 0]' ', velocity: [0, -10, 0]')" "obstacles: [$floor, {box: {centre: [0, 0.05, 0], size: [0.1, 0.1, 0.4]}}]" 0.05
turn() { # SIGN: a turn and a half of an end
    printf '{times: [0, 0.2, 0.4, 0.6], rotate: [[1, 0, 0, 0], [0.7071, %s0.7071, 0, 0], [0, %s1, 0, 0], [-0.7071, %s0.7071, 0, 0]], translate: [[0, 0, 0], [%s0.02, 0, 0], [%s0.04, 0, 0], [%s0.06, 0, 0]], about: [0, 0, 0]}' "$@"
}
scene wring "$(sheet a 0.3 16 'translate: [0, 0, 0]' ", pins: [{box: [[-0.2, -1, -1], [-0.149, 1, 1]], motion: $(turn '' '' '' '' '' '')}, {box: [[0.149, -1, -1], [0.2, 1, 1]], motion: $(turn - - - - - -)}]")" 'gravity: [0, 0, 0]' 0.6

# holds SCENE OPTION...: nothing goes through anything, something touched, and no vertex is cut in more than 20 steps in a row.
holds() {
    holds_scene=$1
    shift
    limited "$DUITE_CLOTH" "$holds_scene.yaml" --check-intersections --report report.json --quiet "$@" > said 2>&1
    holds_got=$?
    cat said
    test $holds_got = 0 && test "$(value intersections)" = 0 && test "$(value intersections_shapes)" = 0 && test "$(value contacts)" -gt 0 && test "$(value contact_cut_run)" -le 20 ||
        { echo "exit status $holds_got, $(value intersections) pairs, $(value intersections_shapes) with obstacles, $(value contacts) contacts, cut in $(value contact_cut_run) steps in a row" && return 1; }
}
triangles='materials.m={model: triangles, density: 0.2, stretch: 1000, shear: 300, poisson: 0.3, damping: {viscous: 2e-5, stiffness: 0.004}, bending: {rigidity: 1e-5}}'

ok "a sheet on a ball" holds ball
ok "a sheet that folds onto itself" holds fold
ok "two sheets over a box, by triangles, bdf2" holds pair --set "$triangles" --set integrator=bdf2
ok "a sheet at 10 m/s onto an edge, h = 10 ms" holds edge --set time.h=0.01
ok "a sheet that is wrung" holds wring
scene press "$(sheet a 0.1 6 'translate: [0, 0.01, 0]' ', pins: [{vertices: [0, 5, 30, 35], motion: {times: [0, 0.1], translate: [[0, 0, 0], [0, -0.05, 0]]}}]')" \
    "obstacles: [$floor]" 0.1
pressed() { # says why, and names no stretch
    limited "$DUITE_CLOTH" press.yaml --quiet > said 2>&1
    pressed_got=$?
    cat said
    test $pressed_got = 1 && grep -q 'cannot be kept apart: obstacles or pins pinch the cloth' said && ! grep -q 'stretch of an edge' said
}
ok "pins that are led into the floor" pressed
scene sunk "$(sheet a 0.1 6 'translate: [0, -0.01, 0]')" "obstacles: [$floor]" 0.1
sunk() { # is refused, and nothing says that a step puts it out
    limited "$DUITE_CLOTH" sunk.yaml > said 2>&1
    sunk_got=$?
    cat said
    test $sunk_got = 2 && grep -q 'm deep in it (vertices count from 1)$' said && grep -q 'go through each other and [1-9][0-9]* through obstacles' said
}
ok "a start in the floor" sunk
sed 's/mode: certified, //; s/nx: 6, ny: 6/nx: 60, ny: 60/; s/thickness: 0.002/thickness: 0.03/' sunk.yaml > coarse.yaml
likewise() { # what nobody asked for says how to do without
    ! limited "$DUITE_CLOTH" coarse.yaml > said 2>&1 && grep "cloth 'a': more than 1024 triangles are nearer at rest than 0.039 m to a corner of triangle [0-9]* .counted from 0.; contact.thickness, or that of a material, 0.03 m, should be smaller.*contact: {mode: project} is the way without$" said &&
        ! limited "$DUITE_CLOTH" coarse.yaml --set contact.thickness=0.002 > said 2>&1 && grep 'go through each other.*contact: {mode: project} is the way without$' said &&
        limited "$DUITE_CLOTH" coarse.yaml --set contact.mode=project > said 2>&1 && grep -qx '  contact          project' said &&
        limited "$DUITE_CLOTH" coarse.yaml --set contact.thickness=0.002 --set 'obstacles=[]' > said 2>&1 && grep -qx '  contact          certified, by default' said
}
ok "certified contact by default" likewise
if test "${DUITE_LONG:-}" = 1; then
    for name in ball fold pair edge wring; do
        for h in 0.001 0.004 0.01; do
            for integrator in implicit_euler bdf2; do
                ok "$name, h = $h, springs, $integrator" holds $name --set time.h=$h --set integrator=$integrator
                ok "$name, h = $h, triangles, $integrator" holds $name --set time.h=$h --set integrator=$integrator --set "$triangles"
            done
        done
    done
fi

# Cloth that slides without friction over edges keeps its speed.
scene slide "$(sheet ground 0.6 25 'translate: [0, 0, 0]' ', pins: [{box: [[-1, -1, -1], [1, 1, 1]]}]')
$(sheet patch 0.1 6 'translate: [-0.2, 0.00205, 0.003], rotate: [0.99, 0, 0.14, 0]' ', velocity: [1, 0, 0]')" 'probes: [{name: patch, cloth: patch, vertices: [0, 35], values: [velocity]}]' 0.2
sliding() {
    limited "$DUITE_CLOTH" slide.yaml --set contact.friction=0 --set contact.self=off --set 'materials.m.damping={stiffness: 0.004}' --output slid --quiet > said 2>&1 || { cat said && return 1; }
    awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i ~ /^patch\.[0-9]*\.vx/) at[++n] = i }
        END { for (i = 1; i <= n; i++) { print "vx", $at[i]; if ($at[i] < 0.995 || $at[i] > 1.005) bad = 1 } exit bad || n != 2 }' slid/probes.csv
}
ok "a patch slides over a cloth without friction" sliding

# The plane of the nearest point of a small ball holds nothing up that flies past it: a ring around it ends where it would without it. It is
# looked at from the first step on, since a wall is near.
awk 'BEGIN { for (r = 0; r < 2; r++) for (i = 0; i < 12; i++) print "v", (0.012 + 0.013 * r) * cos(i * 0.5235987755982988), 0, (0.012 + 0.013 * r) * sin(i * 0.5235987755982988)
    for (i = 1; i <= 12; i++) { j = i % 12 + 1; print "f", i, j, j + 12; print "f", i, j + 12, i + 12 } }' > ring.obj
scene past '  - {name: a, material: m, mesh: {file: ring.obj}, transform: {translate: [0, 0.035, 0]}, velocity: [0, -8, 0]}' \
    'obstacles: [{sphere: {centre: [0, 0, 0], radius: 0.003}}, {plane: {point: [0, 0, 0.0275], normal: [0, 0, -1]}}]
gravity: [0, 0, 0]
probes: [{name: p, vertices: [0, 5, 12], values: [position]}]' 0.02
passing() {
    limited "$DUITE_CLOTH" past.yaml --set 'materials.m={density: 0.2, stretch: 1000, bend: 1}' --output passed --quiet > said 2>&1 || { cat said && return 1; }
    awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i ~ /^p\.[0-9]*\.y/) at[++n] = i }
        END { for (i = 1; i <= n; i++) { print "y", $at[i]; e = $at[i] + 0.125; if (e > 1e-9 || e < -1e-9) bad = 1 } exit bad || n != 3 }' passed/probes.csv
}
ok "a ring flies past a small ball" passing

# The coarse functions of a vertex that several blocks see through contacts: with those of another one solves begin again, or end nowhere.
scene heap "$(for i in 0 1 2 3 4; do sheet s$i 0.3 12 "translate: [0.00$i, 0.0$((i + 1)), 0], rotate: [1, 0, 0.0$i, 0]"; done)" "obstacles: [$floor]" 0.15
coarse() {
    limited "$DUITE_CLOTH" heap.yaml --set solver.preconditioner=coarse --set grain=40 --set time.h=0.008 --report report.json --quiet > said 2>&1
    coarse_got=$?
    cat said report.json
    test $coarse_got = 0 && test "$(value cg_restarts)" = 0 && test "$(value blocks)" -gt 15 && test "$(value contacts)" -gt 500
}
ok "contacts of many blocks and the coarse preconditioner" coarse

# Starts and steps that cannot be kept apart.
scene crossed "$(sheet a 0.3 16 'translate: [0, 0, 0]')
$(sheet b 0.3 16 'translate: [0.001, 0, 0.003], rotate: [1, 1, 0, 0]')" '' 0.1
crossing() {
    limited "$DUITE_CLOTH" crossed.yaml > said 2>&1
    test $? = 2 && grep -q 'crossed.yaml: where the run starts [1-9][0-9]* pairs of triangles go through each other' said &&
        grep -q "of cloth 'a' and triangle .* of cloth 'b' intersect" said
}
ok "cloths that start through each other are refused, with the pairs" crossing
scene near "$(sheet a 0.3 16 'translate: [0, 0, 0]')
$(sheet b 0.3 16 'translate: [0, 1e-10, 0]')" '' 0.1
touching() {
    limited "$DUITE_CLOTH" near.yaml > said 2>&1
    test $? = 2 && grep -q "near.yaml: .* pairs of features touch where the run starts.* the first of them at vertices [0-9 ]* of '.' and [0-9 ]* of '.' .vertices count from 1.: move them apart" said
}
ok "cloths that start nearer than a certificate's margin are refused, with a pair" touching
scene pinched "$(sheet a 0.1 5 'translate: [0, 0, 0]' ', pins: [{box: [[-1, -1, -1], [-0.04, 1, 1]]}]')" 'obstacles: [{box: {centre: [0, 0.1, 0], size: [0.4, 0.02, 0.4], motion: {times: [0, 0.1], translate: [[0, 0, 0], [0, -0.2, 0]]}}}]' 0.1
pinching() {
    limited "$DUITE_CLOTH" pinched.yaml --check-intersections > said 2>&1
    test $? = 1 && grep -q "pairs of features cannot be kept apart: obstacles or pins pinch the cloth.* the first of them at vertices [0-9].* of 'a' and obstacles.0., a box" said
}
ok "a box that goes through what a pin holds ends the run, with a pair" pinching
# Pairs that lie at rest are in front of those of the corner that a pin leads through the sheet below.
scene onto "$(sheet a 0.1 6 'translate: [0, 0, 0]' ', pins: [{box: [[-1, -1, -1], [1, 1, 1]]}]')
$(sheet b 0.1 6 'translate: [0, 0.0021, 0]' ', pins: [{vertices: [35], motion: {times: [0, 0.02, 0.06], translate: [[0, 0, 0], [0, 0, 0], [0, -0.02, 0]]}}]')" '' 0.06
cornered() {
    limited "$DUITE_CLOTH" onto.yaml > said 2>&1
    test $? = 1 && grep -q "pairs of features cannot be kept apart.*, the first of them at vertices .*36 (pinned) of " said
}
ok "of the pairs of a meeting one that fails is named" cornered

# Blocks meet across ranks, and balancers move them; with DUITE_LONG=1 the wrung one is solved again and cut.
cd "$OLDPWD" || exit 99
if quick; then
    ok "one hash: two sheets over a box, few" ranks 4 tests/whole/same_hash "$scratch/pair.yaml" few 0 time.end=0.12
else
    ok "one hash: two sheets over a box, some" ranks 4 tests/whole/same_hash "$scratch/pair.yaml" some 0 time.end=0.15
fi
if test "${DUITE_LONG:-}" = 1; then
    ok "one hash: a sheet that is wrung, few" ranks 4 tests/whole/same_hash "$scratch/wring.yaml" few 0 time.end=0.4 grain=60
    ok "one hash: a sheet that is wrung, some" ranks 4 tests/whole/same_hash "$scratch/wring.yaml" some 0 time.end=0.5 grain=60
fi
