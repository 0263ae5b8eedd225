#!/bin/sh
# Pins that follow obstacles: as pins with the obstacle's motion do, on the triangles of a body that changes its shape, touching it or in
# it, and on every rank.
. "${srcdir:-.}/tests/support/probes.sh"
. "$srcdir/tests/support/bodies.sh"
hash() { "$@" --quiet --report report.json && value state_hash; }

box_obj -0.1 -0.1 -0.1 0.1 0 0.1 > box.obj # its upper side is at y 0
awk '/^v/ { c = cos(0.5); s = sin(0.5); printf "v %.17g %.17g %.17g\n", $2 + 0.03, c * $3 - s * $4, s * $3 + c * $4; next } { print }' box.obj > turned.obj

# A sheet lies on the box, 0.4 mm above it, held along a side; its thickness is 1 mm.
cat > follow.yaml << 'END'
schema: 1
cloths:
  - name: sheet
    mesh: {grid: {width: 0.3, height: 0.3, nx: 7, ny: 7}}
    transform: {translate: [0, 0.0004, 0]}
    material: m
    pins: [{box: [[-0.11, -1, -0.06], [0.11, 1, 0.06]], follow: table}]
    start: [{box: [[-1, -1, -1], [-0.11, 1, 1]], translate: [0, 0.002, 0]}, {box: [[0.11, -1, -1], [1, 1, 1]], translate: [0, 0.002, 0]},
      {box: [[-0.11, -1, -1], [0.11, 1, -0.06]], translate: [0, 0.002, 0]}, {box: [[-0.11, -1, 0.06], [0.11, 1, 1]], translate: [0, 0.002, 0]}]
