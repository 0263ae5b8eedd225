#!/bin/sh
# The bits that runs end with, held against those of golden.txt: every scene of the tree, shortened, and a small sheet by each model,
# integrator, format and preconditioner. All else in the tests compares one run with another, so what moves all of them alike is seen
# here alone. The bits do not depend on compiler or optimisation (.ci/run calls this test with several), but on how METIS cuts the
# mesh: where it cuts a graph that metis_cuts.c makes otherwise than golden.txt says, METIS is another one, and the test is skipped.
# Where it cuts that graph alike and a scene otherwise, the change is our own, and the case fails.
#
# A change that moves bits for a good reason writes the table again, in a commit that says the reason:
#     make && DUITE_GOLDEN=FILE sh tests/whole/test_golden.sh
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
test -x tests/whole/metis_cuts || env -u MAKEFLAGS -u MAKELEVEL "${MAKE:-make}" -s tests/whole/metis_cuts > /dev/null || exit 99
plan_later
table=$srcdir/tests/whole/golden.txt
scenes=$srcdir/cloth/scenes
fresh=${DUITE_GOLDEN:-$scratch/fresh}
case $fresh in /*) ;; *) fresh=$PWD/$fresh ;; esac
metis=$(tests/whole/metis_cuts) || exit 99
cd "$scratch" || exit 99
echo "$metis METIS, of a graph that metis_cuts.c makes" > "$fresh"
test -n "${DUITE_GOLDEN:-}" || grep -qxF "$(cat "$fresh")" "$table" || skip_all "METIS is another one than that of golden.txt: it cuts to $metis"


simulate() { # SCENE ARGUMENT...
    limited "$DUITE_CLOTH" "$@" --threads 2 --quiet --report report.json
}

golden() { # NAME SCENE ARGUMENT...
    golden_name=$1
    shift
    if ! simulate "$@" > output 2>&1; then
        echo "(duite-cloth $* failed)" >> output
        tap_result 1 "$golden_name"
        return
    fi
    printf '%s %s %s\n' "$(value partition_hash)" "$(value state_hash)" "$golden_name" >> "$fresh"
    echo "golden.txt does not have: $(tail -n 1 "$fresh")" > output
    grep -qxF "$(tail -n 1 "$fresh")" "$table"
    tap_result $? "$golden_name"
}

small() { # NAME SETTING...: on a sheet of 30 x 30 vertices that falls askew from its pins
    small_name=$1
    shift
    golden "$small_name" "$scenes/sheet.yaml" --grain 100 --set 'cloths[0].mesh.grid.nx=30' --set 'cloths[0].mesh.grid.ny=30' \
        --set 'gravity=[4,-9.81,2]' --set time.end=0.02 "$@"
}

golden "sheet.yaml, twenty steps" "$scenes/sheet.yaml" --end 0.02
golden "zara.yaml" "$scenes/zara.yaml"
golden "zara.yaml, explicit" "$scenes/zara.yaml" --set integrator=explicit_euler
golden "fabrics.yaml, half a second" "$scenes/fabrics.yaml" --end 0.5
golden "push.yaml, until the ball pushes" "$scenes/push.yaml" --end 0.7 --set 'cloths[0].mesh.grid.nx=33' --set 'cloths[0].mesh.grid.ny=41'
golden "shirt.yaml of 700 vertices, sewn, five steps" "$scenes/shirt.yaml" --set 'cloths[0].mesh.pattern.vertices=700' --grain 100 --set 'phases[1].set.time.end=0.005'
golden "states.yaml, twenty steps" "$srcdir/bench/cg/states.yaml" --end 0.02

triangles='materials.cloth={model: triangles, density: 0.2, stretch: [3000, 1000], shear: 100, poisson: 0.3, damping: {stiffness: 0.01}'
for kind in none jacobi ic0 coarse; do small "preconditioner $kind" --set solver.preconditioner=$kind; done
for format in half half_float; do small "format $format" --set solver.format=$format; done
for jacobian in full absolute; do small "jacobian $jacobian" --set solver.jacobian=$jacobian; done
small "three patches, stop by mass_norm, no guess" --set solver.patches=3 --set 'solver.stop={mass_norm: 0.001}' --set solver.guess=zero
small "both diagonals and bends" --set materials.cloth.diagonals=both --set materials.cloth.bend=10
small "triangles and hinges" --set "$triangles, bending: {rigidity: [1e-4, 5e-5]}}"
small "triangles by the papers' forces" --set "$triangles, forces: uncorrected}"
small "quadratic bending" --set 'materials.cloth.bending={model: quadratic, rigidity: 1e-4}'
small "limits of strain" --set "$triangles}" --set 'materials.cloth.strain_limit={at: 1e-3, stiffness: 1e4}'
small "the floor after the step" --set contact.mode=project --set 'cloths[0].transform.translate=[0,0.002,0]' --set 'cloths[0].velocity=[0,-1,0]'
small "bdf2 with Newton steps" --set integrator=bdf2 --set newton.steps=3 --set energies=steps --set time.h=0.004
for integrator in symplectic_euler verlet rk4; do
    small "$integrator" --set integrator=$integrator --set obstacles=[] --set time.h=1e-5 --set time.end=1e-3 --set materials.cloth.damping.stiffness=1e-4
done
small "wind that swells, loads, a region, a pin that moves" --set 'air={wind: [3, 1, -2], curve: {sine: {frequency: 5, phase: 0.1}}}' \
    --set 'cloths[0].loads=[{vertices: [500], force: [0, 0.1, 0], curve: {keys: [[0, 0], [0.01, 1]]}}]' \
    --set 'materials.hem={density: 0.4, stretch: 9000, shear: 100, diagonals: one}' \
    --set 'cloths[0].regions=[{box: [[-0.5, 0, 0.3], [0.5, 1, 0.5]], material: hem}]' \
    --set 'cloths[0].pins[2].motion={times: [0, 1], translate: [[0, 0, 0], [0, 1, 0]]}'
small "pins to lines and planes" --set 'cloths[0].pins=[{box: [[-1, -1, -1], [-0.2, 1, 1]], to: line, direction: [3, -4, 0]}, {box: [[0.2, -1, -1], [1, 1, 0]], to: plane, normal: [1, 1, 1]}]'
small "cells by turns" --set 'cloths[0].mesh.grid.cells=alternate'
small "mirrored cells, triangles" --set 'cloths[0].mesh.grid.cells=mirrored' --set "$triangles}"
small "equilateral triangles" --set 'cloths[0].mesh.grid={width: 1, nx: 30, ny: 30, cells: equilateral}' --set 'materials.cloth={density: 0.2, stretch: 5000}'
small "a sheet that nothing holds" --set 'cloths[0].pins=[]'
small "a chain, and pins of a radius" --set 'cloths[1]={mesh: {inline: {vertices: [[0, 1, 0], [0.1, 1, 0], [0.3, 1, 0]], edges: [[0, 1], [1, 2]]}}, material: wire, mass_per_vertex: 0.01}' \
    --set 'materials.wire={ea: 50}' --set 'cloths[0].pins=[{nearest: [-0.5, 0.5, -0.5], radius: 0.1}]'
small "steps that are halved" --set time.h=0.02 --set time.end=0.2 --set time.stretch_growth=0.01 --set 'cloths[0].velocity=[0,-3,0]'

none_forgotten() { # of the scenes that ship; contact that is certified is young, its bits are held over ranks and threads alone
    for scene in "$scenes"/*.yaml; do
        grep -q 'mode: certified' "$scene" || grep -q " ${scene##*/}" "$fresh" || { echo "${scene##*/} is in no case" && return 1; }
    done
}
ok "every scene that ships is among them" none_forgotten
