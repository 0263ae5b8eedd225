#!/bin/sh
# velocity_correction: every edge ends each step within its limit and the tolerance, by every integrator, on sheets of springs and of
# triangles and across welds; two masses by the closed form; one state_hash everywhere; with certified contact nothing goes through
# anything; what the report says of it.
. "${srcdir:-.}/tests/support/probes.sh"

sheet() { # NAME MATERIAL MORE: a sheet that hangs from its upper edge and sways, in 9 blocks, with a slider
    cat > "$1.yaml" << END
schema: 1
name: $1
cloths:
  - name: sheet
    mesh: {grid: {width: 1, height: 1, nx: 15, ny: 15}}
    material: m
    transform: {rotate: [0.7071067811865476, 0.7071067811865476, 0, 0]}
    velocity: [0.4, 0, 0.7]
    pins: [{box: [[-1, 0.499, -1], [0.4, 1, 1]]}, {nearest: [0.5, 0.5, 0], to: line, direction: [1, 0, 0]}]
materials: {m: {$2}}
gravity: [0, -9.81, 0]
grain: 25
$3
END
}
soft='density: 0.2, stretch: 8, shear: 3, damping: {stiffness: 0.01}'
within='velocity_correction: {at: 0.05, tolerance: 0.01, rounds: 3000}'
sheet springs "$soft, $within" 'time: {h: 0.002, end: 0.3, stretch_growth: 0, stretch_limit: 100}'
sheet triangles "model: triangles, $soft, $within" 'time: {h: 0.002, end: 0.3, stretch_growth: 0, stretch_limit: 100}'

# limit SCENE --set ...: it would be stretched by 10 % at least, and is by 6 % at most after any step.
go() { limited "$DUITE_CLOTH" "$@" --quiet --report report.json; }
limit() {
    scene=$1
    shift
    go "$scene" "$@" || return 1
    highest=$(value stretch_highest)
    echo "# largest stretch $highest after any step, $(value velocity_correction_rounds) rounds in $(value steps) steps"
    test "$(value velocity_correction_unmet)" = 0 && test "$(value velocity_correction_rounds)" -gt 20 &&
        below "largest stretch, less 1" "$(less "$highest" 1)" 0.060000001 && below "largest excess" "$(value velocity_correction_excess)" 0.01000001 &&
        awk -v s="$highest" 'BEGIN { exit !(s > 1.04) }'
}
free() { # without it
    go "$@" && awk -v s="$(value stretch_highest)" 'BEGIN { print "#", s, "without"; exit !(s > 1.1) }'
}
ok "without it springs are stretched further" free springs.yaml --set 'materials.m.velocity_correction={at: 9}'
if quick; then integrators="implicit_euler verlet"; else integrators="implicit_euler bdf2 explicit_euler symplectic_euler verlet rk4"; fi
for is in $integrators; do
    ok "springs by $is" limit springs.yaml --set integrator=$is
done
ok "by Newton steps" limit springs.yaml --set newton.steps=4
ok "triangles" limit triangles.yaml
ok "triangles by bdf2" limit triangles.yaml --set integrator=bdf2
# Blocks of a few vertices: most edges are between blocks.
ok "in blocks of 4" limit triangles.yaml --grain 4
ok "shorter steps in between" limit triangles.yaml --set time.stretch_growth=0.02

# ---- Two halves, welded, with limits of their own ----
half() { # NAME AT OFFSET
    printf '  - {name: %s, mesh: {grid: {width: 1, height: 0.5, nx: 15, ny: 8}}, material: %s, velocity: [0.3, 0, 0.5], transform: {translate: [0, %s, 0], rotate: [0.7071067811865476, 0.7071067811865476, 0, 0]}' "$@"
}
seam=$(awk 'BEGIN { for (i = 0; i < 15; i++) printf "%s%d", i ? ", " : "", i }')
far=$(awk 'BEGIN { for (i = 0; i < 15; i++) printf "%s%d", i ? ", " : "", 105 + i }')
cat > halves.yaml << END
schema: 1
name: halves
cloths:
$(half a soft 0.25), pins: [{vertices: [$seam]}]}
$(half b stiff -0.25)}
welds: [{from: {cloth: a, vertices: [$far]}, to: {cloth: b, vertices: [$seam]}}]
materials: {soft: {$soft, $within}, stiff: {$soft, $within}}
gravity: [0, -9.81, 0]
grain: 25
time: {h: 0.002, end: 0.3, stretch_growth: 0, stretch_limit: 100}
END
ok "welded halves" limit halves.yaml

