#!/bin/sh
# duite-garment: what it prints and writes, the bits of its meshes, each error of a pattern, files that are no patterns.
# A change that moves bits for a good reason writes the table again: DUITE_GOLDEN=FILE sh tests/whole/test_garment.sh
. "${srcdir:-.}/tests/support/tap.sh"
garment=${DUITE_GARMENT:-$PWD/duite-garment}
mannequin=${DUITE_MANNEQUIN:-$PWD/duite-mannequin}
cloth=${DUITE_CLOTH:-$PWD/duite-cloth}
skip_unless "$garment"
plan_later
patterns=$srcdir/tests/cloth/garment/patterns
table=$srcdir/tests/whole/garment_golden.txt
fresh=${DUITE_GOLDEN:-$scratch/fresh}
case $fresh in /*) ;; *) fresh=$PWD/$fresh ;; esac
shared=$srcdir/../shared/data/patterns
page=$srcdir/cloth/app/duite-garment.1
cd "$scratch" || exit 99

run() { limited "$garment" "$@"; }
prints() { "$@" > printed 2> complained; }

# ---- Words and files

short_answer() { prints run "$2" && grep -q -e "$1" printed && test ! -s complained; }
ok "--help lists the options" short_answer '--vertices' --help
ok "--version names the version" short_answer '^duite-garment [0-9]' --version
documented() { # every option of --help stands in the manual page
    run --help | sed -n 's/^ *\(-.,\)\{0,1\} *--\([a-z-]*\).*/\2/p' | sed 's/-/\\\\-/g' > options
    test "$(wc -l < options)" -ge 7 || return
    while read -r option; do grep -q -e "\\\\-\\\\-$option" "$page" || { echo "--$option is not in the page" && return 1; }; done < options
}
ok "the manual page has every option" documented

writes() {
    prints run "$patterns/gather.json" --edge 0.02 -o skirt.obj && test ! -s complained &&
        grep -q '^panel skirt: [0-9]* vertices, [0-9]* triangles, 0.06 m^2$' printed &&
        grep -q '^seam 0: edge 2 of skirt, 0.2 m, and edge 0 of band, 0.13 m, reversed: 9 pairs, ' printed &&
        test "$(grep -c '^g ' skirt.obj)" = 2 && test "$(grep -c '^v ' skirt.obj)" = "$(grep -c '^vt ' skirt.obj)" &&
        grep -q '"reversed": true' skirt.seams.json
}
ok "mesh, seams and summary" writes
quiet() { prints run "$patterns/gather.json" -n 300 -o q.obj --seams q.txt -q && test ! -s printed && test ! -s complained && test -s q.txt; }
ok "--quiet, --seams" quiet
if command -v python3 > /dev/null; then
    ok "the seams are JSON" python3 -c 'import json; s = json.load(open("skirt.seams.json")); assert len(s["seams"][0]["pairs"]) == 9'
else
    skip "the seams are JSON" "no python3"
fi

unsure() { # distances of two seams do not tell in which direction they are sewn, and the fronts of the panels do
    prints run "$patterns/hood.json" -e 0.02 -o hood.obj && cat complained &&
        grep -qF "warning: these seams may be sewn the wrong way round: 2 3; how far partners are from each other does not tell" complained &&
        grep -q '^seam 2: .*, reversed: 6 pairs, 0.3036 m apart (0.302 the other way round)$' printed
}
ok "directions that are not clear" unsure

