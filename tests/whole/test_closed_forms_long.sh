#!/bin/sh
# Further textbook cases, as test_closed_forms.sh: waves in cloth, on two meshes each, and what needs more steps. docs/accuracy.md has the errors.
. "${srcdir:-.}/tests/support/probes.sh"

crossings() { # COLUMN: the frequency, 1/s, of what swings about 0
    rows '{ now = c(name) } NR > 2 && (now > 0) != (before > 0) { t = c("time") - (c("time") - was) * now / (now - before); if (!n++) first = t; last = t }
        { before = now; was = c("time") } END { printf "%.12g", (n - 1) / 2 / (last - first) }' -v name="$1"
}
# two_meshes WHAT COARSE FINE EXPECTED MOST FORM: the error of the finer one of half the width, and the order, which is 2
two_meshes() {
    near "$1" "$3" "$4" "$5" && awk -v what="$1" -v a="$2" -v b="$3" -v c="$4" 'BEGIN { order = log((a - c) / (b - c)) / log(2)
        printf "# %s, order in mesh width: %.2f\n", what, order; exit !(order > 1.8 && order < 2.2) }' >&3 &&
        row "$1" "$6" "$(digit "$(awk -v a="$3" -v b="$4" 'BEGIN { print a / b - 1 }')"), order $(awk -v a="$2" -v b="$3" -v c="$4" 'BEGIN { printf "%.1f", log((a - c) / (b - c)) / log(2) }') in mesh width"
}

# ---- A drum: a square of 1 m drawn to 1.1 m, held at its rim. w = pi sqrt(2) / 1.1 c, c^2 = 1.1 T / density, T = E / (1 - nu) 0.1.
drum() { # CELLS along a side
    awk -v OFMT=%.17g -v n="$1" 'BEGIN { print "schema: 1\ngravity: [0, 0, 0]\ncloths:\n  - mesh: {grid: {width: 1, height: 1, nx: " n + 1 ", ny: " n + 1 "}}\n    material: m\n    pins:"
        for (i = -1; i < 2; i += 2) print "      - {box: [[-1, 0, " i / 2 "], [1, 0, " i / 2 "]]}\n      - {box: [[" i / 2 ", 0, -1], [" i / 2 ", 0, 1]]}"
        print "    start:\n      - {box: [[-9, -9, -9], [9, 9, 9]], scale: 1.1}"
        for (j = 1; j < n; j++) for (i = 1; i < n; i++) printf "      - {vertices: [%d], translate: [0, %.12g, 0]}\n", j * (n + 1) + i, 1e-4 * sin(3.14159265358979 * i / n) * sin(3.14159265358979 * j / n)
        print "materials: {m: {model: triangles, density: 0.1, stretch: 500, poisson: 0.3, shear: 192.3076923}}"
        printf "time: {h: 1e-4, end: 0.3}\nintegrator: verlet\nprobes: [{name: p, vertices: [%d], values: [position]}]\n", n / 2 * (n + 2) }' > drum.yaml
    run drum.yaml && crossings "p.$(($1 / 2 * ($1 + 2))).y"
}
drums() {
    coarse=$(drum 8) && fine=$(drum 16) || return 1
    two_meshes "a drum drawn to 1.1 times its size, 16 x 16 cells: first frequency" "$coarse" "$fine" "$(awk 'BEGIN { printf "%.12g", sqrt(2) / 2.2 * sqrt(1.1 * 50 / 0.7 / 0.1) }')" 1e-2 "√2 / 2a √(T / ρ)"
}
ok "a drum" drums

# ---- A rod of 2 m, 40 N and 0.02 kg/m, held at one end, swings along itself: w = pi / 2 c / L, c^2 = 40 / 0.02.
bar() { # LINKS
    awk -v n="$1" 'BEGIN { printf "schema: 1\ngravity: [0, 0, 0]\ncloths:\n  - mesh: {inline: {vertices: ["
        for (i = 0; i <= n; i++) printf "%s[%.12g, 0, 0]", (i ? ", " : ""), 2 * i / n
        printf "], edges: ["
        for (i = 0; i < n; i++) printf "%s[%d, %d]", (i ? ", " : ""), i, i + 1
        printf "]}}\n    material: m\n    mass_per_vertex: %.12g\n    masses: [{box: [[0.01, -1, -1], [1.99, 1, 1]], mass: %.12g}]\n", 0.02 / n, 0.02 / n
        print "    pins: [{vertices: [0]}]\n    start:"
        for (i = 1; i <= n; i++) printf "      - {vertices: [%d], translate: [%.12g, 0, 0]}\n", i, 1e-5 * sin(3.14159265358979 / 2 * i / n)
        print "materials: {m: {density: 1, ea: 40}}"
        printf "time: {h: 1e-4, end: 0.5}\nintegrator: verlet\nprobes: [{name: p, vertices: [%d], values: [velocity]}]\n", n }' > bar.yaml
    run bar.yaml && crossings "p.$1.vx"
}
bars() {
    coarse=$(bar 8) && fine=$(bar 16) || return 1
    two_meshes "a rod of 16 links, held at one end: first frequency along itself" "$coarse" "$fine" "$(awk 'BEGIN { printf "%.12g", sqrt(2000) / 8 }')" 2e-3 "c / 4L"
}
ok "a rod that swings along itself" bars

