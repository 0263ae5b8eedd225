#!/bin/sh
# duite-cloth --save-system: the system of the last step, which its solution solves; the same files from any ranks and
# threads, and for any grain up to the last bits of sums.
. "${srcdir:-.}/tests/support/cloth.sh"

cat > scene.yaml << 'END'
schema: 1
cloths:
  - mesh: {grid: {width: 1, height: 1, nx: 8, ny: 9}}
    material: cotton
    pins: [{vertices: [0, 7]}]
materials:
  cotton: {density: 0.2, stretch: 500, shear: 100, bend: 1, damping: {mass: 1, stiffness: 0.01}}
time: {h: 0.01, end: 0.05, fps: 50}
solver: {stop: {relative: 1.0e-10}}
END

run() { limited "$DUITE_CLOTH" scene.yaml "$@"; }
saves() { run --save-system one --quiet && ls one && test "$(ls one | wc -l)" = 5; }
ok "writes five files" saves

# |b - A x| against |b|, of 216 unknowns.
solved() { # FOLDER TOLERANCE
    awk -v tolerance="$2" 'FNR == 1 { file++; n = 0 } /^%/ { next } { n++ }
        n == 1 { rows = $1; next }
        file == 1 { x[n - 1] = $1 }
        file == 2 { r[n - 1] += $1; b += $1 * $1 }
        file == 3 { r[$1] -= $3 * x[$2]; if ($1 != $2) r[$2] -= $3 * x[$1] }
        END { for (i = 1; i <= rows; i++) sum += r[i] * r[i]
              print rows, sqrt(sum / b); exit !(rows == 216 && b > 0 && sum < tolerance ^ 2 * b) }' \
        "$1/solution.mtx" "$1/rhs.mtx" "$1/matrix.mtx"
}
ok "its solution solves it" solved one 2e-10
not_ok_expected "to the tolerance of the scene, no better" solved one 1e-12

same() { # NAME COMMAND...: the same files as those of one rank
    same_name=$1
    shift
    "$@" --save-system "$same_name" --quiet && for file in matrix rhs solution mass position; do
        cmp "one/$file.mtx" "$same_name/$file.mtx" || return 1
    done
}
run --save-system coarse --quiet --grain 30 > said 2>&1
ok "any grain solves it" solved coarse 2e-10
again() { same again run --threads 3 --scheduler fifo; }
ok "the same files from three threads" again
split() { run --save-system one --quiet --grain 10 && same two ranks 2 "$DUITE_CLOTH" scene.yaml --grain 10; }
ok "the same files from two ranks" split
joined() { # by joints inside blocks and between them
    rm -r one && run --save-system one --quiet --grain 10 \
        --set 'joints=[{from: {vertices: [9, 20, 33, 7]}, to: {vertices: [10, 60, 34, 64]}, stiffness: 300, length: 0.1, begin: 0.02, end: 1}]' && solved one 2e-10
}
ok "with timed joints" joined
joined_half() {
    rm -r one && run --save-system one --quiet --grain 10 --set solver.format=half \
        --set 'joints=[{from: {vertices: [9, 20, 33, 7]}, to: {vertices: [10, 60, 34, 64]}, stiffness: 300, length: 0.1, begin: 0.02, end: 1}]' && solved one 2e-10
}
ok "with timed joints, in half storage" joined_half
run --save-system one --quiet
ok "with frames, too" run --save-system three --output frames --quiet
half() { # the same system but for rounding
    run --save-system half --quiet --set solver.format=half && solved half 2e-10 && paste one/matrix.mtx half/matrix.mtx | awk '
        /^%/ { next } { d = $3 - $6; d = d < 0 ? -d : d }
        $1 != $4 || $2 != $5 || d > 1e-10 { bad = 1; print; exit } END { exit bad || NR < 1000 }'
}
ok "in half storage" half
other_step() { run --save-system early --end 0.02 --quiet && ! cmp -s one/rhs.mtx early/rhs.mtx; }
ok "another step is another system" other_step

ok "a step of several systems has none of its own" refuses "by implicit_euler with newton.steps 1 only" run --save-system none \
    --set newton.steps=2
ok "what lines and planes take away the files cannot say" refuses "no pins to lines or planes" run --save-system none \
    --set 'cloths[0].pins=[{vertices: [0], to: line, direction: [0, 1, 0]}]'
ok "explicit runs have no system" refuses "an explicit integrator solves no system" run --save-system none --set integrator=explicit_euler
ok "and leave no folder" test ! -e none
: > file
ok "a folder that cannot be made" refuses "cannot make the folder file/x" run --save-system file/x
