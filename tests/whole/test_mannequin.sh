#!/bin/sh
# duite-mannequin: what it prints and writes, the bits of its meshes, each error; the same figure as a body of a scene.
# A change that moves bits for a good reason writes the table again: DUITE_GOLDEN=FILE sh tests/whole/test_mannequin.sh
. "${srcdir:-.}/tests/support/tap.sh"
. "$srcdir/tests/whole/golden.sh"
mannequin=${DUITE_MANNEQUIN:-$PWD/duite-mannequin}
cloth=${DUITE_CLOTH:-$PWD/duite-cloth}
skip_unless "$mannequin"
skip_unless "$cloth"
plan_later
golden_of mannequin_golden.txt
page=$srcdir/cloth/app/duite-mannequin.1
document=$srcdir/docs/measures.md
cd "$scratch" || exit 99

run() { limited "$mannequin" "$@"; }
prints() { "$@" > printed 2> complained; }

# ---- Words and files

short_answer() { prints run "$2" && grep -q -e "$1" printed && test ! -s complained; }
ok "--help lists the options" short_answer '--measure' --help
ok "--version names the version" short_answer '^duite-mannequin [0-9]' --version
documented() { # every option of --help stands in the manual page
    run --help | sed -n 's/^ *\(-.,\)\{0,1\} *--\([a-z]*\).*/\2/p' > options
    test "$(wc -l < options)" -ge 10 || return
    while read -r option; do grep -q -e "\\\\-\\\\-$option" "$page" || { echo "--$option is not in the page" && return 1; }; done < options
}
ok "the manual page has every option" documented
writes() {
    prints run --measure chest=1.02 -m wrist=0.16 -o figure.obj && test ! -s complained &&
        grep -q '^chest: 1.0[12][0-9]* m (level, 1.28 m high, ' printed && grep -q '^wrist: 0.1[56][0-9]* m (across' printed &&
        grep -q '^[0-9]* vertices, [0-9]* triangles, 1.75 m high$' printed &&
        test "$(grep -c '^v ' figure.obj)" = "$(tail -n 1 printed | cut -d ' ' -f 1)"
}
ok "mesh and girths" writes
tabled() { # the table of the document is that of the program
    prints run -o figure.obj && sed -n 's/^\([a-z_]*\): \([0-9.]*\) m (.*/\1 \2/p' printed > girths
    test "$(wc -l < girths)" = 11 || return
    while read -r name girth; do
        sed -n "/^## The figure/,\$p" "$document" | grep "^| \`$name\` | " | awk -F '|' -v is="$girth" '{ exit !($3 - is < 0.005 && is - $3 < 0.005) }' ||
            { echo "$name is $girth" && return 1; }
    done < girths
}
ok "docs/measures.md has all measures with their defaults" tabled
quiet() { prints run -o q.obj -q && test ! -s printed && test ! -s complained && test -s q.obj; }
ok "--quiet" quiet

walk_is_written() { # and begins as the mesh is
    run --walk 1.5 --fps 10 -q -o walk.obj && test "$(od -An -tu4 -j28 -N4 walk.pc2 | tr -d ' ')" = 16 || return
    n=$(grep -c '^v ' walk.obj)
    test "$(wc -c < walk.pc2)" = $((32 + 16 * 12 * n)) || return
    od -An -v -tf4 -w12 -j32 -N$((12 * n)) walk.pc2 > begin
    grep '^v ' walk.obj | paste -d ' ' - begin | awk '{ for (i = 2; i <= 4; i++) if (($i - $(i + 3)) ^ 2 > 1e-12) bad = 1 } END { exit bad || NR < 5000 }'
}
ok "--walk, --fps" walk_is_written
ok "no output" refuses "say where the mesh goes" run
ok "an output without a name" refuses "--output takes the name of a file" run -o ''
ok "no folder" refuses "cannot write" run -o none/x.obj
ok "an argument" refuses "nothing is read: \`x' is one too many" run x
ok "no height" refuses "--height takes a length above 0" run --height 0 -o x.obj
ok "too high" refuses "height is 9 m; figures have 1 to 2.3 m" run --height 9 -o x.obj
ok "no edge" refuses "--edge takes a length above 0" run -e much -o x.obj
ok "edges that are too long" refuses "edge is 0.1 m; a figure of 1.75 m has 0.008 to 0.025 m" run -e 0.1 -o x.obj
ok "a walk that takes no time" refuses "--walk takes seconds above 0" run --walk 0 -o x.obj
ok "no rate" refuses "--fps takes a rate above 0" run --walk 1 --fps x -o x.obj
ok "a rate of nothing" refuses "--fps is of a walk" run --fps 25 -o x.obj
ok "a walk that is too long" refuses "a walk has fewer than 100000 frames, not 1e+06" run --walk 1e5 --fps 10 -o x.obj
ok "a measure without a girth" refuses "--measure takes a name and a girth, NAME=METRES" run -m chest -o x.obj
ok "no such measure" refuses "there is no measure \`nose'" run -m nose=0.1 -o x.obj
ok "a measure twice" refuses "the measure chest is given twice" run -m chest=1 -m chest=1.1 -o x.obj
ok "a measure that is none" refuses "the measure chest takes a length above 0" run -m chest=wide -o x.obj
ok "a girth out of range" refuses "chest is 3 m; a figure of 1.75 m has 0.82 to 1.28 m" run -m chest=3 -o x.obj
ok "girths that do not go together" refuses "a hip of 0.85 m does not go with a thigh of 0.57 m" run -m hip=0.85 -o x.obj

