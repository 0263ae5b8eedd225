#!/bin/sh
# Materials against closed forms, through scenes and probes alone. Errors are printed; docs/physics.md has a table of them.
. "${srcdir:-.}/tests/support/tap.sh"
. "$srcdir/tests/support/probes.sh"
plan_later

# ---- Membranes: 1 m x 0.6 m of 5 x 4 vertices, pulled at its edges ----
sheet() { # LOADS
    cat << END
schema: 1
gravity: [0, 0, 0]
cloths:
  - mesh: {grid: {width: 1.0, height: 0.6, nx: 5, ny: 4}}
    material: m
    loads: [$1]
materials:
  m: {model: triangles, density: 0.2, stretch: [1000, 300], shear: 50, poisson: 0.4, damping: {mass: 20}}
time: {h: 0.05, end: 40, fps: 0.1}
solver: {stop: {relative: 1.0e-10}}
grain: 7
probes: [{name: p, vertices: [0, 4, 15, 19], values: [position]}]
END
}

sheet '{vertices: [4, 19], force: [2, 0, 0]}, {vertices: [9, 14], force: [4, 0, 0]}, {vertices: [0, 15], force: [-2, 0, 0]},
    {vertices: [5, 10], force: [-4, 0, 0]}' > warp.yaml
uniaxial() { # 12 N over 0.6 m: a strain of 0.02, and of -0.4 x 0.02 across
    run warp.yaml || return 1
    # shellcheck disable=SC2046
    set -- $(last p.0.x p.4.x p.0.z p.15.z)
    near "uniaxial stretch, length" "$(less "$2" "$1")" 1.02 1e-9 &&
        near "uniaxial stretch, width" "$(less "$4" "$3")" 0.5952 1e-9
}
ok "a sheet of triangles, pulled along the warp: length and width" uniaxial

# Tangential 2 N/m on all four edges: half the angle each way.
sheet '{vertices: [4, 19], force: [0, 0, 0.2]}, {vertices: [9, 14], force: [0, 0, 0.4]}, {vertices: [0, 15], force: [0, 0, -0.2]},
    {vertices: [5, 10], force: [0, 0, -0.4]}, {vertices: [15, 19], force: [0.25, 0, 0]}, {vertices: [16, 17, 18], force: [0.5, 0, 0]},
    {vertices: [0, 4], force: [-0.25, 0, 0]}, {vertices: [1, 2, 3], force: [-0.5, 0, 0]}' > shear.yaml
sheared() { # S_uv = 2 / (2 G): the diagonals are |S (1, 0.6)| and |S (1, -0.6)|
    run shear.yaml || return 1
    # shellcheck disable=SC2046
    set -- $(last p.0.x p.0.z p.19.x p.19.z p.4.x p.4.z p.15.x p.15.z)
    near "shear, long diagonal" "$(echo "$@" | awk -v OFMT=%.12g '{ print sqrt(($3 - $1) ^ 2 + ($4 - $2) ^ 2) }')" \
        "$(awk -v OFMT=%.12g 'BEGIN { s = 0.02; print sqrt((1 + s * 0.6) ^ 2 + (s + 0.6) ^ 2) }')" 1e-7 &&
        near "shear, short diagonal" "$(echo "$@" | awk -v OFMT=%.12g '{ print sqrt(($7 - $5) ^ 2 + ($8 - $6) ^ 2) }')" \
            "$(awk -v OFMT=%.12g 'BEGIN { s = 0.02; print sqrt((1 - s * 0.6) ^ 2 + (s - 0.6) ^ 2) }')" 1e-7
}
ok "a sheet of triangles, sheared" sheared

# ---- A strip that hangs: 2 m x 0.2 m; m g L / 2 E longer, m g the weight of a square metre ----
strip() { # MATERIAL
    cat << END
schema: 1
cloths:
  - mesh: {grid: {width: 0.2, height: 2, nx: 3, ny: 21}}
    transform: {rotate: [0.7071067811865476, 0.7071067811865476, 0, 0]}
    material: m
    pins: [{vertices: [0, 1, 2]}]
materials:
  m: {density: 0.2, damping: {mass: 4}, $1}
time: {h: 0.1, end: 60, fps: 0.1}
solver: {stop: {relative: 1.0e-10}}
probes: [{name: p, vertices: [1, 61], values: [position]}]
END
}
hanging() { # NAME MATERIAL
    strip "$2" > strip.yaml
    run strip.yaml || return 1
    # shellcheck disable=SC2046
    set -- "$1" $(last p.1.y p.61.y)
    near "hanging strip, $1" "$(less "$(less "$2" "$3")" 2)" "$(awk 'BEGIN { print 0.2 * 9.81 * 4 / (2 * 100) }')" 2e-4
}
ok "a strip of triangles that hangs" hanging triangles 'model: triangles, stretch: [400, 100], shear: 20'
ok "a strip of springs that hangs: the modulus of the lattice" hanging springs 'stretch: [400, 100]'

