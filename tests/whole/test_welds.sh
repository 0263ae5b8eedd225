#!/bin/sh
# Welds: two halves of a sheet are the whole sheet, bit for bit, on one rank and two; pins, loads, masses and probes by either name of a
# vertex; and several panels at one vertex.
. "${srcdir:-.}/tests/support/probes.sh"

all='[[-9, -9, -9], [9, 9, 9]]'
material='density: 0.25, stretch: 500, shear: 100, damping: {stiffness: 0.01, mass: 0.1, viscous: 0.001}'
# The middle row of the whole sheet is the last row of the upper half and the first of the lower one, which alone has its loads and a pin.
whole() { # MATERIAL SCENE
    cat << END
schema: 1
contact: {mode: project}
grain: 20
cloths:
  - name: a
    mesh: {grid: {width: 1, height: 1, nx: 9, ny: 9, cells: same}}
    material: m
    pins: [{vertices: [0, 36]}]
    loads: [{vertices: [40], force: [0, 0.1, 0]}, {vertices: [41], force: [0, 0.1, 0], curve: {sine: {frequency: 3}}}]
    masses: [{vertices: [40], mass: 0.01}]
materials: {m: {$1}}
time: {h: 0.002, end: 0.1}
$2
probes: [{name: a, box: $all, values: [position, velocity, reaction]}]
END
}
halves() { # MATERIAL SCENE
    cat << END
schema: 1
contact: {mode: project}
grain: 20
cloths:
  - {name: a, mesh: {grid: {width: 1, height: 0.5, nx: 9, ny: 5, cells: same}}, transform: {translate: [0, 0, -0.25]}, material: m, pins: [{vertices: [0]}]}
  - name: b
    mesh: {grid: {width: 1, height: 0.5, nx: 9, ny: 5, cells: same}}
    transform: {translate: [0, 0, 0.25]}
    material: m
    pins: [{vertices: [0]}]
    loads: [{vertices: [4], force: [0, 0.1, 0]}, {vertices: [5], force: [0, 0.1, 0], curve: {sine: {frequency: 3}}}]
    masses: [{vertices: [4], mass: 0.01}]
welds:
  - {from: {cloth: a, vertices: [36, 37, 38, 39, 40, 41, 42, 43, 44]}, to: {cloth: b, vertices: [0, 1, 2, 3, 4, 5, 6, 7, 8]}}
materials: {m: {$1}}
time: {h: 0.002, end: 0.1}
$2
probes: [{name: a, cloth: a, box: $all, values: [position, velocity, reaction]}, {name: b, cloth: b, box: $all, values: [position, velocity, reaction]}]
END
}
# Every number of the halves' probes is that of the whole sheet's, whose vertex is 36 more than one of b.
same() {
    awk -F, 'NR == FNR && FNR == 1 { for (i = 1; i <= NF; i++) { split($i, w, " "); at[w[1]] = i } next }
        NR == FNR { row[FNR] = $0; next }
        FNR == 1 { for (i = 1; i <= NF; i++) { split($i, w, " "); n = split(w[1], part, ".")
            to[i] = at[n == 3 && part[1] == "b" ? "a." part[2] + 36 "." part[3] : w[1]]
            if (!to[i]) { print "no column " w[1]; bad = 1 } } next }
        { split(row[FNR], number, ","); for (i = 1; i <= NF; i++) if ($i != number[to[i]]) { if (!bad) print "line " FNR ", column " i ": " $i " for " number[to[i]]; bad = 1 } }
        END { exit bad || FNR < 50 }' "$1" "$2"
}
hash_of() { sed -n 's/^ *"state_hash": *"\(.*\)".*/\1/p' "$1"; }
welded() { # MATERIAL SCENE
    whole "$1" "$2" > whole.yaml && halves "$1" "$2" > halves.yaml
    run whole.yaml && mv out/probes.csv whole.csv && run halves.yaml --report report.json && same whole.csv out/probes.csv || return 1
    ranks 2 "$DUITE_CLOTH" halves.yaml --threads 2 --quiet --output out2 --report two.json || return 1
    same whole.csv out2/probes.csv && test "$(hash_of report.json)" = "$(hash_of two.json)"
}
ok "two halves of springs are the whole sheet, bit for bit" welded "$material" ''
ok "by BDF2, in half storage" welded "$material" 'integrator: bdf2
solver: {format: half}'
ok "by velocity Verlet" welded "$material" 'integrator: verlet'
ok "two halves of triangles in the wind" welded "model: triangles, $material" 'air: {wind: [1, 2, 3]}'

