#!/bin/sh
# The Blender add-on: a mesh is exported, simulated and brought back, in a Blender without a window.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
command -v blender > /dev/null || skip_all "no blender"
plan_later
brings_back() {
    PYTHONDONTWRITEBYTECODE=1 limited blender -b --factory-startup --python-exit-code 1 --python "$srcdir/tests/whole/read_addon.py" -- \
        "$srcdir/contrib/blender/duite_cloth.py" "$DUITE_CLOTH" "$scratch" > "$scratch/said" 2>&1 || { cat "$scratch/said"; return 1; }
    grep '^brought back' "$scratch/said"
}
ok "a sheet over a moving ball comes back as it was simulated; errors say what to do" brings_back
ok "the scene that it wrote runs without Blender" "$DUITE_CLOTH" "$scratch"/duite-*/scene.yaml --end 0.04 --quiet
