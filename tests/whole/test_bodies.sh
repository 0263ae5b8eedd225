#!/bin/sh
# Bodies as a user meets them: one state_hash over ranks, threads and the rest; the folder of frames has the mesh, and the viewer draws
# it from there; what is wrong with a body is said before any work.
. "${srcdir:-.}/tests/support/tap.sh"
. "$srcdir/tests/support/bodies.sh"
skip_unless "$DUITE_CLOTH"
skip_unless tests/whole/same_hash
plan_later

ring_obj 0.3 0.1 > "$scratch/ring.obj"
cat > "$scratch/ring.yaml" << 'END'
schema: 1
contact: {mode: project}
cloths: [{mesh: {grid: {width: 1, height: 1, nx: 30, ny: 30}}, material: cloth}]
obstacles:
  - body: {obj: ring.obj, scale: 1.1, translate: [0, -0.115, 0.01], motion: {times: [0, 1], translate: [[0, 0, 0], [0.1, 0.2, 0]], rotate: [[1, 0, 0, 0], [1, 0.2, 0.1, 0]]}}
  - body: {obj: ring.obj, scale: 0.5, rotate: [1, 1, 0, 0], translate: [0, -0.3, 0]}
materials: {cloth: {density: 0.2, stretch: 1000, shear: 100, damping: {stiffness: 0.01}}}
time: {h: 0.005, end: 0.1, fps: 20}
grain: 100
END
ok "one hash" ranks 4 tests/whole/same_hash "$scratch/ring.yaml" few 0

# By frames: the ring is drawn out and goes up, in three files. Frames that only shift it do what a motion does.
deform() { awk -v x="$1" -v y="$2" -v wide="$3" '/^v/ { printf "v %.9f %.9f %.9f\n", $2 * wide + x, $3 + y, $4; next } { print }' "$scratch/ring.obj"; }
deform 0 0.01 1.1 > "$scratch/second.obj"
deform 0.02 0.03 1.2 > "$scratch/third.obj"
deform 0.1 0.2 1 > "$scratch/shifted.obj"
sed 's/obj: ring.obj, scale: 1.1\(.*\), motion: .*/obj: ring.obj, scale: 1.1\1, frames: {obj: [ring.obj, second.obj, third.obj], fps: 20}}/' "$scratch/ring.yaml" > "$scratch/frames.yaml"
ok "one hash, by frames" ranks 4 tests/whole/same_hash "$scratch/frames.yaml" few 0
frames_of_a_motion() {
    for way in 'motion: {times: [0, 1], translate: [[0, 0, 0], [0.1, 0.2, 0]]}' 'frames: {obj: [ring.obj, shifted.obj], fps: 1}'; do
        sed "s/scale: 1.1, \\(.*\\), motion: .*/\\1, $way}/" "$scratch/ring.yaml" > "$scratch/way.yaml"
        echo 'probes: [{name: p, vertices: [100, 465, 700], values: [position, velocity]}]' >> "$scratch/way.yaml"
        limited "$DUITE_CLOTH" "$scratch/way.yaml" --output "$scratch/way" --quiet --set solver.stop.relative=1e-12 || return 1
        tail -n 1 "$scratch/way/probes.csv" >> "$scratch/rows" || return 1
    done
    awk -F, 'NR == 1 { split($0, a) } NR == 2 { for (i = 10; i <= NF; i++) { d = $i - a[i]; if (d < 0) d = -d; if (d > most) most = d } }
        END { print "off by", most; exit !(NR == 2 && most < 1e-9) }' "$scratch/rows"
}
ok "frames that shift a body are a motion" frames_of_a_motion

# By the clip of a skinned FBX file: a column bends into a sheet that hangs in its way. A run that ends in the middle goes on, on other ranks, as if it had not.
cp "$srcdir/tests/cloth/mesh/column.fbx" "$scratch"
cat > "$scratch/bend.yaml" << 'END'
schema: 1
gravity: [0, 0, 0]
contact: {mode: certified, thickness: 0.004}
cloths: [{mesh: {grid: {width: 0.3, height: 0.3, nx: 10, ny: 10}}, transform: {rotate: [1, 0, 0, 1], translate: [-0.2, 0.7, 0]}, material: cloth}]
obstacles: [{body: {file: column.fbx, frames: {clip: bend, fps: 50}}}]
materials: {cloth: {density: 0.2, stretch: 500, shear: 100, damping: {mass: 1}}}
time: {h: 0.01, end: 0.5, fps: 20}
grain: 25
END
bends() { # FOLDER OPTION...
    folder=$1
    shift
    limited "$DUITE_CLOTH" "$scratch/bend.yaml" --quiet --check-intersections --report "$scratch/$folder.json" --output "$scratch/$folder" "$@"
}
pushed() {
    bends bent && value state_hash "$scratch/bent.json" &&
        "$DUITE_VIEW" "$scratch/bent" --export "$scratch/bent.obj" && awk '$1 == "v" { n++; far += $2 < -0.21 } END { print n, far; exit !(n == 100 && far > 90) }' "$scratch/bent.obj"
}
resumed() {
    bends half --end 0.25 --checkpoint 100 && mv "$scratch/half.json" "$scratch/first.json" || return 1
    ranks 2 "$DUITE_CLOTH" "$scratch/bend.yaml" --quiet --report "$scratch/half.json" --restart "$scratch/half" && cat "$scratch/half.json" &&
        test "$(value state_hash "$scratch/half.json")" = "$(value state_hash "$scratch/bent.json")" && test "$(value state_hash "$scratch/first.json")" != "$(value state_hash "$scratch/bent.json")" &&
        cmp "$scratch/half/cloth.pc2" "$scratch/bent/cloth.pc2" && cmp "$scratch/half/body-0.pc2" "$scratch/bent/body-0.pc2"
}
if grep -q 'define HAVE_ASSIMP 1' config.h; then
    ok "a clip of FBX pushes the cloth" pushed
    ok "a restart in the middle of the clip" resumed
    ok "one hash, by the clip" ranks 4 tests/whole/same_hash "$scratch/bend.yaml" few 0