# ---- A clamped strip of rigidity D under its weight q, 0.5 m from the clamp: D theta'' = -q (L - s) cos theta ----
# Hinges share the bending out to half an edge either way: the strip is free from half an edge behind its clamped rows on. Its
# diagonals are mirrored at the middle: were they all alike, the strip would twist as it bends, and bend further.
beam() { # COLUMNS DENSITY SETTINGS: columns from the clamp on
    awk -v n="$1" -v OFMT=%.12g -v CONVFMT=%.12g 'BEGIN { d = 0.5 / (n - 0.5)
        for (j = 0; j < 3; j++) for (i = 0; i <= n; i++) print "v", i * d, 0, j * d
        for (j = 0; j < 2; j++) for (i = 1; i <= n; i++) { a = j * (n + 1) + i; b = a + n + 1
            if (j) print "f", a, b, a + 1 "\nf", a + 1, b, b + 1; else print "f", a, b, b + 1 "\nf", a, b + 1, a + 1 } }' > beam.obj
    cat << END
schema: 1
cloths:
  - {mesh: {file: beam.obj}, material: m, pins: [{box: [[-1, -1, -1], [$(awk -v n="$1" 'BEGIN { print 0.51 / (n - 0.5) }'), 1, 1]]}]}
materials:
  m: {model: triangles, stretch: 500, shear: 200, density: $2, damping: {mass: 1}, $3}
time: {h: 0.1, end: 30, fps: 0.1}
solver: {stop: {relative: 1.0e-9}}
probes: [{name: p, vertices: [$((2 * $1 + 1))], values: [position]}]
END
}
elastica() { # LOAD q L^3 / D: deflection over L, by Runge-Kutta from the clamp, its curvature found by halving
    awk -v load="$1" 'function shoot(k, y, t, n, i, h, s, a, b, c, d) { y = 0; t = 0; n = 2000; h = 1 / n
            for (i = 0; i < n; i++) { s = i * h
                a = -load * (1 - s) * cos(t); b = -load * (1 - s - h / 2) * cos(t + h / 2 * k)
                c = -load * (1 - s - h / 2) * cos(t + h / 2 * (k + h / 2 * a)); d = -load * (1 - s - h) * cos(t + h * (k + h / 2 * b))
                y += h * (sin(t) + 4 * sin(t + h / 2 * k + h * h / 8 * a) + sin(t + h * k + h * h / 6 * (a + b + c))) / 6
                t += h * k + h * h / 6 * (a + b + c); k += h / 6 * (a + 2 * b + 2 * c + d) }
            tip = y; return k }
        BEGIN { low = 0; high = load; for (j = 0; j < 60; j++) { k = (low + high) / 2; if (shoot(k) > 0) high = k; else low = k } printf "%.9g\n", tip }'
}
deflection() { # COLUMNS DENSITY SETTINGS
    beam "$1" "$2" "$3" > beam.yaml
    run beam.yaml || return 1
    last "p.$((2 * $1 + 1)).y"
}
bent() { # NAME MODEL LOAD MOST: two meshes, the error and its order
    density=$(awk -v load="$3" 'BEGIN { print load * 1e-3 / 0.125 / 9.81 }') # D = 1e-3 N m
    set -- "$1" "bending: {model: $2, rigidity: 1.0e-3}" "$(elastica "$3")" "$4" "$density"
    coarse=$(deflection 8 "$5" "$2") && fine=$(deflection 16 "$5" "$2") || return 1
    near "$1" "$(awk -v y="$fine" 'BEGIN { print -y / 0.5 }')" "$3" "$4" &&
        awk -v a="$coarse" -v b="$fine" -v c="$3" 'BEGIN { e = -a / 0.5 - c; f = -b / 0.5 - c; e = e < 0 ? -e : e; f = f < 0 ? -f : f
            printf "# its order in mesh width: %.2f\n", log(e / f) / log(15.5 / 7.5); exit !(log(e / f) / log(15.5 / 7.5) > 1.2) }' >&3
}
ok "elastica of little load is q L^4 / 8 D" near "its own check" "$(elastica 0.001)" 0.000125 1e-6
ok "a clamped strip that bends a little, hinges" bent "clamped strip, small, hinges" hinge 0.08 1e-2
ok "a clamped strip that bends a little, quadratic" bent "clamped strip, small, quadratic" quadratic 0.08 1e-2
ok "a clamped strip that bends far" bent "clamped strip, large, hinges" hinge 8 1e-2

# ---- Its first frequency: 3.5160 / (2 pi L^2) sqrt(D / density), from the lowest points of its tip under a sudden weight ----
frequency() {
    beam 16 6.5e-5 'bending: {rigidity: 1.0e-3}' > beam.yaml
    run beam.yaml --set integrator=bdf2 --set time.h=5e-4 --set time.end=0.6 --set materials.m.damping.mass=0 || return 1
    found=$(awk -F, -v name="p.33.y" 'NR == 1 { for (i = 1; i <= NF; i++) { split($i, w, " "); if (w[1] == name) at = i } next }
        NR > 3 && before < older && before <= $at && before < -0.005 && $2 > last + 0.05 { if (!n++) first = $2; last = $2 } { older = before; before = $at }
        END { print (n - 1) / (last - first) }' out/probes.csv)
    near "clamped strip, first frequency" "$found" "$(awk 'BEGIN { print 3.5160 / (2 * 3.14159265 * 0.25) * sqrt(1e-3 / 6.5e-5) }')" 1e-2
}
ok "a clamped strip that swings" frequency
