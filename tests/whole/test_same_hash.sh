#!/bin/sh
# A small sheet, implicit and explicit, has one state_hash over ranks, threads, schedulers, mappings and seeds of `shuffle`, any two
# of which meet: that of golden.txt, if METIS is that of the table. The sheet of 22,500 vertices has one over a dozen of them. With
# DUITE_LONG=1: the small one over half of all products, the large one over all, and more models. To write the lines of the table again:
#     make && DUITE_GOLDEN=FILE sh tests/whole/test_same_hash.sh
. "${srcdir:-.}/tests/support/tap.sh"
. "$srcdir/tests/whole/golden.sh"
skip_unless tests/whole/same_hash
scene=$srcdir/cloth/scenes/sheet.yaml
# Gravity aside, or the first step of a flat sheet would end after as many iterations as there are masses: four.
small='cloths[0].mesh.grid.nx=40 cloths[0].mesh.grid.ny=40 grain=100 time.end=0.001 gravity=[4,-9.81,2] solver.stop.relative=0.001'
# 50 joints lead from the edge of one panel to that of the other, 50 across the blocks of one panel; all act from 0.1 s to 0.2 s.
list() { awk -v from="$1" -v step="$2" 'BEGIN { for (i = 0; i < 50; i++) printf "%s%d", i ? ", " : "[", from + i * step; print "]" }'; }
cat > "$scratch/panels.yaml" << END
schema: 1
contact: {mode: project}
gravity: [0.1, -9.81, 0.2]
cloths:
  - {name: front, mesh: {grid: {width: 1, height: 0.4, nx: 50, ny: 20}}, material: cloth, pins: [{vertices: [0, 49]}]}
  - {name: back, mesh: {grid: {width: 1, height: 0.4, nx: 50, ny: 20}}, material: cloth, transform: {translate: [0, -0.02, 0.41]}}
joints:
  - {from: {cloth: front, vertices: $(list 950 1)}, to: {cloth: back, vertices: $(list 0 1)}, stiffness: 20, damping: 0.01, length: 0, begin: 0.1, end: 0.2}
  - {from: {cloth: back, vertices: $(list 100 1)}, to: {cloth: back, vertices: $(list 150 16)}, stiffness: 5, begin: 0.1, end: 0.2}
materials: {cloth: {density: 0.2, stretch: 3000, shear: 100, damping: {stiffness: 0.01}}}
time: {h: 0.01, end: 0.25, fps: 4}
grain: 150
END

plan_later
golden_of golden.txt
if same_metis; then metis=same; else metis=other; fi
one_hash() { # NAME HOW SEEDS SCENE SETTING...: as same_hash has them
    name=$1 how=$2 seeds=$3 hashed=$4
    shift 4
    DUITE_EXPECTED=
    test $metis = other || DUITE_EXPECTED=$(sed -n "s/^one hash \([0-9a-f]*\) $name\$/\1/p" "$golden_table")
    test -z "${DUITE_GOLDEN:-}" || DUITE_EXPECTED=
    export DUITE_EXPECTED
    ok "$name, $how" ranks 4 tests/whole/same_hash "$hashed" "$how" "$seeds" "$@"
    test -z "${DUITE_GOLDEN:-}" || sed -n "s/^ok 1 .*: \([0-9a-f]*\) *\$/one hash \1 $name/p" "$scratch/output" >> "$golden_fresh"
}
everything=false # of a list of cases, else the first one
if test "${DUITE_LONG:-}" = 1; then
    everything=true
    DUITE_TIMEOUT=4000
    export DUITE_TIMEOUT
    # shellcheck disable=SC2086 # a list of settings
    one_hash "40 x 40, implicit" half 20 "$scene" $small
    one_hash "two panels with 100 joints for a tenth of a second" pairs 4 "$scratch/panels.yaml"
    one_hash "sheet" all 20 "$scene" time.end=0.01
fi
if quick; then
    # shellcheck disable=SC2086 # a list of settings
    one_hash "40 x 40, implicit" some 2 "$scene" $small
