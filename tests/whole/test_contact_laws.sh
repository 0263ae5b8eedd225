#!/bin/sh
# Certified contact and the laws of mechanics, from probes and the report alone: solved to the end, a step never gains energy, what contacts
# hold included; two cloths keep their momentum; what cuts change of it is reported; a pile comes to rest.
. "${srcdir:-.}/tests/support/tap.sh"
. "$srcdir/tests/support/probes.sh"
plan_later


# ---- Two sheets thrown at each other in free space. A vertex of a grid of springs has a quarter of the mass of each of its cells.

cat > throw.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
cloths:
  - {name: a, material: m, mesh: {grid: {width: 0.2, height: 0.2, nx: 7, ny: 7}}, velocity: [0, 0.5, 0]}
  - {name: b, material: m, mesh: {grid: {width: 0.2, height: 0.2, nx: 8, ny: 8}}, velocity: [0.2, -0.5, 0],
     transform: {translate: [0.03, 0.02, 0.02], rotate: [0.97, 0.05, 0.2, 0.03]}}
materials: {m: {density: 0.2, stretch: 1000, shear: 300, bend: 1}}
contact: {mode: certified, thickness: 0.002}
time: {h: 0.002, end: 0.1, stretch_growth: 0, energy_growth: 0}
solver: {stop: {relative: 1.0e-12}}
energies: steps
probes:
  - {name: a, cloth: a, box: [[-2, -2, -2], [2, 2, 2]], values: [velocity]}
  - {name: b, cloth: b, box: [[-2, -2, -2], [2, 2, 2]], values: [velocity]}
END
thrown() { run throw.yaml --report report.json "$@" && test "$(value contacts)" -gt 20; }
momentum() { # the largest change of momentum, kg m/s
    rows 'function mass(name, i, n) { n = name == "a" ? 7 : 8; return 0.008 / (n - 1) ^ 2 * (i % n % (n - 1) ? 1 : 0.5) * (int(i / n) % (n - 1) ? 1 : 0.5) }
        { split("", p); for (name in at) if (split(name, w, ".") == 3 && w[3] ~ /^v/) p[w[3]] += mass(w[1], w[2]) * $at[name]
          for (k in p) { if (!(k in first)) first[k] = p[k]; d = p[k] - first[k]; if (d * d > most) most = d * d } }
        END { printf "%.17g", sqrt(most) }'
}
converged='--set newton.steps=50 --set newton.tolerance=1e-10'
keeps() { # FRICTION: energy, of what they have at the start; momentum, of 8 g at 0.5 m/s twice
    # shellcheck disable=SC2086
    thrown $converged --set contact.friction="$1" || return 1
    test "$(value contact_cuts)" = 0 && below "energy gained, friction $1, of all" "$(value energy_gained | awk -v e="$(value energy_start)" '{ print $1 / e }')" 1e-9 &&
        below "momentum of two cloths, friction $1, of all" "$(momentum | awk '{ print $1 / 0.008 }')" 1e-12
}
ok "without friction, energy and momentum" keeps 0
ok "with friction" keeps 0.3
reports() { # a sheet that is cut changes its momentum by so much
    thrown --set contact.friction=0.3 --set 'cloths[0].velocity=[0, 20, 0]' || return 1
    test "$(value contact_cuts)" -gt 0 && below "momentum beyond what cuts change, of all" \
        "$(momentum | awk -v cut="$(value contact_cut_momentum)" '{ print ($1 - cut) / 0.16 }')" 1e-12
}
ok "what cuts change of the momentum is reported" reports

# ---- Four sheets fall onto the floor and each other.

sheet() { # NAME, HEIGHT, COSINE, SINE of the half angle by which it is turned
    printf '  - {name: %s, material: m, mesh: {grid: {width: 0.2, height: 0.2, nx: 6, ny: 6}}, transform: {translate: [0.003, %s, 0.001], rotate: [%s, 0, %s, 0]}, %s}\n' "$@" \
        'start: [{box: [[-1, 0, -1], [1, 1, 1]], wave: {vector: [8, 0, 6], phase: 0.1, translate: [0, 5.0e-4, 0]}}]'
}
cat > pile.yaml << END
schema: 1
cloths:
$(sheet a 0.01 1 0)
$(sheet b 0.02 0.9848 0.1736)
$(sheet c 0.03 0.9397 0.3420)
$(sheet d 0.04 0.8660 0.5)
materials: {m: {density: 0.2, stretch: 1000, shear: 300, bend: 1}}
obstacles: [{plane: {point: [0, 0, 0], normal: [0, 1, 0]}}]
contact: {mode: certified, thickness: 0.002, friction: 0.3}
time: {h: 0.004, end: 0.16, stretch_growth: 0, energy_growth: 0}
energies: steps
probes: [{name: a, cloth: a, vertices: [14], values: [position]}]
END
falls() {
    # shellcheck disable=SC2086
    run pile.yaml --report report.json $converged --set solver.stop.relative=1e-12 || return 1
    test "$(value contact_cuts)" = 0 && test "$(value contacts)" -gt 50 &&
        below "energy gained by a pile, of all" "$(value energy_gained | awk -v e="$(value energy_start)" '{ print $1 / e }')" 1e-9
}
ok "a pile on a floor gains no energy" falls
rests() { # 0.0314 J where it starts
    run pile.yaml --report report.json --set time.end=0.8 && below "energy of motion of a pile after 0.8 s, J" "$(value energy_kinetic)" 1e-6
}
ok "a pile comes to rest" rests