materials: {m: {density: 0.2, stretch: 1000, shear: 300, bend: 1, damping: {stiffness: 0.004}}}
obstacles: [{box: {name: table, centre: [0, -0.05, 0], size: [0.2, 0.1, 0.2], motion: {times: [0, 0.1], translate: [[0, 0, 0], [0.02, 0.04, 0]], rotate: [[1, 0, 0, 0], [1, 0.1, 0.2, 0]]}}}]
time: {h: 0.005, end: 0.1}
probes: [{name: p, vertices: [17, 24], values: [position, reaction]}, {name: q, vertices: [0], values: [position]}]
grain: 20
END
same() { # MOST: where probes are, against the numbers in a file
    paste -d ' ' wanted found | awk -v most="$1" '{ n = NF / 2; for (i = 1; i <= n; i++) { d = $i - $(n + i); if (d * d > most * most || n < 9) bad = 1 } print } END { exit bad || !NR }'
}
columns='p.17.x p.17.y p.17.z p.24.x p.24.y p.24.z p.17.rx p.17.ry q.0.y'
motion='{box: [[-0.11, -1, -0.06], [0.11, 1, 0.06]], motion: {times: [0, 0.1], translate: [[0, 0, 0], [0.02, 0.04, 0]], rotate: [[1, 0, 0, 0], [1, 0.1, 0.2, 0]]}}'
moves() { # by projection, which leaves held vertices where they are
    run follow.yaml --set contact.mode=project --set "cloths[0].pins=[$motion]" && last $columns > wanted && run follow.yaml --set contact.mode=project && last $columns > found && same 1e-12
}
ok "a pin follows an obstacle as one with its motion does" moves
begun() { # a motion that has a shift at time 0 takes along from there
    run follow.yaml --set 'obstacles[0].box.centre=[-1, -0.05, 0]' \
        --set 'obstacles[0].box.motion={about: [-1, 0, 0], times: [0, 0.1], translate: [[1, 0, 0], [1.02, 0.04, 0]], rotate: [[1, 0, 0, 0], [1, 0.1, 0.2, 0]]}' \
        --set contact.mode=project && last $columns > found && same 1e-12
}
ok "also from a motion that does not begin at rest" begun
touching() { # what is attached does not pinch; the rest is kept out, by shape and by body
    run follow.yaml --check-intersections --report report.json && last $columns > wanted && test "$(value contacts)" -gt 0 &&
        ! run follow.yaml --set 'cloths[0].pins[0].box=[[-0.11, -1, -0.01], [0.11, 1, 0.01]]' --set 'cloths[0].transform.translate=[0, -0.001, 0]' > said 2>&1 && grep 'through obstacles' said
}
ok "attached vertices do not pinch cloth, others are kept out" touching
body='obstacles[0]={body: {name: table, obj: box.obj, motion: {times: [0, 0.1], translate: [[0, 0, 0], [0.02, 0.04, 0]], rotate: [[1, 0, 0, 0], [1, 0.1, 0.2, 0]], about: [0, 0, 0]}}}'
sunk() { # 1 mm in it
    run follow.yaml --set 'cloths[0].transform.translate=[0, -0.001, 0]' --check-intersections --report report.json "$@" && test "$(value contacts)" -gt 0 && limited "$DUITE_VIEW" out --check-intersections
}
ok "attached vertices may be in the obstacle, frames say so" sunk
ok "in a body" sunk --set "$body"
lost() { # without what the frames say, the viewer finds it
    sed '/"attached"/d; s/^    \[.*\]\]$//; s/^  \],$/  ]/' out/scene.json > changed && mv changed out/scene.json && limited "$DUITE_VIEW" out --check-intersections > said 2>&1
    test $? = 4 || { cat said out/scene.json && return 1; }
}
ok "it is known from there alone" lost
frames='obstacles[0]={body: {name: table, obj: box.obj, frames: {obj: [box.obj, turned.obj], fps: 10}}}'
by_frames() { # at the last frame all is where the turn has it
    run follow.yaml --set "$frames" --check-intersections --report report.json && last p.17.x p.17.y p.17.z p.24.x p.24.y p.24.z > found && test "$(value contacts)" -gt 0 &&
        awk 'BEGIN { c = cos(0.5); s = sin(0.5); y = 0.0004 } { n = split("0 -0.05 0 0", z, " ")
            e = ($1 - 0.03) ^ 2 + ($2 - c * y - s * 0.05) ^ 2 + ($3 - s * y + c * 0.05) ^ 2 + ($4 - 0.03) ^ 2 + ($5 - c * y) ^ 2 + ($6 - s * y) ^ 2; print $0, e; exit !(e < 1e-24) }' found
}
ok "triangles of a body with frames take their vertices along" by_frames
# The half of the sheet that follows one box moves away from that which follows the other.
torn() { # WHERE: the second box goes so far
    run follow.yaml --end 0.02 --set cloths[0].start=[] --set 'cloths[0].pins[0].box=[[-1, -1, -1], [0.01, 1, 1]]' --set 'cloths[0].pins[1]={box: [[0.04, -1, -1], [1, 1, 1]], follow: other}' \
        --set "obstacles[1]={box: {name: other, centre: [0.5, -0.05, 0], size: [0.2, 0.1, 0.2], motion: {times: [0, 0.02], translate: [[0, 0, 0], $1]}}}" \
        --set 'obstacles[0].box.motion={times: [0], translate: [[0, 0, 0]]}' --set contact.mode=project > said 2>&1
    cat said
}
tears() {
    torn '[0.02, 0, 0]' && grep -q "warning: .*: pins that follow obstacles stretch cloth 'sheet' by 40 % at 0.02 s: the edge between vertices [0-9]* and [0-9]* (counted from 1); pin fewer of its vertices" said &&
        torn '[0.005, 0, 0]' && ! grep stretch said
}
ok "pins that follow two obstacles and stretch the cloth between them draw a warning" tears
everywhere() { one=$(hash limited "$DUITE_CLOTH" follow.yaml "$@") && two=$(hash ranks 2 "$DUITE_CLOTH" follow.yaml "$@") && echo "$one $two" && test -n "$one" && test "$one" = "$two"; }
ok "on every rank" everywhere --set "$frames"
