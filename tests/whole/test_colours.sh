#!/bin/sh
# Colours of pictures: a sheet of a known strain has the one colour of the scale, from any side and in any light; blocks and ranks are
# those of the run, also where blocks move and where a run goes on; what a folder does not say is refused.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
skip_unless "$DUITE_VIEW"
skip_unless tests/cloth/view/hues
plan_later

# A sheet that is 10 % longer along x than at rest, 6 % along z, and stays so: all of it is pinned.
cat > "$scratch/taut.yaml" << 'END'
schema: 1
gravity: [0, 0, 0]
cloths:
  - name: sheet
    mesh: {grid: {width: 1, height: 1, nx: 15, ny: 15}}
    material: cloth
    start: [{box: [[-9, -9, -9], [9, 9, 9]], scale: [1.1, 1, 1.06]}]
    pins: [{box: [[-9, -9, -9], [9, 9, 9]]}]
materials: {cloth: {density: 0.2, model: triangles, stretch: 1000, shear: 100, poisson: 0}}
obstacles: [{plane: {point: [0, -0.3, 0], normal: [0, 1, 0]}}]
time: {h: 0.01, end: 0.02, fps: 50}
END
says() {
    grep -q -- "$2" "$scratch/output"
    tap_result $? "$1"
}
cloth() { # FOLDER RANKS OPTION...
    to=$scratch/$1 n=$2
    shift 2
    ranks "$n" "$DUITE_CLOTH" --output "$to" --quiet --threads 1 "$@"
}
view() { limited "$DUITE_VIEW" "$@" --size 320x200 --camera=20,40; }
hues() { ./tests/cloth/view/hues "$@" | tee "$scratch/hues"; }
# on_scale PLACE [PICTURE X Y WIDTH HEIGHT]: all pixels there have the colour of that place on the scale.
on_scale() {
    place=$1
    shift
    hues "$@" | awk -v at="$place" '{ print; exit !($8 == 100 && $9 > at - 0.02 && $11 < at + 0.02) }'
}
# shows PART...: the sheet has the colours of these parts, and of no others.
shows() {
    hues "$scratch/picture.png" | awk -v parts=" $* " '{ print; for (p = 0; p < 7; p++) if (($(p + 1) > 1) != (index(parts, " " p " ") > 0)) exit 1 }'
}
middle="150 90 20 20"

ok "a taut sheet" cloth taut 1 "$scratch/taut.yaml"
tap_run view "$scratch/taut" --png "$scratch/plain.png"
if test $tap_got != 0; then
    tap_plan=no
    skip_all "no OpenGL 3.3 here"
fi
ok "strain" view "$scratch/taut" --colour strain,0.2 --png "$scratch/strain.png"
says "says what the scale is and what the frame has" 'colours: largest principal strain, m/m, from 0 to 0.2; this frame has 0.1 to 0.1$'
ok "10 % lie in the middle of 0 to 0.2" on_scale 0.5 "$scratch/strain.png" $middle
ok "strain on another scale" view "$scratch/taut" --colour strain,0.08:0.12 --frame 0 --png "$scratch/strain.png"
ok "10 % lie in the middle of 0.08 to 0.12" on_scale 0.5 "$scratch/strain.png" $middle
ok "strain without a scale" view "$scratch/taut" --colour strain --png "$scratch/strain.png"
ok "it goes up to 10 %" on_scale 1 "$scratch/strain.png" $middle
ok "stress, C times the strain: 100 N/m along the warp" view "$scratch/taut" --colour stress,400 --png "$scratch/stress.png"
ok "100 N/m are a quarter of 400" on_scale 0.25 "$scratch/stress.png" $middle
ok "without a display" env -u DISPLAY -u WAYLAND_DISPLAY "$DUITE_VIEW" "$scratch/taut" --size 320x200 --camera=20,40 --colour stress,400 --png "$scratch/again.png"
ok "is the same picture" cmp "$scratch/stress.png" "$scratch/again.png"
not_ok_expected "a scale is drawn: the corner is not as without" cmp "$scratch/plain.png" "$scratch/strain.png"
ok "it has all of its colours" sh -c './tests/cloth/view/hues "$1" 270 0 50 200 | awk "{ print; exit !(\$9 < 0.03 && \$11 > 0.97) }"' sh "$scratch/stress.png"

