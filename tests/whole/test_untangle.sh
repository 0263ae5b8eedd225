#!/bin/sh
# contact.untangle: starts that are tangled are made free and then run certified; free ones keep every bit; what cannot be untangled is
# refused with its pairs named.
. "${srcdir:-.}/tests/support/tap.sh"
. "$srcdir/tests/support/bodies.sh"
skip_unless "$DUITE_CLOTH"
plan_later
cd "$scratch" || exit 99

# scene NAME CLOTHS OBSTACLES
scene() {
    cat > "$1.yaml" << END
schema: 1
name: $1
cloths:
$2
materials: {m: {density: 0.2, stretch: 500, damping: {stiffness: 0.01}}}
contact: {mode: certified, self: on, thickness: 0.002, untangle: on}
obstacles: [$3]
gravity: [0, -1, 0]
time: {h: 0.005, end: 0.01, fps: 100}
grain: 100
END
}
sheet() { # NAME HEIGHT MORE
    printf '  - {name: %s, material: m, mesh: {grid: {width: 0.2, height: 0.2, nx: 21, ny: 21}}, transform: {translate: [0, %s, 0]}%s}\n' "$@"
}
waves() { # along x, along z, their height
    printf ', start: [{box: [[-1, -1, -1], [1, 1, 1]], wave: {vector: [%s, 0, %s], phase: 0.2, translate: [0, %s, 0]}}]' "$@"
}
between() { awk -v x="$2" -v a="$1" -v b="$3" 'BEGIN { print "#", x, "of", a, "to", b; exit !(x >= a && x <= b) }'; }
fine() { # SCENE OPTION...: it runs, and nothing is in anything from the first frame on
    limited "$DUITE_CLOTH" "$@" --threads 1 --check-intersections --report report.json --quiet
}
freed() { # SCENE LEAST MOST: it was tangled, and the largest move of a vertex (mm) is between these
    ! limited "$DUITE_CLOTH" "$1" --threads 1 --quiet --set contact.untangle=off && fine "$1" && between 1 "$(value untangle_rounds)" 20 &&
        between 1 "$(value untangle_vertices)" 800 && between "$2e-3" "$(value untangle_largest)" "$3e-3"
}

# Waves of 3.5 mm, 4 mm apart: they go through each other by 3 mm in several places.
scene waves "$(sheet a 0 "$(waves 6 4 0.0035)")
$(sheet b 0.004 "$(waves -5 6 0.0035)")"
ok "two sheets through each other" freed waves.yaml 1.5 4
scene ball "$(sheet a 0.096)" 'sphere: {centre: [0.02, 0, 0.01], radius: 0.1}'
ok "a ball in a sheet" freed ball.yaml 4 6
scene corner "$(sheet a 0.083)" 'box: {centre: [0.01, 0, 0.02], size: [0.1, 0.1, 0.1], rotate: [0.880476, 0.279848, 0, 0.364705]}'
ok "the corner of a box in a sheet" freed corner.yaml 1 8

# The same box as a body of twelve triangles, whose corner is in no vertex of the sheet.
box_obj -0.5 -0.5 -0.5 0.5 0.5 0.5 > cube.obj
scene body "$(sheet a 0.083)" 'body: {obj: cube.obj, scale: 0.1, rotate: [0.880476, 0.279848, 0, 0.364705], translate: [0.01, 0, 0.02]}'
ok "the corner of a body in a sheet" freed body.yaml 0.3 8

# A sheet folded over, 6 mm from itself, that dips through itself by 4 mm in two places.
awk 'BEGIN { n = 40; r = 0.003; w = 0.2
    for (i = 0; i <= n; i++) for (j = 0; j <= n; j++) {
        s = w * i / n - w / 2; z = w * j / n; bend = 1.5708 * r
        if (s < -bend) { x = s + bend; y = -r }
        else if (s > bend) { x = bend - s; y = r - 0.01 * (exp(-((x + 0.04) ^ 2 + (z - 0.07) ^ 2) / 0.0002) + exp(-((x + 0.07) ^ 2 + (z - 0.15) ^ 2) / 0.0002)) }
        else { x = r * cos(s / r); y = r * sin(s / r) }
        printf "v %.9f %.9f %.9f\n", x, y, z }
    for (i = 0; i < n; i++) for (j = 0; j < n; j++) { k = i * (n + 1) + j + 1; print "f", k, k + 1, k + n + 2; print "f", k, k + n + 2, k + n + 1 } }' > fold.obj
scene fold '  - {name: a, material: m, mesh: {file: fold.obj}}'
ok "a folded sheet through itself" freed fold.yaml 2 5

# The higher one is inside, free of the lower one.
scene layers "$(sheet inner 0.004 ', layer: 1')
$(sheet outer 0 ', layer: 2')"
layers() {
    fine layers.yaml --output out && test "$(value untangle_rounds)" -gt 0 && between 4.5e-3 "$(value untangle_largest)" 8e-3 &&
        fine layers.yaml --set 'cloths[0].layer=2' && test "$(value untangle_rounds)" = 0
}
ok "the outer cloth starts inside the inner one" layers

scene free "$(sheet a 0)
$(sheet b 0.004)" 'sphere: {centre: [0.02, -0.102, 0.01], radius: 0.1}'
unchanged() {
    fine free.yaml && test "$(value untangle_rounds) $(value untangle_vertices)" = "0 0" && hash=$(value state_hash) &&
        fine free.yaml --set contact.untangle=off && test "$(value state_hash)" = "$hash"
}
ok "a free start keeps every bit" unchanged

scene cross "$(sheet a 0)
$(sheet b 0.001 ', start: [{box: [[-1, -1, -1], [1, 1, 1]], rotate: [1, 1, 0, 0]}]')"
hopeless() {
    limited "$DUITE_CLOTH" cross.yaml --threads 1 --quiet 2> said
    test $? = 2 && grep -q "triangle .* of cloth 'a' and triangle .* of cloth 'b' intersect" said && grep -q "contact.untangle: after 60 rounds [1-9]" said
}
ok "sheets that cross from end to end" hopeless
scene pinned "$(sheet a 0 ', pins: [{box: [[-1, -1, -1], [1, 1, 1]]}]')
$(sheet b 0.0001 ', pins: [{box: [[-1, -1, -1], [1, 1, 1]]}]')"
too_near() {
    limited "$DUITE_CLOTH" pinned.yaml --threads 1 --quiet 2> said
    test $? = 2 && grep -q "nearer than a tenth of the thickness, the first of them at vertices [0-9]* of '[ab]'" said
}
ok "pins too near to each other" too_near

one_hash() {
    fine waves.yaml --set contact.thickness=0.0018 && hash=$(value state_hash) &&
        ranks 3 "$DUITE_CLOTH" waves.yaml --set contact.thickness=0.0018 --threads 2 --quiet --report report.json && test "$(value state_hash)" = "$hash"
}
ok "one hash" one_hash
