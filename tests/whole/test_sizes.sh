#!/bin/sh
# Lengths at rest that change in time, of materials and of bands: a cloth of another size is the mesh of that size; what shrinks around a
# cylinder and what a band gathers have the tensions of closed forms; the same bits on any ranks, and after a restart in the middle.
. "${srcdir:-.}/tests/support/probes.sh"

# A sheet of 0.8 x 0.9 m that swings, and one of 1 x 1 m that is that much smaller: alike, whatever it is made of.
cat > small.yaml << 'END'
schema: 1
cloths:
  - name: sheet
    mesh: {grid: {width: 0.8, height: 0.9, nx: 7, ny: 8, cells: alternate}}
    material: m
    mass_per_vertex: 0.003
    pins: [{vertices: [0]}, {vertices: [6]}]
materials: {m: {model: triangles, stretch: [400, 300], shear: 100, poisson: 0.2, damping: {stiffness: 0.003}, strain_limit: {at: 0.01, stiffness: 300},
                bending: {rigidity: 2e-4}}}
time: {h: 0.01, end: 0.2, energy_growth: 0}
solver: {stop: {relative: 1e-12}, max_iterations: 2000}
probes: [{name: p, vertices: [27, 30, 55], values: [position, velocity, reaction]}]
grain: 12
END
sed 's/width: 0.8, height: 0.9/width: 1, height: 1/; s/^materials: {m: {/&size: {warp: [[0, 0.8]], weft: [[0, 0.9]]}, /
    s/^    material: m/&\n    start: [{box: [[-2, -2, -2], [2, 2, 2]], scale: [0.8, 1, 0.9]}]/' small.yaml > sized.yaml
as_meshed() { # SETTING...
    for setting in "$@"; do set -- "$@" --set "$setting" && shift; done
    run small.yaml "$@" && mv out/probes.csv meshed.csv && run sized.yaml "$@" || return 1
    below "the probes of both, m, m/s, N" "$(paste -d, meshed.csv out/probes.csv | awk -F, 'NR > 1 { n = NF / 2
        for (i = 1; i <= n; i++) { d = $i - $(i + n); if (d < 0) d = -d; if (d > most) most = d } } END { print most + 0 }')" 1e-8
}
ok "a sheet of another size is a mesh of that size, triangles" as_meshed
ok "of springs" as_meshed materials.m.model=springs materials.m.poisson=0 materials.m.bend=20
ok "with quadratic bending" as_meshed materials.m.bending.model=quadratic
ok "with bare edges beside, by BDF2" as_meshed integrator=bdf2 materials.m.ea=10
ok "by Verlet" as_meshed integrator=verlet time.h=1e-4 time.end=0.03

# A ring of 62 edges that lies loosely around a cylinder and shrinks to 0.95 of its length: T = E (2 pi R / girth - 1), girth that of the ring then.
awk 'BEGIN { n = 62; m = 4; r = 0.1012; pi = atan2(0, -1)
    for (j = 0; j <= m; j++) for (i = 0; i < n; i++) printf "v %.17g %.17g %.17g\n", r * cos(2 * pi * i / n), 0.01 * j - 0.02, -r * sin(2 * pi * i / n)
    for (j = 0; j <= m; j++) for (i = 0; i <= n; i++) printf "vt %.17g %.17g\n", 2 * r * sin(pi / n) * i, 0.01 * j
    for (j = 0; j < m; j++) for (i = 0; i < n; i++) {
        a = j * n + i + 1; b = j * n + (i + 1) % n + 1; s = j * (n + 1) + i + 1
        printf "f %d/%d %d/%d %d/%d\nf %d/%d %d/%d %d/%d\n", a, s, b, s + 1, b + n, s + n + 2, a, s, b + n, s + n + 2, a + n, s + n + 1 } }' > ring.obj
