#!/bin/sh
# Certified contact and the laws of mechanics, from probes and the report alone: solved to the end, a step never gains energy, what contacts
# hold included, beyond what the report says they were lent; two cloths keep their momentum and their spin; what pushes and cuts change of it is
# reported; a pile comes to rest.
. "${srcdir:-.}/tests/support/probes.sh"


triangles='materials.m={model: triangles, density: 0.2, stretch: 1000, shear: 300, poisson: 0.3, bending: {rigidity: 1e-5}}'

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
  - {name: a, cloth: a, box: [[-2, -2, -2], [2, 2, 2]], values: [position, velocity, contact]}
  - {name: b, cloth: b, box: [[-2, -2, -2], [2, 2, 2]], values: [position, velocity, contact]}
END
thrown() { run throw.yaml --report report.json "$@" && test "$(value contacts)" -gt 20; }
momentum() { # the largest change of momentum, kg m/s
    rows 'function mass(name, i, n) { n = name == "a" ? 7 : 8; return 0.008 / (n - 1) ^ 2 * (i % n % (n - 1) ? 1 : 0.5) * (int(i / n) % (n - 1) ? 1 : 0.5) }
        { split("", p); for (name in at) if (split(name, w, ".") == 3 && w[3] ~ /^v/) p[w[3]] += mass(w[1], w[2]) * $at[name]
          for (k in p) { if (!(k in first)) first[k] = p[k]; d = p[k] - first[k]; if (d * d > most) most = d * d } }
        END { printf "%.17g", sqrt(most) }'
}
converged='--set newton.steps=50 --set newton.tolerance=1e-10'
share() { # KEY: of the report, of the energy at the start
    value "$1" | awk -v e="$(value energy_start)" '{ print $1 / e }'
}
lends() { # WHAT: no step gained more than contacts were lent in it, so no more was gained in all
    test "$(value contact_cuts)" = 0 && test "$(value contact_pushes)" = 0 && below "energy gained beyond what was lent, $1, of all" "$(share energy_gained_unlent)" 1e-9 &&
        below "energy gained less all that was lent, $1, of all" "$(less "$(share energy_gained)" "$(share energy_lent)")" 1e-9
}
gain() { digit "$(share energy_gained)"; }
beyond() { digit "$(share energy_gained_unlent)"; }
keeps() { # FRICTION: energy, of what they have at the start; momentum, of 8 g at 0.5 m/s twice
    # shellcheck disable=SC2086
    thrown $converged --set contact.friction="$1" || return 1
    lends "friction $1" && below "energy gained, friction $1, of all" "$(share energy_gained)" 1e-9 &&
        below "momentum of two cloths, friction $1, of all" "$(momentum | awk -v OFMT=%.17g '{ print $1 / 0.008 }')" 1e-12 &&
        row "two sheets of springs thrown at each other, μ = $1: momentum changed; energy gained, of all" "0; 0" "$(digit "$(momentum | awk -v OFMT=%.17g '{ print $1 / 0.008 }')"); $(gain)"
}
ok "without friction, energy and momentum" keeps 0
ok "with friction" keeps 0.3
gains_none() { # FRICTION
    # shellcheck disable=SC2086
    thrown $converged --set contact.friction="$1" --set "$triangles" && lends "triangles, friction $1" && below "energy gained, triangles, of all" "$(share energy_gained)" 1e-9 &&
        row "the same, triangles, μ = $1: energy gained, of all" "0" "$(gain)"
}
ok "by triangles, without friction" gains_none 0
ok "by triangles, with friction" gains_none 0.3
reports() { # sheets that are pushed and cut change their momentum by so much
    thrown --set contact.friction=0.3 --set 'cloths[0].velocity=[0, 30, 0]' || return 1
    test "$(value contact_pushes)" -gt 0 && below "momentum beyond what pushes and cuts change, of all" \
        "$(momentum | awk -v cut="$(value contact_cut_momentum)" '{ print ($1 - cut) / 0.24 }')" 1e-12
}
ok "what pushes and cuts change of the momentum is reported" reports

