#!/bin/sh
# Joints from a vertex to a point on an edge: a mass on a bar's worth of two others against the closed form, what two panels of other
# divisions carry, momentum, limits of steps, and the same bits on any ranks and threads.
. "${srcdir:-.}/tests/support/probes.sh"

# A mass of 0.1 kg and, 0.5 m farther from it than the joint is long, two of 0.2 and 0.3 kg, the ends of an edge without strength. The joint ends
# at 0.3 of the edge and keeps across it: their distance d swings by d'' = -(k d + c d') (1 / 0.1 + 0.7^2 / 0.2 + 0.3^2 / 0.3).
cat > three.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
grain: 1
cloths:
  - {name: one, mesh: {inline: {vertices: [[1, 0, 0.3]]}}, mass_per_vertex: 0.1, material: m}
  - name: bar
    mesh: {inline: {vertices: [[0, 0, 0], [0, 0, 1]], edges: [[0, 1]]}}
    mass_per_vertex: 0.2
    masses: [{vertices: [1], mass: 0.1}]
    material: m
joints: [{from: {cloth: one, vertex: 0}, to: {cloth: bar, edge: [0, 1], at: 0.3}, stiffness: 40, damping: 0.1, length: 0.5}]
materials: {m: {ea: 1.0e-30}}
time: {h: 0.001, end: 0.3, stretch_growth: 0}
solver: {stop: {relative: 1.0e-13}}
probes:
  - {name: p, cloth: one, vertices: [0], values: [position, velocity]}
  - {name: q, cloth: bar, vertices: [0, 1], values: [position, velocity]}
END
distance() { # its largest error over all rows, m
    rows '{ t = c("time"); s = 10 + 0.49 / 0.2 + 0.09 / 0.3; r = s * 0.1 / 2; w = sqrt(40 * s - r * r)
        d = 0.5 + 0.5 * exp(-r * t) * (cos(w * t) + r / w * sin(w * t)) - (c("p.0.x") - 0.7 * c("q.0.x") - 0.3 * c("q.1.x"))
        if (d < 0) d = -d; if (d > most) most = d } END { printf "%.3g\n", most }'
}
momentum() { # of 1 kg m/s, and of 1 kg m^2/s about the bar's first end
    rows '{ p = 0.1 * c("p.0.vx") + 0.2 * c("q.0.vx") + 0.3 * c("q.1.vx"); j = 0.1 * c("p.0.z") * c("p.0.vx") + 0.3 * c("q.1.z") * c("q.1.vx")
        if (p < 0) p = -p; if (j < 0) j = -j; if (p > most) most = p; if (j > most) most = j } END { printf "%.3g\n", most }'
}
swings() { # INTEGRATOR H MOST [SETTING...]
    integrator=$1 h=$2 most=$3
    shift 3
    run three.yaml --set integrator="$integrator" --set time.h="$h" "$@" && below "$integrator: distance, m" "$(distance)" "$most" &&
        below "$integrator: momentum" "$(momentum)" 1e-14
}
ok "a mass on an edge by rk4" swings rk4 1e-3 1e-8
ok "by velocity Verlet" swings verlet 1e-3 2e-4
ok "by symplectic Euler" swings symplectic_euler 1e-4 2e-3
ok "by explicit Euler" swings explicit_euler 1e-5 2e-3
ok "by implicit Euler" swings implicit_euler 1e-4 5e-3
ok "by BDF2" swings bdf2 1e-4 1e-4
ok "in one block" swings rk4 1e-3 1e-8 --set grain=9
ok "by implicit Euler with Newton steps" swings implicit_euler 1e-4 5e-3 --set newton.steps=10 --set newton.tolerance=1e-12

# Drawn out by 0.2 m: what is not in the joint is in motion.
conserved() {
    run three.yaml --set integrator=rk4 --set joints[0].damping=0 --set joints[0].length=0.8 || return 1
    below "energy, of 0.8 J" "$(rows '{ e = c("kinetic") + c("elastic") - 0.8; if (e < 0) e = -e; if (e > most) most = e } END { printf "%.3g\n", most / 0.8 }')" 1e-7
}
ok "energy is kept" conserved

