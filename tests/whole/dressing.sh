# Sourced by the tests of the garment scenes, after tap.sh, in $scratch:
#     scene NAME VERTICES END [PHASE]  NAME.yaml of cloth/scenes, with panels of so many vertices, and its last phase (drape) of at most END s
#     dressed NAME WANTED              runs it into the folder NAME: its phases end as WANTED ("end sewn rest"), all seams are closed, and no
#                                      frame has an intersection
#     alike SCENE RANKS OPTION...      its state_hash is that of the first such call, which writes SCENE.hash; at least 4 blocks; with
#                                      contacts, if the scene has certified contact

scene() {
    sed "s/vertices: [0-9]*/vertices: $2/
        /name: ${4:-drape}/,\${ s/\([ {]\)time.end: [0-9.]*,/\1/; s/set: {/set: {time.end: $3, /; }" "$srcdir/cloth/scenes/$1.yaml" > "$1.yaml"
}

dressed() {
    mkdir -p "$1" && limited "$DUITE_CLOTH" "$1.yaml" --quiet --output "$1" --check-intersections --report "$1/report.json" || return 1
    dressed_ends=$(sed -n 's/.*"ended": "\(.*\)"}.*/\1/p' "$1/report.json" | tr '\n' ' ')
    echo "phases ended: $dressed_ends; intersections: $(value intersections "$1/report.json")"
    test "$dressed_ends" = "$2 " && test "$(value intersections "$1/report.json")" = 0 && test "$(value seams_open "$1/report.json")" = 0
}

alike() {
    alike_scene=$1 alike_ranks=$2
    shift 2
    ranks "$alike_ranks" "$DUITE_CLOTH" "$alike_scene.yaml" --quiet --set grain=100 --report report.json "$@" || return 1
    test -s "$alike_scene.hash" || value state_hash > "$alike_scene.hash"
    echo "$(value state_hash), expected $(cat "$alike_scene.hash"); blocks: $(value blocks)"
    test "$(value blocks)" -ge 4 || return 1
    grep -q 'mode: certified\|include: layers' "$alike_scene.yaml" && ! test "$(value contacts)" -gt 0 && return 1
    test "$(value state_hash)" = "$(cat "$alike_scene.hash")"
}
