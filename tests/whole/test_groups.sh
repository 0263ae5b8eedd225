#!/bin/sh
# Groups of OBJ files: where they are named, and the materials and directions of threads that they have, against closed forms. Errors are
# printed.
. "${srcdir:-.}/tests/support/probes.sh"

# A strip of 10 x 4 cells, 1 m by 0.4 m, with uv in metres: group left to x = 0.6, then right; all is in whole.
awk 'BEGIN { nx = 11; ny = 5
    for (j = 0; j < ny; j++) for (i = 0; i < nx; i++) printf "v %.15g 0 %.15g\nvt %.15g %.15g\n", i / 10, j / 10, i / 10, j / 10
    for (k = 0; k < 2; k++) { print k ? "g right whole" : "g left whole"
        for (j = 0; j < ny - 1; j++) for (i = k ? 6 : 0; i < (k ? 10 : 6); i++) { a = j * nx + i + 1
            if ((i + j) % 2) printf "f %d/%d %d/%d %d/%d\nf %d/%d %d/%d %d/%d\n", a, a, a + nx, a + nx, a + 1, a + 1, a + 1, a + 1, a + nx, a + nx, a + nx + 1, a + nx + 1
            else printf "f %d/%d %d/%d %d/%d\nf %d/%d %d/%d %d/%d\n", a, a, a + nx, a + nx, a + nx + 1, a + nx + 1, a, a, a + nx + 1, a + nx + 1, a + 1, a + 1 } } }' > strip.obj
cat > strip.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
cloths:
  - mesh: {file: strip.obj}
    material: soft
    panels: [{group: whole, grain: 0}]
    pins: [{vertices: [0]}, {vertices: [44], to: line, direction: [0, 0, 1]}]
    loads:
      - {edges: [[10, 21], [21, 32], [32, 43], [43, 54]], force: [2e-4, 0, 0]}
      - {edges: [[0, 11], [11, 22], [22, 33], [33, 44]], force: [-2e-4, 0, 0]}
materials:
  soft: {model: triangles, density: 0.1, stretch: [100, 400], shear: 60, poisson: 0.1}
  hard: {model: triangles, density: 0.3, stretch: [400, 100], shear: 60, poisson: 0.4}
time: {h: 100, end: 1000, fps: 1e-9}
newton: {steps: 20, tolerance: 1e-12}
solver: {stop: {relative: 1e-12}}
grain: 9
probes: [{name: p, vertices: [10, 44], values: [position]}]
END

# 1/E = c^4/E1 + s^4/E2 + (1/G - 2 nu/E1) s^2 c^2 of a pull at an angle from the warp; strains of 1e-6 are as good as none.
pulled() { # GRAIN
    run strip.yaml --set "cloths[0].panels[0].grain=$1" || return 1
    near "strip cut at $1 degrees" "$(less "$(last p.10.x)" 1)" "$(awk -v g="$1" 'BEGIN { a = g * atan2(0, -1) / 180; c = cos(a) ^ 2; s = sin(a) ^ 2
        print 2e-4 * (c * c / 100 + s * s / 400 + (1 / 60 - 0.2 / 100) * s * c) }')" 1e-5
}
for grain in 0 30 45 -45 90 120; do ok "a strip cut at $grain degrees" pulled $grain; done

# The strip is wider where the warp runs, at 30 degrees, towards +z, and no other way: shear = -2 s c (...) of the compliance.
sheared() { # GRAIN
    run strip.yaml --set "cloths[0].panels[0].grain=$1" --set 'probes=[{name: p, vertices: [0, 10], values: [position]}]' || return 1
    near "shear of a strip cut at $1 degrees" "$(last p.10.z)" "$(awk -v g="$1" 'BEGIN { a = g * atan2(0, -1) / 180; c = cos(a); s = sin(a)
        print 2e-4 * (2 * c ^ 3 * s / 100 - 2 * c * s ^ 3 / 400 - (1 / 60 - 0.2 / 100) * (c ^ 3 * s - c * s ^ 3)) }')" 1e-4
}
ok "its shear, from u towards v" sheared 30
ok "its shear, from v towards u" sheared -30

