#!/bin/sh
# Frames of a run on two ranks, read back by Blender: the OBJ with a Mesh Cache modifier of the PC2 has the state's positions as
# float32 in each frame, of one cloth and of two.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
command -v blender > /dev/null || skip_all "no blender"
plan_later
. "$srcdir/tests/whole/read_back.sh"

reads() { # FOLDER
    PYTHONDONTWRITEBYTECODE=1 limited blender -b --factory-startup --python-exit-code 1 --python "$srcdir/tests/whole/read_blender.py" -- "$1" 2>&1
}
sees() { # that a coordinate which differs as float32 is seen
    cp one/probes.csv kept && sed 's/,0\.5,/,0.5000001,/' kept > one/probes.csv && ! cmp -s kept one/probes.csv && ! reads one > said && grep 'not the state' said
}
ok "a run of one cloth on two ranks" run_one
ok "Blender reads the state" reads one
ok "the comparison sees the last bit of a float" sees
ok "a run of two cloths on two ranks" run_two
ok "Blender reads the state of both" reads two
