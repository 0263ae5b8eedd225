#!/bin/sh
# A dress of 4,768 vertices in centimetres and lying anyhow: scaled by its scene, pinned at two vertices, it runs 0.1 s on two
# ranks of two threads.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
awk -v around=80 -v rows=60 -f "$srcdir/tests/support/dress.awk" > "$scratch/dress.obj" || exit 99

cat > "$scratch/dress.yaml" << EOF
schema: 1
cloths:
  - name: dress
    mesh: {file: dress.obj}
    transform: {scale: 0.01}
    material: cotton
    pins: [{vertices: [0, 2000]}]
materials:
  cotton: {density: 0.2, stretch: 2000, bend: 5, damping: {stiffness: 0.01}}
time: {h: 0.002, end: 0.1, fps: 25}
integrator: implicit_euler
solver: {stop: {relative: 0.001}}
EOF

moved_but_whole() { # stretched a little where it hangs, nowhere torn
    awk -F': ' '/"max_stretch"/ { s = $2 + 0 } /"steps"/ { n = $2 + 0 } /"simulated_seconds"/ { t = $2 + 0 }
                END { exit !(n == 50 && t > 0.0999 && t < 0.1001 && s > 1 && s < 1.5) }' "$scratch/report.json" ||
        { cat "$scratch/report.json"; return 1; }
}

plan_later
ok "the dress runs 0.1 s" ranks 2 "$DUITE_CLOTH" "$scratch/dress.yaml" --threads 2 --report "$scratch/report.json" \
    --output "$scratch/frames"
ok "it moved and is whole" moved_but_whole
