#!/bin/sh
# The viewer's command line: what it makes, what it refuses and how it ends.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_VIEW"
plan_later

# A triangle in two frames, the second 1 m higher.
dir=$scratch/frames
mkdir "$dir"
printf 'o t\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' > "$dir/cloth.obj"
printf 'frame,time\n0,0\n1,0.04\n' > "$dir/frames.csv"
printf '{"fps": 25, "obstacles": [{"plane": {"point": [0, 0, 0], "normal": [0, 1, 0]}}]}\n' > "$dir/scene.json"
one='\0\0\200\77' nil='\0\0\0\0'
{
    printf 'POINTCACHE2\0\1\0\0\0\3\0\0\0\0\0\0\0\0\0\200\77\2\0\0\0'
    printf "$nil$nil$nil$one$nil$nil$nil$one$nil"
    printf "$nil$one$nil$one$one$nil$nil$one$one"
} > "$dir/cloth.pc2"

# says NAME TEXT: passes when the last command printed TEXT.
printed() { grep -q -- "$1" "$scratch/output"; }
says() {
    printed "$2"
    tap_result $? "$1"
}
view() { limited "$DUITE_VIEW" "$@"; }
picture() { view "$dir" --size 64x48 "$@"; }
is_png() { test "$(head -c 4 "$1" | tail -c 3)" = PNG; }

ok "help" view --help
says "help names the folder" 'DIR'
ok "version" view --version
says "version says the name" '^duite-view [0-9]'
exits 2 "nothing to show" view
exits 1 "neither a place for the picture nor a display" env DISPLAY= WAYLAND_DISPLAY= "$DUITE_VIEW" "$dir"
says "says the option" '--png'
: > "$scratch/file"
exits 2 "a file for a folder" view "$scratch/file" --png "$scratch/x.png"
exits 2 "no such folder" view "$scratch/none" --png "$scratch/x.png"
says "names the folder" "$scratch/none: No such file"
exits 2 "a frame that is not there" picture --png "$scratch/x.png" --frame 2
says "says how many there are" '2 frames, 0 to 1'
for bad in --frame=-1 --frame=1x --frame= --size=0x10 --size=10 --size=10x10x --camera=1 --camera=0,90 --camera=0,0,0 \
    --camera=0,0x --camera=nan,0 --colour=red --colour=contact,0 --colour=contact,1x --colour=contacts --colour=strain,0.2:0.1 \
    --colour=strain,1:1 --colour=rank,2 --png=; do
    exits 2 "refuses $bad" picture --png "$scratch/x.png" "$bad"
done
exits 2 "a colour that there is not" picture --colour green
says "says which there are" '--colour takes block, rank, strain, stress, contact or cloth, not .green'
exits 2 "a scale that goes down" picture --colour strain,0.2:0.1
says "says so" 'MAX is above its MIN'
exits 2 "strain of a folder that does not say it" picture --png "$scratch/x.png" --colour strain
says "says who writes it" 'colours.bin: No such file or directory; duite-cloth --output writes it'
exits 1 "without a driver" env __EGL_VENDOR_LIBRARY_FILENAMES=/dev/null "$DUITE_VIEW" "$dir" --png "$scratch/x.png"
says "says which packages are missing" 'libegl-mesa0'
# An empty file in front of a library hides it.
for hidden in libEGL.so.1 "libGL.so.1 libOpenGL.so.0"; do
    mkdir "$scratch/hide"
    (cd "$scratch/hide" && touch $hidden)
    exits 1 "without $hidden" env LD_LIBRARY_PATH="$scratch/hide" "$DUITE_VIEW" "$dir" --png "$scratch/x.png"
    says "says which packages to install" 'libgl1-mesa-dri'
    rm -r "$scratch/hide"
done
ok "nothing is written when it fails" test ! -e "$scratch/x.png"

tap_run picture --png "$scratch/0.png" --frame 0
if test $tap_got = 1 && printed 'libegl-mesa0'; then
    skip "pictures" "no EGL here"
    exit 0
