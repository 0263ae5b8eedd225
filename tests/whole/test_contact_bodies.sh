#!/bin/sh
# Certified contact with bodies: what rests, slides and is carried against closed forms; a drape against that on the shape which the body
# nearly is; nothing goes through bodies that stand still, move and turn; one state_hash; the real body where it is.
. "${srcdir:-.}/tests/support/tap.sh"
same_hash=$PWD/tests/whole/same_hash
skip_unless "$same_hash"
. "$srcdir/tests/support/bodies.sh"
. "$srcdir/tests/support/probes.sh"
plan_later

slab_obj 40 > slab.obj
apart() { awk -v a="$1" -v b="$2" 'BEGIN { print (a > b ? a - b : b - a) }'; }
# A ball of 0.15 m, of 64 x 32 quads with two poles.
awk 'BEGIN { t = atan2(0, -1); n = 64; m = 32; print "v 0 0.15 0"; print "v 0 -0.15 0"
    for (i = 0; i < n; i++) for (j = 1; j < m; j++) {
        far = 0.15 * sin(t * j / m); printf "v %.12f %.12f %.12f\n", far * cos(2 * t * i / n), 0.15 * cos(t * j / m), far * sin(2 * t * i / n) }
    for (i = 0; i < n; i++) { a = 2 + i * (m - 1); b = 2 + (i + 1) % n * (m - 1)
        print "f", 1, b + 1, a + 1; print "f", 2, a + m - 1, b + m - 1
        for (j = 1; j < m - 1; j++) print "f", a + j, b + j, b + j + 1, a + j + 1 } }' > ball.obj
ring_obj 0.15 0.05 > ring.obj

# scene NAME SIDE N HIGH FRICTION END OBSTACLES MORE
scene() {
    cat > "$1.yaml" << END
schema: 1
name: $1
cloths: [{name: sheet, material: m, mesh: {grid: {width: $2, height: $2, nx: $3, ny: $3}}, transform: {translate: [0, $4, 0], rotate: [1, 0, 0.15, 0]}}]
materials: {m: {density: 0.2, stretch: 500, shear: 50, damping: {stiffness: 0.02}}}
contact: {mode: certified, self: on, thickness: 0.003, friction: $5}
time: {h: 0.01, end: $6, fps: 100}
obstacles: [$7]
probes: [{name: p, vertices: [0, $(($3 * $3 / 2))], values: [position]}]
grain: 40
$8
END
}

scene rest 0.2 11 0.004 0 0.4 'body: {obj: slab.obj}'
rests() { # what it presses is on the multiplier, so the gap is the thickness
    run rest.yaml && set -- $(last p.0.y p.60.y) && below "a corner" "$(apart "$1" 0.003)" 3e-5 && below "the middle" "$(apart "$2" 0.003)" 3e-5
}
ok "a sheet rests on a body" rests

# Down a slope, over dozens of triangles, without friction by g sin(30 degrees), which implicit steps sum up to a h^2 n (n + 1) / 2; with
# it in test_capstan.sh.
slope='gravity: [4.905, -8.495709211, 0]'
scene slope 0.2 11 0.003 0 0.3 'body: {obj: slab.obj, translate: [0.3, 0, 0.05]}' "$slope"
slides() { # edges that are crossed do not hold it up
    run slope.yaml && set -- $(last p.60.x p.60.y) && near "the way down the slope" "$1" 0.2280825 2e-4 && near "the height" "$2" 0.003 1e-3
}
ok "a sheet slides over a body" slides

# A slab that moves and rises from the start on: the sheet slips a little, then it is carried.
scene carried 0.2 11 0.003 0.5 0.3 'body: {obj: slab.obj, motion: {times: [0, 1], translate: [[0, 0, 0], [0.3, 0.1, 0]]}}'
sed 's/body: {obj: slab.obj,/box: {centre: [0, -0.05, 0], size: [1.2, 0.1, 1.2],/' carried.yaml > carrier.yaml
carries() {
    run carrier.yaml && set -- $(last p.60.x) && run carried.yaml && set -- "$1" $(last p.60.x p.60.y) &&
        near "the way" "$2" "$1" 0.02 && near "the height" "$3" 0.033 1e-3
}
ok "a body carries a sheet" carries

# A sheet of 9 vertices comes down on 49 quads of a body: ten pairs fail a vertex of it, but not of both. The step is solved once more.
slab_obj 60 > fine.obj
scene fast 0.2 3 0.008 0.3 0.1 'body: {obj: fine.obj}' 'gravity: [0, 0, 0]'
fast() {
    run fast.yaml --report report.json --set 'cloths[0].velocity=[0, -2, 0]' --set time.h=0.005 || return 1
    grep -E '"(contact_solves|steps_halved)"' report.json
    test "$(value steps_halved)" = 0 && test "$(value contact_solves)" -gt 0
}
ok "a coarse sheet comes down on a fine body" fast

