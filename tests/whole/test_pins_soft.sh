#!/bin/sh
# Soft pins against closed forms, from scenes and probes alone; their vertices by weights and by edges of panels; one that lets go; the same
# bits everywhere, with contact, and after a restart in the middle of a release.
here=$PWD
. "${srcdir:-.}/tests/support/probes.sh"
. "$srcdir/tests/support/bodies.sh"
same_hash=$here/tests/whole/same_hash
skip_unless "$same_hash"
hash() { "$@" --quiet --report report.json && value state_hash; }
largest() { # EXPRESSION: its largest size over the rows
    rows '{ d = '"$1"'; if (d < 0) d = -d; if (d > most) most = d } END { printf "%.3g\n", most }'
}

# Two beads of 0.1 kg that nothing else joins, pulled by 40 N/m and 0.1 kg/s to where they start.
cat > bead.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
cloths:
  - mesh: {inline: {vertices: [[0, 0, 0], [1, 0, 0]], edges: [[0, 1]]}}
    material: none
    mass_per_vertex: 0.1
    pins: [{vertices: [0, 1], stiffness: 40, damping: 0.1}]
materials: {none: {ea: 1.0e-30}}
time: {h: 0.001, end: 0.5, stretch_growth: 0}
solver: {stop: {relative: 1.0e-13}}
probes: [{name: p, vertices: [0]}]
END