fi

# Cloth flies to where a body was in its first frame: the folder has its place in each.
deform 0 5 1 > "$scratch/gone.obj"
cat > "$scratch/fled.yaml" << 'END'
schema: 1
gravity: [0, 0, 0]
contact: {mode: project}
cloths: [{mesh: {grid: {width: 1, height: 1, nx: 10, ny: 10}}, transform: {translate: [2, 0, 0]}, velocity: [-20, 0, 0], material: cloth}]
obstacles: [{body: {obj: ring.obj, frames: {obj: [ring.obj, gone.obj], fps: 100}}}]
materials: {cloth: {density: 0.2, stretch: 1000, shear: 100}}
time: {h: 0.005, end: 0.1, fps: 20}
END
pose_of() { # FOLDER FRAME: the height of the first vertex of its body
    od -An -tf4 -j$((32 + 12 * $(grep -c '^v ' "$1/body-0.obj") * $2 + 4)) -N4 "$1/body-0.pc2"
}
fled() {
    limited "$DUITE_CLOTH" "$scratch/fled.yaml" --check-intersections --output "$scratch/fled" --quiet 2> "$scratch/said" || return 1
    grep '"obj": "body-0.obj", "pc2": "body-0.pc2"' "$scratch/fled/scene.json" || return 1
    limited "$DUITE_VIEW" "$scratch/fled" --check-intersections > "$scratch/said" 2>&1 && grep '^no intersections in 3 frames' "$scratch/said" || return 1
    # It would have been in the way.
    dd if="$scratch/fled/body-0.pc2" bs=1 skip=32 count=$((12 * $(grep -c '^v ' "$scratch/fled/body-0.obj"))) of="$scratch/first" 2> "$scratch/said"
    { head -c 32 "$scratch/fled/body-0.pc2" && cat "$scratch/first" "$scratch/first" "$scratch/first"; } > "$scratch/stays" && cp "$scratch/stays" "$scratch/fled/body-0.pc2"
    limited "$DUITE_VIEW" "$scratch/fled" --check-intersections > "$scratch/said" 2>&1
    grep '^duite-view: .*inter' "$scratch/said"
}
# Three frames of the run at 0, 0.05, 0.1 s; those of the body are 1/100 s apart, and 5 m.
shapes() {
    limited "$DUITE_CLOTH" "$scratch/fled.yaml" --output "$scratch/shapes" --set time.fps=200 --quiet || return 1
    for k in 0 1 2 20; do pose_of "$scratch/shapes" $k; done | tr '\n' ' ' > "$scratch/heights"
    cat "$scratch/heights"
    awk '{ exit !(NF == 4 && ($2 - $1 - 2.5) ^ 2 < 1e-10 && ($3 - $1 - 5) ^ 2 < 1e-10 && $4 == $3) }' "$scratch/heights"
}
ok "a folder has the shapes of bodies in its frames" shapes
# In two phases a body is where it is in each: it begins again.
again() {
    limited "$DUITE_CLOTH" "$scratch/fled.yaml" --output "$scratch/shapes" --set time.fps=200 --set cloths[0].velocity='[0, 0, 0]' \
        --set 'phases=[{name: one, set: {time.end: 0.01}}, {name: two, set: {time.end: 0.01}}]' --quiet || return 1
    for k in 0 1 2 3; do pose_of "$scratch/shapes" $k; done | tr '\n' ' ' > "$scratch/heights"
    cat "$scratch/heights"
    awk '{ exit !(NF == 4 && ($2 - $1 - 2.5) ^ 2 < 1e-10 && ($3 - $1 - 5) ^ 2 < 1e-10 && ($4 - $1 - 2.5) ^ 2 < 1e-10) }' "$scratch/heights"
}
ok "in two phases too" again
shapes_gone() { # those of an earlier run go; a cache that is cut is seen
    limited "$DUITE_CLOTH" "$scratch/fled.yaml" --output "$scratch/shapes" --set 'obstacles=[{body: {obj: ring.obj}}]' --end 0.005 --quiet && test ! -e "$scratch/shapes/body-0.pc2" || return 1
    limited "$DUITE_CLOTH" "$scratch/fled.yaml" --output "$scratch/shapes" --quiet || return 1
    test ! -x "$DUITE_VIEW" && return
    head -c 1000 "$scratch/shapes/body-0.pc2" > "$scratch/cut" && cp "$scratch/cut" "$scratch/shapes/body-0.pc2"
    ! limited "$DUITE_VIEW" "$scratch/shapes" --check-intersections > "$scratch/said" 2>&1 && grep 'body-0.pc2 is cut off' "$scratch/said"
}
ok "shapes of an earlier run go" shapes_gone
if test -x "$DUITE_VIEW"; then
    ok "a folder's body with frames is where it was where intersections are looked for" fled
