#!/bin/sh
# Pins as a user meets them: beads on lines and in planes against closed forms, from scenes and probes alone; reactions.
. "${srcdir:-.}/tests/support/cloth.sh"

run() { limited "$DUITE_CLOTH" "$@" --quiet; }
last() { # NAME...: the last numbers of columns of out/probes.csv
    for name; do
        awk -F, -v name="$name" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) at = i; if (!at) exit 1 } END { print $at }' out/probes.csv || return 1
    done | tr '\n' ' '
}
near() { # TOLERANCE EXPECTED... then the numbers: prints both
    echo "$@" | awk '{ n = (NF - 1) / 2; bad = NF < 3 || n != int(n)
        for (i = 1; i <= n; i++) { d = $(1 + i) - $(1 + n + i); if (d < 0) d = -d; print $(1 + i), $(1 + n + i), d; if (!(d <= $1)) bad = 1 } exit bad }'
}

# Two beads of 0.1 kg on one line, or in one plane, through (0, 0, 0) and (1, 0, 0)
cat > bead.yaml << 'END'
schema: 1
cloths:
  - mesh: {inline: {vertices: [[0, 0, 0], [1, 0, 0]], edges: [[0, 1]]}}
    material: thread
    mass_per_vertex: 0.1
    pins: [{vertices: [0, 1], to: line, direction: [3, -4, 0]}]
materials: {thread: {density: 1, ea: 10}}
time: {h: 0.001, end: 0.5}
solver: {stop: {relative: 1.0e-13}}
probes: [{name: p, vertices: [0]}]
END

# Along the line with cos = 0.8: g cos t^2 / 2; the line carries (I - S) m g.
slides() {
    run bead.yaml --output out --set integrator=verlet || return 1
    near 1e-9 0.5886 -0.7848 0 2.3544 -3.1392 0.47088 0.35316 0 \
        $(last 'p.0.x [m]' 'p.0.y [m]' 'p.0.z [m]' 'p.0.vx [m/s]' 'p.0.vy [m/s]' 'p.0.rx [N]' 'p.0.ry [N]' 'p.0.rz [N]')
}
ok "a bead on a line" slides
# Down a slope of 30 degrees at g / 2, and level across it as it began
slope() {
    run bead.yaml --output out --set integrator=rk4 --set 'cloths[0].velocity=[0, 0, 2]' \
        --set 'cloths[0].pins=[{vertices: [0, 1], to: plane, normal: [-0.5, 0.8660254037844386, 0]}]' || return 1
    near 1e-9 -0.53098182569538 -0.3065625 1 0 $(last 'p.0.x [m]' 'p.0.y [m]' 'p.0.z [m]' 'p.0.rz [N]')
}
ok "a bead on a slope" slope
across() { # INTEGRATOR: how fast it is across the line
    run bead.yaml --output out --set integrator="$1" 2> /dev/null && last 'p.0.vx [m/s]' 'p.0.vy [m/s]' |
        awk '{ v = 0.8 * $1 + 0.6 * $2; print v; exit !(v < 1e-12 && v > -1e-12 && $1 > 2) }'
}
for integrator in explicit_euler symplectic_euler verlet rk4 implicit_euler bdf2; do
    ok "a line leaves no velocity across it, $integrator" across $integrator
done

# A horizontal line turns about the vertical at 2 rad/s: r = cosh 2t, v = 2 sinh 2t, pushed by 2 m w v across.
turns() { # INTEGRATOR ARGUMENT...
    name=$1
    shift
    awk 'BEGIN { printf "{times: ["; for (i = 0; i <= 100; i++) printf "%s%.17g", i ? "," : "", i / 100
        printf "], rotate: ["; for (i = 0; i <= 100; i++) printf "%s[%.17g,0,%.17g,0]", i ? "," : "", cos(i / 100), -sin(i / 100); print "]}" }' > motion
    run bead.yaml --output out --set integrator="$name" --set time.end=0.995 --set 'cloths[0].mesh.inline.vertices=[[1, 0, 0], [3, 0, 0]]' --set time.stretch_growth=0 \
        --set gravity='[0,0,0]' --set materials.thread.ea=1e-12 --set "cloths[0].pins=[{vertices: [0, 1], to: line, direction: [2, 0, 0], motion: $(cat motion)}]" "$@" || return 1
    last 'p.0.x [m]' 'p.0.z [m]' 'p.0.rx [N]' 'p.0.ry [N]' 'p.0.rz [N]' |
        awk -v t=0.995 -v h="${h:-0.001}" '{ c = cos(2 * t); s = sin(2 * t); e = exp(2 * t); r = $1 * c + $2 * s; push = $5 * c - $3 * s
            print r - (e + 1 / e) / 2, $2 * c - $1 * s, push - 0.4 * (e - 1 / e), $3 * c + $5 * s, $4
            away = r - (e + 1 / e) / 2; if (away < 0) away = -away; askew = $2 * c - $1 * s; if (askew < 0) askew = -askew
            wrong = push - 0.4 * (e - 1 / e); if (wrong < 0) wrong = -wrong; pull = $3 * c + $5 * s; if (pull < 0) pull = -pull
            exit !(away < 16 * h && askew < 1e-14 && wrong < 25 * h && pull < 1e-13 && $4 == 0) }'
}
for integrator in explicit_euler symplectic_euler verlet rk4 implicit_euler bdf2; do
    ok "a line that turns, $integrator" turns $integrator
done
finer() { h=0.00025 && turns implicit_euler --set time.h=0.00025; }
ok "the same by shorter steps" finer

