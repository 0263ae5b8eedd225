#!/bin/sh
# duite-mannequin: what it prints and writes, the bits of its meshes, each error; the same figure as a body of a scene.
# A change that moves bits for a good reason writes the table again: DUITE_GOLDEN=FILE sh tests/whole/test_mannequin.sh
. "${srcdir:-.}/tests/support/tap.sh"
mannequin=${DUITE_MANNEQUIN:-$PWD/duite-mannequin}
cloth=${DUITE_CLOTH:-$PWD/duite-cloth}
skip_unless "$mannequin"
skip_unless "$cloth"
plan_later
table=$srcdir/tests/whole/mannequin_golden.txt
fresh=${DUITE_GOLDEN:-$scratch/fresh}
case $fresh in /*) ;; *) fresh=$PWD/$fresh ;; esac
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
refused() { # SENTENCE ARGUMENT...: exit status 2, and one line that has the sentence
    sentence=$1
    shift
    prints run "$@"
    got=$?
    cat complained
    test $got = 2 && grep -qF -e "$sentence" complained
}
ok "no output" refused "say where the mesh goes"
ok "an output without a name" refused "--output takes the name of a file" -o ''
ok "no folder" refused "cannot write" -o none/x.obj
ok "an argument" refused "nothing is read: \`x' is one too many" x
ok "no height" refused "--height takes a length above 0" --height 0 -o x.obj
ok "too high" refused "height is 9 m; figures have 1 to 2.3 m" --height 9 -o x.obj
ok "no edge" refused "--edge takes a length above 0" -e much -o x.obj
ok "edges that are too long" refused "edge is 0.1 m; a figure of 1.75 m has 0.008 to 0.025 m" -e 0.1 -o x.obj
ok "a walk that takes no time" refused "--walk takes seconds above 0" --walk 0 -o x.obj
ok "no rate" refused "--fps takes a rate above 0" --walk 1 --fps x -o x.obj
ok "a rate of nothing" refused "--fps is of a walk" --fps 25 -o x.obj
ok "a walk that is too long" refused "a walk has fewer than 100000 frames, not 1e+06" --walk 1e5 --fps 10 -o x.obj
ok "a measure without a girth" refused "--measure takes a name and a girth, NAME=METRES" -m chest -o x.obj
ok "no such measure" refused "there is no measure \`nose'" -m nose=0.1 -o x.obj
ok "a measure twice" refused "the measure chest is given twice" -m chest=1 -m chest=1.1 -o x.obj
ok "a measure that is none" refused "the measure chest takes a length above 0" -m chest=wide -o x.obj
ok "a girth out of range" refused "chest is 3 m; a figure of 1.75 m has 0.82 to 1.28 m" -m chest=3 -o x.obj
ok "girths that do not go together" refused "a hip of 0.85 m does not go with a thigh of 0.57 m" -m hip=0.85 -o x.obj

# ---- Bits, the same with any compiler and optimisation

golden() { # NAME ARGUMENT...
    golden_name=$1
    shift
    if ! run "$@" -o golden.obj -q > output 2>&1; then tap_result 1 "$golden_name" && return; fi
    printf '%s %s\n' "$(cksum < golden.obj | tr ' ' '-')" "$golden_name" >> "$fresh"
    echo "mannequin_golden.txt does not have: $(tail -n 1 "$fresh")" > output
    grep -qxF "$(tail -n 1 "$fresh")" "$table"
    tap_result $? "$golden_name"
}
golden "the figure"
golden "finer" -e 0.012
golden "a small one" --height 1.3 -e 0.014 -m waist=0.6 -m calf=0.29

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
scene_refused() { # SENTENCE BODY
    scene bad.yaml "$2"
    limited "$cloth" bad.yaml > said 2>&1
    test $? = 2 && cat said && grep -qF -e "$1" said
}
ok "a scene's figure that is impossible" scene_refused "bad.yaml:6:32: mannequin: hip is 3 m" '{mannequin: {measures: {hip: 3}}}'
ok "a measure that a scene cannot have" scene_refused "nose" '{mannequin: {measures: {nose: 0.1}}}'
ok "a body that has neither" scene_refused "mannequin" '{scale: 1}'
ok "a body that has both" scene_refused "mannequin" '{mannequin: {}, obj: alone.obj}'
ok "a walk that is too fast" scene_refused "the speed of a walk is 4 steps a second; at most 3 are expected" '{mannequin: {walk: {speed: 4}}}'
ok "a walk and poses" scene_refused "both walk and poses" '{mannequin: {walk: {}, poses: [{time: 0}]}}'
ok "a walk and a motion" scene_refused "a figure with a walk has no motion" '{mannequin: {walk: {}}, motion: {times: [0, 1], translate: [[0, 0, 0], [0, 1, 0]]}}'
ok "poses and frames" scene_refused "a figure with poses has no frames" '{mannequin: {poses: [{time: 0}]}, frames: {pc2: a.pc2}}'
ok "an angle out of range" scene_refused "right_knee_bend is 100 degrees; 0 to 80 are expected" '{mannequin: {poses: [{time: 0}, {time: 1, right_knee_bend: 100}]}}'
ok "an angle of the spine" scene_refused "spine_turn is 90 degrees; -30 to 30 are expected" '{mannequin: {poses: [{time: 0, spine_turn: 90}]}}'
ok "poses that go back in time" scene_refused "the time of a pose is 1 s, after one of 1 s" '{mannequin: {poses: [{time: 1}, {time: 1}]}}'
ok "too many frames" scene_refused "use a lower fps" '{mannequin: {walk: {}, fps: 1.0e8}}'
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
