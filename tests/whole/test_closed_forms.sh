#!/bin/sh
# Textbook motions, said by scenes and read from probes alone: how vertices start, what they weigh, where they go. docs/accuracy.md has the errors.
. "${srcdir:-.}/tests/support/probes.sh"

# Two masses of 0.1 and 0.3 kg on springs of 40 N/m, the first on a pin: in each mode x(t) = x(0) cos w t.
cat > modes.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
cloths:
  - mesh: {inline: {vertices: [[0, 0, 0], [1, 0, 0], [2, 0, 0]], edges: [[0, 1], [1, 2]]}}
    material: wire
    mass_per_vertex: 0.1
    masses: [{vertices: [2], mass: 0.15}, {nearest: [9, 0, 0], mass: 0.05}]
    pins: [{vertices: [0]}]
materials: {wire: {density: 1, ea: 40}}
time: {h: 5e-4, end: 0.8}
integrator: rk4
probes: [{name: p, vertices: [1, 2]}]
END
mode() { # -1 or 1: the slow or the fast one; its NAME
    name=$2
    # shellcheck disable=SC2046
    set -- $(awk -v sign="$1" -v OFMT=%.17g 'BEGIN { a = 0.03; b = -(80 * 0.3 + 40 * 0.1); w2 = (-b + sign * sqrt(b * b - 4 * a * 1600)) / 2 / a
        print sqrt(w2), (80 - 0.1 * w2) / 40 }')
    run modes.yaml --set "cloths[0].start=[{vertices: [1], translate: [0.01, 0, 0]}, {vertices: [2], translate: [$(awk -v r="$2" 'BEGIN { printf "%.15g", r / 100 }'), 0, 0]}]" || return 1
    below "mode of two masses, $1 rad/s, of its amplitude" "$(rows '{ d = c("p.1.x") - 1 - 0.01 * cos(w * c("time")); e = c("p.2.x") - 2 - 0.01 * r * cos(w * c("time"))
        if (d < 0) d = -d; if (e < 0) e = -e; if (d > most) most = d; if (e > most) most = e } END { print most / 0.01 }' -v w="$1" -v r="$2")" 1e-7 &&
        row "two unequal masses on springs, $name mode, \`rk4\`, ω h below 0.02: of the amplitude" "cos ω t"
}
ok "two unequal masses in their slow mode" mode -1 slow
ok "two unequal masses in their fast mode" mode 1 fast

# Two masses on a spring that it draws out to 1.2 times its length turn about each other: k (l - L) = m w^2 l / 2.
cat > spin.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
cloths:
  - mesh: {inline: {vertices: [[2.5, 0, 0], [3.5, 0, 0]], edges: [[0, 1]]}}
    material: wire
    mass_per_vertex: 0.1
    start: [{vertices: [0, 1], scale: 1.2, about: [3, 0, 0], spin: [0, 12.909944487358056, 0]}]
materials: {wire: {density: 1, ea: 50}}
time: {h: 0.002, end: 5}
energies: steps
probes: [{name: p, vertices: [0, 1]}]
END
spin() { # INTEGRATOR RADIUS MOMENTUM: errors that are allowed
    run spin.yaml --set integrator="$1" || return 1
    # shellcheck disable=SC2046
    set -- "$@" $(rows '{ x = c("p.1.x") - c("p.0.x"); z = c("p.1.z") - c("p.0.z"); r = sqrt(x * x + z * z) / 1.2 - 1
        j = 0; for (v = 0; v < 2; v++) j += c("p." v ".z") * c("p." v ".vx") - (c("p." v ".x") - 3) * c("p." v ".vz")
        j = j / (2 * 0.36 * 12.909944487358056) - 1; if (r < 0) r = -r; if (j < 0) j = -j; if (r > a) a = r; if (j > b) b = j } END { print a, b }')
    below "two masses turn ten times, $1: their distance" "$4" "$2" && below "angular momentum, $1" "$5" "$3" &&
        row "two masses turn about each other on a drawn spring, ten turns, \`$1\`: distance; angular momentum" "k (l − L) = m ω² l / 2; kept" "$(digit "$4"); $(digit "$5")"
}
ok "two masses turn about each other, verlet" spin verlet 1e-4 1e-13
ok "two masses turn about each other, symplectic_euler" spin symplectic_euler 2e-2 1e-13
ok "two masses turn about each other, rk4" spin rk4 1e-6 1e-6