# Rest: two lines carry a weight between them; each vertex of a sheet in one plane, the others on the floor, is there to the last digit.
cat > sheet.yaml << 'END'
schema: 1
cloths:
  - mesh: {grid: {width: 1, height: 1, nx: 9, ny: 9}}
    transform: {translate: [0, 0.02, 0]}
    material: cotton
    pins:
      - {box: [[-0.5, 0.02, -0.5], [-0.5, 0.02, 0.5]], to: line, direction: [0, -1, 0]}
      - {box: [[0.5, 0.02, -0.5], [0.5, 0.02, 0.5]], to: plane, normal: [1, 0, 0], motion: {times: [0, 1], translate: [[0, 0, 0], [0.01, 0, 0]]}}
materials: {cotton: {density: 0.2, stretch: 200, shear: 50, damping: {mass: 5, stiffness: 0.01}}}
obstacles: [{plane: {point: [0, 0, 0], normal: [0, 1, 0]}}]
time: {h: 0.01, end: 2}
grain: 12
probes: [{name: left, box: [[-0.5, 0.02, -0.5], [-0.5, 0.02, 0.5]]}, {name: right, vertices: [44], values: [position]}]
END
lies() { # ARGUMENT...: the lines did not move, the plane did; both ends are on the floor
    run sheet.yaml --output out "$@" || return 1
    near 1e-15 -0.5 0 -0.5 0.51 0 $(last 'left.0.x [m]' 'left.0.y [m]' 'left.0.z [m]' 'right.44.x [m]' 'right.44.y [m]')
}
ok "lines and planes on the floor" lies
alike() {
    run sheet.yaml --output out --set time.end=0.2 && ranks 3 "$DUITE_CLOTH" sheet.yaml --quiet --output three --threads 2 \
        --balance delegate --set time.end=0.2 && cmp out/probes.csv three/probes.csv
}
ok "the same bytes on threads and ranks" alike

# ---- By radius: the vertex nearest to a point and all that are not farther from it, wherever vertices are picked.
cat > round.yaml << 'END'
schema: 1
cloths:
  - mesh: {grid: {width: 1, height: 1, nx: 11, ny: 11}}
    transform: {translate: [0, 1, 0]}
    material: cotton
    pins: [{nearest: [0, 1, 0], radius: 0.1}, {nearest: [0.49, 3, 0.5], radius: 0.3}]
    masses: [{nearest: [0, 1, 0], radius: 0.15, mass: 0.5}]
    loads: [{nearest: [-0.5, 1, -0.5], radius: 0, force: [1, 0, 0]}, {nearest: [0, 1, 0], radius: 0.11, force: [0, 0, 2]}]
    start: [{nearest: [0, 1, 0], radius: 0.1, translate: [0, 0.5, 0]}]
materials: {cotton: {density: 0.2, stretch: 0, shear: 0}}
time: {h: 0.01, end: 0.01}
probes:
  - {name: held, nearest: [0, 1, 0], radius: 0.1, values: [position, total]}
  - {name: corner, nearest: [0.5, 1, 0.5], radius: 0.05, values: [reaction]}
  - {name: pulled, nearest: [-0.5, 1, -0.5], radius: 0.1, values: [velocity]}
END
by_radius() { # 5 vertices are pinned in the middle and lifted, carry 5 of the 9 masses and 5 of the loads; 1 at the corner
    run round.yaml --output out && tr ',' '\n' < out/probes.csv | grep -c '^held.*[xyz] ' | grep -cx 18 &&
        near 1e-12 1.5 1.5 1.5 1.5 1.5 -10 "$(awk 'BEGIN { printf "%.17g", 9.81 * 5 * (0.5 + 0.002) }')" "$(awk 'BEGIN { printf "%.17g", 9.81 * 0.0005 }')" 0 0 \
            $(last 'held.49.y [m]' 'held.59.y [m]' 'held.60.y [m]' 'held.61.y [m]' 'held.71.y [m]' 'held.total.rz [N]' 'held.total.ry [N]' 'corner.120.ry [N]' \
                'pulled.1.vx [m/s]' 'pulled.11.vx [m/s]')
}
ok "pins, masses, loads, starts and probes by radius" by_radius

# ---- Reactions: what the pin pushed over the steps, halved ones too, is what momentum changed, but for the weight.
cat > jerk.yaml << 'END'
schema: 1
cloths:
  - mesh: {inline: {vertices: [[0, 0, 0], [0, -1, 0]], edges: [[0, 1]]}}
    material: thread
    mass_per_vertex: 0.1
    pins: [{vertices: [0], motion: {times: [0, 0.02, 0.05], translate: [[0, 0, 0], [0, 0.08, 0], [0, 0.09, 0]]}}]
materials: {thread: {density: 1, ea: 40}}
newton: {steps: 50, tolerance: 1.0e-12}
time: {h: 0.01, end: 0.06, stretch_growth: 0.02}
solver: {stop: {relative: 1.0e-13}}
probes: [{name: p, vertices: [0, 1]}]
END
jerks() { # KEY: of the pin
    run jerk.yaml --output out --report report.json "$@" || return 1
    awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        { h = $2 - time; time = $2; pushed += h * ($at["p.0.ry [N]"] - 2 * 0.1 * 9.81); p = 0.1 * ($at["p.0.vy [m/s]"] + $at["p.1.vy [m/s]"]); most = p > most ? p : most
          off = pushed - p; if (off < 0) off = -off; if (off > worst) worst = off; if (h > 0 && h < 0.009) short++ }
        END { print short " short steps, off by " worst " of " most " kg m/s"; exit !(short > 3 && most > 0.1 && worst < 1e-9) }' out/probes.csv
}
ok "reactions of a pin that jerks, in halved steps" jerks
ok "reactions of a line that jerks" jerks --set 'cloths[0].pins[0].to=line' --set 'cloths[0].pins[0].direction=[1, 0, 0]'
