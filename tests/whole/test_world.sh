#!/bin/sh
# Textbook cases said by scenes and read from probes alone: what moves pins, what they carry, how chains hang.
. "${srcdir:-.}/tests/support/cloth.sh"

run() { limited "$DUITE_CLOTH" "$@" --quiet; }

# rows FILE PROGRAM: awk on the lines of a table below its head, where c(COLUMN) is a number of the line; columns have no unit. An END
# that is reached for want of a column must leave with `wrong`. row LINE FILE PROGRAM: on one line (2, ..., or $) alone.
rows() {
    awk -F, 'function c(name) { if (name in at) return $at[name]; print "there is no column " name; exit wrong = 2 }
        NR == 1 { for (i = 1; i <= NF; i++) { split($i, column, " "); at[column[1]] = i } next } '"$2" "$1"
}
row() {
    sed -n "1p;$1p" "$2" > row.csv && rows row.csv "$3"
}

# ---- A pendulum whose pin begins to move: x = u t - u / w sin w t, w^2 = g / L, L the length that the weight stretches it to.
cat > pendulum.yaml << 'END'
schema: 1
cloths:
  - mesh: {inline: {vertices: [[0, 0, 0], [0, -1, 0]], edges: [[0, 1]]}}
    material: wire
    mass_per_vertex: 0.1
    pins: [{vertices: [0], motion: {times: [0, 10], translate: [[0, 0, 0], [0.1, 0, 0]]}}]
materials: {wire: {density: 1, ea: 2000, damping: {stiffness: 0.002}}}
time: {h: 0.002, end: 4}
integrator: rk4
grain: 1
probes: [{vertices: [0, 1]}]
END
pendulum() { # ARGUMENT...: integrator and the error that is allowed, against the amplitude
    allowed=$1
    shift
    rm -rf swing
    run pendulum.yaml --output swing "$@" || return 1
    rows swing/probes.csv '{ t = c("time"); u = 0.01; w = sqrt(9.81 / (1 + 0.981 / 2000)); n++
            error = c("probe1.1.x") - (u * t - u / w * sin(w * t)); if (error < 0) error = -error; if (error > most) most = error
            pin = c("probe1.0.x") - u * t; if (pin < 0) pin = -pin; if (pin > off) off = pin }
        END { print n " rows, error " most / (u / w) " of the amplitude, pin off by " off
            exit wrong || !(n == 2001 && most < '"$allowed"' * u / w && off < 1e-15) }'
}
ok "a pendulum on a pin that begins to move, rk4" pendulum 0.001
for integrator in verlet symplectic_euler; do
    ok "with $integrator" pendulum 0.001 --set integrator=$integrator
done
ok "with implicit_euler" pendulum 0.001 --set integrator=implicit_euler --set time.h=0.0001 --set 'solver.stop={relative: 1e-10}' \
    --set time.end=0.2

# ---- Pins that turn: a quarter turn about the y axis through (1, 0, 0) by keys of an eighth, there and back.
turning() {
    run pendulum.yaml --output turn --set 'cloths[0].pins[0].motion={times: [0, 1, 2, 3], about: [1, 0, 0], rotate: [[1, 0, 0, 0],
        [0.9238795325112867, 0, 0.3826834323650898, 0], [-2, 0, -2, 0], [1, 0, 0, 0]]}' || return 1
    rows turn/probes.csv '{ t = c("time"); px = c("probe1.0.x"); py = c("probe1.0.y"); pz = c("probe1.0.z") }
        t == 1 || t == 2 || t == 4 { n++; r = sqrt(0.5)
            x = t == 1 ? 1 - r : t == 2 ? 1 : 0; z = t == 1 ? r : t == 2 ? 1 : 0; print t, px, py, pz
            if ((px - x) ^ 2 + py ^ 2 + (pz - z) ^ 2 > 1e-28) bad = 1 }
        ((px - 1) ^ 2 + pz ^ 2 - 1) ^ 2 > 1e-28 { bad = 1 }
        END { exit wrong || bad || n != 3 }'
}
ok "a pin that turns" turning

