#!/bin/sh
# The window of duite-view --connect: it shows the newest frame, says what it waits for, and outlives runs.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
grep -q '^#define HAVE_ZMQ 1' config.h || skip_all "built without ZeroMQ"
. "$srcdir/tests/support/screen.sh"
plan_later
viewer= simulator=
trap 'status=$?; kill $xvfb $viewer $simulator 2> /dev/null; (exit $status); tap_end' EXIT

# The cloth rests, so that all frames are alike.
sed 's/nx: 150, ny: 150/nx: 20, ny: 20/' "$srcdir/cloth/scenes/sheet.yaml" > "$scratch/still.yaml"
port=$((10000 + $$ % 20000))
simulate() {
    rm -f "$scratch/said"
    "$DUITE_CLOTH" "$scratch/still.yaml" --set 'gravity=[0, 0, 0]' --set time.fps=10 --end 1000 --threads 1 --live $port > /dev/null 2> "$scratch/said" &
    simulator=$!
    awaits $simulator grep -q 'live view' "$scratch/said" || cat "$scratch/said"
}
stops() {
    kill -USR1 $simulator
    got=0
    wait $simulator || got=$?
    simulator=
    cat "$scratch/said"
    test $got = 5
}
picture() { limited "$DUITE_VIEW" --connect 127.0.0.1:$port --size $size --png "$scratch/live.png"; }
says() { # SENTENCE: on standard error, before the window opens
    comes grep -q "$1" "$scratch/window"
}
simulate
tap_run picture
if test $tap_got = 1 && grep -q OpenGL "$scratch/output"; then
    tap_plan=no
    skip_all "no OpenGL 3.3 here"
fi
ok "a picture of the run" picture
ok "the run stops" stops

(cd "$scratch" && DISPLAY=$display exec "$DUITE_VIEW" --connect 127.0.0.1:$port --size $size) > "$scratch/window" 2>&1 &
viewer=$!
ok "it says that it waits for a run" says "^duite-view: waits for a run at 127.0.0.1:$port\$"
simulate
ok "the window shows the newest frame" shows "$scratch/live.png"
ok "the run ends" stops
ok "the window says so" comes_to_differ "$scratch/live.png"
simulate
ok "and shows the next run" shows "$scratch/live.png"
kill -9 $simulator
simulator=
ok "it outlives one that is killed" comes_to_differ "$scratch/live.png"
simulate
ok "and shows the next one" shows "$scratch/live.png"
if command -v xdotool > /dev/null; then
    named() { DISPLAY=$display xdotool search --name "$1" | grep -c .; }
    ok "its title names the frame" comes named "frame [0-9]*, [0-9.]* s, live from 127.0.0.1:$port"
    DISPLAY=$display xdotool mousemove 300 150 sleep 0.3 mousedown 1 sleep 0.3 mousemove 180 130 sleep 0.3 mouseup 1
    ok "a drag turns it" comes_to_differ "$scratch/live.png"
    DISPLAY=$display xdotool key r sleep 2
    ok "r brings the camera back" shows "$scratch/live.png"
fi
ok "the last run stops" stops
kill -0 $viewer
ok "the window is still there" test $? = 0
