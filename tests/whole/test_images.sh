#!/bin/sh
# Bodies that are met by maps of their front and back: a sheet that falls onto one does what it does by the exact way, also where the
# body turns and where it changes its shape; one state_hash over ranks and threads.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
skip_unless tests/whole/same_hash
plan_later

# An egg, its long axis along x, in quads.
awk 'BEGIN { t = atan2(0, -1) / 12; print "v 0.4 0 0"
    for (i = 1; i < 12; i++) for (j = 0; j < 24; j++) printf "v %.9f %.9f %.9f\n", 0.4 * cos(t * i), 0.3 * sin(t * i) * sin(t * j), 0.3 * sin(t * i) * cos(t * j)
    print "v -0.4 0 0"
    for (j = 0; j < 24; j++) { k = (j + 1) % 24; print "f", 1, 2 + k, 2 + j; print "f", 266, 242 + j, 242 + k
        for (i = 0; i < 10; i++) print "f", 2 + 24 * i + j, 2 + 24 * i + k, 26 + 24 * i + k, 26 + 24 * i + j } }' > "$scratch/egg.obj"
awk '/^v/ { printf "v %.9f %.9f %.9f\n", $2 * 1.1, $3 + 0.02, $4 + 0.03; next } { print }' "$scratch/egg.obj" > "$scratch/later.obj"
cat > "$scratch/still.yaml" << 'END'
schema: 1
cloths: [{mesh: {grid: {width: 1, height: 1, nx: 24, ny: 24}}, transform: {translate: [0.02, 0.305, 0.01]}, material: cloth}]
obstacles:
  - body: {obj: egg.obj, meet: image, resolution: 300, view: y}
materials: {cloth: {density: 0.2, stretch: 1000, shear: 100, damping: {stiffness: 0.01}}}
contact: {mode: project}
probes: [{name: all, box: [[-1, -1, -1], [1, 1, 1]], values: [position]}]
time: {h: 0.005, end: 0.1, fps: 20}
grain: 100
END
sed 's/view: y/view: z, motion: {times: [0, 1], translate: [[0, 0, 0], [0.1, 0.4, 0]], rotate: [[1, 0, 0, 0], [1, 0.2, 0.1, 0]]}/' "$scratch/still.yaml" > "$scratch/moving.yaml"
sed 's/view: y/frames: {obj: [egg.obj, later.obj], fps: 10}/' "$scratch/still.yaml" > "$scratch/frames.yaml"

closely() { # name, most: how far a vertex is from where it is by the exact way, at the end, m
    sed 's/meet: image, resolution: 300/meet: bvh/; s/, view: .//' "$scratch/$1.yaml" > "$scratch/$1-bvh.yaml"
    for how in "$1" "$1-bvh"; do
        limited "$DUITE_CLOTH" "$scratch/$how.yaml" --output "$scratch/$how" --quiet || return 1
        tail -n 1 "$scratch/$how/probes.csv" >> "$scratch/$1.rows" || return 1
    done
    awk -F, -v most="$2" 'NR == 1 { split($0, a) } NR == 2 { for (i = 10; i <= NF; i++) { d = $i - a[i]; if (d < 0) d = -d; if (d > far) far = d } }
        END { print "off by", far, "of", NF, "columns"; exit !(NR == 2 && NF > 1700 && far < most && far > 0) }' "$scratch/$1.rows"
}
ok "a body that stands still" closely still 0.01
ok "a body that moves" closely moving 0.01
ok "a body by frames" closely frames 0.01

for kind in moving frames; do
    ok "one hash: $kind" ranks 4 tests/whole/same_hash "$scratch/$kind.yaml" few 0
done

pushes() { # without maps the sheet would fall by 4.9 cm
    limited "$DUITE_CLOTH" "$scratch/still.yaml" --output "$scratch/falls" --quiet --set obstacles=[] || return 1
    ! cmp -s "$scratch/falls/probes.csv" "$scratch/still/probes.csv"
}
ok "maps are met" pushes

refused() { # what is not certified is not let through, before there is a folder
    sed 's/mode: project/mode: certified/' "$scratch/still.yaml" > "$scratch/certified.yaml"
    limited "$DUITE_CLOTH" "$scratch/certified.yaml" --output "$scratch/none" > "$scratch/said" 2>&1
    test $? = 2 && grep 'certified.yaml:4:32: a body that is met by image, in contact.mode certified' "$scratch/said" && ! test -e "$scratch/none"
}
ok "by certified contact" refused