# Both vertices moved by t^2 / 2 from step to step: their pins push with m a, half of it in the first step, which begins at rest.
pushed() {
    run pendulum.yaml --output push --end 0.006 --set 'gravity=[0, 0, 0]' --set 'probes[0].values=[total]' --set \
        'cloths[0].pins[0]={vertices: [0, 1], motion: {times: [0, 0.002, 0.004, 0.006],
        translate: [[0, 0, 0], [2e-6, 0, 0], [8e-6, 0, 0], [18e-6, 0, 0]]}}' || return 1
    rows push/probes.csv '{ k = c("step"); rx = c("probe1.total.rx"); want = k == 0 ? 0 : k == 1 ? 0.1 : 0.2; print rx
            if ((rx - want) ^ 2 > 1e-20) bad = 1 }
        END { exit wrong || bad || NR != 5 }'
}
ok "pins that speed up push with m a" pushed

# ---- A chain between two pins at rest. With H and V the pulls at its left end and W the weight of a vertex, link i pulls by
# (H, V_i), V_i = V - i W, has the length l (1 + T_i / k), and all of them together lead to the right end.
awk 'BEGIN { printf "schema: 1\ncloths:\n  - mesh: {inline: {vertices: ["
    for (i = 0; i <= 16; i++) printf "%s[%g, 0, 0]", i ? ", " : "", i / 16
    printf "], edges: ["
    for (i = 0; i < 16; i++) printf "%s[%d, %d]", i ? ", " : "", i, i + 1
    print "]}}\n    material: rope\n    mass_per_vertex: 0.01\n    pins: [{vertices: [0]}, {vertices: [16], motion: {times: [0, 1],"
    print "      translate: [[0, 0, 0], [-0.4, 0.1, 0]]}}]\nmaterials: {rope: {density: 1, ea: 31.25, damping: {viscous: 0.02, stiffness: 0.01}}}"
    print "time: {h: 0.01, end: 60, fps: 10, rest: {speed: 1e-9, hold: 0.2}}\ngrain: 5\nsolver: {stop: {relative: 1e-10}}"
    print "probes: [{name: ends, vertices: [0, 16], values: [reaction, total]}, {name: all, box: [[-1, -1, -1], [1, 1, 1]], values: [position]}]" }' > chain.yaml
chain() {
    run chain.yaml --output chain --report chain.json && grep -q '"rest_seconds": [0-9]' chain.json || return 1
    row \$ chain/probes.csv '{ H = -c("ends.0.rx"); V = c("ends.0.ry"); W = 0.01 * 9.81; weight = 17 * W; x = y = 0
        total = c("ends.total.ry") - weight; along = c("ends.total.rx")
        print "reactions", -H, V, c("ends.16.rx"), c("ends.16.ry"), "total", total, "along", along
        bad = total ^ 2 > 1e-16 || along ^ 2 > 1e-16
        V -= W # the pin carries its own vertex, too
        for (i = 1; i <= 16; i++) {
            T = sqrt(H * H + V * V)
            l = 1 / 16 + T / 500
            x += l * H / T; y -= l * V / T; V -= W
            off = (c("all." i ".x") - x) ^ 2 + (c("all." i ".y") - y) ^ 2
            if (off > most) most = off
        }
        print "shape off by", sqrt(most), "end", x, y
        exit bad || sqrt(most) > 1e-8 || (x - 0.6) ^ 2 > 1e-14 || (y - 0.1) ^ 2 > 1e-14 }'
}
ok "a chain hangs as its reactions say, which carry its weight" chain

# ---- Loads along edges and on what a box holds: what all pins carry together is their sum, and the chain's weight.
loads() {
    run chain.yaml --output loads --set 'cloths[0].loads=[{edges: [[3, 4], [4, 5]], force: [1, -2, 4]}, {box: [[0.49, -1, -1], [0.51, 1, 1]],
        force: [0, 0, 0.25]}, {nearest: [0.9, 0, 0], force: [0.5, 0, 0]}]' || return 1
    row \$ loads/probes.csv '{ x = c("ends.total.rx"); y = c("ends.total.ry"); z = c("ends.total.rz"); print x, y, z
        exit (x + 0.125 + 0.5) ^ 2 > 1e-14 || (y - 0.25 - 17 * 0.01 * 9.81) ^ 2 > 1e-14 || (z + 0.5 + 0.25) ^ 2 > 1e-14 }'
}
ok "loads along edges, in boxes and at points" loads

