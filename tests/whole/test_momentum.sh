#!/bin/sh
# Momentum and spin of cloths that nothing holds, from probes: momentum is kept to rounding, whatever the solve leaves; spin falls by the
# closed form of implicit Euler. And cloths that something holds keep their bits.
. "${srcdir:-.}/tests/support/cloth.sh"
. "$srcdir/tests/support/table.sh"
exec 3>&1

run() { limited "$DUITE_CLOTH" "$@" --quiet; }

# ---- A free sheet that quivers, beside one on a pin, and a mesh of two pieces, one of them on a pin. The centre of what is free is slowed down by drag: v' = -(a + c / m) v = -v,
# ---- of which implicit Euler makes v / (1 + h) a step.

cat > two.yaml << 'END'
schema: 1
contact: {mode: project}
gravity: [0, 0, 0]
cloths:
  - name: free
    mesh: {grid: {width: 1, height: 1, nx: 10, ny: 10}}
    material: m
    mass_per_vertex: 0.002
    velocity: [1, 0.5, 0.25]
    start: [{box: [[-1, -1, -1], [1, 1, 1]], wave: {vector: [5, 0, 3], translate: [0, 0.05, 0.02]}}]
  - name: held
    mesh: {grid: {width: 1, height: 1, nx: 10, ny: 10}}
    transform: {translate: [0, 3, 0]}
    material: m
    mass_per_vertex: 0.002
    velocity: [1, 0.5, 0.25]
    pins: [{vertices: [0]}]
  - name: both
    mesh: {inline: {vertices: [[0, 6, 0], [1, 6, 0], [0, 7, 0], [1, 7, 0]], edges: [[0, 1], [2, 3]]}}
    material: m
    mass_per_vertex: 0.002
    velocity: [1, 0.5, 0.25]
    start: [{vertices: [3], translate: [0.1, 0, 0.1]}]
    pins: [{vertices: [1]}]
materials: {m: {density: 0.2, stretch: 5000, ea: 5000, shear: 1000, damping: {stiffness: 0.005, mass: 0.5, viscous: 0.001}}}
time: {h: 0.01, end: 0.3, energy_growth: 0, stretch_growth: 0}
grain: 30
probes:
  - {name: free, cloth: free, box: [[-2, -2, -2], [2, 2, 2]], values: [velocity]}
  - {name: piece, cloth: both, vertices: [2, 3], values: [velocity]}
END
keeps() { # MOST, PROBE, SETTING...
    most=$1 probe=$2
    shift 2
    rm -rf two
    run two.yaml --output two --report report.json "$@" || return 1
    awk -F, -v most="$most" -v probe="$probe" '
        NR == 1 { for (i = 1; i <= NF; i++) if ($i ~ "^" probe "[.].*v[xyz] ") { axis = $i; sub(/.*[.]v/, "", axis); of[i] = substr(axis, 1, 1); n++ } next }
        { split("", sum); for (i in of) sum[of[i]] += $i / (n / 3); factor = NR > 2 ? factor * (1 + $2 - before) : 1; before = $2 }
        END { x = sum["x"] * factor - 1; y = sum["y"] * factor - 0.5; z = sum["z"] * factor - 0.25; off = sqrt(x * x + y * y + z * z)
              printf "# %s: the velocity of the centre is off by %.1e\n", probe, off; exit !(n && NR == 32 && off < most) }' two/probes.csv >&3
}
for format in springs half; do
    ok "$format: a free sheet keeps its momentum" keeps 1e-12 free --set solver.format=$format
done
ok "so does a free piece of a mesh that is pinned elsewhere" keeps 1e-12 piece
ok "without a preconditioner, by a loose stop" keeps 1e-12 free --set solver.preconditioner=none --set 'solver.stop={relative: 0.1}'
ok "by Newton steps" keeps 1e-12 free --set newton.steps=4
ok "triangles" keeps 1e-12 free --set 'materials.m={density: 0.2, model: triangles, stretch: 5000, shear: 1000, damping: {stiffness: 0.005, mass: 0.5, viscous: 0.001}}' \
    --set 'cloths[2].material=n' --set 'materials.n={density: 0.2, ea: 5000}'

same() { # the same bits on ranks and threads
    run two.yaml --report report.json && one=$(value state_hash) && run two.yaml --threads 3 --report report.json && threads=$(value state_hash) &&
        ranks 3 "$DUITE_CLOTH" two.yaml --quiet --report report.json && echo "$one $threads $(value state_hash)" && test -n "$one" &&
        test "$threads" = "$one" && test "$(value state_hash)" = "$one"
}
ok "the same bits on ranks and threads" same