# Blocks and ranks.
sed 's/pins:.*/pins: [{nearest: [-0.5, 0, -0.5]}]/; s/model: triangles.*/stretch: 500, shear: 100}}/; s/end: 0.02/end: 0.1/' "$scratch/taut.yaml" > "$scratch/free.yaml"
free() { cloth "$@" "$scratch/free.yaml" --set grain=40; }
ok "a sheet on one rank" free one 1
ok "its rank" view "$scratch/one" --colour rank --png "$scratch/picture.png"
says "says which there are" 'colours: rank, 0 to 0$'
ok "has one colour" shows 0
ok "its blocks" view "$scratch/one" --colour block --png "$scratch/blocks.png"
says "says which there are" 'colours: block, 0 to 5$'
cp "$scratch/blocks.png" "$scratch/picture.png"
ok "six of 40 vertices have six colours" shows 0 1 2 3 4 5
ok "a sheet on two ranks" free two 2
ok "its ranks" view "$scratch/two" --colour rank --png "$scratch/picture.png"
says "says which there are" 'colours: rank, 0 to 1$'
ok "have two colours" shows 0 1
ok "its blocks" view "$scratch/two" --colour block --png "$scratch/again.png"
ok "are those of one rank" cmp "$scratch/blocks.png" "$scratch/again.png"
ok "as cloth" view "$scratch/two" --colour cloth --png "$scratch/picture.png"
not_ok_expected "it has none of these" shows 0 1
exits 2 "springs have no stress" view "$scratch/two" --colour stress --png "$scratch/none.png"
says "says what has" 'all cloths are of springs; a material with model: triangles has one'
exits 2 "no forces of contact were written" view "$scratch/two" --colour contact --png "$scratch/none.png"

# Forces come after their frames: a run that was killed, or goes on, has those of the last frames not yet.
sed 's/obstacles:.*/obstacles: [{plane: {point: [0, 0, 0], normal: [0, 1, 0]}}]/; s/^gravity:.*/contact: {mode: certified, thickness: 0.002, force: on}/; s/start:.*/transform: {translate: [0, 0.0021, 0]}/; /pins:/d' "$scratch/taut.yaml" > "$scratch/lies.yaml"
ok "a sheet that lies on a plane" cloth lies 1 "$scratch/lies.yaml"
ok "its force of contact" view "$scratch/lies" --colour contact --png "$scratch/forces.png"
says "has a range" 'colours: force of contact on a vertex, N, from 0 to [0-9.]*; this frame has 0*[0-9.e-]* to [0-9.e-]*$'
printf '\001' | dd of="$scratch/lies/contact.pc2" bs=1 seek=28 conv=notrunc 2> "$scratch/output"
ok "a frame whose forces are not there yet" view "$scratch/lies" --colour contact --png "$scratch/forces.png"
says "has none" 'colours: force of contact on a vertex, N, from 0 to [0-9.]*; this frame has none$'
ok "one whose forces are" view "$scratch/lies" --colour contact --frame 0 --png "$scratch/forces.png"

# A run of one rank goes on with two: frames have the ranks that there were.
ok "a run to be gone on with" free goes 1 --checkpoint 100 --end 0.05
ok "goes on with two ranks" free goes 2 --restart "$scratch/goes" --end 0.1
ok "an early frame" view "$scratch/goes" --colour rank --frame 1 --png "$scratch/picture.png"
ok "has one rank" shows 0
ok "the last frame" view "$scratch/goes" --colour rank --png "$scratch/picture.png"
ok "has two" shows 0 1

head -c 100 "$scratch/two/colours.bin" > "$scratch/cut" && mv "$scratch/cut" "$scratch/two/colours.bin"
exits 2 "a file that is cut off" view "$scratch/two" --colour rank --png "$scratch/none.png"
says "names it" "two/colours.bin does not say"
rm "$scratch/two/colours.bin"
exits 2 "no file" view "$scratch/two" --colour block --png "$scratch/none.png"
says "names it" "two/colours.bin: No such file"
ok "nothing is written when it fails" test ! -e "$scratch/none.png"
