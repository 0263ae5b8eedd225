#!/bin/sh
# The scenes whose contact is certified, each as it ships and to its end; then a sheet on a ball and five sheets on each other,
# coarser, in steps of 1, 4 and 10 ms, by springs and triangles, by implicit Euler and BDF2. In no frame goes anything through
# anything, by exact arithmetic, and no vertex is cut in more than 20 steps in a row.
. "${srcdir:-.}/tests/support/cloth.sh"
exec 3>&1

nothing_enters() { # NAME SCENE OPTION...
    what=$1
    file=$srcdir/cloth/scenes/$2.yaml
    shift 2
    limited "$DUITE_CLOTH" "$file" "$@" --quiet --check-intersections --report report.json || return 1
    printf '# %-40s %5s steps, %3s halved, %6s contacts, %5s more solves, %6s cuts, %3s in a row\n' "$what" "$(value steps)" \
        "$(value steps_halved)" "$(value contacts)" "$(value contact_solves)" "$(value contact_cuts)" "$(value contact_cut_run)" >&3
    test "$(value intersections)" = 0 && test "$(value intersections_shapes)" = 0 && test "$(value contacts)" -gt 100 &&
        test "$(value contact_cut_run)" -le 20
}
for scene in slope drape twist sphere stack; do
    ok "$scene.yaml" nothing_enters $scene.yaml $scene
done

triangles='{density: 0.2, model: triangles, stretch: 1000, shear: 300, bending: {rigidity: 1e-5}, friction: 0.3, damping: {viscous: 2e-6, stiffness: 0.004}}'
coarse() { # SCENE: its sheets
    case $1 in
    sphere) set -- 0 'width: 1, height: 1, nx: 50, ny: 50' 1 ;;
    stack) set -- '0 1 2 3 4' 'width: 0.5, height: 0.5, nx: 22, ny: 22' 0.6 ;;
    esac
    for i in $1; do printf '%s\n' --set "cloths[$i].mesh.grid={$2}"; done
    printf '%s\n' --end "$3"
}
short() { # as $scene, $h, $model and $integrator say
    set --
    while IFS= read -r word; do set -- "$@" "$word"; done <<END
$(coarse "$scene")
END
    if test "$model" = triangles; then set -- "$@" --set "materials.cloth=$triangles"; fi
    nothing_enters "$scene, $h s, $model, $integrator" "$scene" "$@" --set time.h="$h" --set integrator="$integrator"
}
for scene in sphere stack; do
    for h in 0.01 0.004 0.001; do
        for model in springs triangles; do
            for integrator in implicit_euler bdf2; do
                ok "$scene.yaml, coarse, in steps of $h s, $model, $integrator" short
            done
        done
    done
done
