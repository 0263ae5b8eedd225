#!/bin/sh
# Contact by springs, contact.mode: repulsion: what rests on a plane, slides and creeps on it against closed forms, also where the plane is carried
# along; a sheet comes to rest; two cloths that meet keep their momentum; a sheet stays out of a ball; one state_hash.
. "${srcdir:-.}/tests/support/probes.sh"
. "$srcdir/tests/support/bodies.sh"

cat > rest.yaml << END
schema: 1
name: rest
cloths: [{name: a, material: m, mesh: {grid: {width: 0.1, height: 0.1, nx: 4, ny: 4}}, transform: {translate: [0, 0.0015, 0]}}]
materials: {m: {density: 0.2, stretch: 10, shear: 3}}
obstacles: [{plane: {point: [0, 0, 0], normal: [0, 1, 0]}}]
contact: {mode: repulsion, thickness: 0.002, stiffness: 5}
probes: [{name: p, cloth: a, vertices: [0, 5], values: [position, velocity]}]
time: {h: 0.001, end: 1, fps: 20}
END
# A vertex of mass m rests at d - m g / k: one inside the sheet has 0.2 kg/m2 of a cell, one at a corner a quarter of that. In h^2 k / m = 0.02 of a
# corner steps of 1 ms are short, those of 4 ms by implicit Euler are not.
high() { awk -v m="$1" 'BEGIN { printf "%.15g", 0.002 - m * 0.2 * 0.1 * 0.1 / 9 * 9.81 / 5 }'; }
rests() { # NAME KEY=VALUE...; a row of a table where it has a name
    name=$1
    shift
    for set; do set -- "$@" --set "$set"; shift; done
    run rest.yaml "$@" && near "inside" "$(last p.5.y)" "$(high 1)" 1e-5 && near "at a corner" "$(last p.0.y)" "$(high 0.25)" 1e-5 || return 1
    test -z "$name" || row "a sheet rests on a level plane, $name: heights inside and at a corner" "d − m g / k"
}
ok "rests, implicit Euler" rests '`implicit_euler`, h = 4 ms' time.h=0.004
ok "rests, BDF2" rests '`bdf2`, 1 ms' integrator=bdf2
ok "rests, with Newton steps" rests '' newton.steps=4
ok "rests, with sliders" rests '' time.h=0.004 'cloths[0].pins=[{vertices: [0], to: plane, normal: [1, 0, 0]}]'
ok "rests, Verlet" rests '`verlet`, 1 ms' integrator=verlet
ok "rests, RK4" rests '`rk4`, 1 ms' integrator=rk4
ok "rests, symplectic Euler" rests '`symplectic_euler`, 1 ms' integrator=symplectic_euler
carried='obstacles[0].plane.motion={times: [0, 1], translate: [[0, 0, 0], [0.3, 0.1, 0]]}'
lifts() { # NAME OPTION...
    name=$1
    shift
    run rest.yaml --set "$carried" "$@" && near "inside" "$(less "$(last p.5.y)" 0.1)" "$(high 1)" 1e-4 &&
        row "the same on a plane that rises at 0.1 m/s, $name: height above it inside" "d − m g / k"
}
ok "rests on what rises, implicit Euler" lifts '`implicit_euler`, 4 ms' --set time.h=0.004
ok "rests on what rises, RK4" lifts '`rk4`, 1 ms' --set integrator=rk4

# Two layers vibrate by sqrt(4 k / m) at most, m = 0.125 g: with k = 200 N/m that is 2530 rad/s, too fast for 1 ms.
warns() { # INTEGRATOR STIFFNESS
    limited "$DUITE_CLOTH" rest.yaml --set "integrator=$1" --set "contact={mode: repulsion, damping: 0, thickness: 0.002$2}" --set time.end=0.001 --quiet > said 2>&1 || return 1
    cat said
    grep -q 'steps of 0.001 s are beyond what contacts of stiffness' said
}
quiet() { ! warns "$@"; }
ok "contacts too stiff for Verlet's steps" warns verlet ', stiffness: 200'
ok "as stiff as they are by default" quiet verlet ''
ok "too stiff, by implicit Euler" quiet implicit_euler ', stiffness: 200'

# On a slope, which gravity makes of the plane. Below Coulomb's angle the sheet creeps: 16 vertices resist by k h each, while none has to give more than
# its weight allows. Beyond it slides.
pulled() { # TAN MORE...
    pulled_g=$(awk -v t="$1" 'BEGIN { c = 9.81 / sqrt(1 + t * t); printf "[%.15g, %.15g, 0]", t * c, -c }')
    shift
    run rest.yaml --set contact.friction=0.5 --set "gravity=$pulled_g" "$@"
}
creeps() { # NAME OPTION...
    name=$1
    shift
    pulled 0.1 "$@" && near "creeps, m/s" "$(last p.5.vx)" "$(awk 'BEGIN { printf "%.15g", 0.2 * 0.01 * 9.81 * 0.1 / sqrt(1.01) / (16 * 5 * 0.001) }')" 1e-4 && row "on a slope of tan α = 0.1, μ = 0.5, 16 vertices, \`$name\`: creeps" "M g sin α / (16 k h)"
}
ok "creeps, implicit Euler" creeps implicit_euler
ok "creeps, RK4" creeps rk4 --set integrator=rk4
slides() { # NAME OPTION...
    name=$1
    shift
    pulled 0.6 "$@" && near "slides, m/s2" "$(rows 'c("time") >= 0.5 && !t { t = c("time"); v = c("p.5.vx") } END { printf "%.15g", (c("p.5.vx") - v) / (c("time") - t) }')" \
        "$(awk 'BEGIN { printf "%.15g", 9.81 * (0.6 - 0.5) / sqrt(1.36) }')" 5e-3 && row "on a slope of tan α = 0.6, $name: acceleration" "g (sin α − μ cos α)"
}
ok "slides, implicit Euler, 4 ms" slides '`implicit_euler`, 4 ms' --set time.h=0.004
ok "slides, Verlet" slides '`verlet`, 1 ms' --set integrator=verlet
is_carried() { run rest.yaml --set contact.friction=0.5 --set "$carried" --set time.h=0.004 && near "its speed" "$(last p.5.vx)" 0.3 1e-3; }
ok "is carried along" is_carried