fi
tap_result $tap_got "a picture"
ok "it is a PNG" is_png "$scratch/0.png"
ok "the last frame" picture --png "$scratch/last.png" --frame last
ok "a frame by its number" picture --png "$scratch/1.png" --frame 1
ok "the last frame is frame 1" cmp "$scratch/last.png" "$scratch/1.png"
not_ok_expected "frames differ" cmp "$scratch/0.png" "$scratch/1.png"
ok "another camera" picture --png "$scratch/c.png" --frame 1 --camera=-40,10,1.5
not_ok_expected "cameras differ" cmp "$scratch/c.png" "$scratch/1.png"
# Colours by the force of contact.
exits 2 "forces that were not written" picture --png "$scratch/hot.png" --frame 1 --colour contact
says "says how they are" 'contact.pc2: No such file or directory; .* contact: {force: on}'
{
    printf 'POINTCACHE2\0\1\0\0\0\3\0\0\0\0\0\0\0\0\0\200\77\1\0\0\0'
    printf "$nil$one$nil$nil$nil$nil$nil$nil$nil"
} > "$dir/contact.pc2"
ok "a frame whose forces are not there yet" picture --png "$scratch/hot.png" --frame 1 --colour contact
says "says that it has none" 'force of contact on a vertex, N, from 0 to 1; this frame has none$'
ok "forces" picture --png "$scratch/hot.png" --frame 0 --colour contact
says "says what the scale is and what the frame has" 'force of contact on a vertex, N, from 0 to 1; this frame has 0 to 1$'
not_ok_expected "they show" cmp "$scratch/hot.png" "$scratch/0.png"
ok "forces on another scale" picture --png "$scratch/warm.png" --frame 0 --colour contact,4
not_ok_expected "it shows" cmp "$scratch/hot.png" "$scratch/warm.png"
# The same triangle, and a vertex that nothing uses far away: neither camera nor light looks for it.
mkdir "$scratch/far"
cp "$dir/frames.csv" "$dir/scene.json" "$scratch/far"
sed '/^f/i v 1 1 1' "$dir/cloth.obj" > "$scratch/far/cloth.obj"
far='\0\0\240\101' # 20
{
    printf 'POINTCACHE2\0\1\0\0\0\4\0\0\0\0\0\0\0\0\0\200\77\2\0\0\0'
    printf "$nil$nil$nil$one$nil$nil$nil$one$nil$far$far$far"
    printf "$nil$one$nil$one$one$nil$nil$one$one$far$far$far"
} > "$scratch/far/cloth.pc2"
ok "a picture with an unused vertex" view "$scratch/far" --size 64x48 --frame 1 --png "$scratch/far.png"
ok "it is the same picture" cmp "$scratch/far.png" "$scratch/1.png"
rm "$scratch/far/scene.json" && mkdir "$scratch/far/scene.json"
exits 2 "a folder in the place of a file" view "$scratch/far" --size 64x48 --frame 1 --png "$scratch/far.png"
says "names it" "cannot read $scratch/far/scene.json: Is a directory"
exits 2 "a folder that is not there for the picture" picture --png "$scratch/none/x.png"
says "names it" "$scratch/none/x.png"

# A scene before it runs has a picture, and marks of its pins in it; nothing is left of it.
cat > "$scratch/scene.yaml" << 'END'
schema: 1
cloths:
  - {name: sheet, mesh: {grid: {width: 1, height: 1, nx: 4, ny: 4}}, material: denim, pins: [{vertices: [0, 3]}]}
  - {name: held, mesh: {grid: {width: 1, height: 1, nx: 2, ny: 2}}, material: denim, transform: {translate: [0, 1, 0]}, pins: [{vertices: [0, 1, 2, 3]}]}