# Where all masses are as the weights, the largest vibration is that of the bound: w^2 = 40 (1 / 0.1 + 1 / 0.1), h < 2 / w.
limit='--set cloths[0].mass_per_vertex=0.1 --set cloths[1].mass_per_vertex=0.07 --set cloths[1].masses=[] --set joints[0].damping=0 --set integrator=verlet'
# shellcheck disable=SC2086 # a list of settings
limited_at() { # H
    run three.yaml $limit --set "cloths[1].mass_per_vertex=0.03" --set 'cloths[1].masses=[{vertices: [0], mass: 0.04}]' --set time.h="$1" --set time.end=0.4 2> said
    cat said
}
warns() { limited_at 0.0708 | grep 'beyond the limit of verlet, 0.0707'; }
ok "a step just beyond the limit of verlet is told" warns
silent() { ! limited_at 0.0706 | grep limit; }
ok "one just below it is not" silent

# At an end of the edge it is the joint to that vertex, bit for bit, if that one is timed, too.
at_end() { # AT VERTEX
    run three.yaml --set joints[0].to.at="$1" && cp out/probes.csv edge.csv &&
        run three.yaml --set "joints[0].to={cloth: bar, vertex: $2}" --set joints[0].end=9 && cmp out/probes.csv edge.csv
}
ok "at the first end" at_end 0 0
ok "at the second end" at_end 1 1

# Two panels, 0.7 m wide, side by side, of 10 and 14 cells along the common edge: each vertex of the one side is joined to the edge of the other.
panels() { # FINE: whether the finer panel has the vertices, else the coarser; of panels with 6 and 7 rows of vertices
    awk -v fine="$1" 'BEGIN { for (i = 0; i <= (fine ? 14 : 10); i++) { n = fine ? 10 : 14; t = i / (fine ? 14 : 10) * n; e = int(t + 1e-9); if (e == n) e--
        v = v (i ? ", " : "") (fine ? i : 55 + i); a = a (i ? ", " : "") sprintf("[%d, %d]", (fine ? 55 : 0) + e, (fine ? 55 : 0) + e + 1)
        w = t - e < 1e-9 ? 0 : t - e; f = f (i ? ", " : "") sprintf("%.12g", w) }
        printf "joints: [{from: {cloth: %s, vertices: [%s]}, to: {cloth: %s, edges: [%s], at: [%s]}, stiffness: 1.0e+5, length: 0}]\n", fine ? "b" : "a", v, fine ? "a" : "b", a, f }'
    cat << 'END'
schema: 1
gravity: [0, 0, 0]
contact: {mode: project}
grain: 30
cloths:
  - {name: a, mesh: {grid: {width: 0.7, height: 0.35, nx: 11, ny: 6}}, material: m, pins: [{box: [[-1, -1, -0.175], [1, 1, -0.175]]}]}
  - name: b
    mesh: {grid: {width: 0.7, height: 0.35, nx: 15, ny: 7}}
    material: m
    transform: {translate: [0, 0, 0.35]}
    loads: [{edges: [[90, 91], [91, 92], [92, 93], [93, 94], [94, 95], [95, 96], [96, 97], [97, 98], [98, 99], [99, 100], [100, 101], [101, 102],
        [102, 103], [103, 104]], force: [0, 0, 2]}]
materials: {m: {model: triangles, density: 0.2, stretch: 200, shear: 80}}
time: {h: 100, end: 200, fps: 1e-9}
newton: {steps: 20, tolerance: 1e-10}
solver: {stop: {relative: 1e-12}, max_iterations: 20000}
probes:
  - {name: p, cloth: b, vertices: [90, 97, 104], values: [position]}
  - {name: s, cloth: a, vertices: [55, 58, 60, 65], values: [position]}
  - {name: pins, cloth: a, box: [[-1, -1, -0.175], [1, 1, -0.175]], values: [total]}