# Two sheets meet off the middle; nothing holds them.
cat > meet.yaml << END
schema: 1
name: meet
cloths:
  - {name: a, material: m, mesh: {grid: {width: 0.1, height: 0.1, nx: 8, ny: 8}}, transform: {translate: [0, 0.01, 0]}, velocity: [0, -0.5, 0]}
  - {name: b, material: m, mesh: {grid: {width: 0.1, height: 0.1, nx: 9, ny: 9}}, transform: {translate: [0.01, 0, 0.013]}, velocity: [0.1, 0, 0]}
materials: {m: {density: 0.2, stretch: 100, shear: 30, bend: 1, friction: 0.3, damping: {stiffness: 0.0005}}}
gravity: [0, 0, 0]
contact: {mode: repulsion, thickness: 0.002}
time: {h: 0.0002, end: 0.05, fps: 100}
grain: 20
probes: [{name: a, cloth: a, box: [[-1, -1, -1], [1, 1, 1]], values: [velocity]}, {name: b, cloth: b, box: [[-1, -1, -1], [1, 1, 1]], values: [velocity]}]
END
# Masses go by cells: corners have one quarter of a cell, borders two, all others four.
momentum() {
    rows 'function mass(n, i) { return (i % n && i % n < n - 1 ? 2 : 1) * (i >= n && i < n * (n - 1) ? 2 : 1) / (4 * (n - 1) * (n - 1)) }
        function all(of, n, axis,   i) { for (i = 0; i < n * n; i++) sum += mass(n, i) * c(of "." i "." axis) }
        END { all("a", 8, axis); all("b", 9, axis); printf "%.15g", sum }' -v axis="$1"
}
met() { # NAME OPTION...: the upper one came on the lower one, which took some of its motion, and both momenta are there
    name=$1
    shift
    limited "$DUITE_CLOTH" meet.yaml --check-intersections --report report.json --quiet --threads 1 --output out "$@" || return 1
    below "the momentum down" "$(less "$(momentum vy)" -0.5)" 1e-12 && below "and back" "$(less -0.5 "$(momentum vy)")" 1e-12 &&
        below "that along" "$(less "$(momentum vx)" 0.1)" 1e-12 && below "and back" "$(less 0.1 "$(momentum vx)")" 1e-12 && row "two sheets meet in free flight, \`$name\`: momentum, of a sheet's mass and 1 m/s" "kept" &&
        below "the middle of the lower one goes down" "$(last b.40.vy)" -0.1
}
ok "two sheets meet, implicit Euler" met implicit_euler --set time.h=0.001 --set 'solver={stop: {relative: 1e-14}}'
ok "two sheets meet, symplectic Euler" met symplectic_euler --set integrator=symplectic_euler
ok "two sheets meet, RK4" met rk4 --set integrator=rk4

# The same, and a sheet on a ball that folds onto itself.
cat > ball.yaml << END
schema: 1
name: ball
cloths: [{name: a, material: m, mesh: {grid: {width: 0.3, height: 0.3, nx: 16, ny: 16}}, transform: {translate: [0.01, 0.105, 0.02]}}]
materials: {m: {density: 0.2, stretch: 1000, shear: 300, bend: 1, damping: {viscous: 2e-5, stiffness: 0.004}}}
obstacles: [{sphere: {centre: [0, 0, 0], radius: 0.1}}]
contact: {mode: repulsion, self: on, thickness: 0.003, friction: 0.3}
time: {h: 0.004, end: 0.4, fps: 50}
grain: 60
END
ok "a sheet on a ball" limited "$DUITE_CLOTH" ball.yaml --check-intersections --quiet
# By long implicit steps, with contacts far stiffer than a vertex is heavy, it comes to rest.
settles() {
    limited "$DUITE_CLOTH" ball.yaml --quiet --report report.json --threads 1 --set contact.self=off \
        --set 'obstacles=[{capsule: {from: [-1, 0, 0], to: [1, 0, 0], radius: 0.1}}]' \
        --set 'materials.m.damping={stiffness: 0.004, mass: 10}' --set 'time={h: 0.02, end: 3, energy_growth: 0, rest: {speed: 0.01}}' || return 1
    below "comes to rest, s" "$(sed -n 's/.*"rest_seconds": \([0-9.]*\).*/\1/p' report.json)" 2.9
}
ok "comes to rest on a bar" settles
# A block as a body, which moves up.
box_obj -1 0 -1 1 1 1 > block.obj
block='obstacles[0]={body: {obj: block.obj, translate: [0, -1, 0], motion: {times: [0, 1], translate: [[0, 0, 0], [0, 0.1, 0]]}}}'
lifts_on() { run rest.yaml --set "$block" "$@" && near "inside" "$(less "$(last p.5.y)" 0.1)" "$(high 1)" 1e-4; }
ok "rests on a body that rises" lifts_on --set time.h=0.004
cd "$OLDPWD" || exit 99
ok "one hash: a sheet on a ball" ranks 3 tests/whole/same_hash "$scratch/ball.yaml" few 0 time.end=0.2
ok "one hash: two sheets meet, RK4" ranks 3 tests/whole/same_hash "$scratch/meet.yaml" few 0 integrator=rk4 'probes=[]'
ok "docs/accuracy.md has these rows" table