ok "two halves of triangles with hinges, damped" welded "model: triangles, bending: {rigidity: 1.0e-3}, $material" ''
ok "with the quadratic energy" welded "model: triangles, bending: {model: quadratic, rigidity: 1.0e-3}, $material" ''
ok "two halves of springs with hinges" welded "bending: {rigidity: [1.0e-3, 2.0e-3]}, $material" ''
# The lower half's mesh stands upright, 3 m away, whatever the welds' tolerance, and is turned into place at the start: at rest the seam is flat.
turned() {
    whole "model: triangles, bending: {rigidity: 1.0e-3}, $material" 'solver: {stop: {relative: 1.0e-12}}' > whole.yaml
    halves "model: triangles, bending: {rigidity: 1.0e-3}, $material" 'solver: {stop: {relative: 1.0e-12}}' |
        sed "s/^    transform: .*/    transform: {rotate: [0.5, 0.5, 0, 0], translate: [0, 0, 3]}\n    start: [{box: $all, about: [0, 0, 3], rotate: [0.5, -0.5, 0, 0], translate: [0, 0, -2.75]}]/" > halves.yaml
    run whole.yaml && high=$(last a.76.y) && run halves.yaml && below "lower edge, m" "$(less "$high" "$(last b.40.y)" | sed s/^-//)" 1e-9 &&
        run halves.yaml --set 'welds[0].tolerance=9' && below "of generous welds, m" "$(less "$high" "$(last b.40.y)" | sed s/^-//)" 1e-9 &&
        run halves.yaml --set materials.m.bending.rigidity=0 && ! below "without bending, m" "$(less "$high" "$(last b.40.y)" | sed s/^-//)" 1e-7
}
ok "panels that lie apart at rest are flat across their seam" turned
# Two panels at an angle whose cosine is 0.28, the second of which lies a micrometre's tenth off: they are at rest but for what the welds moved.
bent() { # OFFSET TOLERANCE
    cat > bent.yaml << END
schema: 1
contact: {mode: project}
gravity: [0, 0, 0]
cloths:
  - {name: a, mesh: {grid: {width: 0.3, height: 0.3, nx: 4, ny: 4}}, material: m}
  - {name: b, mesh: {grid: {width: 0.3, height: 0.3, nx: 4, ny: 4}}, material: m, transform: {rotate: [0.8, 0.6, 0, 0], translate: [0, -0.144, $1]}}
welds: [{from: {cloth: a, vertices: [12, 13, 14, 15]}, to: {cloth: b, vertices: [0, 1, 2, 3]}, tolerance: $2}]
materials: {m: {model: triangles, density: 0.2, stretch: 200, shear: 50, bending: {rigidity: 1.0}}}
time: {h: 0.005, end: 0.005}
probes: [{name: p, cloth: b, vertices: [12]}]
END
    run bent.yaml && elastic=$(awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "elastic [J]") at = i } NR == 2 { print $at }' out/probes.csv)
}
ok "a seam keeps the angle that the panels have" eval 'bent 0.192 1e-6 && below "energy, J" "$elastic" 1e-20'
ok "also where they are as close as the weld's tolerance" eval 'bent 0.1920001 1e-6 && below "energy, J" "$elastic" 1e-9'
ok "or as a tolerance of the user's own" eval 'bent 0.19201 2e-5 && below "energy, J" "$elastic" 1e-6'
# Two panels, flat at rest and folded along their seam at the start: the energy is the seam's, which bends only where both bend by one model.
folds() { # BENDING of the second panel
    cat > folds.yaml << END
schema: 1
contact: {mode: project}
gravity: [0, 0, 0]
cloths:
  - {name: a, mesh: {grid: {width: 0.3, height: 0.3, nx: 4, ny: 4}}, material: m}
  - name: b
    mesh: {grid: {width: 0.3, height: 0.3, nx: 4, ny: 4}}
    material: n
    transform: {translate: [0, 0, 0.3]}
    start: [{box: $all, about: [0, 0, 0.15], rotate: [0.8, 0.6, 0, 0]}]
welds: [{from: {cloth: a, vertices: [12, 13, 14, 15]}, to: {cloth: b, vertices: [0, 1, 2, 3]}}]
materials:
  m: {model: triangles, density: 0.2, stretch: 200, shear: 50, bending: {rigidity: 1.0}}
  n: {model: triangles, density: 0.2, stretch: 200, shear: 50, damping: {stiffness: 0.01}, bending: {$1}}
time: {h: 1.0e-4, end: 1.0e-4}
probes: [{name: p, cloth: b, vertices: [12]}]
END
    run folds.yaml && elastic=$(awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "elastic [J]") at = i } NR == 2 { print $at }' out/probes.csv)
}
ok "a seam of two models does not bend" eval 'folds "model: quadratic, rigidity: 1.0" && below "energy, J" "$elastic" 1e-20'
ok "but one of one model does" eval 'folds "rigidity: 1.0" && ! below "energy, J" "$elastic" 0.1'

# ---- Frames and hash name every vertex: those of a weld are at one place ----
frames() {
    halves "$material" '' > halves.yaml
    run halves.yaml || return 1
    test "$(od -An -t d4 -j 16 -N 4 out/cloth.pc2 | tr -d ' ')" = 90 || return 1
    # shellcheck disable=SC2046 # numbers
    set -- $(last a.40.x b.4.x a.40.y b.4.y a.36.ry b.0.ry)
    echo "$@" && test "$1" = "$2" && test "$3" = "$4" && test "$5" = "$6"
    # in the last frame, vertex 40 and vertex 45 + 4
    frame=$(($(od -An -t d4 -j 28 -N 4 out/cloth.pc2 | tr -d ' ') - 1))
    for vertex in 40 49; do od -An -t f4 -j $((32 + 12 * (90 * frame + vertex))) -N 12 out/cloth.pc2; done > places
    cat places && test "$(sort -u places | wc -l)" = 1
}
ok "frames and probes have both names of a vertex" frames
total() { # what carries: the whole weight at rest, and a vertex with two names counts once
    halves "$material" '' | sed 's/end: 0.1/end: 0.002/' > total.yaml
    run total.yaml --set 'probes=[{name: p, cloth: a, vertices: [36], values: [reaction]}, {name: q, cloth: b, vertices: [0], values: [total]}]' &&
        test "$(last p.36.ry)" = "$(last q.total.ry)"
}
ok "a total by the second name" total