# Contact changes the spin about the origin by the sum of x F, x where the step began, times its length; with implicit Euler also in
# the positions and velocities of its end, where springs are too soft to be of account.
spins() { # FRICTION OPTION...: prints what contact, and the motion, changed; the bound by docs/physics.md
    spins_friction=$1
    shift
    # shellcheck disable=SC2086
    thrown $converged --set contact.friction="$spins_friction" "$@" && test "$(value contact_cuts)" = 0 || return 1
    awk -v friction="$spins_friction" -v thickness=0.002 -f "$srcdir/tests/whole/spin.awk" out/probes.csv > spun && cat spun
}
soft='--set materials.m.stretch=1e-12 --set materials.m.shear=1e-12 --set materials.m.bend=1e-12'
centred() { # NAME OPTION...
    name=$1
    shift
    spins 0 "$@" && below "what contact changes of the spin, $*" "$(awk '{ print $1 }' spun)" 1e-12 &&
        row "the same, $name, μ = 0: spin that contact changes, of Σ m \|x\| \|v\|" "0"
}
ok "without friction contact keeps the spin" centred springs
ok "triangles likewise" centred triangles --set "$triangles"
ok "bdf2 likewise, about where steps begin" centred "springs, \`bdf2\`" --set integrator=bdf2
# shellcheck disable=SC2086
ok "sheets that nothing holds together" centred "springs of 1e-12 N/m" $soft
kept() { below "the spin of all that moves" "$(awk '{ print $2 }' spun)" 1e-12 && row "the same: spin of the motion" "kept"; }
ok "their spin at the end of steps" kept
rubs() { # NAME OPTION...: of the bound
    name=$1
    shift
    spins 0.3 "$@" && awk '{ print "# friction changes the spin by", $1, "of a bound of", $3; exit !($1 > 0.01 * $3 && $1 <= $3) }' spun >&3 &&
        row "the same, $name, μ = 0.3: spin that friction changes, of 2.6 μ d J" "below 1" "$(awk '{ printf "%.2f", $1 / $3 }' spun)"
}
ok "friction changes it within the gaps' moment" rubs springs
ok "by triangles" rubs triangles --set "$triangles"
# shellcheck disable=SC2086
ok "with soft sheets" rubs "springs of 1e-12 N/m" $soft
rubbed() { awk '{ exit !($2 <= $3 && $2 > 0.5 * $1) }' spun; }
ok "and the spin at the end of steps" rubbed

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
probes: [{name: a, cloth: a, vertices: [14], values: [position]}, {name: floor, obstacle: 0}]
END
falls() { # SCENE CONTACTS OPTION...: so many of them at least
    falls_scene=$1 falls_contacts=$2
    shift 2
    # shellcheck disable=SC2086
    run "$falls_scene.yaml" --report report.json $converged --set solver.stop.relative=1e-12 "$@" && test "$(value contacts)" -gt "$falls_contacts" && lends "$falls_scene $*"
}
lent() { # NAME SCENE CONTACTS OPTION...; $friction is theirs
    name=$1
    shift
    falls "$@" && row "$name, μ = $friction: energy gained beyond what was lent, of all" "0" "$(beyond)"
}
none() { falls "$@" && below "energy gained" "$(share energy_gained)" 1e-9 && row "four sheets of springs fall onto a floor and each other: energy gained, of all" "0" "$(gain)"; }
ok "a pile on a floor gains no energy" none pile 50
for friction in 0 0.3; do
    ok "what lifts a pile is what it was lent, friction $friction" lent "the same for 0.3 s, springs" pile 100 --set time.end=0.3 --set contact.friction=$friction
    ok "by triangles, friction $friction" lent "the same, triangles" pile 100 --set time.end=0.3 --set contact.friction=$friction --set "$triangles"