# ---- Two masses of 0.1 and 0.3 kg, 1 m apart, at 30 m/s from each other: an edge that no spring holds. In one step of 10 ms it would be
# ---- 1.3 m long. Its ends are 1.05 m apart, their centre is where it was, and the speed between them is 5 m/s. ----
cat > two.yaml << END
schema: 1
name: two
cloths:
  - name: two
    mesh: {inline: {vertices: [[0, 0, 0], [1, 0, 0]], edges: [[0, 1]]}}
    material: m
    mass_per_vertex: 0.1
    masses: [{vertices: [1], mass: 0.2}]
    start: [{vertices: [1], velocity: [30, 0, 0]}]
materials: {m: {ea: 1e-9, velocity_correction: {at: 0.05}}}
probes: [{name: p, vertices: [0, 1], values: [position, velocity]}]
gravity: [0, 0, 0]
energies: steps
time: {h: 0.01, end: 0.01, stretch_growth: 0}
END
two() {
    run two.yaml --report report.json "$@" || return 1
    # shellcheck disable=SC2046 # four numbers
    set -- $(last p.0.x p.1.x p.0.vx p.1.vx)
    near "length" "$(less "$2" "$1")" 1.05 1e-11 && near "speed between the ends" "$(less "$4" "$3")" 5 1e-9 &&
        near "centre, of 4" "$(awk -v a="$1" -v b="$2" 'BEGIN { printf "%.15g", a + 3 * b }')" 3.9 1e-12 &&
        near "energy taken" "$(value energy_corrected)" "$(awk 'BEGIN { print 0.5 * 0.075 * (30 * 30 - 25) }')" 1e-9
}
ok "two masses" two
for is in bdf2 symplectic_euler verlet rk4; do
    ok "two masses by $is" two --set integrator=$is
done
ok "two masses in two blocks" two --grain 1

# ---- A free sheet of 36 masses that no force holds flies apart and turns. Only corrections act, so that momentum and angular
# ---- momentum are those of the start, to rounding, also where edges are between blocks. ----
{
    cat << END
schema: 1
name: free
cloths:
  - name: free
    mesh: {grid: {width: 1, height: 1, nx: 6, ny: 6}}
    material: m
    mass_per_vertex: 0.01
    start:
END
    awk 'BEGIN { for (i = 0; i < 36; i++) { x = i % 6 - 2.5; z = int(i / 6) - 2.5
        printf "      - {vertices: [%d], velocity: [%g, %g, %g]}\n", i, 2 + x * 2 + 0.7 * z, (i * 7 % 11 - 5) * 0.3, z * 1.5 - 0.9 * x } }'
    cat << END