refused() { # SENTENCE ARGUMENT...: exit status 2, and one line that has the sentence
    sentence=$1
    shift
    prints run "$@"
    got=$?
    cat complained
    test $got = 2 && grep -qF -e "$sentence" complained
}
ok "no pattern" refused "say which pattern to mesh" -e 0.1 -o x.obj
ok "no output" refused "say where the mesh goes" "$patterns/dart.json" -e 0.1
ok "no fineness" refused "say how fine" "$patterns/dart.json" -o x.obj
ok "two finenesses" refused "take one" "$patterns/dart.json" -o x.obj -e 0.1 -n 100
ok "no length" refused "--edge takes a length above 0" "$patterns/dart.json" -o x.obj -e 0
ok "no number" refused "--vertices takes a number from 3 on" "$patterns/dart.json" -o x.obj -n 2
ok "edges that are too short" refused "edges of 1e-09 m" "$patterns/dart.json" -o x.obj -e 1e-9
ok "no file" refused "none.json: cannot open the pattern file" none.json -e 0.1 -o x.obj
ok "no folder" refused "cannot write" "$patterns/dart.json" -e 0.1 -o none/x.obj
cp "$patterns/dart.json" mine.json
ok "the pattern is not replaced" refused "would replace the pattern" mine.json -e 0.1 -o mine.json
ok "one file for both" refused "cannot be the same file" mine.json -e 0.1 -o x.obj --seams x.obj

# ---- Own garments

documents=$srcdir/docs/measures.md
listed() { # GARMENT: its measures are in the document, with size M's values and ranges
    run --measures "$1" > printed || return
    sed -n 's/^  \([a-z]*\) *\([0-9.]*\), \([0-9.]*\) more, \([0-9.]* to [0-9.]*\): \(.*\)/| `\1` | \2 | \3 | \4 | \5 |/p' printed > rows
    test "$(wc -l < rows)" -ge 9 || return
    while read -r row; do grep -qF -e "$row" "$documents" || { echo "not in docs/measures.md: $row" && return 1; }; done < rows
}
round_trip() { # GARMENT: the pattern that is written gives the same bits
    run --own "$1" --size S --measure height=1.7 -e 0.03 -o own.obj --write-pattern own.json -q &&
        run own.json -e 0.03 -o again.obj -q && cmp own.obj again.obj && cmp own.seams.json again.seams.json
}
for name in tshirt trousers skirt; do
    ok "$name: the measures are documented" listed $name
    ok "$name: its pattern is read back" round_trip $name
done
pattern_alone() { rm -f x.obj && prints run --own skirt --write-pattern skirt.json && test ! -s printed && test -s skirt.json && test ! -e x.obj; }
ok "a pattern without a mesh" pattern_alone
larger() { # of a larger size more cloth is needed
    for size in XS S M L XL; do run --own trousers --size $size -e 0.1 -o x.obj | awk '/^panel/ { area += $(NF - 1) } END { print area }'; done > areas
    test "$(wc -l < areas)" = 5 && sort -n -u areas | cmp - areas
}
ok "sizes grow" larger
cat > box.obj << 'END'
v -.1 0 -.1
v .1 0 -.1
v .1 0 .1
v -.1 0 .1
v -.1 1.7 -.1
v .1 1.7 -.1
v .1 1.7 .1
v -.1 1.7 .1
f 1 2 3 4
f 8 7 6 5
f 1 5 6 2
f 2 6 7 3
f 3 7 8 4
f 4 8 5 1
END
fits() { prints run --own skirt --measure waist=0.8 -e 0.05 -o x.obj --body box.obj && test ! -s complained; }
ok "a body that it fits" fits
tight() { prints run --own skirt --measure waist=0.7 -e 0.05 -o x.obj --body box.obj && grep -q "warning: .* too small .* its girth is 0.72 m, the body's 0.8 m" complained; }
ok "a body that is too large" tight
sizes_warned() { # GARMENT: the sizes that are too small for the mannequin, which is an M
    for size in XS S M L XL; do
        run --own "$1" --size $size -e 0.03 -o x.obj -q --body figure.obj 2> complained || return
        test ! -s complained || printf '%s ' $size
    done
}
worn() { # GARMENT SIZES: of a T-shirt's ease XS has enough left for a chest of 0.98 m
    sizes_warned "$1" > warned && echo "too small: $(cat warned)" && test "$(cat warned)" = "$2"
}
if test -x "$mannequin" && limited "$mannequin" -o figure.obj -q; then
    ok "tshirt: no size is too small for the mannequin" worn tshirt ""
    ok "trousers: S is too small for the mannequin, M fits" worn trousers "XS S "
    ok "skirt: S is too small for the mannequin, M fits" worn skirt "XS S "