cat > ring.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
cloths: [{name: ring, mesh: {file: ring.obj}, material: m}]
materials: {m: {model: triangles, density: 0.2, stretch: 1000, shear: 500, damping: {stiffness: 0.01, mass: 5}, size: {warp: [[0, 1], [0.2, 0.95]]}}}
obstacles: [{cylinder: {centre: [0, 0, 0], axis: [0, 1, 0], radius: 0.1, length: 0.4}}]
contact: {mode: certified, thickness: 0.001}
probes: [{name: all, box: [[-1, -1, -1], [1, 1, 1]], values: [position, contact]}]
time: {h: 0.01, end: 0.5}
grain: 60
END
girth() { awk 'BEGIN { pi = atan2(0, -1); printf "%.17g", 62 * 2 * 0.1012 * sin(pi / 62) }'; }
# The last row, and vertices so far from the middle: the mean radius R; half the contact of the front half per height, the tension; all of it per area, the pressure.
ring_has() { # PART_OF_GIRTH MODULUS [FAR]
    awk -F, -v girth="$(girth)" -v part="$1" -v modulus="$2" -v far="${3:-0}" 'NR == 1 { for (i = 1; i <= NF; i++) { split($i, w, " "); at[i] = w[1] } next }
        { for (i = 1; i <= NF; i++) last[at[i]] = $i }
        END { height = 0.04; pi = atan2(0, -1)
            for (name in last) { if (name !~ /^all\..*\.x$/) continue
                v = substr(name, 1, length(name) - 1); if (last[v "y"] ^ 2 < far ^ 2) continue
                x = last[v "x"]; z = last[v "z"]; r = sqrt(x * x + z * z); n++; radii += r
                press += (last[v "cx"] * x + last[v "cz"] * z) / r
                if (z > 0) front += last[v "cz"] }
            R = radii / n; T = modulus * (2 * pi * R / (girth * part) - 1)
            print n, R, front / (2 * height), T, press / (2 * pi * R * height), T / R }' out/probes.csv
}
tight() { # PART MODULUS
    read -r vertices radius tension wanted pressure pressed << END
$(ring_has "$1" "$2")
END
    echo "$vertices vertices, radius $radius"
    test "$vertices" = 310 && near "tension of a ring that shrank, N/m" "$tension" "$wanted" 0.02 && row "tension of a ring that shrank to $1 around a cylinder, N/m" "E (2πR / girth − 1)" &&
        near "and its pressure, Pa" "$pressure" "$pressed" 0.02 && row "its pressure, Pa" "T / R"
}
shrinks() { run ring.yaml --check-intersections --report report.json && test "$(value intersections)" = 0 && tight 0.95 1000; }
ok "a ring that shrinks around a cylinder, certified" shrinks

# A band of 0.9 of the girth on each border of a ring of hardly any stiffness, one of them drawn tight: EA (girth / length - 1), of chords.
path() { awk -v from="$1" 'BEGIN { for (i = 0; i < 62; i++) printf "%d, ", from + i; print from }'; }
bands="[{vertices: [$(path 0)], length: 0.57, ea: 20, damping: 0.01}, {vertices: [$(path 248)], length: 0.6, size: [[0, 1], [0.2, 0.95]], ea: 20, damping: 0.01}]"
banded() {
    run ring.yaml --set "cloths[0].bands=$bands" --set materials.m.size=null --set 'materials.m.stretch=[1, 1000]' --set time.end=1.5 --check-intersections --report report.json || return 1
    test "$(value intersections)" = 0 && read -r vertices radius tension wanted pressure pressed << END
$(ring_has 1 0 0.015)
END
    echo "$vertices vertices, radius $radius; $tension $wanted $pressed" # the pressure is that of a height of 0.04 m
    near "tension of two bands around a cylinder, N" "$(awk -v p="$pressure" -v r="$radius" 'BEGIN { printf "%.17g", p * r * 0.04 }')" \
        "$(awk -v r="$radius" 'BEGIN { printf "%.17g", 40 * (124 * r * sin(atan2(0, -1) / 62) / 0.57 - 1) }')" 0.02 && row "tension of two bands around a cylinder, N" "2 EA (girth / length − 1)"
}
ok "bands around a cylinder" banded

# A strip of soft cloth that hangs from a band: the band is stretched evenly by its own end load, however the mesh is cut.
cat > strap.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
cloths:
  - mesh: {inline: {vertices: [[0, 0, 0], [0.1, 0, 0], [0.3, 0, 0], [0.4, 0, 0]], edges: [[0, 1], [1, 2], [2, 3]]}}
    material: m
    mass_per_vertex: 0.01
    pins: [{vertices: [0]}]
    loads: [{vertices: [3], force: [2, 0, 0]}]
    bands: [{vertices: [0, 1, 2, 3], length: 0.2, ea: 10, damping: 0.1, size: [[0, 1], [0.5, 1.5]]}]
