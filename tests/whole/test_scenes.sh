#!/bin/sh
# Every scene that ships, shortened and run once: the bits that it ends with are those of golden.txt; where contact is certified, nothing
# goes through anything, by exact arithmetic in each frame. Then a small sheet by each model, integrator, format and preconditioner.
#
# All else in the tests compares one run with another, so what moves all of them alike is seen here alone. The bits do not depend on
# compiler or optimisation, but on how METIS cuts the mesh: where METIS is another one than golden.txt's, they are not compared.
#
# A change that moves bits for a good reason writes the table again, in a commit that says the reason:
#     make && DUITE_GOLDEN=FILE sh tests/whole/test_scenes.sh
. "${srcdir:-.}/tests/support/tap.sh"
. "$srcdir/tests/whole/golden.sh"
skip_unless "$DUITE_CLOTH"
plan_later
scenes=$srcdir/cloth/scenes
golden_of golden.txt
if same_metis; then metis=same; else metis=other; fi
cd "$scratch" || exit 99
ran=

runs() { # NAME SCENE ARGUMENT...: the case of one run, of whose report more is asked
    run_name=$1 ran="$ran $2"
    shift
    rm -f report.json
    tap_run limited "$DUITE_CLOTH" "$@" --threads 2 --quiet --report report.json
    test $tap_got = 0 || tap_result $tap_got "$run_name"
}
bits() { # SCENE ARGUMENT..., as runs
    runs "$@" || return
    if test $metis = same; then
        golden "$1" "$(value partition_hash) $(value state_hash)"
    else
        skip "$1" "METIS is another one than that of golden.txt: it cuts to $golden_metis"
    fi
}
asked() { # SENTENCE: of the run before
    test -s report.json && ok "$run_name: $1" "$2"
}

small() { # NAME SETTING...: on a sheet of 30 x 30 vertices that falls askew from its pins
    small_name=$1
    shift
    bits "$small_name" "$scenes/sheet.yaml" --grain 100 --set 'cloths[0].mesh.grid.nx=30' --set 'cloths[0].mesh.grid.ny=30' \
        --set 'gravity=[4,-9.81,2]' --set time.end=0.02 "$@"
}

bits "sheet.yaml, twenty steps" "$scenes/sheet.yaml" --end 0.02
bits "zara.yaml" "$scenes/zara.yaml"
bits "zara.yaml, explicit" "$scenes/zara.yaml" --set integrator=explicit_euler
bits "fabrics.yaml, half a second" "$scenes/fabrics.yaml" --end 0.5
whole() { grep max_stretch report.json && awk -v s="$(value max_stretch)" 'BEGIN { exit !(s > 1 && s < 1.3) }'; }
asked "no edge is a third longer" whole
bits "push.yaml, until the ball pushes" "$scenes/push.yaml" --end 0.7 --set 'cloths[0].mesh.grid.nx=33' --set 'cloths[0].mesh.grid.ny=41'
bits "shirt.yaml of 700 vertices, sewn, five steps" "$scenes/shirt.yaml" --set 'cloths[0].mesh.pattern.vertices=700' --grain 100 --set 'phases[1].set.time.end=0.005'
bits "states.yaml, twenty steps" "$srcdir/bench/cg/states.yaml" --end 0.02

