#!/bin/sh
# Wrong input ends duite-cloth with exit code 2 on one rank and on two, says why in one sentence printed once, and leaves
# nothing on the disk: one of each kind. tests/cloth/scene/sentences.txt has what else is said of scenes.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
plan_later
cd "$scratch" || exit 99 # so that sentences have short paths
# mpirun gives the other ranks a second when the first ends with an error; all of ours end by themselves, with the same one.

cat > scene.yaml << 'END'
schema: 1
cloths:
  - mesh: {grid: {width: 1, height: 1, nx: 8, ny: 8}}
    material: cotton
    pins: [{vertices: [0, 7]}]
materials:
  cotton: {density: 0.2, stretch: 500}
time: {h: 0.001, end: 0.004}
END

# changed NAME FROM TO: another scene, NAME.yaml, with FROM replaced.
changed() {
    sed "s|$2|$3|" scene.yaml > "$1.yaml"
    cmp -s scene.yaml "$1.yaml" && echo "$1.yaml" >> unchanged
}

# says RANKS SENTENCE ARGUMENT...: duite-cloth fails with 2, prints the sentence after its own name once, nothing else of
# its own (mpirun adds a text about the exit code), and writes nothing.
says() {
    says_ranks=$1 says_what="duite-cloth: $2"
    shift 2
    set -- "$DUITE_CLOTH" --output frames --report report.json "$@"
    test "$says_ranks" = 1 || set -- ranks "$says_ranks" "$@"
    status=0
    "$@" > said.out 2> said.err < /dev/null || status=$?
    echo "exit status $status"
    cat said.out said.err
    test $status = 2 && test ! -s said.out && test ! -e frames && test ! -e report.json &&
        test "$(grep -c 'duite-cloth: ' said.err)" = 1 && grep -qxF "$says_what" said.err &&
        ! grep -q MPI_ABORT said.err || return 1
    # A sanitizer without its symbolizer adds lines of its own.
    test "$says_ranks" != 1 || test "$(grep -vc '^==[0-9]*==' said.err)" -eq 1
}

# refused NAME SENTENCE ARGUMENT...: on one rank and on two, where the quick subset, too, looks for leaks (tests/support/run.sh).
leaks=${ASAN_OPTIONS:-}
fast=$leaks
if quick; then fast=$leaks:fast_unwind_on_malloc=1:detect_leaks=0; fi
export ASAN_OPTIONS="$fast"
refused() {
    refused_name=$1
    shift
    ASAN_OPTIONS=$leaks
    ok "$refused_name" says 1 "$@"
    ok "$refused_name, 2 ranks" says 2 "$@"
    ASAN_OPTIONS=$fast
}

changed step 'h: 0.001' 'h: 0'
refused "a step of zero" "step.yaml:8:11: time.h is 0; a finite number > 0 (s) is expected" step.yaml
# A fault that only the whole model shows names its place in the scene, too.
changed mass 'grid: {width.*ny: 8}' 'inline: {vertices: [[0, 0, 0], [1, 0, 0]], edges: [[0, 1]]}'
sed -i 's/    pins.*/    pins: []/' mass.yaml
refused "a chain without EA" "mass.yaml:4:15: cloth 'cloth1' has edges without triangles, for which material 'cotton' has no ea; a finite number >= 0 (N) $(
    )is expected: the spring constant of such an edge times its length (stretch is of triangles and threads)" mass.yaml
ok "a value longer than a message" says 1 \
    "--set gravity=$(printf %0192d 0)...: gravity is $(printf %060d 0); a list of 3 numbers (m/s^2) is expected" \
    scene.yaml --set "gravity=$(printf %01200d 0)"
refused "more frames than a disk holds" \
    "--set time.fps=1e12: time.fps * time.end is 4e+09 frames; at most 2147483647 are possible" scene.yaml --set time.fps=1e12
refused "a grain of zero on the command line" \
    "--grain 0: grain is 0; a whole number from 1 to 4294967295 is expected" scene.yaml --grain 0
# Runs that would fill the disk are found before anything is written; repeats, before the run.
refused_room() { # RANKS ARGUMENT...: no room, with an estimate, and nothing is written
    room_ranks=$1
    shift
    set -- "$DUITE_CLOTH" scene.yaml --output frames --report report.json --grain 20 "$@"
    test "$room_ranks" = 1 || set -- ranks "$room_ranks" "$@"
    status=0
    "$@" > said.out 2> said.err < /dev/null || status=$?
    cat said.err
    test $status = 2 && test ! -e frames && test ! -e report.json && test "$(grep -c 'duite-cloth: ' said.err)" = 1 &&
        grep -qE 'duite-cloth: --set time.fps=5e11: time.fps = 5e\+11 gives 2000000001 frames of 64 vertices up to 0.004 s: frames and probes take 1.58e\+03 GB, but frames has room for .* GB; give fewer frames, an earlier time.end, or another folder' said.err
}
# 1.6 TB; a disk that has so much would be filled for hours.
if test "$(df -Pk . | awk 'NR == 2 { print ($4 < 1.4e9) }')" = 1; then
    ok "frames that the disk has no room for" refused_room 1 --set time.fps=5e11
    ok "frames that the disk has no room for, 2 ranks" refused_room 2 --set time.fps=5e11
else
    skip "frames that the disk has no room for" "this disk has room for 1.4 TB"
