# Sourced by tests of windows, after tap.sh: a screen that Xvfb keeps in a file, of $width x $height ($size). $display is its name
# for X; the process $xvfb is to be ended by the test. Without Xvfb, or windows in the build, the test is skipped.

skip_unless "$DUITE_VIEW"
grep -q '^#define HAVE_WINDOW 1' config.h || skip_all "built without windows"
command -v Xvfb > /dev/null || skip_all "Xvfb is not installed"

width=480 height=300
size=${width}x$height
screen=$scratch/screen/Xvfb_screen0
mkdir "$scratch/screen"
Xvfb -displayfd 3 -screen 0 ${width}x${height}x24 -fbdir "$scratch/screen" 3> "$scratch/display" > "$scratch/xvfb" 2>&1 &
xvfb=$!
awaits $xvfb test -s "$scratch/display" || skip_all "Xvfb does not start"
display=:$(cat "$scratch/display")

# is_like PICTURE: the screen is like it: colours differ by 2 of 255 in the mean, and at most 0.5 % of the pixels by more than 16.
# comes COMMAND: it passes within a minute, which is long for a busy machine. shows, comes_to_differ: the screen comes to be, or
# not to be, like a picture.
is_like() { ./tests/cloth/view/alike "$1" "$screen" | awk '{ print; alike = $1 <= 2 && $2 <= 0.5 } END { exit !alike }'; }
differs() { ! is_like "$1"; }
comes() {
    for try in $(seq 60); do
        "$@" && return 0
        sleep 1
    done
    return 1
}
shows() { comes is_like "$1"; }
comes_to_differ() { comes differs "$1"; }