END
}
panels 1 > fine.yaml
panels 0 > coarse.yaml
carries() { # SCENE MOST: 2 N/m draw 200 N/m out by 1 %, over 0.35 m to the seam and as far again
    most=$2
    run "$1" 2> said || { cat said; return 1; }
    # shellcheck disable=SC2046
    set -- $(last p.90.z p.97.z p.104.z s.55.z s.58.z s.60.z s.65.z pins.total.rz)
    near "pull of the pins" "$8" -1.4 1e-6 &&
        for z in "$1" "$2" "$3"; do near "length of both" "$(less "$z" 0.525)" 7e-3 3e-3 || return; done &&
        for z in "$4" "$5" "$6" "$7"; do near "where the seam is" "$(less "$z" 0.175)" 3.5e-3 "$most" || return; done
}
ok "a finer panel on the edges of a coarser one carries what whole cloth does" carries fine.yaml 0.02
ok "a coarser one on the edges of a finer one" carries coarse.yaml 0.03

# Swinging free, by every preconditioner, in steps of other joints, and on any ranks and threads.
free='--set cloths[0].pins=[] --set time.h=0.002 --set time.end=0.05 --set newton.steps=1 --set time.fps=25 --set joints[0].stiffness=100'
drift() { # SETTING...: of the mean velocity of all vertices, which have 1 g each, over that of the first row
    # shellcheck disable=SC2086
    run fine.yaml $free --set joints[0].damping=0.01 --set cloths[0].mass_per_vertex=0.001 --set cloths[1].mass_per_vertex=0.001 --set 'cloths[1].loads=[]' \
        --set 'cloths[1].velocity=[0.3, 1, 2]' --set 'probes=[{name: p, cloth: a, box: [[-9, -9, -9], [9, 9, 9]], values: [velocity]},
            {name: q, cloth: b, box: [[-9, -9, -9], [9, 9, 9]], values: [velocity]}]' "$@" || return 1
    below "momentum of two free panels" "$(awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) { split($i, w, " "); v[i] = w[1] ~ /v[xyz]$/ ? substr(w[1], length(w[1])) : "" } next }
        { delete s; for (i = 1; i <= NF; i++) if (v[i] != "") s[v[i]] += $i; if (NR == 2) for (k in s) was[k] = s[k]
            for (k in s) { d = s[k] / was[k] - 1; if (d < 0) d = -d; if (d > most) most = d } } END { print NR < 9 ? "" : most }' out/probes.csv)" 1e-12
}
ok "momentum of free panels, implicit Euler" drift
ok "momentum of free panels, velocity Verlet" drift --set integrator=verlet --set time.h=1e-4
for solver in none ic0 coarse ic0_coarse; do
    agrees() {
        # shellcheck disable=SC2086
        run fine.yaml $free --set solver.preconditioner=jacobi && cp out/probes.csv one.csv && run fine.yaml $free --set solver.preconditioner=$solver || return 1
        below "$solver against jacobi, m" "$(paste -d, out/probes.csv one.csv | awk -F, 'NR > 1 { n = NF / 2; for (i = 10; i <= n; i++) { d = $i - $(n + i); if (d < 0) d = -d; if (d > most) most = d } } END { print most + 0 }')" 1e-8
    }
    ok "by the preconditioner $solver" agrees
done
same() { # RANKS THREADS
    # shellcheck disable=SC2086
    ranks "$1" "$DUITE_CLOTH" fine.yaml $free --quiet --output out --threads "$2" && cmp out/probes.csv one.csv
}
hashes() {
    # shellcheck disable=SC2086
    run fine.yaml $free "$@" && cp out/probes.csv one.csv && same 1 2 && same 2 1 && same 3 2
}
ok "the same on any ranks and threads" hashes
