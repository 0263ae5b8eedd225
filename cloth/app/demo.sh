#!/bin/sh
# make demo: on two ranks a sheet falls and a T-shirt is sewn around a mannequin; then pictures of both, and a film of the second.
# sheet.yaml runs for 0.32 s: later than 0.36 s its two flaps meet and pass through each other, since cloth does not feel itself
# there. Called in the build folder with srcdir, MPIRUN and VIEW_MISSING (the packages without which duite-view was not built) in
# the environment.
set -eu
ranks=2
sheet=demo/frames
shirt=demo/dressing
views='--camera=25,5 --size 320x448'

if test "$(id -u)" = 0; then # Open MPI refuses root unless told twice
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
fi
# More ranks than Open MPI counts slots are welcome, and the workers bind themselves.
export OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_hwloc_base_binding_policy=none
# hwloc: silent about caches that a virtual machine reports wrongly, and no look for graphics cards on X displays.
export HWLOC_HIDE_ERRORS=2 HWLOC_COMPONENTS="${HWLOC_COMPONENTS:--gl}"

says() {
    echo "$*"
    "$@" < /dev/null
}

simulate() { # SCENE OPTION...
    scene=$1
    shift
    says "${MPIRUN:-mpirun}" -n $ranks ./duite-cloth "$srcdir/cloth/scenes/$scene.yaml" "$@"
    echo
}

mkdir -p demo
rm -f demo/*.png demo/*.mp4
simulate sheet --end 0.32 --output $sheet --report demo/report.json
simulate dressing --output $shirt --report demo/dressing.json

film="none: ffmpeg is not there"
if test -x ./duite-view && test -z "${VIEW_MISSING:-}"; then
    last=$(tail -n 1 $sheet/frames.csv | cut -d , -f 1)
    pictures=
    for frame in 0 $((last / 2)) "$last"; do
        picture=$(printf 'demo/sheet-%03d.png' "$frame")
        says ./duite-view $sheet --frame "$frame" --png "$picture"
        pictures="$pictures$picture "
    done
    # shellcheck disable=SC2086 # options
    says ./duite-view $shirt $views --frame last --png demo/dressing.png
    pictures="${pictures}demo/dressing.png"
    if command -v ffmpeg > /dev/null; then
        # shellcheck disable=SC2086
        says ./duite-view $shirt $views --fps 10 --mp4 demo/dressing.mp4
        film="demo/dressing.mp4, at 0.4 of its speed"
    fi
else
    pictures="none: duite-view was not built (${VIEW_MISSING:-see ./configure}); ./bootstrap installs what it needs"
    film=none
fi

cat << END

The sheet has fallen, and the mannequin is dressed. Look at
    pictures    $pictures
    film        $film
    window      ./duite-view $shirt
    animation   $sheet/cloth.obj with $sheet/cloth.pc2 (Blender: import the OBJ, add a Mesh Cache modifier)
    figures     demo/report.json, demo/dressing.json
END