else
    skip "garments on the mannequin" "no duite-mannequin"
fi

# ---- A T-shirt of the default measures closes around the default figure

closes() {
    "$cloth" "$srcdir/cloth/scenes/dressing.yaml" --quiet --threads 2 --set 'cloths[0].mesh.pattern={garment: tshirt, vertices: 5000}' \
        --set "phases=[{name: sew, set: {gravity: [0, 0, 0], time.end: 0.8}},
                       {name: close, set: {gravity: [0, 0, 0], time.end: 0.5, time.sewn: {distance: 0.002}, 'cloths[0].seams.stiffness': 3000}}]"
}
if test -x "$cloth"; then
    ok "the default T-shirt is sewn around the default mannequin" closes
else
    skip "the default T-shirt is sewn" "no duite-cloth"
fi
ok "no such body" refused "none.obj: cannot be opened" --own skirt -e 0.05 -o x.obj --body none.obj
ok "a body without a mesh" refused "--body needs --output" --own skirt --write-pattern x.json --body box.obj
ok "no such garment" refused "there is no own garment \`kilt'; there are tshirt, trousers, skirt" --own kilt -e 0.1 -o x.obj
ok "no such size" refused "--size takes one of XS, S, M, L, XL" --own skirt --size 42 -e 0.1 -o x.obj
ok "no such measure" refused "a skirt has no such measure" --own skirt --measure sleeve=1 -e 0.1 -o x.obj
ok "a measure without a value" refused "--measure takes NAME=VALUE" --own skirt --measure hem -e 0.1 -o x.obj
ok "a measure that is no number" refused "the value is not a number" --own skirt --measure hem=1m -e 0.1 -o x.obj
ok "a measure that is out of range" refused "skirt: the measure hem is 9; it has to be 0.5 to 4" --own skirt --measure hem=9 -e 0.1 -o x.obj
ok "two patterns" refused "exclude each other" mine.json --own skirt -e 0.1 -o x.obj
ok "a size of a file" refused "need --own" mine.json --size M -e 0.1 -o x.obj
ok "pattern over the mesh" refused "mesh and pattern cannot be the same file" --own skirt -e 0.1 -o x.obj --write-pattern x.obj
ok "pattern over the pattern" refused "would replace the pattern" mine.json --write-pattern mine.json
ok "seams of nothing" refused "--seams needs --output" --own skirt --write-pattern y.json --seams x.obj

# ---- Patterns that cannot be sewn