# ---- Bits, the same with any compiler and optimisation

bits() { # NAME ARGUMENT...
    bits_name=$1
    shift
    if run "$@" -o golden.obj -q > output 2>&1; then golden "$bits_name" "$(cksum < golden.obj | tr ' ' '-')"; else tap_result 1 "$bits_name"; fi
}
bits "the figure"
bits "finer" -e 0.012
bits "a small one" --height 1.3 -e 0.014 -m waist=0.6 -m calf=0.29

# ---- Scenes

scene() { # FILE BODY: a small cloth beside it falls a step
    cat > "$1" << END
schema: 1
time: {h: 0.001, end: 0.001}
materials: {m: {density: 0.2, stretch: 100}}
cloths: [{name: c, mesh: {grid: {width: 0.1, height: 0.1, nx: 3, ny: 3}}, transform: {translate: [0, 2.5, 0]}, material: m}]
contact: {mode: certified, thickness: 0.002}
obstacles: [{body: $2}]
END
}
same() {
    scene s.yaml '{mannequin: {height: 1.6, measures: {waist: 0.7, upper_arm: 0.3}, edge: 0.019}, translate: [0, 0.5, 0]}'
    run --height 1.6 -m waist=0.7 -m upper_arm=0.3 -e 0.019 -q -o alone.obj || return
    scene t.yaml '{obj: alone.obj, translate: [0, 0.5, 0]}'
    limited "$cloth" s.yaml --output s > said 2>&1 && limited "$cloth" t.yaml --output t >> said 2>&1 && cat said && cmp s/body-0.obj t/body-0.obj &&
        ! grep -i warning said
}
ok "a scene's figure is that of the program" same
listed() { # the document's table of angles is that of the program
    limited "$cloth" --keys | sed -n 's/^.*mannequin.poses\[\]\.left_\([a-z_]*\): .*default \([0-9]*\).*/\1 \2/p' > angles
    cat angles
    test "$(wc -l < angles)" = 7 || return
    while read -r name angle; do grep -q "^| \`$name\` | $angle | " "$document" || { echo "$name" && return 1; }; done < angles
}
ok "docs/measures.md has all angles with their defaults" listed

# A figure that walks is one body to all threads, and pushes what is in its way.
walks() {
    scene w.yaml '{mannequin: {edge: 0.025, walk: {speed: 2, begin: -2}, fps: 25}, name: figure}'
    sed -i 's/end: 0.001/end: 0.3/; s/h: 0.001/h: 0.005/; s/translate: .0, 2.5, 0./translate: [0.1, 0.65, 0.17]/' w.yaml
    limited "$cloth" w.yaml --grain 4 --threads 1 --report one.json > said 2>&1 && limited "$cloth" w.yaml --grain 4 --threads 2 --report two.json >> said 2>&1 &&
        limited "$cloth" w.yaml --grain 4 --set 'obstacles[0].body.mannequin.walk.begin=9' --report still.json >> said 2>&1 || return
    cat said
    ! grep -i warning said && grep state_hash one.json > one && grep state_hash two.json > two && grep state_hash still.json > still &&
        cmp one two && ! cmp -s one still
}
ok "a figure that walks" walks
