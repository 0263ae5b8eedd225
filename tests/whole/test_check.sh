#!/bin/sh
# --check says what a run takes, without one: its steps and frames are those of the run, its disk within 5 %, its memory within a factor of 2.
# It writes nothing. Time is no part of a test.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
test -z "$SANITIZER" || skip_all "a sanitizer has memory of its own for all that a program has"
plan_later
scenes=$srcdir/cloth/scenes
cd "$scratch" || exit 99

forecast() {
    limited "$DUITE_CLOTH" "$@" --check --output frames --report report.json > said && cat said && test ! -e frames &&
        for key in steps frames disk_bytes memory_bytes; do eval "check_$key=$(value check_$key)"; done
}
within() { # NAME FACTOR FORECAST TRUTH
    echo "$1: $3 were forecast, $4 came"
    awk -v a="$3" -v b="$4" -v f="$2" 'BEGIN { exit !(b > 0 && a / b <= f && b / a <= f) }'
}
kept() {
    limited "$DUITE_CLOTH" "$@" --quiet --output frames --report report.json &&
        within steps 1 "$check_steps" "$(value steps)" && within frames 1 "$check_frames" "$(grep -c , frames/frames.csv | awk '{ print $1 - 1 }')" &&
        within memory 2 "$check_memory_bytes" "$(value peak_memory_bytes)" &&
        within disk 1.05 "$check_disk_bytes" "$(find frames -type f -printf '%s\n' | awk '{ n += $1 } END { print n }')"
}
tried() { # NAME SCENE OPTION...
    tried_name=$1
    shift
    rm -rf frames
    ok "$tried_name: a forecast" forecast "$@"
    ok "$tried_name: the run keeps it" kept "$@"
}
tried "a sheet" "$scenes/sheet.yaml" --set 'cloths[0].mesh.grid.nx=60' --set 'cloths[0].mesh.grid.ny=60' --end 0.2
tried "a flag with probes" "$scenes/gallery/flag.yaml" --end 0.4 --set 'probes=[{name: hem, box: [[0.8, 0, -1], [1, 2, 1]], values: [position, velocity]}]'
tried "a walk" "$scenes/gallery/cape.yaml" --end 0.4
tried "two phases" "$scenes/gallery/stack.yaml" --set 'phases=[{name: fall, set: {time.end: 0.04}}, {name: slow, set: {time.end: 0.08, gravity: [0, -1, 0]}}]'
tried "forces of contact" "$scenes/gallery/tablecloth.yaml" --end 0.4 --set contact.force=on
advised() { limited "$DUITE_CLOTH" "$scenes/gallery/ribbon.yaml" --check --set contact.thickness=0.01 > said && cat said && grep 'thickness of contact, 0.01 m, is above half' said; }
ok "a thickness above the mesh is slow" advised
mistaken() { ! limited "$DUITE_CLOTH" "$scenes/gallery/stairs.yaml" --check --set 'cloths[0].transform.translate=[0, 0.3, 0]' 2> said && grep '1190 through obstacles' said; }
ok "a start that touches is found" mistaken
