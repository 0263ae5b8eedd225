#!/bin/sh
# make demo: sheet.yaml for 0.32 s on two ranks, and three pictures of it. Later than 0.36 s its two flaps meet and pass through
# each other, since cloth does not feel itself. Called in the build folder with srcdir, MPIRUN and VIEW_MISSING (the packages
# without which duite-view was not built) in the environment.
set -eu
ranks=2
frames=demo/frames

if test "$(id -u)" = 0; then # Open MPI refuses root unless told twice
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
fi
# hwloc: silent about caches that a virtual machine reports wrongly, and no look for graphics cards on X displays.
export HWLOC_HIDE_ERRORS=2 HWLOC_COMPONENTS="${HWLOC_COMPONENTS:--gl}"

mkdir -p demo
rm -f demo/sheet-*.png
# More ranks than Open MPI counts slots are welcome, and the workers bind themselves.
set -- "${MPIRUN:-mpirun}" --oversubscribe --bind-to none -n $ranks ./duite-cloth "$srcdir/cloth/scenes/sheet.yaml" \
    --end 0.32 --output $frames --report demo/report.json
echo "$*"
"$@" < /dev/null

last=$(tail -n 1 $frames/frames.csv | cut -d , -f 1)
if test -x ./duite-view && test -z "${VIEW_MISSING:-}"; then
    pictures=
    for frame in 0 $((last / 2)) "$last"; do
        picture=$(printf 'demo/sheet-%03d.png' "$frame")
        ./duite-view $frames --frame "$frame" --png "$picture"
        pictures="$pictures $picture"
    done
    looks="pictures   $pictures"
else
    looks="pictures    none: duite-view was not built, since these packages are missing: ${VIEW_MISSING:-see ./configure}
            (./bootstrap installs them)"
fi

cat << EOF

The sheet has fallen. Look at
    $looks
    animation   $frames/cloth.obj with $frames/cloth.pc2 (Blender: import the OBJ, add a Mesh Cache modifier)
    figures     demo/report.json
EOF