# Two chains of unequal masses fly through a medium that takes 3 1/s of every velocity, whatever a vertex weighs: no spring is ever
# stretched, and v is divided by 1 + 3 h in each step of implicit Euler.
cat > medium.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
cloths:
  - mesh: {inline: {vertices: [[0, 0, 0], [1, 0, 0], [2, 0, 0]], edges: [[0, 1], [1, 2]]}}
    material: wire
    mass_per_vertex: 0.1
    masses: [{vertices: [0], mass: 0.7}, {vertices: [2], mass: 0.3}]
    velocity: [2, 0, 0]
    name: long
  - mesh: {inline: {vertices: [[0, 5, 0], [1, 5, 0]], edges: [[0, 1]]}}
    material: wire
    mass_per_vertex: 0.05
    masses: [{vertices: [1], mass: 2}]
    velocity: [2, 0, 0]
    name: short
materials: {wire: {density: 1, ea: 1, damping: {mass: 3}}}
time: {h: 0.01, end: 0.5}
solver: {stop: {relative: 1e-13}}
probes: [{name: p, cloth: long, vertices: [0, 1, 2]}, {name: q, cloth: short, vertices: [0, 1]}]
END
medium() { # INTEGRATOR FACTOR: of a velocity in a step
    run medium.yaml --set integrator="$1" || return 1
    below "five unequal masses in a medium, $1: their velocities" "$(rows 'function off(v) { v = v / u - 1; if (v < 0) v = -v; if (v > most) most = v }
        { u = 2 * exp(c("step") * log(f)); for (i = 0; i < 3; i++) off(c("p." i ".vx")); for (i = 0; i < 2; i++) off(c("q." i ".vx")) } END { print most + 0 }' -v f="$2")" 1e-11 &&
        row "unequal masses in a medium of $3 1/s, \`$1\`: velocities" "$4"
}
ok "unequal masses in a medium, implicit_euler" medium implicit_euler "$(awk 'BEGIN { printf "%.17g", 1 / 1.03 }')" 3 "v / (1 + 3 h) a step"
ok "unequal masses in a medium, explicit_euler" medium explicit_euler 0.97 3 "(1 − 3 h) v a step"

# A pendulum let go at 2 rad: its period by the arithmetic-geometric mean, the wire 1e-5 of its length longer.
cat > far.yaml << 'END'
schema: 1
cloths:
  - mesh: {inline: {vertices: [[0, 0, 0], [0.9092974268256817, 0.4161468365471424, 0]], edges: [[0, 1]]}}
    material: wire
    mass_per_vertex: 0.1
    pins: [{vertices: [0]}]
materials: {wire: {density: 1, ea: 1e5}}
time: {h: 5e-4, end: 2.2}
integrator: rk4
probes: [{name: p, vertices: [1], values: [position]}]
END
far() {
    run far.yaml || return 1
    near "period of a pendulum that swings to 2 rad" \
        "$(rows 'NR > 2 && (x > 0) != (c("p.1.x") > 0) { t = c("time") - 5e-4 * c("p.1.x") / (c("p.1.x") - x); if (n++) print 2 * (t - first); first = t }
            { x = c("p.1.x") }')" \
        "$(awk -v OFMT=%.17g 'BEGIN { a = 1; b = cos(1); while (a - b > 1e-14) { m = (a + b) / 2; b = sqrt(a * b); a = m } print 2 * 3.14159265358979 / sqrt(9.81) / a }')" 1e-4 &&
        row "a pendulum swings to 2 rad: period" "2π / √(g / L) / M(1, cos 1), M the arithmetic-geometric mean"
}
ok "a pendulum that swings far" far

# A weight that circles at 0.6 rad to the vertical on a wire: w^2 = g / L cos 0.6; the pin carries the weight and the pull across.
cat > cone.yaml << 'END'
schema: 1
cloths:
  - mesh: {inline: {vertices: [[0, 0, 0], [0.5646424733950354, -0.8253356149096783, 0]], edges: [[0, 1]]}}
    material: wire
    mass_per_vertex: 0.1
    pins: [{vertices: [0]}]
    start: [{vertices: [1], scale: 1.0000118860814, spin: [0, 3.44761856436, 0]}]