materials: {m: {stretch: 1e-9, velocity_correction: {at: 0.02, rounds: 2000}}}
probes: [{name: p, box: [[-9, -9, -9], [9, 9, 9]], values: [position, velocity]}]
gravity: [0, 0, 0]
energies: steps
grain: 6
time: {h: 0.01, end: 0.1, stretch_growth: 0, stretch_limit: 100}
END
} > free.yaml
momenta() { # those of the first and the last row, of a mass of 1: nothing is further apart than MOST of the largest number in the sums
    run free.yaml --report report.json "$@" || return 1
    echo "# $(value velocity_correction_rounds) rounds, energy taken $(value energy_corrected) J, stretch $(value stretch_highest)"
    test "$(value velocity_correction_rounds)" -gt 20 && test "$(value velocity_correction_unmet)" = 0 &&
        below "energy taken, less 0, and negative" "-$(value energy_corrected)" 0 &&
        rows 'function sum(k, value) { if (NR == 2) first[k] = value; last[k] = value }
            { for (k = 1; k <= 6; k++) s[k] = 0; scale = 0
            for (i = 0; i < 36; i++) { x = c("p." i ".x"); y = c("p." i ".y"); z = c("p." i ".z"); u = c("p." i ".vx"); v = c("p." i ".vy"); w = c("p." i ".vz")
                s[1] += u; s[2] += v; s[3] += w; s[4] += y * w - z * v; s[5] += z * u - x * w; s[6] += x * v - y * u; scale += u * u + v * v + w * w }
            for (k = 1; k <= 6; k++) sum(k, s[k]) }
            END { for (k = 1; k <= 6; k++) { e = last[k] - first[k]; if (e < 0) e = -e; if (e > most) most = e }
                printf "# momenta off by %.2g\n", most; exit !(NR > 5 && most < 1e-10) }'
}
ok "a free sheet keeps momentum and angular momentum" momenta
ok "in blocks of 2" momenta --grain 2
ok "by symplectic Euler" momenta --set integrator=symplectic_euler

# ---- The same bits everywhere ----
everywhere() { # a line for each: RANKS THREADS SCHEDULER MAPPING BALANCE
    echo '2 2 locality cyclic delegate
3 1 priority metis wander'
    quick || echo '1 2 steal metis none
2 1 fifo block none
4 1 lifo random migrate'
}
same() { # SCENE
    go "$1" --threads 1 || return 1
    hash=$(value state_hash)
    echo "# $hash"
    everywhere > runs
    while read -r ranks threads scheduler mapping balance; do
        ranks "$ranks" "$DUITE_CLOTH" "$1" --threads "$threads" --scheduler "$scheduler" --mapping "$mapping" --balance "$balance" \
            --quiet --report many.json < /dev/null || return 1
        test "$hash" = "$(value state_hash many.json)" || { echo "another hash on $ranks ranks of $threads threads"; return 1; }
    done < runs
}
ok "one state_hash of springs" same springs.yaml
in_full "one state_hash of triangles" same triangles.yaml

# ---- With certified contact: a sheet sinks onto a ball ----
cat > ball.yaml << END
schema: 1
name: ball
cloths:
  - name: sheet
    mesh: {grid: {width: 0.6, height: 0.6, nx: 21, ny: 21}}
    material: m
    transform: {translate: [0, 0.21, 0]}
materials: {m: {model: triangles, density: 0.2, stretch: 15, shear: 8, damping: {stiffness: 0.01}, velocity_correction: {at: 0.02, rounds: 300}}}
obstacles: [{sphere: {centre: [0, 0, 0], radius: 0.2}}]
contact: {mode: certified, self: on, thickness: 0.004}
gravity: [0, -9.81, 0]
grain: 50
time: {h: 0.002, end: 0.4, fps: 50, stretch_growth: 0, stretch_limit: 100}
END
certified() {
    limited "$DUITE_CLOTH" ball.yaml --check-intersections --quiet --report report.json || return 1
    echo "# $(value velocity_correction_rounds) rounds, $(value contacts) contacts, largest stretch $(value stretch_highest)"
    test "$(value intersections)" = 0 && test "$(value contacts)" -gt 20 && test "$(value velocity_correction_rounds)" -gt 20
}
ok "with certified contact nothing goes through anything" certified

# ---- What the report and the summary say ----
unmet() {
    limited "$DUITE_CLOTH" springs.yaml --threads 1 --report report.json --set 'materials.m.velocity_correction={at: 0.01, rounds: 2}' 2>&1 | tee said
    test "$(grep -c "warning: after .* steps edges are over the limit of velocity_correction" said)" = 1 && test "$(value velocity_correction_unmet)" -gt 0
}
ok "too few rounds are said" unmet
none() {
    go two.yaml --threads 1 --set 'materials.m={ea: 1e-9}' && test "$(value velocity_correction_rounds)" = 0 && test "$(value velocity_correction_excess)" = null
}
ok "without the key there is nothing of it" none