else
    skip "a folder's body with frames" "duite-view was not built"
fi

frames() {
    limited "$DUITE_CLOTH" "$scratch/ring.yaml" --output "$scratch/out" --quiet || return 1
    grep '{"body": {"obj": "body-1.obj"}}' "$scratch/out/scene.json" || return 1
    test "$(grep -c '^v ' "$scratch/out/body-0.obj")" = 288 && test "$(grep -c '^f ' "$scratch/out/body-1.obj")" = 576 || return 1
    # A body of the folder is the same body again, without the turn and scale.
    sed 's/obj: ring.obj, scale: 1.1, translate: .0, -0.115, 0.01./obj: out\/body-0.obj/; s/obj: ring.obj, scale: 0.5.*]}/obj: out\/body-1.obj}/' \
        "$scratch/ring.yaml" > "$scratch/again.yaml"
    limited "$DUITE_CLOTH" "$scratch/again.yaml" --report "$scratch/again.json" --quiet || return 1
    limited "$DUITE_CLOTH" "$scratch/ring.yaml" --report "$scratch/ring.json" --quiet || return 1
    grep state_hash "$scratch/ring.json" "$scratch/again.json"
    test "$(grep state_hash "$scratch/ring.json")" = "$(grep state_hash "$scratch/again.json")"
}
ok "frames have the meshes" frames
if test -x "$DUITE_VIEW" && "$DUITE_VIEW" "$scratch/out" --png "$scratch/picture.png" > /dev/null 2>&1; then
    mv "$scratch/out/body-1.obj" "$scratch/body-1.obj"
    exits 2 "a mesh of the folder is gone" "$DUITE_VIEW" "$scratch/out" --png "$scratch/picture.png"
else
    skip "a mesh of the folder is gone" "no pictures here"
fi

reads_itself() { # a mesh in the folder of frames would be replaced while the scene names it
    cp "$scratch/out/body-0.obj" "$scratch/before.obj"
    for key in 'obj: ring.obj, scale: 1.1' 'grid: {width: 1, height: 1, nx: 30, ny: 30}'; do
        case $key in obj*) file=body-0.obj with=obj ;; *) file=cloth.obj with=file ;; esac
        sed "s/$key/$with: out\\/$file/" "$scratch/ring.yaml" > "$scratch/itself.yaml"
        limited "$DUITE_CLOTH" "$scratch/itself.yaml" --end 0.01 --output "$scratch/out" > "$scratch/said" 2>&1
        test $? = 2 && grep -F "$scratch/out/$file would be replaced, but this run reads it, as $scratch/out/$file; " "$scratch/said" || return 1
        cmp "$scratch/out/body-0.obj" "$scratch/before.obj" || return 1
        limited "$DUITE_CLOTH" "$scratch/itself.yaml" --end 0.01 --report "$scratch/out/$file" > "$scratch/said" 2>&1
        test $? = 2 && grep -F -e "--report (or DUITE_REPORT) $scratch/out/$file: this is a file that the scene reads, which would be lost" "$scratch/said" || return 1
    done
}
ok "a scene that reads the frames' own mesh" reads_itself

refused() { # what is open is said, with its place, before there is a folder
    sed '$d' "$scratch/ring.obj" > "$scratch/open.obj"
    sed 's/ring.obj/open.obj/' "$scratch/ring.yaml" > "$scratch/open.yaml"
    limited "$DUITE_CLOTH" "$scratch/open.yaml" --output "$scratch/none" > "$scratch/said" 2>&1
    test $? = 2 && grep 'open.yaml:5:17: body: open.obj: the mesh is not closed' "$scratch/said" && ! test -e "$scratch/none"
}
ok "a body with a hole" refused
