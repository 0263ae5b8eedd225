#!/bin/sh
# Materials against closed forms, through scenes and probes alone. docs/accuracy.md has a table of the errors.
. "${srcdir:-.}/tests/support/probes.sh"

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
        near "uniaxial stretch, width" "$(less "$4" "$3")" 0.5952 1e-9 &&
        row "triangles pulled along the warp: length, width" "strain F / (E₁ w), −ν₁₂ of it across"
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
    near "shear, long diagonal" "$(echo "$@" | awk -v OFMT=%.17g '{ print sqrt(($3 - $1) ^ 2 + ($4 - $2) ^ 2) }')" \
        "$(awk -v OFMT=%.12g 'BEGIN { s = 0.02; print sqrt((1 + s * 0.6) ^ 2 + (s + 0.6) ^ 2) }')" 1e-7 &&
        near "shear, short diagonal" "$(echo "$@" | awk -v OFMT=%.17g '{ print sqrt(($7 - $5) ^ 2 + ($8 - $6) ^ 2) }')" \
            "$(awk -v OFMT=%.12g 'BEGIN { s = 0.02; print sqrt((1 - s * 0.6) ^ 2 + (s - 0.6) ^ 2) }')" 1e-7 &&
        row "triangles sheared by tangential loads τ: diagonals" "S = [[1, τ/2G], [τ/2G, 1]]"
}
ok "a sheet of triangles, sheared" sheared

# ---- Bending in the plane: 1 m x 0.5 m, pulled at its ends by s z. Strain s z / E1 along the threads, sag s / 8 E1 in the middle ----
# One long implicit step from rest is the solution of small loads. Displacements converge with order 2 in mesh width, strains with 1:
# of a mesh that is alike everywhere, without the lines at which mirrored diagonals meet.
plane() { # CELLS along, half as many across: error of the sag, and the largest of the strain, as parts of their values
    awk -v n="$1" -v OFMT=%.12g -v CONVFMT=%.12g 'function pull(z) { return 0.02 * z * d / 6 }
        BEGIN { m = n / 2; d = 0.5 / m
            print "schema: 1\ngravity: [0, 0, 0]\ncloths:\n  - mesh: {grid: {width: 1, height: 0.5, nx: " n + 1 ", ny: " m + 1 ", cells: same}}\n    material: m\n    loads:"
            for (j = 0; j <= m; j++) { z = j * d - 0.25
                f = (j > 0 ? 2 * pull(z) + pull(z - d) : 0) + (j < m ? 2 * pull(z) + pull(z + d) : 0)
                print "      - {vertices: [" (j * (n + 1) + n) "], force: [" f ", 0, 0]}\n      - {vertices: [" (j * (n + 1)) "], force: [" (-f) ", 0, 0]}" }
            print "materials: {m: {model: triangles, density: 0.2, stretch: [1000, 300], shear: 50, poisson: 0.4}}"
            print "time: {h: 100, end: 100, fps: 0.01}\nsolver: {stop: {relative: 1e-12}}"
            print "probes: [{name: p, box: [[-9, -9, -9], [9, 9, 9]], values: [position]}]" }' > plane.yaml
    run plane.yaml || return 1
    rows 'NR == 3 { m = n / 2; d = 1 / n; middle = m / 2 * (n + 1); s = 0.02 / 1000
        sag = c("p." middle + m ".z") - (c("p." middle ".z") + c("p." middle + n ".z")) / 2; sag = sag / (s / 8) - 1
        for (j = 0; j <= m; j++) for (i = 0; i < n; i++) { v = j * (n + 1) + i
            e = (c("p." v + 1 ".x") - c("p." v ".x")) / d - 1 # of the triangles above and below this edge
            for (k = -1; k < 2; k++) if (j + k >= 0 && j + k <= m) { off = (e - s * ((j + k) * d - 0.25)) / (s / 4); if (off < 0) off = -off; if (off > most) most = off } }
        print sag < 0 ? -sag : sag, most }' -v n="$1"
}
halved() { awk -v a="$1" -v b="$2" 'BEGIN { printf "%.1f", log(a / b) / log(2) }'; }
converges() {
    # shellcheck disable=SC2046
    set -- $(plane 8) $(plane 16) $(plane 32)
    awk -v a="$1" -v b="$2" -v c="$3" -v d="$4" -v e="$5" -v f="$6" 'BEGIN {
        printf "# bending in the plane, 8, 16 and 32 cells: sag off by %.2g, %.2g, %.2g: order %.2f, %.2f\n", a, c, e, log(a / c) / log(2), log(c / e) / log(2)
        printf "# its strain off by %.2g, %.2g, %.2g: order %.2f, %.2f\n", b, d, f, log(b / d) / log(2), log(d / f) / log(2)
        p = log(c / e) / log(2) - 2; q = log(d / f) / log(2) - 1; exit !(p * p < 0.15 ^ 2 && q * q < 0.15 ^ 2) }' >&3 &&
        row "triangles bent in their plane by a pull s z at the ends, 32 x 16 cells: sag" "s L² / 8 E₁" "$(digit "$5"), order $(halved "$3" "$5") in mesh width" &&
        row "the same: largest error of the strain" "s z / E₁" "$(digit "$6"), order $(halved "$4" "$6")"
}
ok "convergence in mesh width: displacement 2, strain 1" converges

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
probes: [{name: p, vertices: [1, 60, 61, 62], values: [position]}]
END
}
hanging() { # NAME MATERIAL
    strip "$2" > strip.yaml
    run strip.yaml || return 1
    # shellcheck disable=SC2046
    set -- "$1" $(last p.1.y p.60.y p.61.y p.62.y)
    near "hanging strip, $1" "$(echo "$@" | awk -v OFMT=%.17g '{ print $2 - ($3 + 2 * $4 + $5) / 4 - 2 }')" "$(awk -v OFMT=%.17g 'BEGIN { print 0.2 * 9.81 * 4 / (2 * 100) }')" 2e-4 &&
        row "a strip of $1 hangs: its stretch" "ρ g L² / 2 E"
}
ok "a strip of triangles that hangs" hanging triangles 'model: triangles, stretch: [400, 100], shear: 20'
ok "a strip of springs that hangs: the modulus of the lattice" hanging springs 'stretch: [400, 100]'

