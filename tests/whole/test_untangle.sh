#!/bin/sh
# contact.untangle: starts that are tangled are made free and then run certified; free ones keep every bit; what cannot be untangled is
# refused with its pairs named.
. "${srcdir:-.}/tests/support/cloth.sh"
. "$srcdir/tests/support/bodies.sh"

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

# Two halves of a sheet, the second of which is inside out; a sheet 3 mm above both goes through that one alone.
awk 'BEGIN { for (half = 0; half < 2; half++) {
        for (i = 0; i < 11; i++) for (j = 0; j < 21; j++) printf "v %.9f 0 %.9f\n", 0.01 * i + 0.11 * half - 0.105, 0.01 * j - 0.1
        for (i = 0; i < 10; i++) for (j = 0; j < 20; j++) {
            a = 231 * half + 21 * i + j + 1; b = a + 1; c = a + 22; d = a + 21
            print half ? "f " a " " c " " b "\nf " a " " d " " c : "f " a " " b " " c "\nf " a " " c " " d } } }' > halves.obj
scene halves "  - {name: shirt, material: m, mesh: {file: halves.obj}, layer: 1}
$(sheet jacket 0.003 ', layer: 2')"
turned() { # N SCENE: so many parts are said to be inside out
    turned_n=$1
    shift
    fine "$@" > said 2>&1 || { cat said && return 1; }
    cat said
    test "$(grep -c 'inside out' said)" = "$turned_n"
}
inside_out() {
    turned 1 halves.yaml && grep -q "the part of 231 vertices with vertex 232 of 'shirt' (counted from 1) faces away from 'jacket'" said
}
ok "the part that is inside out is named" inside_out
swapped() {
    turned 1 layers.yaml && grep -q "the part of 441 vertices with vertex 1 of 'inner'" said && turned 0 layers.yaml --set 'cloths[0].layer=2' && turned 0 waves.yaml
}
ok "so is a cloth with the outer one in it, and no other" swapped

# The outer cloth is held below the inner one, beside it, so that edges there reach up to its other side.
scene held "  - {name: inner, material: m, mesh: {grid: {width: 0.09, height: 0.24, nx: 10, ny: 25}}, layer: 1}
$(sheet outer -0.045 ', layer: 2, pins: [{box: [[-1, -1, -1], [-0.055, 1, 1]]}, {box: [[0.055, -1, -1], [1, 1, 1]]}]')"
stretched() {
    limited "$DUITE_CLOTH" held.yaml --set contact.thickness=0.004 --report report.json --quiet > said 2>&1 || { cat said && return 1; }
    cat said
    between 3 "$(value untangle_stretch)" 5 &&
        grep -Eq "contact.untangle made the edge between vertices [0-9]+ of 'outer' and [0-9]+ of 'outer' [34][.][0-9]* times as long" said
}
ok "edges that it makes three times as long are warned of" stretched
modest() {
    fine waves.yaml > said 2>&1 && between 1 "$(value untangle_stretch)" 2 && ! grep "times as long" said
}
ok "others are not" modest

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

# Without untangling: two sheets far nearer than a tenth of the thickness, on a box, where floats tell them apart and where they do not.
scene close "$(sheet a 0.0001)
$(sheet b 0.0002)" 'box: {centre: [0, -0.05, 0], size: [0.3, 0.1, 0.3]}'
parts() { # what is 0.1 mm from the next, 0.05 of the thickness, is parted at no more than 0.2 m/s
    limited "$DUITE_CLOTH" close.yaml --set contact.untangle=off --set time.end=0.1 --check-intersections --report report.json --quiet --output parted \
        --set 'probes=[{cloth: b, vertices: [220], values: [position, velocity]}]' || return 1
    awk -F, 'NR > 1 { most = $14 > most ? $14 : most; y = $11 } END { print "#", most, "m/s,", y, "m in the end"; exit !(most < 0.2 && y > 0.002 && y < 0.005) }' parted/probes.csv
}
ok "a start much nearer than a tenth of the thickness is parted" parts
unwritten() { # 1e-8 m at a height of 1 m
    sed 's/0.0001,/1.00000001,/; s/0.0002,/1.00000002,/; s/-0.05,/0.95,/' close.yaml > high.yaml
    limited "$DUITE_CLOTH" high.yaml --set contact.untangle=off --quiet > said 2>&1
    unwritten_got=$?
    cat said
    test $unwritten_got = 2 && grep -q "frame 0 as written, at 0 s: triangle .* of cloth 'a' and triangle .* of cloth 'b' intersect" said &&
        grep -q 'so near to each other that frames, whose numbers are floats, have them in one place: move them apart, or write contact: {untangle: on}' said &&
        fine high.yaml
}
ok "one that floats cannot tell apart is refused" unwritten

one_hash() {
    fine waves.yaml --set contact.thickness=0.0018 && hash=$(value state_hash) &&
        ranks 3 "$DUITE_CLOTH" waves.yaml --set contact.thickness=0.0018 --threads 2 --quiet --report report.json && test "$(value state_hash)" = "$hash"
}
ok "one hash" one_hash
