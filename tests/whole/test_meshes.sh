#!/bin/sh
# Meshes as they come from other programs: uv in islands, pieces, edges that are too short. Twins differ in what must not matter, and so
# give the same forces. Errors are printed.
. "${srcdir:-.}/tests/support/probes.sh"

# A strip of 10 x 4 cells of 1/8 m, in two groups, with uv. Beyond x = 5/8 m the uv is that of an island of its own: SHIFT away in u, or
# turned by 90 degrees.
strip() { # SHIFT TURNED
    awk -v shift="$1" -v turned="$2" 'BEGIN { nx = 11; ny = 5; print "mtllib strip.mtl"; print "o Whole strip"
        for (j = 0; j < ny; j++) for (i = 0; i < nx; i++) printf "v %.15g %.15g %.15g\nvt %.15g %.15g\n", i / 8, (i % 3) / 64, j / 8, i / 8, j / 8
        for (j = 0; j < ny; j++) for (i = 0; i < nx; i++) if (turned) printf "vt %.15g %.15g\n", shift - j / 8, i / 8
            else printf "vt %.15g %.15g\n", i / 8 + shift, j / 8
        for (k = 0; k < 2; k++) { print k ? "g right" : "g left first"; print k ? "usemtl red" : "usemtl blue one"; at = k * (shift || turned) * nx * ny
            for (j = 0; j < ny - 1; j++) for (i = 5 * k; i < 5 * k + 5; i++) { a = j * nx + i + 1; b = a + nx
                printf "f %d/%d %d/%d %d/%d\nf %d/%d %d/%d %d/%d\n", a, a + at, b, b + at, b + 1, b + 1 + at, a, a + at, b + 1, b + 1 + at, a + 1, a + 1 + at } } }'
}
strip 0 0 > whole.obj
strip 2 0 > moved.obj
strip 2 1 > turned.obj
sed 's/^vt .*/vt 0 0/' whole.obj > point.obj
sed '/^usemtl red/,$s|/[0-9]*||g' whole.obj > half.obj
sed 's|/[0-9]*||g; /^vt /d' whole.obj > bare.obj
echo 'newmtl red' > strip.mtl
cat > strip.yaml << 'END'
schema: 1
cloths:
  - mesh: {file: whole.obj}
    material: cloth
    pins: [{box: [[0, 0, 0], [0, 1, 1]]}, {box: [[1.25, 0, 0], [1.25, 1, 1]], motion: {times: [0, 0.1], translate: [[0, 0, 0], [0.02, 0, 0]]}}]
materials: {cloth: {model: triangles, density: 0.25, stretch: [100, 400], shear: 30, bending: {rigidity: [1e-4, 4e-4]}, damping: {stiffness: 0.01, mass: 1}}}
time: {h: 0.01, end: 0.2, fps: 50}
probes: [{name: p, box: [[0, 0, 0], [0, 1, 1]], values: [total]}]
END
SPRINGS='materials.cloth={density: 0.25, stretch: [100, 400], bend: 1, damping: {stiffness: 0.01, mass: 1}}'

twins() { # MESH SCENE...: the same to the last bit
    mesh=$1
    shift
    run strip.yaml "$@" && cp out/cloth.pc2 one.pc2 && cp out/probes.csv one.csv && run strip.yaml --set "cloths[0].mesh.file=$mesh" "$@" &&
        cmp out/probes.csv one.csv && cmp out/cloth.pc2 one.pc2
}
ok "uv in two islands: triangles, and hinges between them" twins moved.obj
ok "springs along warp and weft" twins moved.obj --set "$SPRINGS"
differs() { ! twins "$@"; }
ok "an island that is turned has its warp along it" differs turned.obj
ok "uv without an area says no more than none" twins point.obj --set 'cloths[0].mesh.file=bare.obj'

like() { # MESH SCENE...: flat at rest, of uv: but for rounding; a shape at rest of its own draws the strip together
    mesh=$1
    shift
    run strip.yaml --set 'cloths[0].rest=uv' "$@" && pull=$(last p.total.rx) &&
        run strip.yaml --set 'cloths[0].rest=uv' "$@" --set "cloths[0].mesh.file=$mesh" && near "force of the strip" "$(last p.total.rx)" "$pull" 1e-9
}
ALIKE='materials.cloth={model: triangles, density: 0.25, stretch: 100, shear: 30, bending: {rigidity: 1e-4}, strain_limit: {at: 0.01, stiffness: 50}}'
ok "a rest shape of two islands" like moved.obj
ok "of which one is turned" like turned.obj --set "$ALIKE"
ok "of springs" like turned.obj --set 'materials.cloth={density: 0.25, stretch: 100, bend: 1, damping: {mass: 1}}'
ok "with a load along the border of the islands" like turned.obj --set "$ALIKE" \
    --set 'cloths[0].loads=[{edges: [[5, 16], [16, 27], [27, 38], [38, 49]], force: [2, 0, 0]}]'