# ---- Sheets of springs: what is pulled and sheared has the moduli that the report says, which are those of docs/physics.md ----
# 5 x 4 vertices in cells of A x B, free but for forces along its edges, half of an edge's on each end: uniform strain in any lattice.
lattice() { # A B MATERIAL LOADS
    cat << END
schema: 1
gravity: [0, 0, 0]
cloths:
  - mesh: {grid: {width: $(awk -v OFMT=%.17g -v a="$1" 'BEGIN { print 4 * a }'), height: $(awk -v OFMT=%.17g -v b="$2" 'BEGIN { print 3 * b }'), nx: 5, ny: 4, cells: same}}
    material: m
    loads: [$4]
materials:
  m: {density: 0.2, $3, damping: {mass: 20}}
time: {h: 0.05, end: 40, fps: 0.1}
solver: {stop: {relative: 1.0e-10}}
grain: 7
probes: [{name: p, vertices: [0, 4, 15, 19], values: [position]}]
END
}
along_z() { echo "{edges: [[$1, $(($1 + 5))], [$(($1 + 5)), $(($1 + 10))], [$(($1 + 10)), $(($1 + 15))]], force: $2}"; }
along_x() { echo "{edges: [[$1, $(($1 + 1))], [$(($1 + 1)), $(($1 + 2))], [$(($1 + 2)), $(($1 + 3))], [$(($1 + 3)), $(($1 + 4))]], force: $2}"; }
said() { sed -n "s/^ *\"material_m_$1\": *\([^,]*\).*/\1/p" report.json; }
gives() { # WHAT KEY FOUND CLOSED-FORM: what the report says, and what the sheet does
    near "$1, report" "$(said "$2")" "$4" 1e-12 && near "$1" "$3" "$4" 2e-4
}
strains() { # along x, along z, the angle
    # shellcheck disable=SC2046
    last p.0.x p.0.z p.4.x p.4.z p.15.x p.15.z p.19.x p.19.z |
        awk -v OFMT=%.12g -v w="$(awk -v OFMT=%.17g -v a="$1" 'BEGIN { print 4 * a }')" -v h="$(awk -v OFMT=%.17g -v b="$2" 'BEGIN { print 3 * b }')" '{
            print ($3 - $1 + $7 - $5) / 2 / w - 1, ($6 - $2 + $8 - $4) / 2 / h - 1, ($4 - $2 + $8 - $6) / 2 / w + ($5 - $1 + $7 - $3) / 2 / h }'
}
moduli() { # NAME A B MATERIAL E1 E2 G NU12: closed forms; 0.01 N/m on the edges
    lattice "$2" "$3" "$4" "$(along_z 4 '[0.01, 0, 0]'), $(along_z 0 '[-0.01, 0, 0]')" > warp.yaml
    run warp.yaml --report report.json || return 1
    # shellcheck disable=SC2046
    set -- "$@" $(strains "$2" "$3")
    gives "$1, E of the warp" E_warp "$(awk -v e="$9" 'BEGIN { printf "%.12g", 0.01 / e }')" "$5" || return 1
    narrows=$(awk -v x="$9" -v z="${10}" 'BEGIN { printf "%.12g", -z / x }')
    below "$1, nu12 $8 but for" "$(awk -v a="$narrows" -v b="$8" -v c="$(said nu12)" 'BEGIN { a -= b; c -= b; print (a < 0 ? -a : a) + 1e6 * (c < 0 ? -c : c) }')" 1e-4 || return 1
    lattice "$2" "$3" "$4" "$(along_x 15 '[0, 0, 0.01]'), $(along_x 0 '[0, 0, -0.01]')" > weft.yaml
    run weft.yaml --report report.json || return 1
    # shellcheck disable=SC2046
    set -- "$1" "$2" "$3" "$4" "$5" "$6" "$7" "$8" $(strains "$2" "$3")
    gives "$1, E of the weft" E_weft "$(awk -v e="${10}" 'BEGIN { printf "%.12g", 0.01 / e }')" "$6" || return 1
    lattice "$2" "$3" "$4" "$(along_x 15 '[0.01, 0, 0]'), $(along_x 0 '[-0.01, 0, 0]'), $(along_z 4 '[0, 0, 0.01]'), $(along_z 0 '[0, 0, -0.01]')" > shear.yaml
    run shear.yaml --report report.json || return 1
    # shellcheck disable=SC2046
    set -- "$1" "$2" "$3" "$4" "$5" "$6" "$7" "$8" $(strains "$2" "$3")
    gives "$1, G" G "$(awk -v e="${11}" 'BEGIN { printf "%.12g", 0.01 / e }')" "$7" && row "a lattice of springs, $1: E₁, E₂, ν₁₂, G" "its [moduli](physics.md#moduli-of-a-lattice-of-springs)"
}
value() { awk "BEGIN { printf \"%.17g\", $1 }"; }
ok "both diagonals, shear half of stretch: isotropic" moduli "both diagonals" 0.1 0.1 'stretch: 900, shear: 450' 1200 1200 450 "$(value 1/3)"
# C11 = ks + kd, C22 = kw + kd, C12 = G = kd
ok "warp and weft" moduli "warp and weft" 0.1 0.1 'stretch: [900, 300], shear: 400' "$(value 1300-160000/700)" "$(value 700-160000/1300)" 400 "$(value 4/7)"
# Cells of 0.1 x 0.2: C11 = 900 / 2 + 2 kd 0.1^3 / (0.2 * 0.05) = 530, C22 = 1200 + 2 kd 0.2^3 / (0.1 * 0.05) = 2480, C12 = 2 kd 0.02 / 0.05
ok "cells that are not square" moduli "oblong cells" 0.1 0.2 'stretch: [900, 600], shear: 400' "$(value 530-320*320/2480)" "$(value 2480-320*320/530)" 320 "$(value 320/2480)"
ok "one diagonal: 1 / G = 2 / kd + 2 / ks" moduli "one diagonal" 0.1 0.1 'stretch: 1000, shear: 400, diagonals: one' 1000 1000 "$(value 1000/7)" 0
# 1 / G = (a^2 / 900 + b^2 / 600 + (a^2 + b^2) / kd) / (a b)
ok "one, in cells that are not square" moduli "one diagonal, oblong" 0.1 0.2 'stretch: [900, 600], shear: 400, diagonals: one' 450 1200 \
    "$(value '0.02/(0.01/900+0.04/600+0.05/400)')" 0