# ---- Spin. A rod about its pin: by implicit Euler, converged, a step turns it by t with tan(t) = h w first, then tan(t) = sin(s) / (2 - cos(s)),
# ---- s the step before.

cat > rod.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
cloths:
  - mesh: {inline: {vertices: [[0, 0, 0], [1, 0, 0]], edges: [[0, 1]]}}
    material: m
    mass_per_vertex: 0.1
    start: [{vertices: [1], translate: [3.94784e-6, 0, 0], velocity: [0, 6.283185307179586, 0]}]
    pins: [{vertices: [0]}]
materials: {m: {density: 0.2, ea: 1.0e+6}}
time: {h: 0.01, end: 1, stretch_growth: 0, energy_growth: 0}
newton: {steps: 100, tolerance: 1.0e-10}
solver: {stop: {relative: 1.0e-13}}
probes: [{vertices: [1]}]
END
turns() {
    rm -rf rod
    run rod.yaml --output rod --report report.json || return 1
    awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) { if ($i ~ /[.]x /) x = i; if ($i ~ /[.]y /) y = i } next }
        NR > 2 { t = NR == 3 ? atan2(0.01 * 6.283185307179586, 1) : atan2(sin(t), 2 - cos(t)); at += t
                 off = sqrt(($x - cos(at)) ^ 2 + ($y - sin(at)) ^ 2); if (off > most) most = off }
        END { w = 6.283185307179586; printf "# a rod turns as the recurrence says but for %.1e m; %.4f of its spin is left after 1 s, by 1 / sqrt(1 + 2 h w^2 t) %.4f\n",
                  most, t / 0.01 / w, 1 / sqrt(1 + 0.02 * w * w); exit !(NR == 102 && most < 1e-5) }' rod/probes.csv >&3
}
ok "a rod turns by the recurrence of implicit Euler" turns

cat > spin.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
cloths:
  - mesh: {grid: {width: 1, height: 1, nx: 10, ny: 10}}
    material: m
    mass_per_vertex: 0.002
    start: [{box: [[-2, -2, -2], [2, 2, 2]], spin: [0, 6.283185307179586, 0]}]
materials: {m: {density: 0.2, stretch: 5000, shear: 2500}}
time: {h: 0.001, end: 1}
newton: {tolerance: 1.0e-8}
probes: [{box: [[-2, -2, -2], [2, 2, 2]]}]
END
spins() { # NAME, H, LEAST, MOST that is left of the angular momentum after 1 s, CLOSED FORM of what is lost, SETTING...
    name=$1 h=$2 least=$3 most=$4 form=$5
    shift 5
    rm -rf spin
    run spin.yaml --output spin --report report.json --set time.h="$h" "$@" || return 1
    awk -F, -v h="$h" -v what="$*" -v least="$least" -v most="$most" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i ~ /[.]x /) at[i]; next }
        { sum = 0; for (i in at) sum += $(i + 2) * $(i + 3) - $i * $(i + 5); if (NR == 2) first = sum }
        END { printf "# spin at h = %g %s: %.4f is left after 1 s\n", h, what, sum / first
              printf "%.1f %%", 100 * (1 - sum / first) > "lost"; exit !(sum / first >= least && sum / first <= most) }' spin/probes.csv >&3 &&
        row "a free sheet turns once a second, h = $h s, $name: angular momentum lost in 1 s" "$form" "$(cat lost)"
}
of_rigid() { awk -v h="$1" 'BEGIN { w = 6.283185307179586; printf "1 − 1 / √(1 + 2 h ω² T): %.1f %%", 100 * (1 - 1 / sqrt(1 + 2 * h * w * w)) }'; }
ok "a sheet's spin falls by 1 / sqrt(1 + 2 h w^2 t), h = 1 ms" spins '`implicit_euler`, Newton converged' 0.001 0.9617 0.9637 "$(of_rigid 0.001)" --set newton.steps=30
ok "h = 10 ms" spins '`implicit_euler`, Newton converged' 0.01 0.7465 0.7495 "$(of_rigid 0.01)" --set newton.steps=30
ok "one linear step loses more" spins '`implicit_euler`, one linear step' 0.01 0.1 0.7 ""
ok "bdf2 keeps it, h = 1 ms" spins '`bdf2`, one linear step' 0.001 0.9999 1 0 --set integrator=bdf2
ok "h = 10 ms" spins '`bdf2`, one linear step' 0.01 0.95 1 0 --set integrator=bdf2
ok "h = 10 ms, converged" spins '`bdf2`, Newton converged' 0.01 0.99 1 0 --set integrator=bdf2 --set newton.steps=30
ok "docs/accuracy.md has these rows" table