swapped() { # turned by 90 degrees it is the strip of swapped moduli
    run strip.yaml --set 'cloths[0].panels[0].grain=90' && turned=$(last p.10.x p.44.z) &&
        run strip.yaml --set 'materials.soft={model: triangles, density: 0.1, stretch: [400, 100], shear: 60, poisson: 0.4}' || return 1
    echo "$turned" "$(last p.10.x p.44.z)"
    test "$turned" = "$(last p.10.x p.44.z)"
}
ok "turned by 90 degrees: warp and weft change places" swapped
half() { # turned by 180 degrees it is itself, to the last bit
    run strip.yaml --set 'cloths[0].panels[0].grain=30' && cp out/probes.csv one.csv && run strip.yaml --set 'cloths[0].panels[0].grain=210' &&
        cmp out/probes.csv one.csv
}
ok "turned by 180 degrees: the same" half

# Two materials in series, by groups; a region has the last word.
series() { # SCENE...
    run strip.yaml --set 'cloths[0].panels=[{group: left, material: soft, grain: 90}, {group: right, material: hard}]' "$@" || return 1
    near "strip of two groups" "$(less "$(last p.10.x)" 1)" 2e-6 1e-5
}
ok "two groups of other materials" series --set 'materials.hard={model: triangles, density: 0.3, stretch: [160, 160], shear: 60}' \
    --set 'materials.soft={model: triangles, density: 0.3, stretch: [100, 240], shear: 60}' \
    --set 'cloths[0].loads=[{edges: [[10, 21], [21, 32], [32, 43], [43, 54]], force: [4e-4, 0, 0]}, {edges: [[0, 11], [11, 22], [22, 33], [33, 44]], force: [-4e-4, 0, 0]}]'

# Masses: 0.24 m^2 of one, 0.16 m^2 of the other; and 0.01 kg on each of the 25 vertices that the right group has.
weighed() { # PANELS KG
    run strip.yaml --set 'gravity=[0, -9.81, 0]' --set 'cloths[0].loads=[]' --set "cloths[0].panels=$1" --set 'cloths[0].masses=[{group: right, mass: 0.01}]' \
        --set 'cloths[0].pins=[{group: left}, {group: right}]' --set 'probes=[{name: p, group: whole, values: [total]}]' --end 100 || return 1
    near "weight of two groups" "$(last p.total.ry)" "$(awk -v m="$2" 'BEGIN { print 9.81 * (m + 0.25) }')" 1e-6
}
ok "two groups of two densities" weighed '[{group: right, material: hard}]' 0.072
ok "the last of two that share faces counts" weighed '[{group: right, material: hard}, {group: whole, material: soft}]' 0.04
ok "an own material under one that turns it" weighed '[{group: whole, material: hard}, {group: right, grain: 7}]' 0.12

# Pins, loads and starts by groups: what the pins of one hold is all that pulls at the other.
held() {
    run strip.yaml --set 'cloths[0].pins=[{group: left}]' --set 'cloths[0].loads=[{group: right, force: [1e-5, 0, 0]}]' --set 'cloths[0].panels=[]' \
        --set 'probes=[{name: p, group: left, values: [total]}, {name: s, vertices: [10], values: [position]}]' || return 1
    near "the force of a group's pins on 25 loads" "$(last p.total.rx)" -25e-5 1e-6 || return
    run strip.yaml --set 'cloths[0].start=[{group: right, translate: [0, 0.25, 0]}]' --set 'cloths[0].loads=[]' --set 'cloths[0].pins=[{group: whole}]' \
        --set 'probes=[{name: p, vertices: [5, 6, 10], values: [position]}]' --end 100 || return
    test "$(last p.5.y p.6.y p.10.y)" = "0 0.25 0.25 "
}
ok "pins, loads, probes and starts of groups" held

