#!/bin/sh
# The materials that every scene knows by name: what docs/fabrics.md says of them is what a strip weighs, and how far it hangs
# along the warp and along the weft; the scene that ships with them runs by long steps, too.
. "${srcdir:-.}/tests/support/probes.sh"

# A strip of 0.5 m x 0.05 m whose upper side may narrow; the rotation brings the warp, or the weft, down.
strip() { # FABRIC ROTATION WIDTH HEIGHT NX NY UPPER LOWER
    cat << END
schema: 1
cloths:
  - mesh: {grid: {width: $3, height: $4, nx: $5, ny: $6}}
    transform: {rotate: $2}
    material: it
    pins: [{vertices: $7, to: line, direction: [1, 0, 0]}]
materials: {it: {like: $1, damping: {mass: 20}}}
time: {h: 0.05, end: 20, fps: 0.1}
solver: {stop: {relative: 1.0e-10}}
probes: [{name: up, vertices: $7, values: [position, total]}, {name: low, vertices: $8, values: [position]}]
END
}
warp() { strip "$1" '[0.7071067811865476, 0, 0, 0.7071067811865476]' 0.5 0.05 11 3 '[10, 21, 32]' '[0, 11, 22]'; }
weft() { strip "$1" '[0.7071067811865476, 0.7071067811865476, 0, 0]' 0.05 0.5 3 11 '[0, 1, 2]' '[30, 31, 32]'; }

hangs() { # FABRIC WHERE DENSITY MODULUS UPPER LOWER MIDDLE LOWER: its weight is carried, and stretches it by q L^2 / 2 E
    run strip.yaml || return 1
    fabric=$1 where=$2
    shift
    # shellcheck disable=SC2046 # three numbers
    set -- "$fabric $where" "$2" "$3" $(last up.total.ry "up.$4.y" "low.$5.y" "low.$6.y" "low.$7.y")
    near "$1, weight" "$4" "$(awk -v q="$2" 'BEGIN { printf "%.12g", 9.81 * q * 0.025 }')" 1e-6 &&
        near "$1, stretch" "$(awk -v up="$5" -v a="$6" -v b="$7" -v c="$8" 'BEGIN { printf "%.12g", up - (a + 2 * b + c) / 4 - 0.5 }')" "$(awk -v q="$2" -v e="$3" 'BEGIN { printf "%.12g", 9.81 * q * 0.125 / e }')" 2e-3 && row "a strip of \`$fabric\` hangs $where: weight, stretch" "ρ g L² / 2 E"
}
while read -r fabric density warp weft; do
    warp "$fabric" > strip.yaml
    ok "$fabric along the warp" hangs "$fabric" "along the warp" "$density" "$warp" 10 0 11 22
    weft "$fabric" > strip.yaml
    ok "$fabric along the weft" hangs "$fabric" "along the weft" "$density" "$weft" 0 30 31 32
done << 'END'
rib_knit 0.276 130.3 85.7
silk 0.0347 2000 2000
denim 0.324 2026.8 410.5
polycotton 0.22 4069.9 4033.0
END

# Between jaws a fabric carries, at the strains that FAST printed, the loads of the instrument: 5, 20 and 100 gf/cm.
jaws() { # TRANSLATE FIXED MOVED: rows or columns of 3 x 3 vertices, 0.1 m
    cat << END
schema: 1
gravity: [0, 0, 0]
cloths:
  - mesh: {grid: {width: 0.1, height: 0.1, nx: 3, ny: 3}}
    material: wool_plain
    pins: [{vertices: $2}, {vertices: $3, motion: {times: [0, 1], translate: [[0, 0, 0], $1]}}]
time: {h: 0.1, end: 1.2}
newton: {steps: 20}
probes: [{name: jaw, vertices: $3, values: [total]}]
END
}
carries() { # COLUMN LOAD
    run strip.yaml && near "the jaw, N" "$(last "jaw.total.$1" | awk '{ printf "%.12g", $1 < 0 ? -$1 : $1 }')" "$(awk -v f="$2" 'BEGIN { printf "%.12g", f * 0.0980665 }')" 1e-6
}
while read -r load warp weft; do
    jaws "[$warp, 0, 0]" '[0, 3, 6]' '[2, 5, 8]' > strip.yaml
    ok "wool_plain along the warp at $load gf/cm" carries rx "$load"
    jaws "[0, 0, $weft]" '[0, 1, 2]' '[6, 7, 8]' > strip.yaml
    ok "wool_plain along the weft at $load gf/cm" carries rz "$load"
done << 'END'
5 0.00067 0.00040
20 0.00187 0.00187
100 0.00460 0.00587
END

scene=$srcdir/cloth/scenes/fabrics.yaml
ships() { # H END: no edge is twice as long, nothing was given up
    run "$scene" --report report.json --set time.h="$1" --end "$2" || return 1
    grep -E 'max_stretch|steps_halved' report.json
    awk -F'[:,]' '/"max_stretch"/ { s = $2 } END { exit !(s > 1 && s < 1.3) }' report.json
}
ok "the shipped scene by steps of 40 ms" ships 0.04 0.4
bare() { # no materials, no damping
    printf 'schema: 1\ncloths: [{mesh: {grid: {width: 1, height: 1, nx: 5, ny: 5}}, material: %s}]\ntime: {h: 0.01, end: 0.05}\n' "$1" > bare.yaml
    run bare.yaml
}
for fabric in rib_knit silk denim polycotton interlock jersey sweatshirt swimwear tablecloth poplin wool_suiting faille wool_plain cotton_denim; do
    ok "a scene that says $fabric and no more" bare $fabric
done
cotton() { # is what the scene makes it, and no knit in disguise
    ! bare cotton 2> said.err && cat said.err && grep -q "there is no material 'cotton'.*rib_knit, silk, denim, polycotton" said.err
}
ok "cotton is an error that lists the fabrics" cotton
ok "docs/accuracy.md has these rows" table
