#!/bin/sh
# Friction of certified contact against closed forms: a belt over half a cylinder, drawn by T1 and T2, holds up to T2 / T1 = exp(pi m) and
# slips beyond; a sheet slides down a slope by Coulomb's law, on a box and on a mesh of it. With DUITE_LONG=1: more widths of the mesh,
# steps and coefficients, the angle of slip, and ten seconds at rest.
. "${srcdir:-.}/tests/support/probes.sh"
. "$srcdir/tests/support/bodies.sh"

# ---- A belt of 20 mm over a cylinder of 50 mm. Its rows of vertices are WIDTH m apart; ten of them hang down on each side.

belt() { # WIDTH OBSTACLE FRICTION OF_LAW: T2 grows to so much of what the law says
    awk -v l="$1" -v obstacle="$2" -v m="$3" -v of="$4" 'function row(x, y, k) { for (k = 0; k < 3; k++) printf "v %.15g %.15g %.15g\n", x, y, 0.01 * k - 0.01 > "belt.obj" }
        function draw(v, most, k) { for (k = 0; k < 3; k++) printf "      - {vertices: [%d], force: [0, %.15g, 0], curve: {keys: [[0, %.15g], [0.1, %.15g], [0.4, 1]]}}\n",
            v + k, -most / (k == 1 ? 2 : 4), 0.15 / most, 0.5 / most }
        BEGIN { pi = atan2(0, -1); r = 0.05102; n = int(pi * r / l + 0.5); s = 2 * r * sin(pi / n / 2)
            for (i = 10; i > 0; i--) row(-r, -i * s)
            for (i = 0; i <= n; i++) row(-r * cos(pi * i / n), r * sin(pi * i / n))
            for (i = 1; i <= 10; i++) row(r, -i * s)
            for (i = 0; i < n + 20; i++) for (k = 1; k < 3; k++) { a = 3 * i + k
                if ((i + k) % 2) printf "f %d %d %d\nf %d %d %d\n", a, a + 3, a + 4, a, a + 4, a + 1 > "belt.obj"
                else printf "f %d %d %d\nf %d %d %d\n", a, a + 3, a + 1, a + 1, a + 3, a + 4 > "belt.obj" }
            print "schema: 1\ngravity: [0, 0, 0]\ncloths:\n  - material: m\n    mesh: {file: belt.obj}\n    loads:"
            draw(0, 0.5); draw(3 * (n + 20), 0.5 * of * exp(pi * m))
            print "materials: {m: {density: 0.5, stretch: 20000, bend: 0, damping: {stiffness: 0.003, mass: 20}}}"
            print "contact: {mode: certified, self: off, thickness: 0.001, friction: " m "}"
            print "time: {h: 0.005, end: 0.6, stretch_growth: 0}\nobstacles: [{" obstacle "}]"
            print "probes: [{name: p, vertices: [0], values: [position]}]" }' > belt.yaml
}
cylinder='cylinder: {centre: [0, 0, 0], axis: [0, 0, 1], radius: 0.05, length: 0.2}'
# A mesh of it with N sides.
barrel() {
    awk -v n="$1" 'BEGIN { t = 2 * atan2(0, -1) / n
        for (j = 0; j < 2; j++) for (i = 0; i < n; i++) printf "v %.15g %.15g %.15g\n", 0.05 * cos(t * (i + 0.3)), 0.05 * sin(t * (i + 0.3)), 0.2 * j - 0.1
        print "v 0 0 -0.1\nv 0 0 0.1"
        for (i = 1; i <= n; i++) { k = i % n + 1; print "f", i, k, n + k, n + i; print "f", 2 * n + 1, k, i; print "f", 2 * n + 2, n + i, n + k } }' > barrel.obj
}
moves() { # OPTION...: how far the end goes up after the load has grown
    run belt.yaml "$@" && rows '$2 < 0.45001 { from = c("p.0.y") } END { printf "%.17g", $at["p.0.y"] - from }'
}
capstan() { # NAME WIDTH OBSTACLE FRICTION OPTION...: after the NAME, the rows and the coefficient
    name=$1 width=$2 obstacle=$3 friction=$4
    shift 4
    belt "$width" "$obstacle" "$friction" 0.98 && below "at 0.98 of exp(pi $friction), rows of $width m: m in 0.15 s" "$(moves "$@")" 5e-4 &&
        belt "$width" "$obstacle" "$friction" 1.02 && below "at 1.02: 2 mm less" "$(less 0.002 "$(moves "$@")")" 0 &&
        row "a belt on $name, μ = $friction, rows $(awk -v w="$width" 'BEGIN { printf "%g", 1000 * w }') mm apart: T₂ / T₁ at 0.98 of the law; at 1.02" "exp(π μ): holds; slips" "both do"
}
ok "a belt on a cylinder" capstan "a cylinder" 0.005 "$cylinder" 0.3
barrel 100
ok "a belt on a mesh of it" capstan "a mesh of 100 sides" 0.005 'body: {obj: barrel.obj}' 0.3

# ---- A sheet on a slope: gravity is turned in place of it. The slab is 1.2 m wide; its top has 40 x 40 quads.