ok "that of sheet.yaml" moduli "sheet.yaml" 0.1 0.1 'stretch: 5000, shear: 2500, diagonals: one' 5000 5000 "$(value 2500/3)" 0

null() { # KEY...: what the report does not know
    for key in "$@"; do test "$(said "$key")" = null || return 1; done
}
no_grid() {
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' > one.obj
    lattice 0.1 0.1 'stretch: 900' '' > other.yaml
    run other.yaml --end 0.1 --report report.json --set 'probes=[]' --set 'cloths[0].mesh={file: one.obj}' && null E_warp E_weft G nu12
}
ok "springs of a mesh that is no grid: null" no_grid
two_cells() { # the same material in cells of other sides; triangles do not mind
    lattice 0.1 0.1 'stretch: 900' '' > other.yaml
    set -- --end 0.1 --report report.json --set contact.mode=project --set 'probes=[]' --set 'cloths[1]={mesh: {grid: {width: 1, height: 2, nx: 5, ny: 5}}, material: m}'
    run other.yaml "$@" && null E_warp E_weft && run other.yaml "$@" --set materials.m.model=triangles --set materials.m.poisson=0.2 &&
        near "triangles, report" "$(said E_weft)" 900 0 && near "triangles, nu12" "$(said nu12)" 0.2 0
}
ok "cloths of other cells: null" two_cells

