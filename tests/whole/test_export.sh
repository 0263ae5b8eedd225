#!/bin/sh
# duite-view --export: frames of two cloths and a moving ball as USD, Alembic, glTF and OBJ have the state's positions as float32, and the mesh.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
skip_unless "$DUITE_VIEW"
command -v python3 > /dev/null || skip_all "no python3"
plan_later

cat > "$scratch/two.yaml" << 'EOF'
schema: 1
name: two
cloths:
  - {mesh: {grid: {width: 0.2, height: 0.2, nx: 5, ny: 4}}, material: cloth}
  - {mesh: {grid: {width: 0.2, height: 0.1, nx: 4, ny: 3}}, material: cloth, transform: {translate: [0, 0.1, 0]}}
materials: {cloth: {density: 0.2, stretch: 100, shear: 30, bend: 1}}
obstacles:
  - sphere: {centre: [0, -1, 0], radius: 0.1, motion: {times: [0, 1], translate: [[0, 0, 0], [1, 0, 0]]}}
  - plane: {point: [0, -2, 0], normal: [0, 1, 0]}
time: {h: 0.01, end: 0.12, fps: 25}
EOF
export_to() { "$DUITE_VIEW" "$scratch/frames" --export "$scratch/$@"; }
reads() { PYTHONDONTWRITEBYTECODE=1 python3 "$srcdir/tests/whole/read_export.py" "$scratch/frames" "$scratch/$1" "$2"; }
sees() { # a coordinate that differs by its last bit
    sed 's/-0\.100000001,/-0.100000009,/' "$scratch/a.usda" > "$scratch/b.usda" && ! cmp -s "$scratch/a.usda" "$scratch/b.usda" && ! reads b.usda 0:3
}
ok "a run of two cloths" "$DUITE_CLOTH" "$scratch/two.yaml" --quiet --output "$scratch/frames"
for frames in a.usda-:-0:3 some.usd-1:2-1:2 a.abc-:-0:3 some.abc-1:2-1:2 one.abc-3:3-3:3; do
    file=${frames%%-*} rest=${frames#*-}
    ok "writes $file, frames ${rest%-*}" export_to "$file" --frames "${rest%-*}"
    ok "$file has the cloths and the ball of each frame" reads "$file" "${rest#*-}"
done
ok "the comparison sees the last bit of a float" sees
for file in a.glb a.obj; do
    ok "writes $file" export_to "$file" --frame 2
    ok "$file has the frame" reads "$file" 2:2
done
cat > "$scratch/again.yaml" << 'EOF'
schema: 1
cloths:
  - {mesh: {file: 'a.glb#cloth'}, material: cloth}
materials: {cloth: {density: 0.2, stretch: 100}}
time: {h: 0.01, end: 0.01}
EOF
again() { # the same vertices, in the same order
    "$DUITE_CLOTH" "$scratch/again.yaml" --quiet --output "$scratch/again" && "$DUITE_VIEW" "$scratch/again" --export "$scratch/again.obj" --frame 0 &&
        grep '^v ' "$scratch/again.obj" > "$scratch/vertices" && grep '^v ' "$scratch/a.obj" | head -n "$(wc -l < "$scratch/vertices")" | cmp - "$scratch/vertices"
}
if grep -q 'define HAVE_ASSIMP 1' config.h; then ok "a cloth of glTF is read back" again; fi
ok "another ending is refused" refuses "ends in .usda, .usd, .abc, .glb or .obj, not" export_to a.fbx
ok "a frame that is not there is refused" refuses "4 frames, 0 to 3: no frame 9" export_to c.glb --frame 9
ok "frames that are not there are refused" refuses "4 frames, 0 to 3: no frame 9" export_to c.usda --frames 2:9
ok "several frames in one of glTF are refused" refuses "--frames is of films, of USD, of Alembic and of the check" export_to c.glb --frames 1:2
exits 2 "a file that cannot be written" "$DUITE_VIEW" "$scratch/frames" --export "$scratch/nowhere/c.glb"
full() { ln -s /dev/full "$scratch/full.abc" && ! export_to full.abc 2> "$scratch/said" && cat "$scratch/said" && grep -q "cannot write .*full.abc: No space left" "$scratch/said"; }
if test -w /dev/full; then ok "a full disk is said" full; fi
pipe() { mkfifo "$scratch/p.abc" && { cat "$scratch/p.abc" > /dev/null & } && export_to p.abc; }
ok "a pipe is refused" refuses "p.abc: Alembic goes to a file, not to a pipe" pipe
ok "what was refused left no file" test ! -e "$scratch/c.glb" -a ! -e "$scratch/c.usda"