slab_obj 40 > slab.obj
slope() { # DEGREES FRICTION END OBSTACLE
    awk -v a="$1" -v m="$2" -v end="$3" -v obstacle="$4" 'BEGIN { a *= atan2(0, -1) / 180
        printf "schema: 1\ngravity: [%.15g, %.15g, 0]\n", 9.81 * sin(a), -9.81 * cos(a)
        print "cloths: [{material: m, mesh: {grid: {width: 0.2, height: 0.2, nx: 7, ny: 7}}, transform: {translate: [-0.2, 0.003, 0], rotate: [1, 0, 0.15, 0]}}]"
        print "materials: {m: {density: 0.2, stretch: 500, shear: 50, damping: {stiffness: 0.02}}}"
        print "contact: {mode: certified, self: off, thickness: 0.003, friction: " m "}\ntime: {h: 0.005, end: " end "}\nobstacles: [{" obstacle "}]"
        print "probes: [{name: p, vertices: [24], values: [position, velocity]}]" }' > slope.yaml
}
box='box: {centre: [0, -0.05, 0], size: [1.2, 0.1, 1.2]}'
slides() { # NAME FRICTION OBSTACLE OPTION...
    name=$1 friction=$2
    slope 30 "$2" 0.4 "$3"
    shift 3
    run slope.yaml "$@" && near "acceleration, m/s2, friction $friction" "$(rows '$2 < 0.15001 { v = c("p.24.vx"); t = $2 } END { printf "%.15g", ($at["p.24.vx"] - v) / ($2 - t) }')" \
        "$(awk -v m="$friction" 'BEGIN { printf "%.15g", 9.81 * (0.5 - m * sqrt(0.75)) }')" 0.01 &&
        row "a sheet slides down $name, 30 degrees, μ = $friction: acceleration" "g (sin α − μ cos α)"
}
ok "a sheet slides on a box" slides "a box" 0.3 "$box"
ok "a sheet slides on a mesh of it" slides "a mesh of a box" 0.3 'body: {obj: slab.obj}'
creeps() { # m in the second half of the time
    rows '$2 < end / 2 + 0.001 { x = c("p.24.x") } END { printf "%.17g", $at["p.24.x"] - x }' -v end="$1"
}
if test "${DUITE_LONG:-}" = 1; then
    rm -f table # the rows above are those of test_capstan.sh
    ok "rows of 10 mm" capstan "a cylinder" 0.01 "$cylinder" 0.3
    ok "rows of 2.5 mm" capstan "a cylinder" 0.0025 "$cylinder" 0.3
    ok "a coefficient of 0.5" capstan "a cylinder" 0.005 "$cylinder" 0.5
    ok "steps of 2 ms" capstan "a cylinder, h = 2 ms" 0.005 "$cylinder" 0.3 --set time.h=0.002
    ok "on a mesh, steps of 2 ms" capstan "a mesh of 100 sides, h = 2 ms" 0.005 'body: {obj: barrel.obj}' 0.3 --set time.h=0.002
    barrel 200
    ok "on a mesh of 200 sides" capstan "a mesh of 200 sides" 0.005 'body: {obj: barrel.obj}' 0.3
    ok "on a mesh of 200 sides, rows of 10 mm" capstan "a mesh of 200 sides" 0.01 'body: {obj: barrel.obj}' 0.3
    barrel 128
    ok "on a mesh of 128 sides, rows of 3.5 mm" capstan "a mesh of 128 sides" 0.0035 'body: {obj: barrel.obj}' 0.3
    for h in 0.002 0.01; do
        ok "a sheet slides on a box, h = $h" slides "a box, h = $h s" 0.3 "$box" --set time.h=$h
        ok "a sheet slides on a mesh of it, h = $h" slides "a mesh of a box, h = $h s" 0.3 'body: {obj: slab.obj}' --set time.h=$h
    done
    sticks() { # NAME FRICTION OBSTACLE: half a degree below the angle it stays, half a degree above it slides
        name=$1
        shift
        angle=$(awk -v m="$1" 'BEGIN { printf "%.15g", atan2(m, 1) * 180 / atan2(0, -1) }')
        slope "$(less "$angle" 0.5)" "$1" 2 "$2" && run slope.yaml && below "half a degree below, m in 1 s" "$(creeps 2)" 1e-6 &&
            slope "$(less "$angle" -0.5)" "$1" 2 "$2" && run slope.yaml && below "half a degree above: 5 cm less" "$(less 0.05 "$(creeps 2)")" 0 &&
            row "a sheet on $name, μ = 0.4, half a degree below the angle of slip; above" "stays; slides" "both do"
    }
    ok "the angle of slip, box" sticks "a box" 0.4 "$box"
    ok "the angle of slip, mesh" sticks "a mesh of a box" 0.4 'body: {obj: slab.obj}'
    stays() { # NAME OBSTACLE: from 1 s to 10 s
        slope 20 0.5 10 "$2" && run slope.yaml && below "m from 1 s to 10 s" \
            "$(rows '$2 < 1.001 { x = c("p.24.x"); z = c("p.24.z") } END { printf "%.17g", sqrt(($at["p.24.x"] - x) ^ 2 + ($at["p.24.z"] - z) ^ 2) }')" 1e-6 && row "a sheet on $1, 20 degrees, μ = 0.5: way from 1 to 10 s, m" "0"
    }
    ok "ten seconds on a box" stays "a box" "$box"
    ok "ten seconds on a mesh of it" stays "a mesh of a box" 'body: {obj: slab.obj}'
fi
ok "docs/accuracy.md has these rows" table
