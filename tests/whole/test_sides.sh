#!/bin/sh
# Sides that a scene names: two with a friction of their own, and cloths, obstacles and groups that do not meet, by certified contact and by
# projection, on every rank, for who checks intersections, and for who reads the frames.
. "${srcdir:-.}/tests/support/probes.sh"

# ---- Friction of two ----
cat > slide.yaml << 'END'
schema: 1
gravity: [4, -9.81, 0]
cloths: [{mesh: {grid: {width: 0.2, height: 0.2, nx: 8, ny: 8}}, transform: {translate: [0, 0.0011, 0]}, material: m}]
materials: {m: {density: 0.2, stretch: 1000, shear: 300, friction: 0.25}}
obstacles: [{plane: {point: [0, 0, 0], normal: [0, 1, 0], friction: 0.25, name: slope}}]
contact: {mode: certified}
time: {h: 0.005, end: 0.1}
grain: 20
END
hash() { "$@" --quiet --report report.json && value state_hash; }
alike() { # the coefficient that 0.25 and 0.25 make
    wanted=$(hash limited "$DUITE_CLOTH" slide.yaml)
    set -- slide.yaml --set materials.m.friction=0.9 --set 'obstacles[0].plane.friction=0.7' --set 'contact.pairs=[{of: [slope, m], friction: 0.25}]'
    one=$(hash limited "$DUITE_CLOTH" "$@") && two=$(hash ranks 2 "$DUITE_CLOTH" "$@") &&
        other=$(hash limited "$DUITE_CLOTH" "$@" --set 'contact.pairs=[{of: [m, slope], friction: 0.26}]') &&
        echo "$wanted $one $two, not $other" && test -n "$wanted" && test "$wanted" = "$one" && test "$wanted" = "$two" && test "$wanted" != "$other"
}
ok "contact.pairs replace what the coefficients of two make, on every rank" alike

# ---- What does not meet: a sheet falls through another one into a ball, 15 steps of 10 ms ----
cat > sides.yaml << 'END'
schema: 1
cloths:
  - {name: lower, mesh: {grid: {width: 0.2, height: 0.2, nx: 6, ny: 6}}, transform: {translate: [0, 0.1, 0]}, material: m, pins: [{box: [[-1, -1, -1], [1, 1, 1]]}]}
  - {name: upper, groups: [veil, light], mesh: {grid: {width: 0.2, height: 0.2, nx: 6, ny: 6}}, transform: {translate: [0.01, 0.12, 0.01]}, material: m}
materials: {m: {density: 0.2, stretch: 1000, shear: 300}}
obstacles:
  - sphere: {centre: [0, 0, 0], radius: 0.05, name: ball}
  - plane: {point: [0, -0.1, 0], normal: [0, 1, 0], groups: [light]}
contact: {ignore: [[light, lower], [ball, veil]]}
time: {h: 0.01, end: 0.15, fps: 20}
solver: {stop: {relative: 1.0e-10}}
probes: [{name: p, cloth: upper, vertices: [0, 14], values: [position]}]
grain: 20
END
fell() { # metres, of both: the formula of implicit Euler, to rounding
    set -- $(last p.0.y p.14.y)
    awk -v a="$1" -v b="$2" 'BEGIN { y = 0.12 - 9.81 * 1e-4 * 15 * 16 / 2; a -= y; b -= y; print a, b; exit !(a * a + b * b < 1e-16) }'
}
falls() { run sides.yaml --report report.json "$@" && fell; }
ok "cloths that are told to do not meet, nor obstacles" falls --check-intersections
ok "by projection likewise" falls --set contact.mode=project
stopped() { run sides.yaml --set 'contact.ignore=[]' --set contact.mode="$1" && ! fell; }
ok "others do, certified" stopped certified
ok "and by projection" stopped project
everywhere() { one=$(hash limited "$DUITE_CLOTH" sides.yaml "$@") && two=$(hash ranks 2 "$DUITE_CLOTH" sides.yaml "$@") && echo "$one $two" && test -n "$one" && test "$one" = "$two"; }
ok "on every rank" everywhere
ok "on every rank by projection" everywhere --set contact.mode=project
framed() { # 15 steps end with the sheet in the ball: its folder says what did not meet
    run sides.yaml && limited "$DUITE_VIEW" out --check-intersections > said 2>&1 || { cat said; return 1; }
    sed '/"apart"/d; s/^  \],$/  ]/' out/scene.json > changed && mv changed out/scene.json
    limited "$DUITE_VIEW" out --check-intersections > said 2>&1
    test $? = 4 && grep 'with obstacles' said
}
ok "frames tell what does not meet" framed
nobody() { # names that leave nothing out, as obstacles do not meet: the folder can be read
    run sides.yaml --set 'contact.ignore=[[ball, ground]]' --set 'obstacles[1].plane.name=ground' && limited "$DUITE_VIEW" out --check-intersections > said 2>&1 || { cat said; return 1; }
}
ok "frames tell that nothing is left out" nobody
crossed() { # a cloth of two squares that cross
    cat > crossed.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
cloths:
  - {name: a, material: m, mesh: {inline: {vertices: [[0, 0, 0], [1, 0, 0], [0, 0, 1], [0.2, -1, 0.2], [0.3, 1, 0.2], [0.2, 1, 0.3]], triangles: [[0, 1, 2], [3, 4, 5]]}}}
materials: {m: {density: 0.2, stretch: 1000}}
contact: {self: on, ignore: [[a, a]]}
time: {h: 0.01, end: 0.05}
END
    run crossed.yaml --check-intersections --report report.json && ! run crossed.yaml --set 'contact.ignore=[]' > said 2>&1 && grep 'go through each other' said
}
ok "a cloth that does not meet itself" crossed
unasked() { # with self: off it may start so; who looks for intersections sees them
    run crossed.yaml --set contact='{mode: certified, self: off}' --report report.json && ! run crossed.yaml --set contact='{mode: certified, self: off}' --check-intersections > said 2>&1 && grep 'triangles intersect' said
}
ok "nor is asked to" unasked

# ---- Joints: cloths that they pull together end a thickness apart ----
cat > joined.yaml << 'END'
schema: 1
cloths:
  - {name: front, mesh: {grid: {width: 0.2, height: 0.1, nx: 8, ny: 4}}, material: m, pins: [{vertices: [0, 7]}]}
  - {name: back, mesh: {grid: {width: 0.2, height: 0.1, nx: 8, ny: 4}}, material: m, transform: {translate: [0, -0.02, 0]}}
joints: [{from: {cloth: front, vertices: [24, 25, 26, 27, 28, 29, 30, 31]}, to: {cloth: back, vertices: [24, 25, 26, 27, 28, 29, 30, 31]}, stiffness: 50, damping: 0.05, length: 0}]
materials: {m: {density: 0.2, stretch: 1000, shear: 300, damping: {mass: 5, stiffness: 0.004}}}
time: {h: 0.005, end: 0.3}
probes: [{name: p, cloth: front, vertices: [26], values: [position]}, {name: q, cloth: back, vertices: [26], values: [position]}]
END
joined() {
    run joined.yaml --check-intersections && set -- $(last p.26.x p.26.y p.26.z q.26.x q.26.y q.26.z) &&
        awk -v x=$(less $1 $4) -v y=$(less $2 $5) -v z=$(less $3 $6) 'BEGIN { d = sqrt(x * x + y * y + z * z); print "apart " d; exit !(d > 1e-4 && d < 3e-3) }'
}
ok "joined cloths end a thickness apart" joined