scene ball 0.4 21 0.16 0.3 0.3 'body: {obj: ball.obj}'
sed 's/body: .*\]/sphere: {centre: [0, 0, 0], radius: 0.15}]/' ball.yaml > sphere.yaml
alike() { # the mesh is within 0.2 mm of the ball
    run sphere.yaml && set -- $(last p.0.x p.0.y p.0.z p.220.y) && run ball.yaml && set -- "$@" $(last p.0.x p.0.y p.0.z p.220.y) &&
        below "x of a corner" "$(apart "$5" "$1")" 0.006 && below "y of it" "$(apart "$6" "$2")" 0.006 && below "z of it" "$(apart "$7" "$3")" 0.006 &&
        below "y of the middle" "$(apart "$8" "$4")" 0.0005
}
ok "a drape on a ball is as on a sphere" alike

# Two rings, of which one rises and turns through the sheet's place while the other stands still below it.
scene rings 0.5 20 0.1 0.5 0.4 'body: {obj: ring.obj, motion: {times: [0, 0.5], translate: [[0, 0, 0], [0.05, 0.15, 0]], rotate: [[1, 0, 0, 0], [1, 0.2, 0.5, 0]]}},
  body: {obj: ring.obj, scale: 0.5, rotate: [1, 1, 0, 0], translate: [0, -0.1, 0]}'
through() { # SCENE OPTION...: nothing is
    limited "$DUITE_CLOTH" "$@" --threads 1 --check-intersections --report report.json --quiet
}
ok "rings that move and turn" through rings.yaml
ok "one hash" ranks 3 "$same_hash" rings.yaml few 0 time.end=0.12
stands() { ranks 2 "$same_hash" ball.yaml few 0 time.end=0.08; }
ok "one hash on a body that stands still" stands

# An open surface is a cloth that is held: a bowl that turns and rises below a sheet.
awk 'BEGIN {
    n = 16; m = 8; pi = 3.14159265358979
    for (j = 0; j <= m; j++) for (i = 0; i < (j ? n : 1); i++) { t = j / m * pi / 2; p = 2 * pi * i / n
        print "v", 0.2 * sin(t) * cos(p), -0.2 * cos(t), 0.2 * sin(t) * sin(p) }
    for (i = 0; i < n; i++) print "f", 1, 2 + i, 2 + (i + 1) % n
    for (j = 0; j < m - 1; j++) for (i = 0; i < n; i++) { a = 2 + j * n + i; b = 2 + j * n + (i + 1) % n; print "f", a, a + n, b + n, b }
}' > bowl.obj
cat > bowl.yaml << 'END'
schema: 1
cloths:
  - {name: sheet, mesh: {grid: {width: 0.5, height: 0.5, nx: 20, ny: 20}}, material: silk, transform: {translate: [0, 0.02, 0]}}
  - name: bowl
    mesh: {file: bowl.obj}
    material: silk
    pins: [{box: [[-1, -1, -1], [1, 1, 1]], motion: {times: [0, 1], translate: [[0, 0, 0], [0, 0.1, 0]], rotate: [{axis: [0, 1, 0], turns: 0}, {axis: [0, 1, 0], turns: 1}]}}]
contact: {mode: certified, self: on}
time: {h: 0.01, end: 0.5, fps: 25}
grain: 60
END
caught() { through bowl.yaml && echo "$(value contacts) contacts" && test "$(value intersections)" = 0 && test "$(value contacts)" -gt 20; }
ok "a sheet falls into an open bowl that turns" caught
ok "one hash" ranks 2 "$same_hash" bowl.yaml few 0 time.end=0.2

# Over the head of the body of others, in decimetres.
real=$srcdir/../shared/data/body/female_generic.obj
if test -r "$real" && ! quick; then
    scene real 0.4 24 0.8 0.3 0.25 "body: {obj: $real, scale: 0.1}"
    sed -i 's/translate: \[0, 0.8, 0\]/translate: [0.02, 0.8, 0.05]/; s/grain: 40/grain: 150/' real.yaml
    for h in 0.004 0.01; do
        ok "the real body by steps of $h s" through real.yaml --set time.h=$h --set time.fps=25
    done
else
    skip "the real body" "its mesh is not here, or quick tests are wanted"
fi