# A triangle with sides of 1 m along u and v, of springs, held where it is 1 % larger: each side pulls with E A / L^2 times 1 cm.
printf 'v 0 0 0\nv 1 0 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\ng all\nf 1/1 3/3 2/2\n' > corner.obj
cat > corner.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
cloths:
  - mesh: {file: corner.obj}
    material: threads
    panels: [{group: all, grain: 30}]
    pins: [{group: all}]
    start: [{group: all, scale: 1.01}]
materials: {threads: {density: 0.1, stretch: [100, 400]}}
time: {h: 0.01, end: 0.02}
integrator: verlet
probes: [{name: p, vertices: [0, 1], values: [reaction]}]
END
springs() {
    run corner.yaml || return 1
    near "a spring at 30 degrees to the warp" "$(last p.0.rx)" -0.875 1e-9 && near "at 60 degrees" "$(last p.0.rz)" -1.625 1e-9
}
ok "springs are turned, too" springs

# A flap on a hinge along v: threads along u cross it. In one cell of two triangles, whose diagonal is the hinge.
cat > flap.obj << 'END'
v 0 0 0
v 0 0 1
v -1 0 0.5
v 1 0 0.5
vt 0 0
vt 0 1
vt -1 0.5
vt 1 0.5
g flap
f 1/1 2/2 3/3
f 2/2 1/1 4/4
END
cat > flap.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
cloths:
  - mesh: {file: flap.obj}
    material: sheet
    panels: [{group: flap, grain: 0}]
    mass_per_vertex: 0.1
    pins: [{vertices: [0, 1, 2]}]
    start: [{vertices: [3], velocity: [0, 0.001, 0]}]
materials: {sheet: {stretch: 100, bending: {rigidity: [10, 40]}}}
time: {h: 2e-4, end: 1}
integrator: rk4
probes: [{name: p, vertices: [3], values: [velocity]}]
END
flap() { # GRAIN RIGIDITY: w^2 = 10 of a rigidity of 10 (test_closed_forms.sh)
    run flap.yaml --set "cloths[0].panels[0].grain=$1" || return 1
    below "flap whose threads cross its hinge at $1 degrees" "$(rows '{ d = c("p.3.vy") - 0.001 * cos(sqrt(k * 10) * c("time")); if (d < 0) d = -d; if (d > most) most = d }
        END { print most / 0.001 }' -v k="$2")" 1e-6
}
ok "the warp's rigidity across a hinge" flap 0 10
ok "the weft's" flap 90 40
ok "the mean at 45 degrees" flap 45 25

# Without directions a grain does nothing; triangles of others that lie on the border are said.
ok "a grain of springs" says "grain means nothing in cloth 'cloth1'" flap.yaml --set 'materials.sheet.bending.rigidity=10'
sed 's/^f 2.*/g tip\n&/' flap.obj > ear.obj
printf 'v 0 1 0.5\ng tip\nf 3 2 5\nf 1 3 5\n' >> ear.obj
ok "a triangle that counts to another group" says "have all corners in it, count as its own: 1" flap.yaml --set 'cloths[0].mesh={file: ear.obj}' \
    --set 'cloths[0].panels=[{group: tip, material: sheet}]'

same() {
    run strip.yaml --set 'cloths[0].panels=[{group: left, material: hard, grain: 20}, {group: right, grain: -70}]' --end 300 && cp out/probes.csv one.csv &&
        ranks 2 "$DUITE_CLOTH" strip.yaml --set 'cloths[0].panels=[{group: left, material: hard, grain: 20}, {group: right, grain: -70}]' --end 300 --quiet \
            --output out --threads 2 && cmp out/probes.csv one.csv
}
ok "groups on 2 ranks" same
