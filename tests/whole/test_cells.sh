#!/bin/sh
# A grid's diagonals: a sheet that is symmetric has symmetric masses, moves symmetrically, and bends as its rigidity says.
# A scene that says nothing of its cells has mirrored ones.
. "${srcdir:-.}/tests/support/probes.sh"

# ---- Masses: what the pins of 3 x 3 vertices carry ----
masses() { # CELLS MATERIAL: masses of the nine vertices, of the sheet's
    cat > masses.yaml << END
schema: 1
cloths: [{mesh: {grid: {width: 1, height: 1, nx: 3, ny: 3$1}}, material: m, pins: [{box: [[-1, -1, -1], [1, 1, 1]]}]}]
materials: {m: {density: 0.2, stretch: 1000, shear: 100, $2}}
time: {h: 0.01, end: 0.01}
probes: [{name: p, box: [[-1, -1, -1], [1, 1, 1]], values: [reaction]}]
END
    run masses.yaml || return 1
    # shellcheck disable=SC2046 # nine numbers
    set -- $(last p.0.ry p.1.ry p.2.ry p.3.ry p.4.ry p.5.ry p.6.ry p.7.ry p.8.ry)
    for force in "$@"; do awk -v f="$force" 'BEGIN { printf "%.6f ", f / (9.81 * 0.2) }'; done
}
weighs() { # EXPECTED CELLS MATERIAL
    expected=$1
    shift
    found=$(masses "$@") && echo "found    $found" && echo "expected $expected" && test "$found" = "$expected "
}
by_cell="0.062500 0.125000 0.062500 0.125000 0.250000 0.125000 0.062500 0.125000 0.062500"
for cells in '' ', cells: alternate' ', cells: same'; do
    ok "springs weigh a quarter of each cell$cells" weighs "$by_cell" "$cells" 'model: springs'
done
by_triangle="0.083333 0.083333 0.083333 0.083333 0.333333 0.083333 0.083333 0.083333 0.083333"
ok "triangles weigh a third each, and mirrored ones alike" weighs "$by_triangle" '' 'model: triangles'

# ---- A sheet held in its middle drapes: mirror images of each other along u and along v ----
drape() { # CELLS MATERIAL
    cat << END
schema: 1
cloths:
  - mesh: {grid: {width: 0.6, height: 0.6, nx: 13, ny: 13$1}}
    material: m
    pins: [{box: [[-0.101, -1, -0.101], [0.101, 1, 0.101]]}]
materials: {m: {$2, damping: {mass: 2, stiffness: 0.005}}}
time: {h: 0.01, end: 0.5, fps: 1}
solver: {stop: {mass_norm: 1.0e-7}}
probes: [{name: p, box: [[-1, -1, -1], [1, 1, 1]], values: [position]}]
END
}
unlike() { # the largest distance between a vertex and the image of its opposite, m
    rows 'END { n = 13
        for (j = 0; j < n; j++) for (i = 0; i < n; i++) {
            v = j * n + i; u = j * n + n - 1 - i; w = (n - 1 - j) * n + i
            far(c("p." v ".x") + c("p." u ".x")); far(c("p." v ".y") - c("p." u ".y")); far(c("p." v ".z") - c("p." u ".z"))
            far(c("p." v ".x") - c("p." w ".x")); far(c("p." v ".y") - c("p." w ".y")); far(c("p." v ".z") + c("p." w ".z")) }
        print most + 0 }
        function far(d) { if (d < 0) d = -d; if (d > most) most = d }'
}
drapes() { # WHAT MOST CELLS MATERIAL
    drape "$3" "$4" > drape.yaml
    run drape.yaml && below "$1" "$(unlike)" "$2"
}
springs='density: 0.2, stretch: 500, shear: 100, bending: {rigidity: 1.0e-5}'
ok "a rib knit drapes symmetrically" drapes "a mirrored rib knit" 1e-6 '' 'like: rib_knit'
ok "springs with one diagonal a cell do" drapes "mirrored springs" 1e-6 '' "$springs, diagonals: one"
ok "with cells by turns, too" drapes "alternating springs" 1e-6 ', cells: alternate' "$springs, diagonals: one"
leans() {
    drape ', cells: same' "$springs, diagonals: one" > drape.yaml
    run drape.yaml && unlike=$(unlike) && echo "off by $unlike" && awk -v u="$unlike" 'BEGIN { exit !(u > 1e-2) }'
}
ok "with diagonals that are all alike they lean" leans