# ---- Two weights under each other: w^2 = g / L (2 -+ sqrt 2), the lower one out 1 +- sqrt 2 times as far.
double() { # -1 or 1, slow or fast
    awk -v OFMT=%.17g -v sign="$1" 'BEGIN { print "schema: 1\ncloths:\n  - mesh: {inline: {vertices: [[0, 0, 0], [0, -0.5, 0], [0, -1, 0]], edges: [[0, 1], [1, 2]]}}"
        print "    material: wire\n    mass_per_vertex: 0.1\n    pins: [{vertices: [0]}]"
        printf "    start: [{vertices: [1], translate: [1e-4, -1.962e-5, 0]}, {vertices: [2], translate: [%.12g, -2.943e-5, 0]}]\n", 1e-4 * (1 - sign * sqrt(2))
        print "materials: {wire: {density: 1, ea: 5e4}}\ntime: {h: 2.5e-4, end: 6}\nintegrator: rk4\nprobes: [{name: p, vertices: [1, 2], values: [position]}]" }' > double.yaml
    run double.yaml && near "double pendulum, mode $1" "$(crossings p.2.x)" \
        "$(awk -v sign="$1" 'BEGIN { printf "%.12g", sqrt(9.81 / 0.5 * (2 + sign * sqrt(2))) / 2 / 3.14159265358979 }')" 1e-4 && row "a double pendulum, $2 mode: frequency" "√(g / L (2 ∓ √2))"
}
ok "a double pendulum, slow" double -1 slow
ok "a double pendulum, fast" double 1 fast

# ---- A strip of 0.5 m clamped at one end, with a small load at the other: F L^3 / 3 D w. (1 - 1/4 (n - 1/2)^-2) of it, as a chain of hinges.
tip() { # CELLS
    awk -v n="$1" 'BEGIN { d = 0.5 / (n - 0.5); for (j = 0; j < 3; j++) for (i = 0; i <= n; i++) printf "v %.12g 0 %.12g\n", i * d, j * d / 4
        for (j = 0; j < 2; j++) for (i = 1; i <= n; i++) { a = j * (n + 1) + i; b = a + n + 1
            if (j) print "f", a, b, a + 1 "\nf", a + 1, b, b + 1; else print "f", a, b, b + 1 "\nf", a, b + 1, a + 1 } }' > tip.obj
    d=$(awk -v n="$1" 'BEGIN { printf "%.12g", 0.5 / (n - 0.5) }')
    load=$(awk -v d="$d" 'BEGIN { printf "%.12g", -1e-6 * 2 * d / 4 / 4 }') # of three vertices: 1, 2 and 1 of four parts
    cat > tip.yaml << END
schema: 1
gravity: [0, 0, 0]
cloths:
  - mesh: {file: tip.obj}
    material: m
    pins: [{box: [[-1, -1, -1], [$(awk -v OFMT=%.17g -v d="$d" 'BEGIN { print 1.1 * d }'), 1, 1]]}]
    loads: [{box: [[0.5, -1, -1], [1, 1, 1]], force: [0, $load, 0]}, {vertices: [$((2 * $1 + 1))], force: [0, $load, 0]}]
materials: {m: {model: triangles, density: 0.01, stretch: 500, shear: 200, bending: {rigidity: 1.0e-3}}}
time: {h: 100, end: 100, fps: 0.01}
solver: {stop: {relative: 1.0e-8}}
probes: [{name: p, vertices: [$((2 * $1 + 1))], values: [position]}]
END
    run tip.yaml && last "p.$((2 * $1 + 1)).y"
}
tips() {
    coarse=$(tip 8) && fine=$(tip 16) || return 1
    exact=$(awk 'BEGIN { printf "%.12g", -1e-6 * 0.125 / 3 / 1e-3 }')
    chain=$(awk -v y="$exact" 'BEGIN { printf "%.12g", y * (1 - 0.25 / 15.5 ^ 2) }')
    near "clamped strip with a load at its end" "$fine" "$exact" 2e-3 &&
        row "a clamped strip with a load at its end, 16 columns" "F L³ / 3 D w" &&
        near "the same as a chain of hinges" "$fine" "$chain" 5e-5 &&
        row "the same" "(1 − ¼ (n − ½)⁻²) of it: a chain of hinges" "$(digit "$(awk -v a="$fine" -v b="$chain" 'BEGIN { print a / b - 1 }')")"
}
ok "a strip with a load at its end" tips

# ---- A level sheet that begins to fall in air: v = V tanh(g t / V), V = sqrt(2 density g / (rho normal)).
cat > sink.yaml << 'END'
schema: 1
air: {density: 1.2, normal: 1.25}
cloths:
  - mesh: {grid: {width: 1, height: 1, nx: 4, ny: 4}}
    material: silk
materials: {silk: {density: 0.06, stretch: 100, shear: 50}}
time: {h: 0.002, end: 0.2}
integrator: rk4
probes: [{name: p, vertices: [5], values: [velocity]}]
END
sinks() {
    run sink.yaml || return 1
    below "a sheet sets out to sink in air, of its speed" "$(rows '{ V = sqrt(2 * 0.06 * 9.81 / 1.2 / 1.25); e = exp(2 * 9.81 * c("time") / V)
        d = c("p.5.vy") / V + (e - 1) / (e + 1); if (d < 0) d = -d; if (d > most) most = d } END { print most }')" 1e-5 && row "a level sheet sets out to sink in air, of its last speed V" "V tanh(g t / V)"
}
ok "a sheet sets out to sink" sinks
ok "docs/accuracy.md has these rows" table