# m x" + c x' + k x = 0 from x = 0 at 1 m/s, in any direction: exp(-r t) sin(w t) / w
swing='r = 0.1 / 0.2; w = sqrt(40 / 0.1 - r * r); t = c("time"); x = exp(-r * t) * sin(w * t) / w;'
swings() { # INTEGRATOR H MOST
    run bead.yaml --set integrator="$1" --set time.h="$2" --set 'cloths[0].velocity=[0.6, 0, -0.8]' &&
        below "period and decay of a soft pin by $1, m" "$(rows "{ $swing"' d = sqrt((0.6 * x - c("p.0.x")) ^ 2 + c("p.0.y") ^ 2 + (0.8 * x + c("p.0.z")) ^ 2); if (d > most) most = d }
            END { printf "%.3g\n", most }')" "$3"
}
ok "swings, rk4" swings rk4 1e-3 1e-8
ok "swings, verlet" swings verlet 1e-3 1e-5
ok "swings, symplectic_euler" swings symplectic_euler 1e-4 1e-4
ok "swings, explicit_euler" swings explicit_euler 1e-5 2e-4
ok "swings, bdf2" swings bdf2 1e-4 1e-4
ok "swings, implicit_euler" swings implicit_euler 1e-5 2e-4

steps() { # from rest: (m + h c + h^2 k) v = h m g, however long the step
    run bead.yaml --set time.h=0.1 --set time.end=0.1 --set 'gravity=[0, -10, 0]' &&
        near "speed after one implicit step" "$(last p.0.vy)" "$(awk 'BEGIN { printf "%.17g", -0.1 / (0.1 + 0.1 * 0.1 + 0.01 * 40) }')" 1e-12
}
ok "an implicit step has the whole of stiffness and damping" steps
hangs() { # INTEGRATOR: m g / k below, and the pin carries m g
    run bead.yaml --set integrator="$1" --set 'gravity=[0, -10, 0]' --set time.end=4 --set 'cloths[0].pins[0].damping=4' &&
        near "extension of a soft pin, $1" "$(last p.0.y)" -0.025 1e-9 && near "its pull" "$(last p.0.ry)" 1 1e-9
}
ok "hangs by m g / k, bdf2" hangs bdf2
ok "hangs by m g / k, rk4" hangs rk4
pulls() { # k x + c v of each row; energy is k x^2 / 2 of both beads
    run bead.yaml --set integrator=rk4 --set 'cloths[0].velocity=[0, 1, 0]' &&
        below "the reaction of a soft pin, N" "$(largest 'c("p.0.ry") + 40 * c("p.0.y") + 0.1 * c("p.0.vy")')" 1e-12 &&
        below "its energy, J" "$(largest 'c("elastic") - 40 * c("p.0.y") ^ 2')" 1e-12 &&
        run bead.yaml --set integrator=verlet --set 'cloths[0].velocity=[0, 1, 0]' --set 'cloths[0].pins[0].damping=0' &&
        below "energy of an undamped swing, J" "$(largest 'c("elastic") + c("kinetic") - 0.1')" 2e-5
}
ok "its pull and its energy" pulls

# ---- A pin that moves at 2 m/s takes its bead along: m d" + c d' + k d = 0 of the way behind, from d' = -2 m/s.
led() { # INTEGRATOR MOST
    run bead.yaml --set integrator="$1" --set 'cloths[0].pins[0].motion={times: [0, 1], translate: [[0, 0, 0], [0, 2, 0]]}' &&
        below "a soft pin that moves, $1, m" "$(rows "{ $swing"' d = 2 * t - 2 * x - c("p.0.y"); if (d < 0) d = -d; if (d > most) most = d } END { printf "%.3g\n", most }')" "$2"
}
ok "moves, rk4" led rk4 1e-7
ok "moves, verlet" led verlet 1e-4
ok "moves, bdf2" eval "led bdf2 5e-3"
follows() { # an obstacle and a motion alike
    sed -i 's/^time:/obstacles: [{sphere: {name: ball, centre: [0, 3, 0], radius: 0.1, motion: {about: [0, 3, 0], times: [0, 0.3], translate: [[0, 0, 0], [0.1, 0.2, 0]], rotate: [[1, 0, 0, 0], [1, 0, 0, 0.2]]}}}]\n&/' bead.yaml
    run bead.yaml --set 'cloths[0].pins[0].follow=ball' && one=$(last p.0.x p.0.y) &&
        run bead.yaml --set 'cloths[0].pins[0].motion={about: [0, 3, 0], times: [0, 0.3], translate: [[0, 0, 0], [0.1, 0.2, 0]], rotate: [[1, 0, 0, 0], [1, 0, 0, 0.2]]}' &&
        echo "$one $(last p.0.x p.0.y)" | awk '{ print; exit !(($1 - $3) ^ 2 + ($2 - $4) ^ 2 < 1e-24 && $2 > 0.1) }'
}
ok "follows an obstacle as one with its motion does" follows

# ---- A release: m x" = -s (k x + c x') - m g, s from 1 to 0 between 0.1 and 0.3 s; then it falls.
let_go='cloths[0].pins[0].curve={keys: [[0.1, 1], [0.3, 0]]}'
released() { # INTEGRATOR MOST: against Runge and Kutta with the tenth of a step
    run bead.yaml --set integrator="$1" --set 'gravity=[0, -10, 0]' --set "$let_go" || return 1
    below "a pin that lets go, $1, m" "$(rows 'function s(t) { return t < 0.1 ? 1 : t > 0.3 ? 0 : 1 - (t - 0.1) / 0.2 }
        function a(t, x, v) { return -s(t) * (400 * x + v) - 10 }
        { for (; k < 10 * (NR - 2); k++) { h = 1e-4; t = k * h; k1 = a(t, x, v); k2 = a(t + h / 2, x + h / 2 * v, v + h / 2 * k1)
            k3 = a(t + h / 2, x + h / 2 * v + h * h / 4 * k1, v + h / 2 * k2); k4 = a(t + h, x + h * v + h * h / 2 * k2, v + h * k3)
            x += h * v + h * h / 6 * (k1 + k2 + k3); v += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4) }
          d = x - c("p.0.y"); if (d < 0) d = -d; if (d > most) most = d; last = c("p.0.ry") } END { if (last != 0) most = "still held"; printf "%.3g\n", most }')" "$2"
}
ok "lets go, rk4" released rk4 1e-8
ok "lets go, verlet" released verlet 1e-5
ok "lets go, bdf2" released bdf2 1e-3
ok "lets go, implicit_euler" released implicit_euler 2e-2
apart() { # two pins of one vertex add up, of which one lets go
    run bead.yaml --set integrator=rk4 --set 'gravity=[0, -10, 0]' --set time.end=2 \
        --set 'cloths[0].pins=[{vertices: [0, 1], stiffness: 60, damping: 4, curve: {keys: [[0.5, 1], [0.6, 0]]}}, {vertices: [0], stiffness: 40, damping: 2}]' &&
        near "two pins until one lets go" "$(rows '{ if (c("time") < 0.5001) y = c("p.0.y") } END { printf "%.17g", y }')" -0.01 1e-6 && near "the other one" "$(last p.0.y)" -0.025 1e-6
}
ok "soft pins of a vertex add up" apart

# ---- Momentum: of a sheet in loose solves it changes by what soft pins and weight push, to the last digits.
cat > momentum.yaml << 'END'
schema: 1
cloths:
  - mesh: {grid: {width: 0.5, height: 0.5, nx: 12, ny: 12}}
    mass_per_vertex: 0.01
    material: cotton
    pins: [{box: [[-0.25, 0, -0.25], [0.25, 0, -0.2]], stiffness: 3, damping: 0.05, motion: {times: [0, 0.5], translate: [[0, 0, 0], [0.2, 0, 0.1]]}, curve: {keys: [[0.2, 1], [0.3, 0.2]]}}]
materials: {cotton: {density: 0.2, model: triangles, stretch: 500, shear: 100, bending: {rigidity: 1.0e-5}}}
time: {h: 0.01, end: 0.5}
solver: {stop: {relative: 0.01}}
grain: 40
probes: [{name: p, box: [[-1, -1, -1], [1, 1, 1]], values: [velocity, total]}]
END
pushed() {
    run momentum.yaml && below "momentum of a sheet on soft pins less what pushed it, kg m/s" "$(awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) for (k = 0; k < 3; k++) { axis = substr("xyz", k + 1, 1)
            if ($i ~ "^p[.][0-9]+[.]v" axis) of[i] = k; if ($i ~ "^p[.]total[.]r" axis) total[k] = i; if ($i ~ /^time/) time = i } next }
        { h = $time - t; t = $time; for (k = 0; k < 3; k++) p[k] = 0; for (i in of) p[of[i]] += 0.01 * $i
          for (k = 0; k < 3; k++) { sum[k] += h * ($total[k] - (k == 1) * 144 * 0.01 * 9.81); d = sum[k] - p[k]; d = d < 0 ? -d : d; if (d > most) most = d } }
        END { print most }' out/probes.csv)" 1e-12
}
ok "momentum changes by what soft pins push" pushed