fi
warned() { # SENTENCE ARGUMENT...: a warning, and the run is made
    warned_what="duite-cloth: warning: $1"
    shift
    rm -rf warned
    limited "$DUITE_CLOTH" scene.yaml --quiet --output warned "$@" 2> said.err
    status=$?
    cat said.err
    test $status = 0 && grep -qE "^$warned_what\$" said.err
}
ok "frames that are closer than steps" warned "--set time.fps=1e5: time.fps = 100000 gives 401 frames of 64 vertices up to 0.004 s, but there are 4 steps: each is shown 100 times; time.fps = 1000 shows each once" --set time.fps=1e5
ok "frames between steps are fine" sh -c '"$0" scene.yaml --quiet --output fine --set time.fps=3000 2> said.err && test ! -s said.err' "$DUITE_CLOTH"
ok "a cloth that is nearly nothing" warned "scene.yaml:8:11: in steps of 0.001 s the cloth is .* times stiffer than its mass \(vertex [0-9]+ of cloth 'cloth1', counted from 1\): solves can fail, and the run can take up to 1024 times as many steps; give a density or mass .* times as large, or steps of at most .* s" \
    --set materials.cotton.density=1e-12
for mass in 1 2; do
    test $mass = 1 && set -- || set -- --set 'cloths[0].mass_per_vertex=0.003'
    ok "a wind that is too strong for the step, $mass" warned "--set time.h=0.01: steps of 0.01 s are beyond the limit of the air, which is not in the matrix, 0.00[0-9]* s: its push on cloth 'cloth1' can grow in each. It blows 1 m in a step, vertices are 0.125 m apart; give shorter steps or less wind" \
        --set 'air={wind: [100, 0, 0]}' --set time.h=0.01 --set time.end=0.02 "$@"
done

refused "an unknown key on the command line" \
    "--set time.fsp=30: fsp is not a key of time; did you mean 'fps'? Allowed: h, end, fps, halving, stretch_growth, stretch_limit, energy_growth, rest, sewn" scene.yaml --set time.fsp=30
refused "a missing scene" "none.yaml: cannot open the scene file: No such file or directory" none.yaml
changed mesh 'grid: {width.*ny: 8}' 'file: mesh.obj'
refused "a missing mesh" "mesh.yaml:3:18: mesh: mesh.obj: cannot be opened: No such file or directory" mesh.yaml
mkfifo mesh.obj
refused "a mesh that is a pipe" "mesh.yaml:3:18: mesh: mesh.obj: cannot be opened: it is no plain file, but a pipe, a device or the like" mesh.yaml
mkfifo pattern.json
changed piped 'mesh: {grid: {width.*ny: 8}}' 'mesh: {pattern: {file: pattern.json, edge: 0.1}}'
refused "a pattern that is a pipe" "piped.yaml:3:21: mesh: pattern.json: cannot open the pattern file: it is no plain file, but a pipe, a device or the like" piped.yaml
ok "more ranks than blocks, 2 ranks" says 2 \
    "2 ranks are more than there are blocks (1): 64 vertices at a grain of 1000; start fewer ranks or give a smaller grain" \
    scene.yaml
refused "a folder of frames that is a file" "cannot make the folder scene.yaml: Not a directory" scene.yaml --grain 20 \
    --output scene.yaml
refused "a report without a folder" "--report (or DUITE_REPORT) none/x.json: cannot write in its folder: No such file or directory" scene.yaml \
    --grain 20 --report none/x.json
cp scene.yaml kept.yaml
ok "a report that is the scene" sh -c '
    "$0" kept.yaml --report ./kept.yaml 2> said.err
    status=$?
    cat said.err
    test $status = 2 && cmp scene.yaml kept.yaml &&
        grep -qx "duite-cloth: --report (or DUITE_REPORT) ./kept.yaml: this is the scene itself, which would be lost" said.err' "$DUITE_CLOTH"
beyond() { # KEY=VALUE: forces beyond all numbers end the run soon, with a sentence
    status=0
    limited "$DUITE_CLOTH" scene.yaml --set "$1" > said.out 2> said.err || status=$?
    cat said.err
    test $status = 1 && grep -q 'duite-cloth: step 1: conjugate gradients broke down .* beyond all measure' said.err
}
ok "a force beyond all measure" beyond 'cloths[0].loads=[{vertices: [3], force: [0, 1e300, 0]}]'
ok "a curve beyond all measure" beyond 'cloths[0].loads=[{vertices: [3], force: [0, 1, 0], curve: {keys: [[0, 1e308]]}}]'
ok "a scene without end" says 1 "/dev/zero: larger than 256 MiB; a large mesh belongs into a file of its own" /dev/zero

# Paths longer than a sentence lose their middle, not what is wrong.
long=$(printf '%0240d/%0240d/%0240d/%0240d/%0240d' 1 2 3 4 5)
mkdir -p "$long" && cp step.yaml "$long/step.yaml"
long_path() { # END_OF_SENTENCE ARGUMENT...
    long_end=$1
    shift
    "$@" > said.out 2> said.err && return 1
    cat said.err
    case $(cat said.err) in *"$long_end") test "$(wc -l < said.err)" = 1 && grep -q ' \.\.\. 0*' said.err ;; *) return 1 ;; esac
}
ok "a scene in a deep folder" long_path "/step.yaml:8:11: time.h is 0; a finite number > 0 (s) is expected" "$DUITE_CLOTH" "$long/step.yaml"
ok "a folder of frames that is too deep" long_path ": Not a directory" "$DUITE_CLOTH" scene.yaml --output "$long/step.yaml/x"

ok "every change was one" test ! -e unchanged
ok "the scene itself is right" limited "$DUITE_CLOTH" scene.yaml --quiet