# ---- A clamped strip, two square cells wide, of rigidity D under a little weight q: q L^4 / 8 D ----
# It is free from half a cell behind its two clamped columns on. Where its two halves meet it gives way: of first order in the cell.
strip() { # COLUMNS CELLS: its sag, of the closed form
    awk -v n="$1" -v cells="$2" 'BEGIN { OFMT = CONVFMT = "%.12g"; d = 0.5 / (n - 0.5); L = 0.5; D = 1e-3; q = 0.08 * D / L ^ 3
        print "schema: 1\ncloths:\n  - mesh: {grid: {width: " n * d ", height: " 2 * d ", nx: " n + 1 ", ny: 3" cells "}}"
        print "    material: m\n    pins: [{box: [[-9, -9, -9], [" 1.01 * d - n * d / 2 ", 9, 9]]}]"
        print "materials: {m: {model: triangles, stretch: 500, shear: 200, density: " q / 9.81 ", damping: {mass: 1}, bending: {rigidity: " D "}}}"
        print "time: {h: 0.1, end: 30, fps: 0.1}\nsolver: {stop: {relative: 1.0e-9}}"
        print "probes: [{name: p, vertices: [" n ", " 2 * n + 1 ", " 3 * n + 2 "], values: [position]}]" }' > strip.yaml
    run strip.yaml && last "p.$1.y" "p.$((2 * $1 + 1)).y" "p.$((3 * $1 + 2)).y" | awk '{ printf "%.6f %.6f\n", -$2 / (0.08 * 0.5 / 8), ($1 - $3) / $2 }'
}
bends() {
    coarse=$(strip 8 '') && fine=$(strip 16 '') || return 1
    near "a strip of two square cells and 16" "${fine% *}" 1 0.05 && below "its twist, of its sag" "$(echo "${fine#* }" | tr -d -)" 1e-6 &&
        awk -v a="${coarse% *}" -v b="${fine% *}" 'BEGIN { order = log((a - 1) / (b - 1)) / log(15.5 / 7.5)
            printf "# order in mesh width: %.2f\n", order; exit !(order > 0.9 && order < 1.3) }' >&3
}
ok "a strip of square cells bends as its rigidity says, and does not twist" bends
alike() {
    sag=$(strip 16 ', cells: same') && echo "$sag" && awk -v sag="${sag% *}" 'BEGIN { exit !(sag > 1.15 && sag < 1.25) }'
}
ok "with diagonals that are all alike it sags a fifth further" alike

# ---- Equilateral triangles of springs: E is the modulus and nu 1/3 whichever way the sheet is pulled ----
# Strained by e along x and held so, its energy is E e^2 / 2 (1 - nu^2) a square metre.
pulled() { # DEGREES
    awk -v turn="$1" 'BEGIN { OFMT = CONVFMT = "%.15g"; t = turn * 3.14159265358979 / 360
        print "schema: 1\ngravity: [0, 0, 0]\ncloths:\n  - mesh: {grid: {width: 1, nx: 7, ny: 6, cells: equilateral}}\n    material: m"
        print "    transform: {rotate: [" cos(t) ", 0, " sin(t) ", 0]}\n    pins: [{box: [[-9, -9, -9], [9, 9, 9]]}]"
        print "    start: [{box: [[-9, -9, -9], [9, 9, 9]], scale: [1.00001, 1, 1]}]"
        print "materials: {m: {density: 0.2, stretch: 1000}}\ntime: {h: 0.01, end: 0.01}"
        print "probes: [{name: p, vertices: [0], values: [position]}]" }' > pulled.yaml
    run pulled.yaml && area=$(awk 'BEGIN { printf "%.12g", 5 * 11 * sqrt(3) / 4 / 36 }') &&
        near "equilateral springs pulled at $1 degrees" "$(last elastic)" "$(awk -v a="$area" 'BEGIN { printf "%.12g", 1000 * 1e-10 / 2 * 9 / 8 * a }')" 1e-4
}
for turn in 0 15 30 45 90; do
    ok "a sheet of equilateral triangles pulled at $turn degrees" pulled $turn
done
even() {
    printf 'schema: 1\ncloths: [{mesh: {grid: {width: 0.6, nx: 14, ny: 15, cells: equilateral}}, material: rib_knit, pins: [{nearest: [0, 0, 0], radius: 0.12}]}]
time: {h: 0.01, end: 0.3, fps: 1}\nsolver: {stop: {mass_norm: 1.0e-7}}\nprobes: [{name: p, vertices: [0, 13, 189, 202], values: [position]}]\n' > even.yaml
    run even.yaml || return 1
    # shellcheck disable=SC2046 # four numbers
    set -- $(last p.0.y p.13.y p.189.y p.202.y)
    below "corners of an equilateral sheet" "$(echo "$@" | awk '{ for (i = 2; i <= 4; i++) { d = $i - $1; if (d < 0) d = -d; if (d > most) most = d } print most }')" 1e-6
}
ok "a sheet of equilateral triangles drapes symmetrically" even