# ---- Weights: of five beads in a row by a file, by a column of vt; those of 0 fall.
printf '# a line for each\n1\n0.5\n\n0.25\n0 # not at all\n1e-1\n' > weights.txt
awk 'BEGIN { split("1 0.5 0.25 0 0.1", w, " "); for (i = 1; i <= 5; i++) print "v", i, 0, 0; print "v 0 5 0\nv 0 6 0\nv 1 6 0"
    for (i = 1; i <= 5; i++) print "vt", 0, w[i]; print "vt 0 0"; print "l 1 2\nl 2 3\nl 3 4\nl 4 5\nf 6/6 7/6 8/6\nf 1/1 2/2 6/6\nf 3/3 4/4 7/6\nf 5/5 8/6 7/6" }' > row.obj
cat > row.yaml << 'END'
schema: 1
gravity: [0, -10, 0]
cloths:
  - mesh: {file: row.obj}
    material: none
    mass_per_vertex: 0.01
    pins: [{vertices: [5, 6, 7]}, {weights: {uv: v}, stiffness: 20, damping: 2}]
materials: {none: {density: 1, stretch: 0, shear: 0, ea: 0}}
time: {h: 0.002, end: 8, stretch_growth: 0, energy_growth: 0}
integrator: bdf2
solver: {stop: {relative: 1.0e-13}}
probes: [{name: p, vertices: [0, 1, 2, 3, 4], values: [position]}]
END
weighted() {
    run row.yaml "$@" || return 1
    for bead in '0 1' '1 0.5' '2 0.25' '4 0.1'; do
        near "bead of weight ${bead#* }" "$(last p."${bead% *}".y)" "$(awk -v w="${bead#* }" 'BEGIN { printf "%.17g", -0.1 / (20 * w) }')" 1e-6 || return 1
    done
    near "the one of weight 0" "$(last p.3.y)" -320 0.01
}
ok "weights by a column of vt" weighted
sed '/^vt/d; s|/[0-9]*||g' row.obj > plain.obj
printf '0\n0\n0\n' >> weights.txt
ok "weights by a file" weighted --set 'cloths[0].pins[1].weights={file: weights.txt}' --set 'cloths[0].mesh.file=plain.obj'

# ---- An edge of a panel, of a pattern and of its OBJ file with the file of seams: what the latter lists
garment=${DUITE_GARMENT:-$here/duite-garment}
cp "$srcdir/tests/cloth/garment/patterns/gather.json" .
"$garment" gather.json --edge 0.02 -o skirt.obj --quiet || exit 99
cat > skirt.yaml << 'END'
schema: 1
cloths:
  - mesh: {pattern: {file: gather.json, edge: 0.02}}
    material: cotton
    pins: [{edge: {panel: skirt, edge: 3}, stiffness: 50}]
materials: {cotton: {density: 0.2, stretch: 50, shear: 5}}
time: {h: 0.01, end: 0.01}
probes: [{name: p, edge: {panel: skirt, edge: 3}, values: [position]}]
END
along() {
    sed -n '/"name": "skirt"/,/\]\]/p' skirt.seams.json | grep '^ *\[*\[[0-9]' | sed -n '4s/[^0-9,]//gp' | tr -s ',' '\n' > wanted
    run skirt.yaml "$@" --report report.json && head -1 out/probes.csv | tr ',' '\n' | sed -n 's/^p\.\([0-9]*\)\.x .*/\1/p' > found && cat found && test "$(wc -l < found)" -gt 3 && diff wanted found
}
ok "an edge of a panel of a pattern" along
ok "of an OBJ file with its seams" along --set 'cloths[0].mesh={file: skirt.obj}' --set 'cloths[0].seams={file: skirt.seams.json, state: open}'
band() { # SETTING...: an elastic along the edge is the one along its vertices, and another one than none
    for how in "edge: {panel: skirt, edge: 3}" "vertices: [$(paste -sd, wanted)]"; do
        run skirt.yaml "$@" --set "cloths[0].bands=[{$how, length: 0.1, ea: 20}]" --report report.json && value state_hash >> hashes || return 1
    done
    run skirt.yaml "$@" --report report.json && value state_hash >> hashes && cat hashes && test "$(sed -n 1p hashes)" = "$(sed -n 2p hashes)" &&
        test "$(sort -u hashes | wc -l)" = 2 && rm hashes
}
ok "a band along it" band
ok "and along that of the OBJ file" band --set 'cloths[0].mesh={file: skirt.obj}' --set 'cloths[0].seams={file: skirt.seams.json, state: open}'

# ---- All of it at once: a sheet that falls on a moving ball by weights, is led, and let go; with contact, on ranks, after a restart.
awk 'BEGIN { for (v = 0; v < 400; v++) { w = 1 - int(v / 20) / 6; print (w > 0 ? w : 0) } }' > sheet.txt
cat > sheet.yaml << 'END'
schema: 1
cloths:
  - mesh: {grid: {width: 0.4, height: 0.4, nx: 20, ny: 20}}
    transform: {translate: [0, 0.11, 0]}
    material: cotton
    pins:
      - {weights: {file: sheet.txt}, stiffness: 4, damping: 0.02, motion: {times: [0, 0.3], translate: [[0, 0, 0], [0, 0.05, -0.1]]}, curve: {keys: [[0.2, 1], [0.4, 0]]}}
      - {vertices: [380, 399], stiffness: 2, follow: ball}
materials: {cotton: {density: 0.2, stretch: 300, shear: 100, bend: 0.1, damping: {stiffness: 0.004}}}
obstacles: [{sphere: {name: ball, centre: [0, 0, 0], radius: 0.1, motion: {times: [0, 0.5], translate: [[0, 0, 0], [0.05, 0, 0]]}}}]
contact: {mode: certified, self: on, thickness: 0.002}
time: {h: 0.01, end: 0.5, fps: 50}
probes: [{name: p, vertices: [0, 5, 399]}]
grain: 60
END
meets() {
    run sheet.yaml --check-intersections --report report.json --checkpoint 100 && cp -r out alone && test "$(value contacts)" -gt 0 && test "$(value intersections)" = 0 &&
        test "$(last p.0.ry)" = "0 " && below "the least pull of the corner that follows, N" "$(less 0.001 "$(last p.399.ry | tr -d -)")" 0
}
ok "a sheet on a ball by soft pins, nothing goes through" meets
again() { # in the middle of the release, on two ranks
    rm -rf out && run sheet.yaml --end 0.3 --checkpoint 100 && ranks 2 "$DUITE_CLOTH" sheet.yaml --quiet --restart out && cmp out/probes.csv alone/probes.csv && cmp out/cloth.pc2 alone/cloth.pc2
}
ok "the same after a restart in the middle of a release" again
ok "one hash" ranks 3 "$same_hash" sheet.yaml few 0
ok "one hash, by verlet without contact" ranks 3 "$same_hash" sheet.yaml few 0 integrator=verlet contact.mode=project time.h=0.001 time.end=0.1
box_obj -0.1 -0.1 -0.1 0.1 0 0.1 > box.obj
awk '/^v/ { c = cos(0.5); s = sin(0.5); printf "v %.17g %.17g %.17g\n", $2 + 0.03, c * $3 - s * $4, s * $3 + c * $4; next } { print }' box.obj > turned.obj
frames='obstacles=[{body: {name: ball, obj: box.obj, frames: {obj: [box.obj, turned.obj], fps: 2}}}]'
along_frames() { # without weight, at the end it is where the triangle has it, but for what damping leaves
    run sheet.yaml --set "$frames" --set 'gravity=[0, 0, 0]' --set contact.mode=project --set 'cloths[0].transform.translate=[0, 0.02, 0]' --set materials.cotton.stretch=0 \
        --set materials.cotton.shear=0 --set materials.cotton.bend=0 --set time.end=4 --set 'cloths[0].pins=[{nearest: [0, 0.02, 0], radius: 0.05, stiffness: 20, damping: 0.2, follow: ball}]' \
        --set 'probes=[{name: p, vertices: [190], values: [position]}]' || return 1
    last p.190.x p.190.y p.190.z | awk -v x="$(awk 'BEGIN { printf "%.17g", 0.4 * 10 / 19 - 0.2 }')" -v z="$(awk 'BEGIN { printf "%.17g", 0.4 * 9 / 19 - 0.2 }')" \
        'BEGIN { c = cos(0.5); s = sin(0.5) } { e = ($1 - x - 0.03) ^ 2 + ($2 - c * 0.02 + s * z) ^ 2 + ($3 - s * 0.02 - c * z) ^ 2; print $0, e; exit !(e < 1e-12) }'
}
ok "soft pins follow the triangles of a body with frames" along_frames
ok "one hash, by frames" ranks 3 "$same_hash" sheet.yaml few 0 "$frames" time.end=0.2
fast() { # 0.1 kg with 4e5 N/m: 2000 rad/s
    says "steps of 0.002 s are beyond the limit of verlet" bead.yaml --set integrator=verlet --set time.h=0.002 --set 'cloths[0].pins[0].stiffness=4e5' && grep 'up to 200[0-9.]* rad.s, at vertex 1' said
}
ok "explicit steps that are too long for a soft pin draw a warning" fast