# ---- Certified contact: cloth touches, and no vertex is cut in more than 20 steps in a row. Sanitizers see it by test_contact.sh.
apart() {
    grep -E '"(contacts|contact_|intersections|steps)' report.json
    test "$(value intersections)" = 0 && test "$(value intersections_shapes)" = 0 && test "$(value contacts)" -gt 100 &&
        test "$(value contact_cut_run)" -le 20
}
certified() { # NAME SETTING...
    certified_scene=$1
    shift
    for set; do set -- "$@" --set "$set"; shift; done
    runs "$certified_scene.yaml" "$scenes/$certified_scene.yaml" --check-intersections "$@" && asked "nothing goes through anything" apart
}
contact() {
    certified sphere 'cloths[0].mesh.grid={width: 1, height: 1, nx: 40, ny: 40}' time.end=0.5
    set --
    for i in 0 1 2 3 4; do set -- "$@" "cloths[$i].mesh.grid={width: 0.5, height: 0.5, nx: 15, ny: 15}"; done
    certified stack "$@" time.end=0.25
    certified twist 'cloths[0].mesh.grid={width: 0.8, height: 0.25, nx: 41, ny: 14}' time.h=0.01
    certified laid 'cloths[0].mesh.grid={width: 1, height: 1, nx: 21, ny: 21}' time.end=1.5
    # The places where cloth over an edge is nearest to it jump along the edge: a cloth that follows them rocks for ever.
    certified drape 'cloths[0].mesh.disc.rings=16' time.end=2.5
    rests() { grep -E 'rest_seconds|drape_' report.json && test "$(value rest_seconds)" != null; }
    asked "comes to rest" rests
    ok "the drape coefficient of cloth that has begun to hang, on one rank and two" drape_coefficient
}
drape_on() { # RANKS: the line of the summary; the second rank knows no scene
    ranks "$1" "$DUITE_CLOTH" "$scenes/drape.yaml" --set 'cloths[0].mesh.disc.rings=14' --end 0.08 --threads 1 --grain 300 --report report.json | grep '^  drape '
}
drape_coefficient() {
    drape_on 1 > one && drape_on 2 > two && cat one two && cmp one two && awk "BEGIN { c = $(value drape_coefficient_percent); exit !(c > 90 && c < 99) }"
}
if test -n "${SANITIZER:-}"; then skip "certified contact" "another test shows sanitizers the same code"; else contact; fi

# ---- Models, on a sheet

triangles='materials.cloth={model: triangles, density: 0.2, stretch: [3000, 1000], shear: 100, poisson: 0.3, damping: {stiffness: 0.01}'
for kind in none jacobi ic0 coarse; do small "preconditioner $kind" --set solver.preconditioner=$kind; done
small "format half" --set solver.format=half
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
small "soft pins, one of them moves and lets go" --set "$triangles}" --set 'cloths[0].pins=[{box: [[-1, -1, -1], [-0.2, 1, 1]], stiffness: 30, damping: 0.1}, {nearest: [0.5, 0.5, 0.5], radius: 0.2, stiffness: 50, motion: {times: [0, 1], translate: [[0, 0, 0], [0, 1, 0]]}, curve: {keys: [[0.005, 1], [0.015, 0]]}}]'
small "cells by turns" --set 'cloths[0].mesh.grid.cells=alternate'
small "mirrored cells, triangles" --set 'cloths[0].mesh.grid.cells=mirrored' --set "$triangles}"
small "equilateral triangles" --set 'cloths[0].mesh.grid={width: 1, nx: 30, ny: 30, cells: equilateral}' --set 'materials.cloth={density: 0.2, stretch: 5000}'
small "a sheet that nothing holds" --set 'cloths[0].pins=[]'
small "a chain, and pins of a radius" --set 'cloths[1]={mesh: {inline: {vertices: [[0, 1, 0], [0.1, 1, 0], [0.3, 1, 0]], edges: [[0, 1], [1, 2]]}}, material: wire, mass_per_vertex: 0.01}' \
    --set 'materials.wire={ea: 50}' --set 'cloths[0].pins=[{nearest: [-0.5, 0.5, -0.5], radius: 0.1}]'
small "steps that are halved" --set time.h=0.02 --set time.end=0.2 --set time.stretch_growth=0.01 --set 'cloths[0].velocity=[0,-3,0]'

none_forgotten() { # test_slope.sh, test_dressing.sh and test_dressing_long.sh run the others
    for scene in "$scenes"/*.yaml; do
        case $ran in *"$scene"*) continue ;; esac
        case ${scene##*/} in slope.yaml | dressing.yaml | jeans.yaml | layers.yaml | walk.yaml) ;; *) echo "${scene##*/} is in no case" && return 1 ;; esac
    done
}
if test -z "${SANITIZER:-}"; then ok "every scene that ships is among them" none_forgotten; fi
