#!/bin/sh
# The window of the viewer, on a screen that Xvfb keeps in a file: what it shows is what a picture of the frame has, and mouse
# and keys do what the help says.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_VIEW"
grep -q '^#define HAVE_WINDOW 1' config.h || skip_all "built without windows"
. "$srcdir/tests/support/screen.sh"
plan_later

dir=$scratch/frames
sed 's/nx: 150, ny: 150/nx: 20, ny: 20/' "$srcdir/cloth/scenes/sheet.yaml" > "$scratch/small.yaml"
ok "frames" "$DUITE_CLOTH" "$scratch/small.yaml" --end 0.16 --output "$dir"
viewer=
trap 'kill $xvfb $viewer 2> /dev/null; tap_end' EXIT
picture() { limited "$DUITE_VIEW" "$dir" --size $size "$@"; }

opens() { # OPTION...
    (cd "$scratch" && DISPLAY=$display exec "$DUITE_VIEW" "$dir" --size $size "$@") > "$scratch/window" 2>&1 &
    viewer=$!
}
ends() { # STATUS
    got=0
    wait $viewer || got=$?
    viewer=
    test $got = "$1" || { echo "it ended with $got" && cat "$scratch/window" && return 1; }
}

tap_run picture --png "$scratch/last.png"
if test $tap_got != 0; then
    tap_plan=no
    skip_all "no OpenGL 3.3 here"
fi
ok "a picture of the first frame" picture --frame 0 --png "$scratch/first.png"
ok "one with edges" picture --wireframe --png "$scratch/wire.png"
ok "one of another side" picture --camera=-60,40 --png "$scratch/side.png"
not_ok_expected "edges are seen" cmp "$scratch/last.png" "$scratch/wire.png"
ok "one by blocks" picture --colour block --png "$scratch/block.png"
ok "one by strain, with a scale" picture --colour strain,0.02 --png "$scratch/strain.png"

opens
ok "the window shows what the picture of the last frame has" shows "$scratch/last.png"
kill $viewer
ok "a signal ends it" ends 143
opens --frame 0 --wireframe --camera=-60,40
ok "a picture with these options" picture --frame 0 --wireframe --camera=-60,40 --png "$scratch/all.png"
ok "the window shows them, too" shows "$scratch/all.png"
kill $viewer
ok "and ends" ends 143
opens --colour strain,0.02
ok "the window shows the strain and its scale" shows "$scratch/strain.png"
kill $viewer
ok "and ends again" ends 143

if ! command -v xdotool > /dev/null; then
    skip "mouse and keys" "xdotool is not installed"
    exit
fi
hand() { DISPLAY=$display xdotool "$@"; }
opens
ok "the window again" shows "$scratch/last.png"
hand mousemove 200 150 key Home
ok "Home goes to the first frame" shows "$scratch/first.png"
hand key Right key Left key End
ok "End to the last" shows "$scratch/last.png"
hand key w
ok "w shows the edges" shows "$scratch/wire.png"
hand key w key c
ok "c colours by blocks" shows "$scratch/block.png"
hand key c key c key c
ok "after all that there are, c comes to the cloth's own colours" shows "$scratch/last.png"
hand key r key s
ok "s writes a picture" comes grep -q 'duite-view-[0-9]*.png' "$scratch/window"
ok "they are still there" shows "$scratch/last.png"
ok "the picture is what the window shows" shows "$scratch/$(grep png "$scratch/window")"
hand mousemove 300 150 sleep 0.3 mousedown 1 sleep 0.3 mousemove 180 130 sleep 0.3 mouseup 1
ok "a drag turns it" comes_to_differ "$scratch/last.png"
hand click 4 key r
ok "r brings the camera back" shows "$scratch/last.png"
hand mousemove $((width / 2)) $((height / 4)) sleep 0.3 click 1
ok "a click on the cloth names a vertex, and prints its probe" comes grep -qx -e '- {name: vertex[0-9]*, cloth: sheet, vertices: \[[0-9]*\]}' "$scratch/window"
hand key h
ok "h shows the help" comes_to_differ "$scratch/last.png"
hand key h key space
ok "after playing the last frame is there again" shows "$scratch/last.png"
hand key q
ok "q ends it" ends 0