# ---- A clamped strip of rigidity D under its weight q, 0.5 m from the clamp: D theta'' = -q (L - s) cos theta ----
# Hinges share the bending out to half an edge either way: the strip is free from half an edge behind its clamped rows on. Its
# diagonals are mirrored at the middle: were they all alike, the strip would twist as it bends, and bend further. What either half
# twists on its own vanishes with the width of a cell against its length (docs/physics.md): here a quarter.
beam() { # COLUMNS DENSITY SETTINGS: columns from the clamp on
    awk -v n="$1" -v OFMT=%.12g -v CONVFMT=%.12g 'BEGIN { d = 0.5 / (n - 0.5)
        for (j = 0; j < 3; j++) for (i = 0; i <= n; i++) print "v", i * d, 0, j * d / 4
        for (j = 0; j < 2; j++) for (i = 1; i <= n; i++) { a = j * (n + 1) + i; b = a + n + 1
            if (j) print "f", a, b, a + 1 "\nf", a + 1, b, b + 1; else print "f", a, b, b + 1 "\nf", a, b + 1, a + 1 } }' > beam.obj
    cat << END
schema: 1
cloths:
  - {mesh: {file: beam.obj}, material: m, pins: [{box: [[-1, -1, -1], [$(awk -v OFMT=%.17g -v n="$1" 'BEGIN { print 0.51 / (n - 0.5) }'), 1, 1]]}]}
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
# order WHAT COARSE FINE EXACT: of two meshes of 7.5 and 15.5 cells; 2 is expected
order() {
    awk -v what="$1" -v a="$2" -v b="$3" -v c="$4" 'BEGIN { e = a - c; f = b - c; order = log(e / f) / log(15.5 / 7.5)
        printf "# %s, order in mesh width: %.2f\n", what, order; exit !(order > 1.8 && order < 2.3) }' >&3
}
bent() { # NAME MODEL LOAD MOST: two meshes, the error and its order
    density=$(awk -v OFMT=%.17g -v load="$3" 'BEGIN { print load * 1e-3 / 0.125 / 9.81 }') # D = 1e-3 N m
    set -- "$1" "bending: {model: $2, rigidity: 1.0e-3}" "$(elastica "$3")" "$4" "$density"
    coarse=$(deflection 8 "$5" "$2") && fine=$(deflection 16 "$5" "$2") || return 1
    near "$1" "$(awk -v OFMT=%.17g -v y="$fine" 'BEGIN { print -y / 0.5 }')" "$3" "$4" && order "$1" "$coarse" "$fine" "$(awk -v OFMT=%.17g -v y="$3" 'BEGIN { print -y / 2 }')" &&
        row "$1: deflection by 16 columns" "the elastica"
}
ok "elastica of little load is q L^4 / 8 D" near "its own check" "$(elastica 0.001)" 0.000125 1e-6
ok "a clamped strip that bends a little, hinges" bent "a clamped strip bends a little, q L³ / D = 0.08, hinges" hinge 0.08 3e-3
ok "a clamped strip that bends a little, quadratic" bent "the same, quadratic" quadratic 0.08 3e-3
ok "a clamped strip that bends far" bent "a clamped strip bends far, q L³ / D = 8, hinges" hinge 8 1e-3