# ---- Air: a level sheet sinks, in the end, with sqrt(2 density g / (rho normal)).
cat > sheet.yaml << 'END'
schema: 1
air: {density: 1.2, normal: 1.25, tangent: 0.5}
cloths:
  - mesh: {grid: {width: 1, height: 1, nx: 6, ny: 6}}
    material: silk
materials: {silk: {density: 0.06, stretch: 100, shear: 50, damping: {stiffness: 0.001}}}
time: {h: 0.002, end: 2}
grain: 9
solver: {stop: {relative: 1e-12}}
probes: [{name: all, box: [[-9, -9, -9], [9, 9, 9]], values: [velocity, total]}]
END
sinks() { # ARGUMENT...
    run sheet.yaml --output sink "$@" || return 1
    row \$ sink/probes.csv '{ want = -sqrt(2 * 0.06 * 9.81 / 1.2 / 1.25)
        for (i = 0; i < 36; i++) { d = c("all." i ".vy") - want; if (d < 0) d = -d; if (d > most) most = d }
        print "off by", most; exit !(most < 1e-6) }'
}
ok "a sheet sinks at its terminal velocity" sinks
ok "with rk4 and a wind along it" sinks --set integrator=rk4 --set air.tangent=0 --set 'air.wind=[3, 0, 1]'

# Held everywhere it carries the wind's pressure, and friction: at the start, when nothing has moved.
wind() {
    run sheet.yaml --output wind --end 0.002 --set 'cloths[0].pins=[{box: [[-9, -9, -9], [9, 9, 9]]}]' --set 'air.wind=[3, 2, -4]' || return 1
    row 2 wind/probes.csv '{ x = 0.6 * 0.5 * 5 * 3; y = 0.6 * 1.25 * 2 * 2 - 0.06 * 9.81; z = -0.6 * 0.5 * 5 * 4
        rx = c("all.total.rx"); ry = c("all.total.ry"); rz = c("all.total.rz"); print rx, ry, rz
        exit !((rx + x) ^ 2 + (ry + y) ^ 2 + (rz + z) ^ 2 < 1e-24) }'
}
ok "the wind's force on a sheet that is held" wind
# A load along an edge counts its length at rest, which uv may say.
edge_at_rest() {
    run sheet.yaml --output edge --end 0.002 --set 'cloths[0].pins=[{box: [[-9, -9, -9], [9, 9, 9]]}]' --set 'cloths[0].rest=uv' \
        --set 'cloths[0].transform={scale: 2}' --set 'cloths[0].loads=[{edges: [[0, 1]], force: [1, 0, 0]}]' || return 1
    row \$ edge/probes.csv '{ rx = c("all.total.rx"); print rx; exit !((rx + 0.2) ^ 2 < 1e-24) }'
}
ok "a load along an edge, by its length at rest" edge_at_rest
same() { # ARGUMENT...
    set -- "$@" --end 0.2
    run sheet.yaml --output a "$@" && ranks 3 "$DUITE_CLOTH" sheet.yaml --quiet --output b --threads 2 "$@" && cmp a/probes.csv b/probes.csv
}
ok "air is the same on 3 ranks" same
in_full "and where no spring joins all corners that share its force" same --set materials.silk.diagonals=one
ok "a sheet of triangles sinks likewise" sinks --set 'materials.silk={model: triangles, density: 0.06, stretch: 100, shear: 50, damping: {stiffness: 0.001}}'
stormy() { # WIND LIMIT H: warned of beyond 2 density / (1.2 * 1.25 |u|), and only there
    cat > storm.yaml << END
schema: 1
cloths: [{mesh: {grid: {width: 1, height: 1, nx: 3, ny: 3}}, material: it, velocity: [0, 0, -2]}]
materials: {it: {density: 0.03, stretch: 50}}
air: {density: 1.2, normal: 1.25, wind: [0, 0, $1]}
time: {h: $3, end: 0.01}
END
    run storm.yaml 2> said
    cat said
    grep -q "^duite-cloth: warning: storm.yaml:5:11: steps of $3 s are beyond the limit of the air, which is not in the matrix, $2 s: its push on cloth 'cloth1'" said
}
ok "a step that is too long for the wind is warned of" stormy 6 0.005 0.006
ok "one that is not is not" eval '! stormy 6 0.005 0.0049'