# bad SENTENCE SED...: the dart's pattern, changed by sed, is refused with this sentence.
bad() {
    sentence=$1
    shift
    sed "$@" "$patterns/dart.json" > bad.json
    if cmp -s bad.json "$patterns/dart.json"; then echo "nothing changed: $*" > output && tap_result 1 "$sentence" && return; fi
    ok "$sentence" refused "$sentence" bad.json -e 0.05 -o x.obj
}
bad "panel 'back' is no closed loop: edge 0 ends at vertex 1, edge 1 begins at vertex 3" -e 's/\[1, 2\]/[3, 2]/'
bad "panel 'back' is no closed loop: edge 5 ends at vertex 6, edge 6 begins at vertex 0" -e 's/\[6, 0\]/[0, 6]/'
bad "panel 'back' comes to vertex 0 a second time with edge 3" -e 's/\[2, 3\]/[2, 0]/; s/\[3, 4\]/[0, 4]/'
bad "panel 'back' has vertex 7, but no edge there" -e 's/\[0, 50\]\]/[0, 50], [9, 9]]/'
bad "panel 'back' has 0 edges" -e 's/"edges": \[{/"edges": [], "label": [{/; s/"stitches": .*/"stitches": []/'
bad "panel 'back': edge 2 has no length" -e 's/\[22, 50\]/[40, 50]/'
bad "panel 'back': edges 0 and 3 cross or touch each other" -e 's/\[20, 35\]/[20, -5]/'
bad "panel 'back': edges 0 and 3 cross or touch each other" -e 's/\[20, 35\]/[20, 0]/'
bad "panel 'back': edges 1 and 2 cross or touch each other" -e 's/\[22, 50\]/[40, 20]/'
bad "panel 'back': edge 0 crosses or touches itself" -e 's/"endpoints": \[0, 1\]/"endpoints": [0, 1], "curvature": {"type": "cubic", "params": [[2, -0.5], [-1, -0.5]]}/'
bad "panel 'back': edge 0 is an arc of radius 0.1 m" -e 's/"endpoints": \[0, 1\]/"endpoints": [0, 1], "curvature": {"type": "circle", "params": [10, 0, 1]}/'
bad "panel 'back', edge 0: the radius is not above 0" -e 's/"endpoints": \[0, 1\]/"endpoints": [0, 1], "curvature": {"type": "circle", "params": [-10, 0, 1]}/'
bad "panel 'back', edge 0: curvature.params of a circle has 2 entries; it has to have 3" -e 's/"endpoints": \[0, 1\]/"endpoints": [0, 1], "curvature": {"type": "circle", "params": [10, 0]}/'
bad "panel 'back', edge 0: curvature.type is none of quadratic, cubic and circle" -e 's/"endpoints": \[0, 1\]/"endpoints": [0, 1], "curvature": {"type": "spline", "params": []}/'
bad "panel 'back', edge 0: a control point has 1 entries; it has to have 2" -e 's/"endpoints": \[0, 1\]/"endpoints": [0, 1], "curvature": [0.5]/'
bad "panel 'back', edge 0: an endpoint is 7, but there are 7 vertices, counted from 0" -e 's/\[0, 1\]/[0, 7]/'
bad "panel 'back', edge 0: endpoints are missing" -e 's/{"endpoints": \[0, 1\]}/{}/'
bad "panel 'back', edge 0: unknown key \"colour\" in the edge, which may have endpoints, curvature, label" -e 's/"endpoints": \[0, 1\]/"endpoints": [0, 1], "colour": 1/'
bad "bad.json:8:9: panel 'back': unknown key \"turn\" in the panel" -e 's/"translation"/"turn"/'
bad "panel 'back': rotation: missing" -e 's/"rotation": \[0, 0, 0\]/"label": ""/'
bad "panel 'back': a vertex is \"x\"; it has to be a number" -e 's/\[40, 0\]/[40, "x"]/'
bad "panel 'back': a vertex is 1e999; it has to be a number" -e 's/\[40, 0\]/[40, 1e999]/'
bad "unknown key \"units\" in properties" -e 's/units_in_meter/units/'
bad "units_in_meter is 0; it has to be 0.001 to 1e6" -e 's/"units_in_meter": 100/"units_in_meter": 0/'
bad "units_in_meter is \"cm\"" -e 's/"units_in_meter": 100/"units_in_meter": "cm"/'
bad "panel 'back' is 500 m large; panels have 0.001 to 100 m: is units_in_meter right?" -e 's/"units_in_meter": 100/"units_in_meter": 0.1/'
ok "edges too short to be had" refused "edges of 1e-06 m give about 2e+11 vertices; up to 134217728 can be had" "$patterns/dart.json" --edge 1e-6 -o x.obj
short_edges() { # by the scene, whose key is named
    printf 'schema: 1\ncloths:\n  - mesh: {pattern: {garment: tshirt, edge: 1e-6}}\n    material: m\nmaterials: {m: {density: 0.2, stretch: 100}}\ntime: {h: 0.001, end: 0.001}\n' > short.yaml
    status=0
    limited "$DUITE_CLOTH" short.yaml --quiet > said 2>&1 || status=$?
    cat said
    test $status = 2 && grep -q "^duite-cloth: short.yaml:3:45: the pattern is to have [0-9]* vertices, which take [0-9]* GB of memory or more; this machine has " said
}
ok "also in a scene" short_edges
units() { # UNITS: with so many in a metre the back has 0.5 m * 100 / UNITS
    sed "s/\"units_in_meter\": 100/\"units_in_meter\": $1/" "$patterns/dart.json" > units.json && run units.json --vertices 300 -o x.obj --quiet 2> said
    cat said
}
warns_of_units() {
    units 5 && grep -qx "duite-garment: warning: units.json: panel 'back' is 10 m large; panels have 0.05 to 4 m: is units_in_meter right?" said &&
        units 2000 && grep -q "panel 'back' is 0.025 m large" said && units 100 && ! test -s said &&
        units 5 && printf 'schema: 1\ncloths: [{mesh: {pattern: {file: units.json, vertices: 300}}, material: m}]\nmaterials: {m: {density: 0.2, stretch: 100}}\n%s\n' \
        'time: {h: 0.001, end: 0.001}' > units.yaml && limited "$DUITE_CLOTH" units.yaml --quiet 2> said && cat said &&
        grep -q "units.yaml:2:[0-9]*: mesh: units.json: panel 'back' is 10 m large; panels have 0.05 to 4 m: is units_in_meter right?" said
}
ok "units that make a panel of 10 m draw a warning" warns_of_units
bad "curvature_coords is world; it has to be" -e 's/"relative"/world/'
bad "stitch 0: there is no panel 'front'" -e 's/"panel": "back", "edge": 4/"panel": "front", "edge": 4/'
bad "stitch 0: the edge of panel 'back' is 7, but there are 7 edges, counted from 0" -e 's/"edge": 4/"edge": 7/'
bad "stitch 0 joins edge 3 of panel 'back' to itself" -e 's/"edge": 4/"edge": 3/'
bad "stitch 1: edge 4 of panel 'back' is stitched already, by stitch 0" -e 's/"stitches": \[/&[{"panel": "back", "edge": 4}, {"panel": "back", "edge": 0}], /'
bad "stitch 0: a stitch has 1 entries; it has to have 2 to 3" -e 's/, {"panel": "back", "edge": 4}//'
bad "the file has no \"properties\"" -e 's/"properties"/"parameters"/'
bad "the pattern has no panels" -e 's/"panels": {/"panels": {}, "panel_order": {/; s/"stitches": .*/"stitches": []/'
bad "has the key edge twice" -e 's/"edge": 4/"edge": 4, "edge": 4/'
bad "not JSON" -e 's/\[40, 0\],/[40, 0] "/'
bad "bad.json:8:9: a comment begins here, and JSON has none: take it out" -e '8s,"translation",// "translation",'
bad "bad.json:1:1: a comment begins here, and JSON has none: take it out" -e '1s,^,/* "a" */,'
kept() { # slashes in a text are none
    sed 's,"label": "",&,; s,"translation": ,"label": "http://a/*bc", "translation": ,' "$patterns/dart.json" > bad.json && run bad.json -e 0.05 -o x.obj 2> said
    cat said
    ! grep "a comment" said
}
ok "slashes in a text are no comment" kept

