#!/bin/sh
# Contact that the scene leaves no room or no time for: obstacles that close on cloth for good, a ring that it does not fit through, obstacles
# at 100 m/s, bodies that jump, 50 layers in the room of one. A run goes on, or ends, and names the first pair without room.
# Surfaces do not intersect in its frames, a step takes no more than twice the memory that the cloth takes at rest, and a signal ends it.
. "${srcdir:-.}/tests/support/cloth.sh"
. "$srcdir/tests/support/bodies.sh"

bad() { # NAME CLOTHS OBSTACLES END
    cat > "$1.yaml" << END
schema: 1
name: $1
cloths:
$2
materials: {m: {density: 0.2, stretch: 1000, shear: 300, bend: 1, friction: 0.3, damping: {stiffness: 0.004}}}
obstacles: [$3]
contact: {mode: certified, self: on, thickness: 0.001, friction: 0.3}
time: {h: 0.005, end: $4, fps: 50}
END
}
sheet() { # NAME SIZE VERTICES X Y MORE
    printf '  - {name: %s, material: m, mesh: {grid: {width: %s, height: %s, nx: %s, ny: %s}}, transform: {translate: [%s, %s, 0]}%s}\n' "$1" "$2" "$2" "$3" "$3" "$4" "$5" "$6"
}
try() { # SCENE OPTION...: its status in $got
    try_scene=$1
    shift
    got=0
    limited "$DUITE_CLOTH" "$try_scene.yaml" --threads 1 --quiet --check-intersections --report report.json --output out "$@" > said 2>&1 || got=$?
    cat said
    ! grep 'intersect in' said
}
goes_on() { try "$@" && test $got = 0 && test "$(value intersections) $(value intersections_shapes)" = '0 0'; }
named() { # SCENE PAIR: as the pair, a pattern, is named, by the report of a run that goes on, or by the sentence of one that ends
    try "$1"
    case $got in
    0) grep contact_pinch report.json && grep -Eq "\"contact_pinch\": \"vertices $2, at [0-9.]+ s\"" report.json ;;
    1)
        grep -Eq "^duite-cloth: [1-9][0-9]* pairs of features cannot be kept apart: obstacles or pins pinch the cloth, or are too fast, the first of them at vertices $2 \(vertices count from 1\); the step had been halved down to h/1024; the last frame is [0-9]+$" said
        ;;
    *) return 1 ;;
    esac
}
remembers() { # SCENE END: what a run takes until shortly before it ends so, against its first step
    goes_on "$1" --end 0.005 && first=$(value peak_memory_bytes) && goes_on "$1" --end "$2" && echo "$first bytes, then $(value peak_memory_bytes)" &&
        test "$(value peak_memory_bytes)" -le $((2 * first))
}
led() { printf 'motion: {times: [0, %s], translate: [[0, 0, 0], [0, %s, 0]]}' "$@"; } # SECONDS WAY
shape=', a box'

# Half of the sheet lies between the boxes.
low='box: {name: low, centre: [-0.05, -0.05, 0], size: [0.2, 0.1, 0.2]}'
bad close "$(sheet a 0.1 11 0.03 0.0015)" "$low, box: {name: high, centre: [-0.05, 0.06, 0], size: [0.2, 0.1, 0.2], $(led 0.1 -0.02)}" 0.5
ok "boxes that close on cloth for good" named close "[0-9 ]+ of 'a' and obstacles\[[01]\]$shape"
ok "what they take" remembers close 0.045
bad clap "$(sheet a 0.1 11 0 0)" "box: {centre: [-0.05, -0.25, 0], size: [0.2, 0.1, 0.2], $(led 0.002 0.2)}, box: {centre: [-0.05, 0.25, 0], size: [0.2, 0.1, 0.2], $(led 0.002 -0.2)}" 0.1
ok "boxes that meet at 200 m/s with cloth between" named clap "[0-9 ]+ of 'a' and obstacles\[[01]\]$shape"

ring_obj 0.015 0.005 > ring.obj
bad ring "$(sheet a 0.2 11 0 0.012 ", pins: [{nearest: [0, 0.012, 0], radius: 0.001, $(led 0.3 -0.3)}]")" 'body: {obj: ring.obj}' 0.35
ok "cloth that is pulled through a ring too small for it" named ring "[0-9 ]+(\(pinned\) )?[0-9 ]*of 'a' and obstacles\[0\], a body"

held=', pins: [{vertices: [0, 10]}]'
bad ball "$(sheet a 0.3 11 0 0 "$held")" "sphere: {centre: [0.01, -0.3, 0.02], radius: 0.05, $(led 0.006 0.6)}" 0.06
ok "a ball at 100 m/s" goes_on ball
bad plate "$(sheet a 0.3 11 0 0 "$held")" "box: {centre: [0.01, -0.3, 0.02], size: [0.2, 0.02, 0.2], $(led 0.006 0.6)}" 0.06
ok "a plate at 100 m/s" goes_on plate

box_obj -0.1 -0.12 -0.1 0.1 -0.02 0.1 > at0.obj
box_obj -0.1 0.12 -0.1 0.1 0.22 0.1 > at1.obj
box_obj 0.1 -0.32 0.1 0.3 -0.22 0.3 > at2.obj
sed 's/^v 0.1 -0.02 0.1$/v 0.1 2 0.1/' at0.obj > spike.obj
bad jumps "$(sheet a 0.3 11 0 0)" 'body: {obj: at0.obj, frames: {obj: [at0.obj, at1.obj, at2.obj, at0.obj], fps: 200}}' 0.06
ok "a body that jumps to either side of cloth" goes_on jumps
bad spikes "$(sheet a 0.3 11 0 0)" 'body: {obj: at0.obj, frames: {obj: [at0.obj, spike.obj, at0.obj, spike.obj, at0.obj], fps: 200}}' 0.06
ok "a body of which one vertex jumps by 2 m" goes_on spikes

layers() {
    for i in $(seq 0 49); do
        sheet "l$i" 0.04 3 "0.00$((i % 3))" "$(awk -v i="$i" 'BEGIN { print 0.001 + 0.0012 * i }')"
    done
}
bad layers "$(layers)" "box: {centre: [0, -0.05, 0], size: [0.2, 0.1, 0.2]}, box: {centre: [0, 0.112, 0], size: [0.2, 0.1, 0.2], $(led 0.2 -0.061)}" 0.25
ok "50 layers pressed to a millimetre" named layers "[0-9 ]+of 'l[0-9]+' and .*"
ok "what they take" remembers layers 0.1

# Cloth pressed to a tenth of its thickness, which stretches it beyond the usual bound, takes many short steps, here for hours.
bad tight "$(sheet a 0.1 11 0.03 0.0015)" "$low, box: {name: high, centre: [-0.05, 0.06, 0], size: [0.2, 0.1, 0.2], $(led 0.1 -0.0099)}" 100000
rows() { test "$(wc -l < out/probes.csv)" -gt "$1"; }
stops() { # SIGNAL
    rm -rf out
    "$DUITE_CLOTH" tight.yaml --threads 2 --quiet --output out --set time.stretch_growth=0 --set 'probes=[{cloth: a, vertices: [0]}]' > said 2>&1 &
    job=$!
    awaits $job rows 30 && kill -"$1" $job
    got=0
    wait $job || got=$?
    cat said
    test $got = 5 && grep -q 'stopped as asked by a signal after step' said
}
ok "SIGTERM ends it" stops TERM
ok "SIGUSR1 ends it" stops USR1
