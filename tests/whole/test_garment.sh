#!/bin/sh
# duite-garment: what it prints and writes, the bits of its meshes, wrong options.
# A change that moves bits for a good reason writes the table again: DUITE_GOLDEN=FILE sh tests/whole/test_garment.sh
. "${srcdir:-.}/tests/support/tap.sh"
. "$srcdir/tests/whole/golden.sh"
garment=${DUITE_GARMENT:-$PWD/duite-garment}
mannequin=${DUITE_MANNEQUIN:-$PWD/duite-mannequin}
cloth=${DUITE_CLOTH:-$PWD/duite-cloth}
skip_unless "$garment"
plan_later
golden_of garment_golden.txt
patterns=$srcdir/tests/cloth/garment/patterns
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

ok "no pattern" refuses "say which pattern to mesh" run -e 0.1 -o x.obj
ok "no output" refuses "say where the mesh goes" run "$patterns/dart.json" -e 0.1
ok "no fineness" refuses "say how fine" run "$patterns/dart.json" -o x.obj
ok "two finenesses" refuses "take one" run "$patterns/dart.json" -o x.obj -e 0.1 -n 100
ok "no length" refuses "--edge takes a length above 0" run "$patterns/dart.json" -o x.obj -e 0
ok "no number" refuses "--vertices takes a number from 3 on" run "$patterns/dart.json" -o x.obj -n 2
ok "edges that are too short" refuses "edges of 1e-09 m" run "$patterns/dart.json" -o x.obj -e 1e-9
ok "no file" refuses "none.json: cannot open the pattern file" run none.json -e 0.1 -o x.obj
ok "no folder" refuses "cannot write" run "$patterns/dart.json" -e 0.1 -o none/x.obj
cp "$patterns/dart.json" mine.json
ok "the pattern is not replaced" refuses "would replace the pattern" run mine.json -e 0.1 -o mine.json
ok "one file for both" refuses "cannot be the same file" run mine.json -e 0.1 -o x.obj --seams x.obj

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

# ---- Two squares of a DXF file, which are sewn up to their notches

square() { # NAME: of 0.2 m, notches in the middle of its right and its left side
    echo "0 BLOCK|8 0|2 $1|0 TEXT|8 1|1 Piece Name: $1|0 TEXT|8 1|1 Size: 38|0 POLYLINE|8 1|70 1|0 VERTEX|8 1|10 0|20 0|0 VERTEX|8 1|10 200|20 0|"
    echo "0 VERTEX|8 1|10 200|20 200|0 VERTEX|8 1|10 0|20 200|0 SEQEND|8 1|0 POINT|8 4|10 200|20 100|0 POINT|8 4|10 0|20 100|0 ENDBLK|"
}
{ echo "0 SECTION|2 BLOCKS|" && square front && square back && echo "0 ENDSEC|0 EOF"; } | tr '|' '\n' | awk 'NF { print $1; sub(/^[0-9]+ /, ""); print }' > bag.dxf
cat > bag.yaml << 'END'
schema: 1
cloths:
  - mesh:
      pattern:
        {file: bag.dxf, size: '38', notches: on, edge: 0.025, place: {front: {translation: [0, 0, 0.01]}, back: {rotation: [0, 180, 0], translation: [0, 0, -0.01]}},
         stitches: [[{panel: front, edge: 1}, {panel: back, edge: 5}], [{panel: front, edge: 5}, {panel: back, edge: 1}]]}
    material: m
    seams: {state: pulled, stiffness: 300, damping: 10}
materials: {m: {density: 0.2, model: triangles, stretch: 500, shear: 100, damping: {mass: 5}}}
gravity: [0, 0, 0]
time: {h: 0.01, end: 0.4, fps: 25}
END
bag() { # RANKS: 0.1 m of each side come together, and no more
    ranks "$1" "$cloth" bag.yaml --quiet --grain 20 --output "bag$1" --report "bag$1.json" --set 'time.sewn={distance: 0.002}' && cat "bag$1.json" &&
        test "$(value state_hash "bag$1.json")" = "$(value state_hash bag1.json)"
}
open_above() { # the upper corners are where they were, the lower ones have met
    "$DUITE_VIEW" bag1 --export bag.obj && awk '$1 == "v" && ($2 * $2 > 0.0099) { if ($3 > 0.09) up += $4 * $4 > 0.005 * 0.005; if ($3 < -0.09) down += $4 * $4 > 0.002 * 0.002 }
        END { print up, down; exit up == 0 || down > 0 }' bag.obj
}
if test -x "$cloth"; then
    ok "a bag of DXF pieces is sewn up to its notches" bag 1
    ok "with the same bits on two ranks" bag 2
    if test -x "$DUITE_VIEW"; then ok "and is open above them" open_above; fi
