#!/bin/sh
# Every program takes files with bits turned over, numbers replaced, pieces lost and ends cut off. It ends with a sentence, or does its work:
# never by a signal, a sanitizer or the limit of time. DUITE_MUTANTS: how many of each file, from the seed DUITE_SEED on.
# shellcheck disable=SC2086 # commands of several words
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
skip_unless tests/fuzz/mutate
plan_later
bin=$PWD
cd "$scratch" || exit 99
mutants=${DUITE_MUTANTS:-300} first=${DUITE_SEED:-1}
export ASAN_OPTIONS="${ASAN_OPTIONS:-}:exitcode=98" UBSAN_OPTIONS=exitcode=98

cat > scene.yaml << 'END'
schema: 1
cloths:
  - {name: a, mesh: {file: mesh.obj}, material: m, pins: [{group: left}], transform: {translate: [0, 0.02, 0]}}
  - {name: b, mesh: {pattern: {file: panels.json, edge: 0.1}}, material: m, seams: {state: pulled, stiffness: 30}}
materials: {m: {model: triangles, density: 0.2, stretch: 500, shear: 100, bending: {rigidity: 1e-5}}}
obstacles: [{plane: {point: [0, -2, 0], normal: [0, 1, 0]}}, {body: {obj: body.obj}}]
contact: {mode: certified, self: on, thickness: 0.001, force: on}
probes: [{cloth: a, vertices: [0]}]
time: {h: 0.002, end: 0.008, fps: 250}
grain: 20
END
printf 'v 0 -1 0\nv 0.2 -1 0\nv 0 -0.8 0\nv 0 -1 0.2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n' > body.obj
printf 'o a\ng left\nv 0 0 0\nv .1 0 0\nv .1 0 .1\nv 0 0 .1\nvt 0 0\nvt .1 0\nvt .1 .1\nvt 0 .1\nf 1/1 2/2 3/3\ng right\nf 1/1 3/3 4/4\n' > mesh.obj
cp "$srcdir/tests/cloth/garment/patterns/straight.json" panels.json
"$DUITE_CLOTH" scene.yaml --quiet --output run --checkpoint 100 --trace trace --trace-steps 1:2 > begun 2>&1 || { cat begun; exit 99; }
checkpoint=run/checkpoints/000001.checkpoint

fine() { # STATUS: a run may last longer than the limit if a scene wants it to, but hears TERM then
    case $1 in 0 | 1 | 2 | 4 | 124 | 143) ;; *) return 1 ;; esac
}
# A mutant of FILE is in its place when COMMAND runs on `again`, a copy of the folder.
each() { # FILE COMMAND...
    of=$1 bad=no
    shift
    cp "$of" whole
    for seed in $(seq "$first" $((first + mutants - 1))); do
        rm -rf again && cp -r run again
        "$bin"/tests/fuzz/mutate "$seed" whole "$of" || return 1
        status=0
        timeout --kill-after=30 30 "$@" > said 2>&1 || status=$?
        fine $status || { tail -n 30 said; echo "seed $seed of $of: status $status"; bad=yes; }
    done
    cp whole "$of"
    test $bad = no
}
mutants() { # NAME FILE COMMAND...
    name=$1
    shift
    ok "$mutants mutants of $name" each "$@"
}
cloth="$DUITE_CLOTH scene.yaml --quiet"
mutants "a scene" scene.yaml $cloth
mutants "a mesh" mesh.obj $cloth
mutants "a body" body.obj $cloth
mutants "a pattern" panels.json $cloth
mutants "a checkpoint" $checkpoint $cloth --restart again --end 0.012
for file in cloth.pc2 frames.csv probes.csv scene.json cloth.obj contact.pc2; do
    mutants "$file, for a restart" run/$file $cloth --restart again --end 0.012
    mutants "$file, for duite-view" run/$file "$DUITE_VIEW" again --check-intersections
done
mutants "a trace" trace "$bin"/duite-trace trace --partial --csv tables --paje all.paje --chrome all.json --dot all.dot --graph all.graph --svg all.svg
mutants "a trace, summed up" trace "$bin"/duite-trace trace
mutants "a trace, predicted" trace "$bin"/duite-predict trace --hosts 2
mutants "a pattern, for duite-garment" panels.json "$bin"/duite-garment panels.json -o made.obj --edge 0.05 --body body.obj
mutants "a body, for duite-garment" body.obj "$bin"/duite-garment panels.json -o made.obj --edge 0.05 --body body.obj