materials: {m: {ea: 0, damping: {mass: 20}}}
probes: [{name: p, vertices: [1, 3], values: [position]}]
time: {h: 0.01, end: 4}
END
gathers() {
    run strap.yaml || return 1
    read -r first all << END
$(last p.1.x p.3.x)
END
    near "length of a band, m" "$all" 0.36 1e-6 && row "a band of length l under F, grown to 1.5 l" "1.5 l (1 + F / EA)" && near "its first quarter, m" "$first" 0.09 1e-6
}
ok "a band's parts are stretched alike" gathers

# ---- The same bits; and after a restart in the middle of the change ----
runs="3 --threads 2 --scheduler lifo"
alike() { # SCENE SETTING...
    scene=$1
    shift
    for setting in "$@"; do set -- "$@" --set "$setting" && shift; done
    run $scene "$@" --set 'probes=[]' --report report.json || return 1
    # shellcheck disable=SC2086 # options
    ranks ${runs%% *} "$DUITE_CLOTH" $scene --quiet --report many.json --set 'probes=[]' ${runs#* } "$@" && test "$(value state_hash)" = "$(value state_hash many.json)"
}
change='materials.m.size={warp: [[0, 1], [0.2, 0.9]], weft: [[0.05, 1], [0.1, 1.05]]}'
ok "the same bits, triangles" alike small.yaml "$change"
runs="2 --threads 2 --scheduler fifo --mapping cyclic"
ok "of springs, halved steps" alike small.yaml "$change" materials.m.model=springs materials.m.poisson=0 time.h=0.02 time.stretch_growth=0.01
ok "of a ring with bands under contact" alike ring.yaml "cloths[0].bands=$bands" time.end=0.05
restarts() {
    rm -rf part && limited "$DUITE_CLOTH" ring.yaml --threads 1 --quiet --report whole.json --set time.end=0.16 --set 'probes=[]' &&
        limited "$DUITE_CLOTH" ring.yaml --threads 1 --quiet --output part --checkpoint 1000 --end 0.1 --set 'probes=[]' &&
        limited "$DUITE_CLOTH" ring.yaml --threads 2 --quiet --restart part --end 0.16 --report rest.json --set 'probes=[]' || return 1
    test "$(value state_hash whole.json)" = "$(value state_hash rest.json)"
}
ok "a restart in the middle of the change" restarts

# Gusts (tests/cloth/physics/test_air.c has their means): the same on all ranks, others by another seed.
cat > wind.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
air: {wind: [4, 0, 1], turbulence: {intensity: 0.3, length: 0.3, seed: 5}}
cloths: [{mesh: {grid: {width: 1, height: 1, nx: 12, ny: 12}}, material: silk, pins: [{vertices: [0, 11]}]}]
time: {h: 0.005, end: 0.05}
grain: 20
END
gusts() { alike wind.yaml && mv report.json five.json && run wind.yaml --set air.turbulence.seed=6 --report report.json && test "$(value state_hash)" != "$(value state_hash five.json)"; }
ok "gusts are those of the seed" gusts

# ---- Bad input ----
refused() { # SENTENCE SETTING
    limited "$DUITE_CLOTH" ring.yaml --quiet --set "$2" > said 2>&1 && return 1
    cat said
    grep -qF "$1" said
}
ok "a size of nothing" refused "a size is 0 times that of the mesh; a factor from 0.1 to 10 is expected" 'materials.m.size={both: [[0, 1], [1, 0]]}'
ok "both and one" refused "materials.m.size has both and warp" 'materials.m.size={both: [[0, 1]], warp: [[0, 1]]}'
ok "times that do not ascend" refused "the time of key 1, from 0, is 0, which does not come after 0" 'materials.m.size={both: [[0, 1], [0, 1]]}'
ok "a band of one vertex" refused "a band has one vertex" 'cloths[0].bands=[{vertices: [1], length: 1, ea: 1}]'
ok "a band beside the edges" refused "there is no edge between vertices 0 and 2 of cloth 'ring', which a band has" 'cloths[0].bands=[{vertices: [0, 2], length: 1, ea: 1}]'
ok "docs/accuracy.md has these rows" table