fi
no_rules() { echo x > bag.rul && refuses "no piece has the size '40'; there are 38; export all sizes as pieces, since grade rules are not read: bag.rul" run bag.dxf --size 40 -e 0.1 -o x.obj; }
ok "grade rules beside a file of one size are named" no_rules
ok "notches of an own garment" refuses "--notches is of a DXF file" run --own skirt --notches -e 0.1 -o x.obj

ok "no such body" refuses "none.obj: cannot be opened" run --own skirt -e 0.05 -o x.obj --body none.obj
ok "a body without a mesh" refuses "--body needs --output" run --own skirt --write-pattern x.json --body box.obj
ok "no such garment" refuses "there is no own garment \`kilt'; there are tshirt, trousers, skirt" run --own kilt -e 0.1 -o x.obj
ok "no such size" refuses "--size takes one of XS, S, M, L, XL" run --own skirt --size 42 -e 0.1 -o x.obj
ok "no such measure" refuses "a skirt has no such measure" run --own skirt --measure sleeve=1 -e 0.1 -o x.obj
ok "a measure without a value" refuses "--measure takes NAME=VALUE" run --own skirt --measure hem -e 0.1 -o x.obj
ok "a measure that is no number" refuses "the value is not a number" run --own skirt --measure hem=1m -e 0.1 -o x.obj
ok "a measure that is out of range" refuses "skirt: the measure hem is 9; it has to be 0.5 to 4" run --own skirt --measure hem=9 -e 0.1 -o x.obj
ok "two patterns" refuses "exclude each other" run mine.json --own skirt -e 0.1 -o x.obj
ok "a size of a file" refuses "a pattern as JSON has one size" run mine.json --size M -e 0.1 -o x.obj
ok "pattern over the mesh" refuses "mesh and pattern cannot be the same file" run --own skirt -e 0.1 -o x.obj --write-pattern x.obj
ok "pattern over the pattern" refuses "would replace the pattern" run mine.json --write-pattern mine.json
ok "seams of nothing" refuses "--seams needs --output" run --own skirt --write-pattern y.json --seams x.obj

# ---- Patterns that cannot be sewn: tests/cloth/scene/sentences.txt has them all

sed 's/\[1, 2\]/[3, 2]/' "$patterns/dart.json" > bad.json
ok "a pattern that cannot be sewn" refuses "bad.json: panel 'back' is no closed loop: edge 0 ends at vertex 1, edge 1 begins at vertex 3" run bad.json -e 0.05 -o x.obj

ok "edges too short to be had" refuses "edges of 1e-06 m give about 2e+11 vertices; up to 134217728 can be had" run "$patterns/dart.json" --edge 1e-6 -o x.obj
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
kept() { # slashes in a text are none
    sed 's,"label": "",&,; s,"translation": ,"label": "http://a/*bc", "translation": ,' "$patterns/dart.json" > bad.json && run bad.json -e 0.05 -o x.obj 2> said
    cat said
    ! grep "a comment" said
}
ok "slashes in a text are no comment" kept

# ---- Bits, the same with any compiler and optimisation

bits() { # NAME ARGUMENT...
    bits_name=$1
    shift
    if run "$@" -o golden.obj -q > output 2>&1; then golden "$bits_name" "$(cat golden.obj golden.seams.json | cksum | tr ' ' '-')"; else tap_result 1 "$bits_name"; fi
}
for name in straight quadratic cubic circle dart gather fold steep; do
    bits "$name, 3 cm" "$patterns/$name.json" -e 0.03
    bits "$name, 4000 vertices" "$patterns/$name.json" -n 4000
done

for name in tshirt trousers skirt; do
    bits "own $name, 2 cm" --own $name -e 0.02
    bits "own $name, XL, 5000 vertices" --own $name --size XL -n 5000
done

# ---- Patterns of others

whole() { # NAME: 35,000 vertices within 1 %, no bad triangle
    prints run "$shared/$1.json" -n 35000 -o others.obj && tail -n 1 printed
    tail -n 1 printed | awk '{ exit !($1 >= 34650 && $1 <= 35350 && $(NF - 6) >= 20 && $(NF - 3) <= 0.0001 * $3) }'
}
for name in tee dress skirt_4_panels wb_pants_straight; do
    if test -e "$shared/$name.json"; then
        ok "$name.json: 35,000 vertices" whole $name
        bits "$name.json" "$shared/$name.json" -n 35000
    else
        skip "$name.json" "not there"
    fi
done