materials: {wire: {density: 1, ea: 1e5}}
time: {h: 5e-4, end: 1.8224712718}
integrator: rk4
probes: [{name: p, vertices: [0, 1]}]
END
cone() { # after one turn
    run cone.yaml --set time.h=5.0624202e-4 || return 1
    # shellcheck disable=SC2046
    set -- $(last p.1.x p.1.y p.1.z p.0.rx p.0.ry)
    near "conical pendulum, height" "$2" -0.8253356149 2e-5 && near "where it is after a turn" "$1" 0.56464247 2e-4 &&
        below "and across" "$3" 1e-3 && near "pull on its pin, upwards" "$5" 1.962 1e-4 &&
        near "pull on its pin, inwards" "$4" "$(awk -v OFMT=%.17g 'BEGIN { print -0.981 * sin(0.6) / cos(0.6) }')" 1e-3 &&
        row "a conical pendulum: height, place after a turn, force on its pin" "ω² = g / (L cos α)"
}
ok "a conical pendulum" cone

# A chain of links of 0.1 m and 0.4 m hangs: each is drawn by the weights below it, F L / EA, whatever its length.
cat > links.yaml << 'END'
schema: 1
cloths:
  - mesh: {inline: {vertices: [[0, 0, 0], [0, -0.1, 0], [0, -0.5, 0]], edges: [[0, 1], [1, 2]]}}
    material: wire
    mass_per_vertex: 0.1
    pins: [{vertices: [0]}]
materials: {wire: {density: 1, ea: 40, damping: {mass: 20}}}
time: {h: 0.05, end: 40, fps: 0.1}
solver: {stop: {relative: 1.0e-10}}
probes: [{name: p, vertices: [1, 2], values: [position]}]
END
links() {
    run links.yaml || return 1
    # shellcheck disable=SC2046
    set -- $(last p.1.y p.2.y)
    near "a chain, its upper link" "$1" "$(awk -v OFMT=%.17g 'BEGIN { print -0.1 * (1 + 1.962 / 40) }')" 1e-6 &&
        near "its lower link, four times as long" "$(less "$2" "$1")" "$(awk -v OFMT=%.17g 'BEGIN { print -0.4 * (1 + 0.981 / 40) }')" 1e-6 &&
        row "a chain hangs, its links of 0.1 and 0.4 m: lengths" "L (1 + F / EA), F the weights below"
}
ok "links of other lengths are drawn by the same strain" links

# A taut chain of nine weights between two pins: w = 2 sqrt(T / m a) sin(n pi / 20).
awk 'BEGIN { printf "schema: 1\ngravity: [0, 0, 0]\ncloths:\n  - mesh: {inline: {vertices: ["
    for (i = 0; i <= 10; i++) printf "%s[%g, 0, 0]", i ? ", " : "", i / 10
    printf "], edges: ["
    for (i = 0; i < 10; i++) printf "%s[%d, %d]", i ? ", " : "", i, i + 1
    printf "]}}\n    material: wire\n    mass_per_vertex: 0.01\n    pins: [{vertices: [0, 10]}]\n    start: [{box: [[-9, -9, -9], [9, 9, 9]], scale: 1.25, wave: {vector: [1.5, 0, 0], translate: [0, 1e-5, 0]}}"
    print "]\nmaterials: {wire: {density: 1, ea: 20}}\ntime: {h: 2.5e-4, end: 0.3}\nintegrator: rk4\nprobes: [{name: p, vertices: [5], values: [position]}]" }' > string.yaml
string() {
    run string.yaml || return 1
    below "third mode of a taut chain, of its amplitude" "$(rows '{ w = 2 * sqrt(5 / 0.01 / 0.125) * sin(3 * 3.14159265358979324 / 20)
        d = c("p.5.y") + 1e-5 * cos(w * c("time")); if (d < 0) d = -d; if (d > most) most = d } END { print most / 1e-5 }')" 1e-5 &&
        row "a taut chain of nine weights, third mode: of the amplitude" "ω = 2 √(T / m a) sin(3π / 20)"
}
ok "a taut chain in its third mode" string