done
cat > ball.yaml << 'END'
schema: 1
cloths:
  - {name: a, material: m, mesh: {grid: {width: 0.3, height: 0.3, nx: 12, ny: 12}}, transform: {translate: [0.01, 0.105, 0.02]}}
materials: {m: {density: 0.2, stretch: 1000, shear: 300, bend: 1}}
obstacles: [{sphere: {centre: [0, 0, 0], radius: 0.1}}]
contact: {mode: certified, thickness: 0.002}
time: {h: 0.004, end: 0.15, stretch_growth: 0, energy_growth: 0}
energies: steps
END
sed -e 's/0\.01, 0\.105, 0\.02\]/0, 0.16, 0], rotate: [1, 1, 0, 0]/' -e 's/sphere: {.*}}/plane: {point: [0, 0, 0], normal: [0, 1, 0]}}/' ball.yaml > stand.yaml
for friction in 0 0.3; do
    ok "a sheet on a ball, friction $friction" lent "a sheet on a ball" ball 20 --set contact.friction=$friction
    ok "a sheet that lands on its edge, friction $friction" lent "a sheet that lands on its edge" stand 10 --set contact.friction=$friction
done
lifted() { test "$(share energy_gained | awk -v OFMT=%.17g '{ print ($1 > 1e-3) }')" = 1; }
ok "it jumps, by what it was lent" lifted
# Steps of bdf2 may gain energy, but not beyond what time.energy_growth lets them, 0.5 % of 0.77 m g L of square sheets.
guarded() { # NAME SCENE MASS WIDTH OPTION...
    guarded_name=$1 guarded_scene=$2 guarded_most=$(awk -v m="$3" -v l="$4" 'BEGIN { print 0.005 * 0.77 * m * 9.81 * l }')
    shift 4
    # shellcheck disable=SC2086
    run "$guarded_scene.yaml" --report report.json $converged --set solver.stop.relative=1e-12 --set integrator=bdf2 --set time.energy_growth=0.005 "$@" &&
        test "$(value contact_cuts)" = 0 && below "energy gained beyond what was lent, $guarded_scene $*, bdf2, J" "$(value energy_gained_unlent)" "$guarded_most" &&
        row "$guarded_name, μ = $friction, \`bdf2\`: energy gained beyond what was lent, of 0.77 m g L" "below 0.5 %" "$(awk -v e="$(value energy_gained_unlent)" -v most="$guarded_most" 'BEGIN { printf "%.2f %%", 0.5 * e / most }')"
}
for friction in 0 0.3; do
    ok "a pile, bdf2, friction $friction" guarded "the pile of springs" pile 0.032 0.2 --set contact.friction=$friction
    ok "by triangles, bdf2, friction $friction" guarded "the pile of triangles" pile 0.032 0.2 --set contact.friction=$friction --set "$triangles"
    ok "a sheet that lands on its edge, bdf2, friction $friction" guarded "the sheet that lands on its edge" stand 0.018 0.3 --set contact.friction=$friction
done
rests() { # 0.0314 J where it starts
    run pile.yaml --report report.json --set time.end=0.8 && below "energy of motion of a pile after 0.8 s, J" "$(value energy_kinetic)" 1e-6 && row "the pile of springs by linear steps: energy of motion after 0.8 s, of 31 mJ" "0" "$(digit "$(value energy_kinetic | awk -v OFMT=%.17g '{ print $1 / 0.0314 }')")"
}
ok "a pile comes to rest" rests
weighs() { # DAMPING: 32 g at rest, in each step of a second
    run pile.yaml --set time.end=3 --set "materials.m.damping={$1}" || return 1
    below "weight on the floor, of a pile's" "$(rows '$2 > 2 { d = c("floor.cy") / 0.31392 - 1; n++; if (d * d > most) most = d * d } END { if (n) printf "%.17g", sqrt(most) }')" 1e-6
}
for damping in 'stiffness: 0.004' 'mass: 20'; do ok "the floor carries a pile's weight, damping of $damping" weighs "$damping"; done
ok "docs/accuracy.md has these rows" table