# A written mesh is read again as the same, and has the names.
again() {
    run strip.yaml --set 'cloths[0].mesh.file=moved.obj' && cp out/cloth.pc2 one.pc2 && cp out/cloth.obj again.obj &&
        run strip.yaml --set 'cloths[0].mesh.file=again.obj' && cmp out/cloth.pc2 one.pc2 &&
        sed 's/^g cloth1 /g /' out/cloth.obj | diff again.obj - # what was the cloth's name is that of an object
}
ok "cloth.obj read again, and written again" again
lines() {
    grep -E '^(mtllib|o|g|usemtl)' again.obj > got
    printf '%s\n' "mtllib $(realpath strip.mtl)" 'o cloth1' 'g Whole_strip left first' 'usemtl blue one' 'g Whole_strip right' 'usemtl red' > expected
    diff got expected && test "$(grep -c '^vt' again.obj)" = 60
}
ok "its uv, groups and materials" lines
two() { # a second cloth has no groups and no material of the first one
    run strip.yaml --set 'cloths=[{mesh: {file: moved.obj}, material: cloth}, {mesh: {file: bare.obj}, material: cloth}, {mesh: {grid: {width: 1, height: 1, nx: 2, ny: 2}}, material: cloth, name: sheet}]' \
        --set 'probes=[]' --set 'contact={mode: project}' --end 0.01 || return
    sed -n '/^o sheet/,$p' out/cloth.obj | grep -E '^(o|g|usemtl|f)' > got
    printf '%s\n' 'o sheet' g 'usemtl sheet' 'f 111/61 113/63 114/64' > expected
    head -4 got | diff - expected
}
ok "groups and materials end with their cloth" two

ok "uv that some faces lack is said" says "40 of 80 faces have corners without vt" strip.yaml --set 'cloths[0].mesh.file=half.obj'
silent() { says "Limited by" "$@" && ! grep -q vt said; }
ok "nothing is said of a mesh without uv" silent strip.yaml --set 'cloths[0].mesh.file=bare.obj'
ok "an object is a group" says "frames" strip.yaml --set 'cloths[0].pins=[{group: Whole strip}]'

# A sheet of 8 x 4 cells of 1/8 m, whose halves have vertices of their own where they meet; or none (WHOLE); or bent to a tube, whose slit
# has its vertices twice.
halves() { # WHOLE
    awk -v whole="$1" 'BEGIN { for (k = 0; k < 2; k++) for (j = 0; j < 5; j++) for (i = k && whole; i < 5; i++) {
            print "v", (i + 4 * k) / 8, 0, j / 8; at[k, i, j] = ++n }
        for (j = 0; whole && j < 5; j++) at[1, 0, j] = at[0, 4, j]
        for (k = 0; k < 2; k++) for (j = 0; j < 4; j++) for (i = 0; i < 4; i++) {
            print "f", at[k, i, j], at[k, i, j + 1], at[k, i + 1, j + 1]; print "f", at[k, i, j], at[k, i + 1, j + 1], at[k, i + 1, j] } }'
}
halves 0 > halves.obj
halves 1 > one.obj
awk '$1 == "v" { a = $2 * 8 * atan2(0, -1) / 4; printf "v %.15g %.15g %s\n", cos(a) / 4, sin(a) / 4, $4; next } 1' one.obj > tube.obj
cat > halves.yaml << 'END'
schema: 1
cloths:
  - mesh: {file: halves.obj}
    material: cloth
    pins: [{box: [[0, 0, 0], [0, 1, 1]]}]
materials: {cloth: {model: triangles, density: 0.25, stretch: 100, shear: 30, bending: {rigidity: 1e-3}, damping: {stiffness: 0.01, mass: 1}}}
time: {h: 0.01, end: 0.1, fps: 50}
solver: {stop: {relative: 1e-12}}
contact: {mode: project}
probes: [{name: p, box: [[0, 0, 0], [0, 1, 1]], values: [total]}]
END
ok "pieces are said, and what lies on another's place" says "has 2 pieces; 5 vertices at borders lie on another's place" halves.yaml
ok "so is a slit" says "has 1 piece; 5 vertices at borders" halves.yaml --set 'cloths[0].mesh.file=tube.obj' --set 'cloths[0].pins=[]' --set 'probes=[]'
quiet() { says "Limited by" halves.yaml --output out "$@" && ! grep -q warning said; }
ok "not where welds join them" quiet --set 'welds=[{from: {vertices: [4, 9, 14, 19, 24]}, to: {vertices: [25, 30, 35, 40, 45]}}]'
ok "nor where joints do" quiet \
    --set 'joints=[{from: {vertices: [4, 9, 14, 19, 24]}, to: {vertices: [25, 30, 35, 40, 45]}, stiffness: 10, length: 0}]'
