#!/bin/sh
# Cloths of several materials, by regions, against closed forms, through probes alone. docs/accuracy.md has the errors.
. "${srcdir:-.}/tests/support/probes.sh"

# Two weights of 0.1 kg, each on a spring of 40 N/m, coupled by one of 2 N/m: the first, drawn aside, hands its swing over and back.
cat > beats.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
cloths:
  - mesh: {inline: {vertices: [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]], edges: [[0, 1], [1, 2], [2, 3]]}}
    material: wire
    regions: [{vertices: [1, 2], material: weak}]
    mass_per_vertex: 0.1
    pins: [{vertices: [0, 3]}]
    start: [{vertices: [1], translate: [0.01, 0, 0]}]
materials: {wire: {density: 1, ea: 40}, weak: {density: 1, ea: 2}}
time: {h: 1e-3, end: 7}
integrator: rk4
probes: [{name: p, vertices: [1, 2], values: [position]}]
END
beats() {
    run beats.yaml || return 1
    below "beats of two coupled weights, of the amplitude" "$(rows '{ t = c("time"); s = cos(20 * t); f = cos(sqrt(440) * t)
        a = (c("p.1.x") - 1) / 0.01 - (s + f) / 2; b = (c("p.2.x") - 2) / 0.01 - (s - f) / 2
        if (a < 0) a = -a; if (b < 0) b = -b; if (a > most) most = a; if (b > most) most = b } END { print most }')" 1e-5 && row "two weights on springs, coupled by a weaker one, \`rk4\`: beats, of the amplitude" "(cos ω t ± cos √(ω² + 2 k₂ / m) t) / 2"
}
ok "a spring of its own between two weights" beats

# A strip of two materials is drawn at its end with 2 N/m: 2 N/m (L1 / E1 + L2 / E2) longer, from the pins to the loads.
cat > series.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
cloths:
  - mesh: {grid: {width: 1, height: 0.4, nx: 11, ny: 5}}
    material: soft
    regions:
      - {box: [[-9, -9, -9], [9, 9, 9]], material: wrong}
      - {box: [[-9, -9, -9], [-0.1, 9, 9]], material: soft}
      - {box: [[-0.1, -9, -9], [9, 9, 9]], material: hard}
    pins: [{box: [[-0.5, 0, -1], [-0.5, 0, 1]]}]
    loads: [{edges: [[10, 21], [21, 32], [32, 43], [43, 54]], force: [2, 0, 0]}]
materials:
  soft: {density: 0.1, stretch: 100}
  hard: {density: 0.3, stretch: 400}
  wrong: {density: 9, stretch: 7}
time: {h: 100, end: 1000, fps: 1e-9}
newton: {steps: 20, tolerance: 1e-12}
solver: {stop: {relative: 1e-10}}
grain: 9
probes: [{name: p, vertices: [4, 21], values: [position]}, {name: pins, box: [[-0.5, 0, -1], [-0.5, 0, 1]], values: [total]}]
END
series() { # NAME SCENE...
    name=$1
    shift
    run series.yaml "$@" || return 1
    # shellcheck disable=SC2046
    set -- $(last p.4.x p.21.x)
    near "strip of two materials, the soft part" "$(less "$1" -0.5)" 0.408 1e-9 && near "the whole" "$(less "$2" -0.5)" 1.011 1e-9 && row "a strip of two materials, of $name, drawn: either part" "s (L₁ / E₁ + L₂ / E₂)"
}
ok "a strip of two materials, springs" series springs
ok "a strip of two materials, triangles" series triangles --set materials.soft.model=triangles --set materials.hard.model=triangles \
    --set materials.wrong.model=triangles
weighs() {
    run series.yaml --set 'gravity=[0, -9.81, 0]' --set 'cloths[0].loads=[]' --set 'cloths[0].pins=[{box: [[-9, -9, -9], [9, 9, 9]]}]' \
        --set 'probes=[{name: p, box: [[-9, -9, -9], [9, 9, 9]], values: [total]}]' --end 100 || return 1
    near "weight of a strip of two densities" "$(last p.total.ry)" "$(awk -v OFMT=%.17g 'BEGIN { print 9.81 * 0.4 * (0.4 * 0.1 + 0.6 * 0.3) }')" 1e-6 && row "its weight" "g (ρ₁ A₁ + ρ₂ A₂)"
}
ok "a strip of two densities" weighs

# A flap on a hinge of its own rigidity and damping, as in test_closed_forms.sh.
cat > flap.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
cloths:
  - mesh: {inline: {vertices: [[0, 0, 0], [0, 0, 1], [-1, 0, 0.5], [1, 0, 0.5]], triangles: [[0, 1, 2], [1, 0, 3]]}}
    material: sheet
    regions: [{vertices: [0, 1], material: fold}, {vertices: [3, 0], material: drag}]
    mass_per_vertex: 0.1
    pins: [{vertices: [0, 1, 2]}]
    start: [{vertices: [3], velocity: [0, 0.001, 0]}]
materials:
  sheet: {stretch: 100}
  fold: {stretch: 100, bending: {rigidity: 10}, damping: {stiffness: 0.02}}
  drag: {stretch: 100, damping: {viscous: 0.1}}
time: {h: 2e-4, end: 1}
integrator: rk4
probes: [{name: p, vertices: [3], values: [velocity]}]
END
flap() { # MODEL SCENE...
    name=$1
    shift
    run flap.yaml "$@" || return 1
    below "flap on a fold of its own, dragged at its tip" "$(rows '{ a = 0.02 * 50 + 0.5; w = sqrt(100 - a * a); t = c("time"); d = c("p.3.vy") - 0.001 * exp(-a * t) * (cos(w * t) - a / w * sin(w * t))
        if (d < 0) d = -d; if (d > most) most = d } END { print most / 0.001 }')" 1e-6 && row "a flap on a fold of its own rigidity and damping, its tip dragged, \`$name\`" "ω² = D / m, e^(−(β ω² + d) t / 2)"
}
ok "a fold with a rigidity, its tip with a drag" flap hinge
ok "a quadratic fold" flap quadratic --set materials.fold.bending.model=quadratic

# The limit of explicit steps is that of the hardest region: 2 / w, w^2 = 2 (k1 + k2) / m or less.
warned() {
    run beats.yaml --end 0.01 --set integrator=verlet --set time.h=0.005 --set materials.weak.ea=4e4 2> said || true
    cat said
    grep -q 'beyond the limit of verlet, 0.0022' said
}
ok "the limit of explicit steps" warned

same() {
    run series.yaml --end 200 && cp out/probes.csv one.csv &&
        ranks 2 "$DUITE_CLOTH" series.yaml --end 200 --quiet --output out --threads 2 && cmp out/probes.csv one.csv
}
ok "regions on 2 ranks" same
ok "docs/accuracy.md has these rows" table