time: {h: 0.01, end: 1}
END
start() { TMPDIR=$scratch/start view "$scratch/scene.yaml" --size 64x48 "$@"; }
mkdir "$scratch/start"
ok "a scene before it runs" start --png "$scratch/start.png"
sed '/sheet/s/pins:.*]}\]/pins: []/' "$scratch/scene.yaml" > "$scratch/free.yaml"
ok "one without pins" view "$scratch/free.yaml" --size 64x48 --png "$scratch/free.png"
not_ok_expected "pins are seen" cmp "$scratch/start.png" "$scratch/free.png"
exits 2 "a film of it" start --mp4 "$scratch/start.mp4"
says "says that it has not run" 'scene.yaml has not run: it has no film'
ok "nothing is left" sh -c 'test -z "$(ls "$1")"' sh "$scratch/start"
sed 's/denim/felt/' "$scratch/scene.yaml" > "$scratch/wrong.yaml"
exits 2 "a scene with a mistake" view "$scratch/wrong.yaml" --png "$scratch/start.png"
says "names it" 'wrong.yaml:3:.*felt'

# Films. A program in the place of ffmpeg keeps what it is sent, or fails.
mkdir "$scratch/bin"
PATH=$scratch/bin:$PATH
stand_in() { # LINE...
    printf '%s\n' '#!/bin/sh' "$@" > "$scratch/bin/ffmpeg"
    chmod +x "$scratch/bin/ffmpeg"
}
film() { picture --mp4 "$scratch/film.mp4" "$@"; }
size() { wc -c < "$scratch/film.mp4" | tr -d ' '; }
stand_in 'for last; do continue; done' 'echo "$*" > "'"$scratch"'/asked"' 'exec cat > "${last#file:}"'
ok "a film" film
ok "it is two pictures" test "$(size)" = $((2 * 64 * 48 * 3))
ok "at the rate of the frames" grep -q -e '-framerate 25 ' "$scratch/asked"
ok "one frame of it, at another rate" film --frames 1: --fps 12.5
ok "it is one picture" test "$(size)" = $((64 * 48 * 3))
ok "at that rate" grep -q -e '-framerate 12.5 ' "$scratch/asked"
ok "another frame" sh -c 'cp "$1" "$1.1" && shift && "$@"' sh "$scratch/film.mp4" "$DUITE_VIEW" "$dir" --size 64x48 \
    --mp4 "$scratch/film.mp4" --frames :0
not_ok_expected "is another picture" cmp "$scratch/film.mp4" "$scratch/film.mp4.1"
exits 2 "frames that are not there" film --frames 1:2
says "says how many there are" '2 frames, 0 to 1: no frame 2'
exits 2 "an odd width" view "$dir" --size 63x48 --mp4 "$scratch/odd.mp4"
says "says so" 'even width and height, not 63 x 48'
for bad in --frames=1:0 --frames=1 --frames=-1: --frames=a: --frames=0:1x --fps=0 --fps=x --fps=nan --mp4=; do
    exits 2 "refuses $bad" film "$bad"
done
rm "$scratch/film.mp4"
stand_in 'echo first >&2' 'echo no such encoder >&2' 'exit 1'
exits 1 "ffmpeg fails" film
says "says what it said last" "cannot write $scratch/film.mp4: ffmpeg failed: no such encoder"
ok "nothing is left" sh -c 'test ! -e "$1" && test ! -e "$1.part"' sh "$scratch/film.mp4"
stand_in 'exit 0'
exits 1 "ffmpeg ends before the pictures do" film --size 640x480
says "says so" 'ffmpeg ended early'
exits 1 "without ffmpeg" env PATH="$scratch/none" "$DUITE_VIEW" "$dir" --size 64x48 --mp4 "$scratch/film.mp4"
says "says what to install" 'install ffmpeg'
rm "$scratch/bin/ffmpeg"
if command -v ffmpeg > /dev/null && command -v ffprobe > /dev/null; then
    ok "a film by ffmpeg" film --fps 50
    ok "it has the frames, the size and the rate" sh -c 'test "$(ffprobe -v error -count_frames -show_entries \
        stream=codec_name,width,height,r_frame_rate,nb_read_frames -of csv=p=0 "$1")" = h264,64,48,50/1,2' sh "$scratch/film.mp4"
else
    skip "a film by ffmpeg" "there is none"
fi