# ---- A pin on the second name; a chain of welds is one vertex; parts of another damping ----
cat > star.yaml << 'END'
schema: 1
contact: {mode: project}
cloths:
  - {name: a, mesh: {inline: {vertices: [[0, 0, 0], [1, 0, 0]], edges: [[0, 1]]}}, mass_per_vertex: 0.1, material: m}
  - {name: b, mesh: {inline: {vertices: [[0, 1, 0], [0, 0, 0]], edges: [[0, 1]]}}, mass_per_vertex: 0.2, material: m}
  - {name: c, mesh: {inline: {vertices: [[0, 0, 1], [0, 0, 0]], edges: [[0, 1]]}}, mass_per_vertex: 0.3, material: n}
welds: [{from: {cloth: a, vertex: 0}, to: {cloth: b, vertex: 1}}, {from: {cloth: b, vertices: [1]}, to: {cloth: c, vertices: [1]}}]
materials: {m: {ea: 1.0e-9, damping: {viscous: 0.1, mass: 0.5}}, n: {ea: 1.0e-9, damping: {viscous: 0.3, mass: 0.25}}}
time: {h: 0.01, end: 0.01}
probes: [{name: p, cloth: c, vertices: [1]}, {name: q, cloth: a, vertices: [0]}]
END
chain() { # 0.6 kg fall with drag 0.3 + 0.5 * 0.3 + 0.25 * 0.3 kg/s
    run star.yaml && near "speed of a vertex of three parts" "$(last q.0.vy)" "$(awk 'BEGIN { printf "%.12g", -0.01 * 0.6 * 9.81 / (0.6 + 0.01 * 0.525) }')" 1e-9 &&
        test "$(last p.1.vy)" = "$(last q.0.vy)"
}
ok "three vertices in a chain of welds are one, with their masses and drag" chain
pinned() {
    run star.yaml --set 'cloths[2].pins=[{vertices: [1]}]' && near "reaction of a pin on the last name" "$(last q.0.ry)" "$(awk 'BEGIN { printf "%.12g", 0.6 * 9.81 }')" 1e-9
}
ok "a pin on the last name holds the one" pinned
moving() { # momentum by mass: 0.1 of 0.6
    run star.yaml --set gravity='[0, 0, 0]' --set 'cloths[0].velocity=[0, 6, 0]' &&
        near "velocity at the start" "$(awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "q.0.vy [m/s]") at = i } NR == 2 { print $at }' out/probes.csv)" 1 1e-12
}
ok "parts that move start with their common momentum" moving
tube() { # a strip whose ends are one: all vertices alike
    cat > tube.yaml << END
schema: 1
contact: {mode: project}
gravity: [0, 0, 0]
cloths:
  - mesh: {inline: {vertices: [[1, 0, 0], [0, 0, 1], [-1, 0, 0], [0, 0, -1], [1, 0, 0]], edges: [[0, 1], [1, 2], [2, 3], [3, 4]]}}
    mass_per_vertex: 0.1
    masses: [{vertices: [1, 2, 3], mass: 0.1}]
    material: m
    start: [{box: $all, scale: 1.1}]
welds: [{from: {vertex: 0}, to: {vertex: 4}}]
materials: {m: {ea: 10}}
time: {h: 0.01, end: 0.2}
solver: {stop: {relative: 1.0e-12}}
probes: [{name: p, vertices: [0, 1, 2, 4]}]
END
    # shellcheck disable=SC2046 # numbers
    run tube.yaml && set -- $(last p.0.x p.1.z p.2.x p.4.x) && near "a ring" "$1" "$2" 1e-9 && near "a ring" "$1" "${3#-}" 1e-9 && test "$1" = "$4"
}
ok "both ends of a chain are one: a ring stays round" tube

once() {
    run tube.yaml --set gravity='[0, -9.81, 0]' --set 'cloths[0].pins=[{vertices: [0]}]' --set 'probes=[{name: p, vertices: [0, 4], values: [reaction, total]}]' || return 1
    # shellcheck disable=SC2046 # numbers
    set -- $(last p.0.ry p.4.ry p.total.ry)
    echo "$@" && test "$1" = "$2" && test "$1" = "$3"
}
ok "a total counts a vertex with two names once" once

near_enough() { run star.yaml --set 'welds[0].to.vertex=0' --set 'welds[0].tolerance=1' --set 'welds[1].tolerance=2'; }
ok "vertices that start apart by less than their tolerance" near_enough