# A sheet that lies on a slope of 0.5 rad slides: g sin 0.5 t^2 / 2 by schemes of second order, h more of t by those of first.
cat > slope.yaml << 'END'
schema: 1
cloths:
  - mesh: {grid: {width: 1, height: 1, nx: 6, ny: 6}}
    material: cotton
    transform: {rotate: [0.9689124217106447, 0, 0, 0.24740395925452294]}
materials: {cotton: {density: 0.2, stretch: 500, shear: 200}}
obstacles: [{plane: {point: [0, 0, 0], normal: [-0.479425538604203, 0.8775825618903728, 0]}}]
time: {h: 2e-3, end: 0.4}
solver: {stop: {relative: 1e-12}}
probes: [{name: p, vertices: [14], values: [position]}]
END
slides() { # NAME, KEY=VALUE, what it slides more: in g sin 0.5 h t
    more=$3
    run slope.yaml --set "$2" || return 1
    # shellcheck disable=SC2046
    set -- "$1" $(rows 'NR == 2 { x = c("p.14.x"); y = c("p.14.y") }
        END { x = c("p.14.x") - x; y = c("p.14.y") - y; printf "%.15g %.15g", -0.8775825618903728 * x - 0.479425538604203 * y, -0.479425538604203 * x + 0.8775825618903728 * y }')
    near "sheet on a slope, $1" "$2" "$(awk -v more="$more" 'BEGIN { printf "%.15g", 9.81 * 0.479425538604203 * 0.4 * (0.2 + more * 0.002) }')" 1e-12 &&
        below "and off it" "$3" 1e-13 && row "a sheet slides down a slope without friction, \`$1\`" "g sin α t² / 2"
}
ok "a sheet slides down a slope, verlet" slides verlet integrator=verlet 0

# A pin that shakes a damped weight, x = A sin W t by 96 keys a turn: in the end it answers with amplitude and phase of
# (k + i W c) / (k - m W^2 + i W c), but for the straight lines between keys: A (sin(pi / 96) / (pi / 96))^2.
shaken() { # RATIO of W to the weight's own 20 rad/s
    awk -v ratio="$1" 'BEGIN { W = 20 * ratio; T = 2 * 3.14159265358979324 / W; n = 96 * 12
        print "schema: 1\ngravity: [0, 0, 0]\ncloths:\n  - mesh: {inline: {vertices: [[0, 0, 0], [1, 0, 0]], edges: [[0, 1]]}}\n    material: wire\n    mass_per_vertex: 0.1"
        printf "    pins: [{vertices: [0], motion: {times: ["
        for (i = 0; i <= n; i++) printf "%s%.15g", i ? ", " : "", i * T / 96
        printf "], translate: ["
        for (i = 0; i <= n; i++) printf "%s[%.15g, 0, 0]", i ? ", " : "", 0.01 * sin(i * 2 * 3.14159265358979324 / 96)
        print "]}}]\nmaterials: {wire: {density: 1, ea: 40, damping: {stiffness: 0.02}}}"
        printf "time: {h: %.15g, end: %.15g}\nintegrator: rk4\nprobes: [{name: p, vertices: [1], values: [position]}]\n", T / 96, 12 * T }' > shaken.yaml
    run shaken.yaml || return 1
    # shellcheck disable=SC2046
    set -- "$1" $(rows 'NR > 2 + 11 * 96 { t = 2 * 3.14159265358979324 * (NR - 2) / 96; s += (c("p.1.x") - 1) * sin(t) / 48; k += (c("p.1.x") - 1) * cos(t) / 48 }
        END { print sqrt(s * s + k * k) / 0.01, atan2(k, s) }') \
        $(awk -v OFMT=%.17g -v W="$1" 'BEGIN { W *= 20; e = W * 0.8; d = 40 - 0.1 * W * W; f = 3.14159265358979324 / 96; f = (sin(f) / f) ^ 2
            print f * sqrt((1600 + e * e) / (d * d + e * e)), atan2(e, 40) - atan2(e, d) }')
    near "weight shaken at $1 of its frequency, amplitude" "$2" "$4" 2e-4 && near "its phase" "$3" "$5" 5e-4 &&
        row "a weight shaken at $1 of its frequency: amplitude, phase" "(k + i W c) / (k − m W² + i W c)"
}
ok "a weight shaken slowly" shaken 0.5
ok "a weight shaken at resonance" shaken 1
ok "a weight shaken fast" shaken 1.7

# A free sheet, drawn out askew to its threads, spins up by the torque that the papers' forces leave, and by nothing else:
# after one step it has h times that as angular momentum.
cat > askew.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
cloths:
  - mesh: {grid: {width: 1, height: 1, nx: 4, ny: 4}}
    transform: {rotate: [0.9238795325112867, 0, 0.3826834323650898, 0]}
    material: paper
    mass_per_vertex: 0.1
    start: [{box: [[-9, -9, -9], [9, 9, 9]], scale: [1.05, 1, 1]}]
materials: {paper: {model: triangles, stretch: [1000, 300], shear: 50, forces: uncorrected}}
time: {h: 1e-7, end: 1e-7}
integrator: symplectic_euler
grain: 5
probes: [{name: p, box: [[-9, -9, -9], [9, 9, 9]]}]
END
torque() { sed -n 's/^ *"torque_left": *\([^,]*\).*/\1/p' report; }
askew() {
    run askew.yaml --report report || return 1
    # shellcheck disable=SC2046
    set -- $(rows '{ j = 0; for (v = 0; v < 16; v++) j += 0.1 * (c("p." v ".z") * c("p." v ".vx") - c("p." v ".x") * c("p." v ".vz")) } END { print j < 0 ? -j / 1e-7 : j / 1e-7 }')
    near "torque of uncorrected forces, N m" "$1" "$(torque)" 1e-6 && run askew.yaml --report report --set materials.paper.forces=exact &&
        below "and of exact ones" "$(torque)" 0 && row "torque of \`forces: uncorrected\` on a sheet drawn askew; of exact forces" "growth of its angular momentum; 0"
}
ok "a sheet drawn out askew, torque of the papers' forces" askew

# A flap on a hinge, its other triangle held, is a weight m at 1 m from the hinge of stiffness D: it swings with w^2 = D / m, and
# damping b of bending takes exp(-b w^2 t / 2).
cat > flap.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
cloths:
  - mesh: {inline: {vertices: [[0, 0, 0], [0, 0, 1], [-1, 0, 0.5], [1, 0, 0.5]], triangles: [[0, 1, 2], [1, 0, 3]]}}
    material: sheet
    mass_per_vertex: 0.1
    pins: [{vertices: [0, 1, 2]}]
    start: [{vertices: [3], velocity: [0, 0.001, 0]}]
materials: {sheet: {stretch: 100, bending: {rigidity: 10}, damping: {stiffness: 0.02}}}
time: {h: 2e-4, end: 1}
integrator: rk4
probes: [{name: p, vertices: [3]}]
END
flap() { # NAME DAMPING SCENE...: its damping; the velocity along y against the closed form
    name=$1 damping=$2
    shift 2
    run flap.yaml "$@" || return 1
    below "flap on a hinge, $name" "$(rows '{ a = b * 50; w = sqrt(100 - a * a); t = c("time"); d = c("p.3.vy") - 0.001 * exp(-a * t) * (cos(w * t) - a / w * sin(w * t))
        if (d < 0) d = -d; if (d > most) most = d } END { print most / 0.001 }' -v b="$damping")" 1e-6 &&
        row "a flap on a hinge, damping: $name" "ω² = D / m, e^(−β ω² t / 2)"
}
ok "a flap on a hinge, damped as all is" flap stiffness 0.02
ok "a flap on a hinge, with a damping of its own" flap bending 0.05 --set materials.sheet.damping.bending=0.05
ok "a flap on a hinge, with none" flap none 0 --set materials.sheet.damping.bending=0
ok "a flap on a flat fold, with a damping of its own" flap fold 0.05 --set materials.sheet.damping.bending=0.05 --set materials.sheet.bending.model=quadratic

# A shifted start alone moves it: the same bits on ranks and threads.
same() {
    run spin.yaml --set grain=1 --end 0.1 --set integrator=implicit_euler && cp out/probes.csv one.csv &&
        ranks 2 "$DUITE_CLOTH" spin.yaml --quiet --output out --threads 2 --set grain=1 --end 0.1 --set integrator=implicit_euler && cmp out/probes.csv one.csv
}
ok "starts and masses on 2 ranks" same
ok "docs/accuracy.md has these rows" table