ok "nor where the mesh is whole" quiet --set 'cloths[0].mesh.file=one.obj'
ok "nor where weld makes them one" quiet --set 'cloths[0].mesh.weld=1e-5'
welded() { # SCENE...
    run halves.yaml --set 'cloths[0].mesh.file=one.obj' "$@" && pull=$(last p.total.ry) &&
        run halves.yaml --set 'cloths[0].mesh={weld: 1e-5, file: halves.obj}' "$@" && near "force of welded halves" "$(last p.total.ry)" "$pull" 1e-6
}
ok "welded halves are the whole: triangles and hinges" welded
ok "springs" welded --set 'materials.cloth={density: 0.25, stretch: 100, damping: {stiffness: 0.01, mass: 1}}'
CERTIFIED='contact={mode: certified, self: on, thickness: 0.002}'
ok "and start where contact is certified" run halves.yaml --set 'cloths[0].mesh.weld=1e-5' --set "$CERTIFIED"
advised() {
    limited "$DUITE_CLOTH" halves.yaml --set "$CERTIFIED" > said 2>&1
    test $? = 2 || return
    cat said
    grep -qF "join what lies on another's place, by mesh: {weld: 1e-5}" said && ! grep -q untangle said
}
ok "where halves do not, the error says what joins them" advised
ok "a weld that joins nothing is said" says "weld joins no vertices: no two of cloth 'cloth1' are within 0.001 m" halves.yaml \
    --set 'cloths[0].mesh={file: one.obj, weld: 1e-3}'
far() {
    limited "$DUITE_CLOTH" halves.yaml --set 'cloths[0].mesh.weld=0.13' > said 2>&1
    test $? = 2 || return
    cat said
    grep -qF "welds make vertices 0 and 5 of cloth 'cloth1' one, which a triangle joins" said
}
ok "one that is longer than an edge is refused" far

# One vertex of the sheet lies 0.17 mm from another: its neighbours do not push each other apart, as they would over 2 mm.
awk '$1 == "v" && $2 == 0.5 && $4 == 0.25 { $2 = 0.625 - 0.00017 } 1' one.obj > short.obj
SHORT='cloths[0].mesh.file=short.obj'
ok "triangles with a short edge are counted" says '  low triangles    2 of cloth1, triangle ' halves.yaml --set "$SHORT" --set "$CERTIFIED"
rests() {
    run halves.yaml --set "$SHORT" --set "$CERTIFIED" --set 'cloths[0].pins=[]' --set 'gravity=[0, 0, 0]' \
        --set 'probes=[{name: p, vertices: [14, 33], values: [position]}]' || return
    near "distance of its ends" "$(less "$(last p.33.x)" "$(last p.14.x)")" 0.00017 1e-6 &&
        near "height, and 1 m" "$(less 1 "$(last p.14.y)")" 1 1e-9
}
ok "a sheet with one stays at rest" rests
alone() { # --check-intersections finds none either
    limited "$DUITE_CLOTH" halves.yaml --set "$SHORT" --set "$CERTIFIED" --output out --check-intersections > said 2>&1 || { cat said && return 1; }
    cat said
    grep -q 'intersections *none' said
}
ok "one that swings goes through nothing" alone
same() { # a mesh with all of these, in blocks, on one rank and on two
    set -- halves.yaml --set 'cloths[0].mesh={file: pieces.obj, weld: 1e-5}' --set "$CERTIFIED" --set 'cloths[0].rest=uv' --grain 9
    run "$@" && cp out/cloth.pc2 one.pc2 && ranks 2 "$DUITE_CLOTH" "$@" --quiet --output out --threads 2 && cmp out/cloth.pc2 one.pc2
}
awk '$1 == "v" && $2 == 0.25 && $4 == 0.25 { $2 = 0.375 - 0.00017 }
    $1 == "v" { print; n++; uv = uv "vt " $2 " " $4 "\n"; turned = turned "vt " 9 - $4 " " $2 "\n"; next }
    $1 == "f" && !uvs { printf "%s%s", uv, turned; uvs = 1 }
    { k = $2 > 25 ? n : 0; print "f", $2 "/" $2 + k, $3 "/" $3 + k, $4 "/" $4 + k }' halves.obj > pieces.obj
ok "islands, pieces and a short edge on 2 ranks" same
