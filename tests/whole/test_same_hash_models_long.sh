#!/bin/sh
# Every model with every integrator and way to meet a floor has one state_hash over ranks, threads, schedulers, mappings and balancers, in a
# wind, with weights, a start of its own, and pins of every kind, held and moved. Any two of these five meet in one of some 50 runs of a case:
# what goes wrong does so by one of them or by two that meet, and the whole product (960 times five balancers a case) would take days;
# test_same_hash_long.sh has that of one scene.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless tests/whole/same_hash
plan_later

cat > "$scratch/world.yaml" << 'END'
schema: 1
gravity: [4, -9.81, 2]
air: {wind: [3, 1, -2]}
cloths:
  - name: sheet
    mesh: {grid: {width: 1, height: 1, nx: 30, ny: 30}}
    material: cloth
    masses: [{box: [[-1, -1, 0.45], [1, 1, 1]], mass: 0.001}]
    start: [{box: [[-1, -1, -1], [0, 1, 1]], translate: [0, 0.001, 0], spin: [0, 0.5, 0]}]
    loads: [{nearest: [0, 0, 0.5], force: [0.01, 0.02, -0.01]}]
    pins:
      - vertices: [0]
      - {nearest: [0.5, 0, -0.5], motion: {times: [0, 1], translate: [[0, 0, 0], [0.5, 0.1, -0.2]], rotate: [[1, 0, 0, 0], [1, 0.2, 0, 0]]}}
      - {nearest: [-0.5, 0, 0.5], to: line, direction: [1, 1, 0], motion: {times: [0, 1], translate: [[0, 0, 0], [0, 0.3, 0]]}}
      - {nearest: [0.5, 0, 0.5], to: plane, normal: [1, 2, 0]}
  - mesh: {inline: {vertices: [[2, 0, 0], [2.1, 0, 0], [2.2, 0, 0]], edges: [[0, 1], [1, 2]]}}
    material: wire
    mass_per_vertex: 0.01
materials:
  cloth: {density: 0.2, stretch: 3000, shear: 100, damping: {stiffness: 1.0e-5, mass: 0.1, viscous: 1.0e-5}}
  wire: {density: 1, ea: 30}
obstacles: [{plane: {point: [0, -0.0001, 0], normal: [0, 1, 0]}}]
time: {h: 1.0e-5, end: 6.0e-5}
solver: {stop: {relative: 1.0e-4}}
grain: 60
END

one_hash() { # NAME SETTING...
    what=$1
    shift
    ok "$what" ranks 4 tests/whole/same_hash "$scratch/world.yaml" pairs 2 "$@"
}
every_integrator() { # MODEL SETTING...
    model=$1
    shift
    for integrator in explicit_euler symplectic_euler verlet rk4; do
        one_hash "$model, $integrator" "$@" integrator=$integrator
    done
    set -- "$@" time.h=0.001 time.end=0.004
    one_hash "$model, implicit_euler" "$@"
    one_hash "$model, implicit_euler, Newton, whole slope" "$@" newton.steps=4 solver.jacobian=full energies=steps
    one_hash "$model, bdf2" "$@" integrator=bdf2 solver.format=half
    one_hash "$model, bdf2, Newton" "$@" integrator=bdf2 newton.steps=4
    one_hash "$model, long steps that are halved" "$@" time.h=0.02 time.end=0.04 time.stretch_growth=0.02
}
# No work is done on the cloth: steps that gain energy are made again, by implicit Euler and with half the length.
swings() { # MODEL SETTING...
    model=$1
    shift
    set -- "$@" 'air={normal: 0, tangent: 0}' obstacles=[] cloths[0].start=[] 'cloths[0].pins=[{vertices: [0, 15]}]' \
        'cloths[0].mesh.grid={width: 1, height: 1, nx: 16, ny: 16}' 'materials.cloth.damping={}' materials.cloth.shear=400 time.h=0.02 time.end=0.8 integrator=bdf2
    one_hash "$model, bdf2 that gains energy" "$@"
    for setting in "$@"; do set -- "$@" --set "$setting" && shift; done
    ok "$model, there are such steps" made_anew "$@"
}
made_anew() {
    limited "$DUITE_CLOTH" "$scratch/world.yaml" --quiet --report "$scratch/report.json" "$@" || return 1
    grep steps "$scratch/report.json"
    ! grep -qE '"steps_(retaken|halved)": 0,' "$scratch/report.json"
}

every_integrator "springs" materials.cloth.bend=50
every_integrator "springs, hinges" 'materials.cloth.bending={rigidity: [1e-4, 5e-5]}'
every_integrator "triangles" materials.cloth.model=triangles 'materials.cloth.stretch=[3000, 1000]' materials.cloth.poisson=0.3
every_integrator "triangles, hinges" materials.cloth.model=triangles materials.cloth.forces=uncorrected 'materials.cloth.bending={rigidity: 1e-4}'
every_integrator "triangles, quadratic bending" materials.cloth.model=triangles cloths[0].rest=uv \
    'materials.cloth.bending={model: quadratic, rigidity: 1e-4}'
swings "springs" materials.cloth.bend=50
swings "triangles" materials.cloth.model=triangles 'materials.cloth.stretch=[3000, 1000]' materials.cloth.poisson=0.3