else
    # shellcheck disable=SC2086
    one_hash "40 x 40, implicit" pairs 8 "$scene" $small
    for kind in none jacobi coarse; do
        # shellcheck disable=SC2086
        one_hash "40 x 40, preconditioner $kind" some 0 "$scene" $small solver.preconditioner=$kind time.end=0.002
        $everything || break
    done
    # shellcheck disable=SC2086
    one_hash "40 x 40, three patches a block" some 0 "$scene" $small solver.patches=3
    # shellcheck disable=SC2086
    one_hash "40 x 40, 400 blocks, whose coarse space is solved by groups" few 0 "$scene" $small grain=4
    # shellcheck disable=SC2086
    one_hash "40 x 40, format half" some 0 "$scene" $small solver.format=half
    # shellcheck disable=SC2086
    one_hash "40 x 40, triangles and hinges" some 0 "$scene" $small \
        'materials.cloth={model: triangles, density: 0.2, stretch: [3000, 1000], shear: 100, poisson: 0.3, damping: {stiffness: 0.01}, bending: {rigidity: [1e-4, 5e-5]}}'
    # shellcheck disable=SC2086
    one_hash "40 x 40, threads that stiffen" some 0 "$scene" $small 'materials.cloth={model: triangles, density: 0.2, shear: 100, damping: {stiffness: 0.01}, stretch_curve: {warp: [[1.0e-7, 1.0e-4], [0.01, 50]], weft: [[1.0e-7, 5.0e-5], [0.1, 3000]]}}'
    # shellcheck disable=SC2086
    one_hash "40 x 40, triangles and quadratic bending, verlet, a wind and a pin that moves" few 0 "$scene" $small \
        'air={wind: [3, 1, -2]}' 'cloths[0].pins[2].motion={times: [0, 1], translate: [[0, 0, 0], [0, 1, 0]]}' \
        integrator=verlet obstacles=[] time.h=1e-5 time.end=5e-5 \
        'materials.cloth={model: triangles, density: 0.2, stretch: 3000, shear: 100, bending: {model: quadratic, rigidity: 1e-4}, damping: {stiffness: 1e-5}}'
    # shellcheck disable=SC2086
    one_hash "40 x 40, explicit" some 3 "$scene" $small integrator=explicit_euler
    for kind in symplectic_euler verlet rk4; do
        # shellcheck disable=SC2086
        one_hash "40 x 40, $kind" few 0 "$scene" $small integrator=$kind obstacles=[] time.h=1e-5 time.end=5e-5 materials.cloth.damping.stiffness=1e-4
    done
    # shellcheck disable=SC2086 # it lands on the floor in the first step
    one_hash "40 x 40, a floor, absolute slopes" few 0 "$scene" $small solver.jacobian=absolute time.end=0.003 \
        'cloths[0].transform.translate=[0,0.0005,0]' 'cloths[0].velocity=[0,-1,0]'
    for more in contact.mode=project 'contact.mode=project integrator=bdf2'; do
        # shellcheck disable=SC2086 # a ball comes from below, a floor rises and tilts, a box stands in the way; steps are halved
        one_hash "40 x 40, obstacles that move, $more" few 0 "$scene" $small $more time.end=0.003 time.stretch_growth=0.002 \
            'obstacles=[{sphere: {centre: [0.1, 0.2495, 0], radius: 0.25, motion: {times: [0, 1], translate: [[0, 0, 0], [0.1, 1, 0]]}}}, {plane: {point: [0, 0.499, 0], normal: [0, 1, 0], motion: {times: [0, 1], rotate: [[1, 0, 0, 0], [0.8, 0, 0, 0.6]]}}}, {box: {centre: [-0.3, 0.45, 0], size: [0.2, 0.099, 0.3], rotate: [0.9, 0, 0.1, 0]}}]'
        $everything || break
    done
    for more in 'time.end=0.003' 'integrator=bdf2 newton.steps=2 time.end=0.003' 'integrator=verlet time.h=1e-5 time.end=5e-5 materials.cloth.damping.stiffness=1e-4'; do
        # shellcheck disable=SC2086 # every integrator's way; sliders turn, and some meet the floor
        one_hash "40 x 40, sliders, $more" few 0 "$scene" $small 'cloths[0].transform.translate=[0,0.0005,0]' 'cloths[0].velocity=[0,-1,0]' \
            'cloths[0].pins=[{box: [[-1, -1, -1], [-0.2, 1, 1]], to: line, direction: [3, -4, 0], motion: {times: [0, 1], rotate: [[1, 0, 0, 0], [0.8, 0, 0.6, 0]], about: [0.5, 0, 0]}}, {box: [[0.2, -1, -1], [1, 1, 0]], to: plane, normal: [1, 1, 1]}]' $more
        $everything || break
    done
    one_hash "two panels with 100 joints for a tenth of a second" some 0 "$scratch/panels.yaml"
    for more in 'solver.preconditioner=none time.end=0.03' 'integrator=bdf2 newton.steps=2'; do
        # shellcheck disable=SC2086
        one_hash "two panels with 100 joints, $more" few 0 "$scratch/panels.yaml" $more
        $everything || break
    done
    # shellcheck disable=SC2086
    one_hash "40 x 40, bdf2 with Newton steps and energies" few 0 "$scene" $small integrator=bdf2 newton.steps=3 energies=steps time.h=0.004 time.end=0.012
    one_hash "8 x 8, so stiff that solves begin again" few 0 "$scene" 'cloths[0].mesh.grid={width: 1, height: 1, nx: 8, ny: 8}' \
        grain=10 time.h=0.01 time.end=0.05 materials.cloth.stretch=1e12 'solver.stop={mass_norm: 3e-6}'
    one_hash "sheet" some 0 "$scene" time.end=0.01
fi