# ---- Its first frequency: 3.5160 / (2 pi L^2) sqrt(D / density), let go in the shape of that mode, from where its tip crosses the middle ----
frequency() { # COLUMNS
    beam "$1" 6.5e-5 'bending: {rigidity: 1.0e-3}' > beam.yaml
    run beam.yaml --set integrator=bdf2 --set time.h=2e-4 --set time.end=0.3 --set materials.m.damping.mass=0 --set 'gravity=[0, 0, 0]' \
        --set "cloths[0].start=$(awk -v n="$1" 'BEGIN { k = 1.8751040687; d = 1 / (n - 0.5); printf "["
            for (i = 2; i <= n; i++) { x = k * (i - 0.5) * d; e = exp(x); y = (e + 1 / e) / 2 - cos(x) - 0.734095514 * ((e - 1 / e) / 2 - sin(x))
                printf "%s{box: [[%.12g, -1, -1], [%.12g, 1, 1]], translate: [0, %.12g, 0]}", (i == 2 ? "" : ", "), (i - 0.1) * d / 2, (i + 0.1) * d / 2, y * 1e-4 }
            print "]" }')" || return 1
    rows '{ now = c("p." tip ".y") } NR > 2 && (now > 0) != (before > 0) { t = c("time") - 2e-4 * now / (now - before); if (!n++) first = t; last = t }
        { before = now } END { printf "%.12g", (n - 1) / 2 / (last - first) }' -v tip=$((2 * $1 + 1))
}
swings() {
    coarse=$(frequency 8) && fine=$(frequency 16) || return 1
    set -- "$(awk 'BEGIN { printf "%.12g", 3.5160153 / (2 * 3.14159265359 * 0.25) * sqrt(1e-3 / 6.5e-5) }')"
    near "clamped strip, first frequency" "$fine" "$1" 6e-3 && order "clamped strip, first frequency" "$coarse" "$fine" "$1" &&
        row "the same: first frequency" "3.516 / (2π L²) √(D / ρ)"
}
ok "a clamped strip that swings" swings
ok "docs/accuracy.md has these rows" table
