#!/bin/sh
# The force of contact as probes report it: with weights it is what changes the momentum of a cloth in each step; cloths press each other
# alike; what obstacles press is all that comes from outside.
. "${srcdir:-.}/tests/support/cloth.sh"
exec 3>&1

all='box: [[-9, -9, -9], [9, 9, 9]]'
sheet() { # NAME VERTICES PLACE MORE: 30 cm wide, 1 g a vertex
    printf '  - {name: %s, material: m, mass_per_vertex: 0.001, mesh: {grid: {width: 0.3, height: 0.3, nx: %s, ny: %s}}, transform: {%s}%s}\n' "$@" | sed 's/ny: \(transform\)/\1/'
}
scene() { # NAME CLOTHS OBSTACLES PROBES END
    cat > "$1.yaml" << END
schema: 1
cloths:
$2
materials: {m: {stretch: 200, shear: 60, bend: 1, damping: {stiffness: 0.004}}}
obstacles: [$3]
contact: {mode: certified, self: on, thickness: 0.002, friction: 0.4}
time: {h: 0.005, end: $5}
solver: {stop: {mass_norm: 1e-10}}
grain: 40
probes:
$4
END
}
probes() { # CLOTH...
    for cloth; do printf '  - {name: %s, cloth: %s, %s, values: [velocity, contact_total]}\n' "$cloth" "$cloth" "$all"; done
}
floor='{plane: {point: [0, 0, 0], normal: [0, 1, 0]}}'
run() { limited "$DUITE_CLOTH" "$@" --quiet; }

balanced() { awk -F, -v most=1e-6 -v cloths="$(shift && echo "$*")" -f "$srcdir/tests/whole/balance.awk" "$1/probes.csv" >&3; } # FOLDER CLOTH...

scene slide "$(sheet a 8 8 'translate: [0, 0.0021, 0], rotate: [0.96, 0, 0.28, 0]' ', velocity: [0.6, 0, 0.1]')" "$floor" "$(probes a)
  - {name: by0, obstacle: 0}" 0.2
slides() { run slide.yaml --output slide && balanced slide a; }
ok "a sheet that slides over a floor" slides
rests() { # on it, in the end
    awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i ~ /^a[.]total[.]cy/) at = i } { force = $at } END { print force; exit !(force - 0.62784 < 1e-4 && 0.62784 - force < 1e-4) }' slide/probes.csv
}
ok "the floor carries its weight" rests

scene lie "$(sheet a 8 8 'translate: [0.02, 0.105, 0.01]')" "{sphere: {centre: [0, 0, 0], radius: 0.1}}, $floor" "$(probes a)
  - {name: by0, obstacle: 0}
  - {name: by1, obstacle: 1}" 0.25
lies() { run lie.yaml --output lie && balanced lie a; }
ok "a sheet that falls over a ball onto the floor and itself" lies

printf 'v %s\n' '-0.1 0 -0.1' '-0.1 0 0.1' '0.1 0 0.1' '0.1 0 -0.1' '0 0.1 0' > body.obj
printf 'f %s\n' '4 3 2 1' '1 2 5' '2 3 5' '3 4 5' '4 1 5' >> body.obj
scene top "$(sheet a 8 8 'translate: [0.03, 0.105, 0.01]')" '{body: {obj: body.obj}}' "$(probes a)
  - {name: by0, obstacle: 0}" 0.15
tops() { run top.yaml --output top && balanced top a; }
ok "a sheet that falls onto the tip of a body" tops

named=$(echo "$floor" | sed 's/]}}$/], name: ground}}/')
scene two "$(sheet a 8 8 'translate: [0, 0.0021, 0]')
$(sheet b 7 7 'translate: [0.01, 0.008, 0.02], rotate: [0.924, 0, 0.383, 0]' ', velocity: [0.3, 0, 0]')" "$named" "$(probes a b)
  - {name: by0, obstacle: ground}" 0.1
press() { run two.yaml --output two && balanced two a b; }
ok "two sheets press each other alike" press
alike() { ranks 3 "$DUITE_CLOTH" two.yaml --quiet --output three --threads 2 --balance delegate && cmp two/probes.csv three/probes.csv; }
ok "the same bytes on ranks" alike

# Frames have the forces of their vertices: in each the sum over cloth a is what the probe says at that time.
same_in_frames() { # FPS FRAMES
    run two.yaml --output frames --set contact.force=on --set time.fps="$1" || return 1
    od -An -v -w1356 -t f4 -j 32 frames/contact.pc2 > forces # 113 vertices a line, of a the first 64
    awk -v frames="$2" 'function abs(x) { return x < 0 ? -x : x }
        FILENAME ~ /probes/ { split($0, f, ","); if (FNR == 1) for (i in f) if (f[i] ~ /^a[.]total[.]cy/) at = i; if (FNR > 1) want[f[2] + 0] = f[at]; next }
        FILENAME ~ /frames.csv/ { split($0, f, ","); if (FNR > 1) time[FNR - 1] = f[2] + 0; next }
        { n++; for (i = sum = 0; i < 64; i++) sum += $(3 * i + 2); if (abs(sum) > 0.1) heavy++
          if (!(time[n] in want) || abs(sum - want[time[n]]) > 1e-5) { print "# frame", n - 1, "at", time[n], sum, want[time[n]]; bad = 1 } }
        END { exit bad || n != frames || heavy < n / 2 }' frames/probes.csv frames/frames.csv forces
}
ok "frames have the forces" same_in_frames 200 21
ok "frames that show the end of the step before" same_in_frames 130 14
frames_alike() { ranks 2 "$DUITE_CLOTH" two.yaml --quiet --output frames2 --set contact.force=on --set time.fps=130 --threads 2 --mapping cyclic && cmp frames/contact.pc2 frames2/contact.pc2; }
ok "the same forces on ranks" frames_alike
gone() { run two.yaml --output frames --end 0.01 && test ! -e frames/contact.pc2; }
ok "a run without them removes those of one before" gone
mkdir mine && echo "my own" > mine/contact.pc2
refused() { run two.yaml --output mine --set contact.force=on 2> said || status=$?; cat said; test "$status" = 2 && grep -q 'mine/contact.pc2 is in the way, and is no point cache' said && grep -q "my own" mine/contact.pc2; }
ok "a file of the user's stays" refused

# The line of a terminal says how many contacts there are.
progress() { script -qec "$DUITE_CLOTH two.yaml --end 0.05" typed > /dev/null && tr '\r' '\n' < typed | grep 'step 10 of 10, 0 s left, [0-9]* iterations, [1-9][0-9]* contacts$'; }
if command -v script > /dev/null; then ok "progress tells of contacts" progress; else skip "progress tells of contacts" "no script(1)"; fi