hostile() { # NAME TEXT: no crash, one sentence
    printf '%b' "$2" > hostile.json
    exits 2 "hostile: $1" run hostile.json -e 0.05 -o x.obj
}
hostile "nothing" ''
hostile "a list" '[]'
hostile "a number" '7'
hostile "zero bytes" '\000\000\000'
hostile "half a file" '{"pattern": {"panels": {"a": {"vertices": [[0, 0'
hostile "no closing brackets" "$(awk 'BEGIN { for (i = 0; i < 2000; i++) printf "[" }')"
hostile "itself" '&a {"pattern": *a, "properties": *a}'
hostile "panels that are each other" '{"properties": {"units_in_meter": 1}, "pattern": {"panels": &p {"a": {"vertices": &p [], "edges": *p, "translation": *p, "rotation": *p}}}}'
hostile "a name without end" "{\"properties\": {\"units_in_meter\": 1}, \"pattern\": {\"panels\": {\"$(awk 'BEGIN { for (i = 0; i < 900; i++) printf "x" }')\": {}}}}"
hostile "two panels of one name" '{"properties": {"units_in_meter": 1}, "pattern": {"panels": {"a b": &a {"vertices": [[0,0],[1,0],[0,1]], "edges": [{"endpoints":[0,1]},{"endpoints":[1,2]},{"endpoints":[2,0]}], "translation": [0,0,0], "rotation": [0,0,0]}, "a_b": *a}}}'
hostile "a needle" '{"properties": {"units_in_meter": 1}, "pattern": {"panels": {"a": {"vertices": [[0,0],[1,0],[1,1e-12]], "edges": [{"endpoints":[0,1]},{"endpoints":[1,2]},{"endpoints":[2,0]}], "translation": [0,0,0], "rotation": [0,0,0]}}}}'
hostile "a spike" '{"properties": {"units_in_meter": 1}, "pattern": {"panels": {"a": {"vertices": [[0,0],[1,0],[2,0],[1,0],[0,1]], "edges": [{"endpoints":[0,1]},{"endpoints":[1,2]},{"endpoints":[2,3]},{"endpoints":[3,4]},{"endpoints":[4,0]}], "translation": [0,0,0], "rotation": [0,0,0]}}}}'
hostile "a curve beyond everything" '{"properties": {"units_in_meter": 1}, "pattern": {"panels": {"a": {"vertices": [[0,0],[1,0],[0,1]], "edges": [{"endpoints":[0,1], "curvature": [1e9, -1e9]},{"endpoints":[1,2]},{"endpoints":[2,0]}], "translation": [0,0,0], "rotation": [0,0,0]}}}}'

# ---- Bits, the same with any compiler and optimisation

golden() { # NAME ARGUMENT...
    golden_name=$1
    shift
    if ! run "$@" -o golden.obj -q > output 2>&1; then tap_result 1 "$golden_name" && return; fi
    printf '%s %s\n' "$(cat golden.obj golden.seams.json | cksum | tr ' ' '-')" "$golden_name" >> "$fresh"
    echo "garment_golden.txt does not have: $(tail -n 1 "$fresh")" > output
    grep -qxF "$(tail -n 1 "$fresh")" "$table"
    tap_result $? "$golden_name"
}
for name in straight quadratic cubic circle dart gather fold steep; do
    golden "$name, 3 cm" "$patterns/$name.json" -e 0.03
    golden "$name, 4000 vertices" "$patterns/$name.json" -n 4000
done

for name in tshirt trousers skirt; do
    golden "own $name, 2 cm" --own $name -e 0.02
    golden "own $name, XL, 5000 vertices" --own $name --size XL -n 5000
done

# ---- Patterns of others

whole() { # NAME: 35,000 vertices within 1 %, no bad triangle
    prints run "$shared/$1.json" -n 35000 -o others.obj && tail -n 1 printed
    tail -n 1 printed | awk '{ exit !($1 >= 34650 && $1 <= 35350 && $(NF - 6) >= 20 && $(NF - 3) <= 0.0001 * $3) }'
}
for name in tee dress skirt_4_panels wb_pants_straight; do
    if test -e "$shared/$name.json"; then
        ok "$name.json: 35,000 vertices" whole $name
        golden "$name.json" "$shared/$name.json" -n 35000
    else
        skip "$name.json" "not there"
    fi
done
