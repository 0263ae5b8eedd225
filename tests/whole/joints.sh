# Sourced by tests of joints after probes.sh: two masses on a joint, two panels joined along an edge; $timed: settings of every run of the
# masses.
timed=

# Two masses of 0.1 and 0.3 kg, joined by 40 N/m and 0.1 kg/s, begin 0.5 m farther apart than the joint is long.
cat > two.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
grain: 1
cloths:
  - {name: one, mesh: {inline: {vertices: [[0, 0, 0]]}}, mass_per_vertex: 0.1, material: m}
  - {name: other, mesh: {inline: {vertices: [[5, 0, 0], [1, 0, 0]], edges: [[0, 1]]}}, mass_per_vertex: 0.3, material: m}
joints: [{from: {cloth: other, vertices: [1]}, to: {cloth: one, vertex: 0}, stiffness: 40, damping: 0.1, length: 0.5}]
materials: {m: {ea: 1.0e-30}}
time: {h: 0.001, end: 0.3, stretch_growth: 0}
solver: {stop: {relative: 1.0e-12}}
probes:
  - {name: p, cloth: one, vertices: [0], values: [position, velocity]}
  - {name: q, cloth: other, vertices: [1], values: [position, velocity]}
END
swings() { # INTEGRATOR H MOST: the largest error of their distance, by the test's own distance(), and their momentum
    # shellcheck disable=SC2086 # a list of settings
    run two.yaml $timed --set integrator="$1" --set time.h="$2" && below "$1: distance of two masses, m" "$(distance)" "$3" &&
        below "$1: their momentum, of 1 kg m/s at most" "$(momentum)" 1e-14
}
momentum() { rows '{ p = 0.1 * c("p.0.vx") + 0.3 * c("q.1.vx"); if (p < 0) p = -p; if (p > most) most = p } END { printf "%.3g\n", most }'; }

# Joined by 8 joints, over several blocks.
cat > panels.yaml << 'END'
schema: 1
grain: 20
contact: {mode: project}
cloths:
  - {name: front, mesh: {grid: {width: 0.7, height: 0.7, nx: 8, ny: 8}}, material: m, pins: [{vertices: [0, 7]}]}
  - {name: back, mesh: {grid: {width: 0.7, height: 0.7, nx: 8, ny: 8}}, material: m, transform: {translate: [0, -0.1, 0.72]}}
joints:
  - {from: {cloth: front, vertices: [56, 57, 58, 59, 60, 61, 62, 63]}, to: {cloth: back, vertices: [0, 1, 2, 3, 4, 5, 6, 7]}, stiffness: 50, damping: 0.05, length: 0}
materials: {m: {model: triangles, density: 0.2, stretch: 200, shear: 50, bending: {rigidity: 1.0e-4}}}
time: {h: 0.002, end: 0.2}
solver: {stop: {relative: 1.0e-12}}
probes: [{name: p, cloth: front, vertices: [58, 60], values: [position, reaction]}, {name: q, cloth: back, vertices: [4], values: [position]}]
END

