#!/bin/sh
# Loads and winds that vary in time, against closed forms, through probes alone. docs/accuracy.md has errors and orders.
. "${srcdir:-.}/tests/support/probes.sh"

largest() { # EXPRESSION: its largest size over the rows
    rows '{ d = '"$1"'; if (d < 0) d = -d; if (d > most) most = d } END { print most }'
}

# A weight of 0.1 kg on a spring of 40 N/m, 20 rad/s, at rest until F sin W t pushes it along the spring.
cat > driven.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
cloths:
  - mesh: {inline: {vertices: [[0, 0, 0], [1, 0, 0]], edges: [[0, 1]]}}
    material: wire
    mass_per_vertex: 0.1
    pins: [{vertices: [0]}]
    loads:
      - {vertices: [1], force: [0.2, 0, 0], curve: {sine: {frequency: 3.183098861837907}}}
      - {vertices: [0], force: [0, 0.3, 0], curve: {sine: {frequency: 1, phase: 0.25}}}
materials: {wire: {density: 1, ea: 40}}
time: {h: 1e-3, end: 2}
integrator: rk4
solver: {stop: {relative: 1e-12}}
probes: [{name: p, vertices: [0, 1]}]
END
driven() { # RATIO of W to 20 rad/s, but 1
    run driven.yaml --set "cloths[0].loads[0].curve.sine.frequency=$(awk -v r="$1" 'BEGIN { printf "%.16g", r * 10 / 3.141592653589793 }')" || return 1
    below "weight driven at $1 of its frequency, of its static deflection" \
        "$(largest "(c(\"p.1.x\") - 1) / 0.005 - (sin(20 * $1 * c(\"time\")) - $1 * sin(20 * c(\"time\"))) / (1 - $1 ^ 2)")" 1e-6 &&
        row "a weight pushed by F sin W t at $1 of its frequency ω, \`rk4\`, ω h = 0.02: of F / k" "(sin W t − r sin ω t) / (1 − r²), r = W / ω"
}
ok "a weight driven slowly" driven 0.5
ok "a weight driven fast" driven 1.7
ok "a weight driven near resonance beats" driven 0.95

# At resonance it swings by F / (2 m w^2) (sin w t - w t cos w t); the error in 2 s falls with the order of the scheme.
error_at() { # INTEGRATOR H
    run driven.yaml --set integrator="$1" --set time.h="$2" &&
        largest 'c("p.1.x") - 1 - 0.0025 * (sin(20 * c("time")) - 20 * c("time") * cos(20 * c("time")))'
}
resonance() { # INTEGRATOR H ORDER
    coarse=$(error_at "$1" "$2") && fine=$(error_at "$1" "$(awk -v OFMT=%.17g -v h="$2" 'BEGIN { print h / 2 }')") || return 1
    awk -v what="$1" -v a="$coarse" -v b="$fine" -v order="$3" 'BEGIN { o = log(a / b) / log(2)
        printf "# resonance, %s: error %.2g m, order %.2f\n", what, b, o; exit !(o > order - 0.15 && o < order + 0.15) }' >&3 &&
        row "the same at resonance, \`$1\`" "F / 2k (sin ω t − ω t cos ω t)" "order $(awk -v a="$coarse" -v b="$fine" 'BEGIN { printf "%.2f", log(a / b) / log(2) }')"
}
ok "resonance, explicit_euler" resonance explicit_euler 2e-4 1
# The positions of this scheme are those of Verlet where a run begins at rest and without force.
ok "resonance, symplectic_euler" resonance symplectic_euler 2e-3 2
ok "resonance, verlet" resonance verlet 2e-3 2
ok "resonance, rk4" resonance rk4 4e-3 4
ok "resonance, implicit_euler" resonance implicit_euler 2e-4 1
ok "resonance, bdf2" resonance bdf2 1e-3 2

# The pin of a held vertex carries its load; the energy of loads is that of the forces of its time.
told() {
    run driven.yaml --end 0.7 || return 1
    below "a varying load on a pin" "$(largest 'c("p.0.ry") + 0.3 * cos(2 * 3.141592653589793 * c("time"))')" 1e-12 &&
        below "energy of a varying load" "$(largest 'c("loads") + 0.2 * sin(20 * c("time")) * c("p.1.x")')" 1e-12 && row "a load that varies: force on its pin, N; energy of loads, J" "that of its time"
}
ok "probes of varying loads" told

# A load that grows to F in T and stays: x = F/k (t/T - sin(w t)/(w T)), then F/k (1 + (sin(w (t - T)) - sin(w t))/(w T)).
keys() {
    run driven.yaml --set 'cloths[0].loads[0].curve={keys: [[0, 0], [0.5, 1]]}' || return 1
    below "a weight under a load that grows" \
        "$(largest '(c("p.1.x") - 1) / 0.005 + sin(20 * c("time")) / 10 - (c("time") > 0.5 ? 1 + sin(20 * (c("time") - 0.5)) / 10 : 2 * c("time"))')" 1e-6 && row "a weight under a load that grows to F in T and stays" "F / k (t / T − sin ω t / ω T), then about 1"
}
ok "a load by key frames" keys

# The pins of a sheet across a gust carry rho/2 C A (U s)^2 of its time.
cat > gust.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
air: {wind: [0, 8, 0], curve: {keys: [[0, 0], [0.1, 1], [0.3, 0.5]]}}
cloths:
  - mesh: {grid: {width: 2, height: 1, nx: 5, ny: 4}}
    material: silk
    pins: [{box: [[-9, -9, -9], [9, 9, 9]]}]
time: {h: 0.01, end: 0.4}
grain: 5
probes: [{name: p, box: [[-9, -9, -9], [9, 9, 9]], values: [total]}]
END
gust() {
    run gust.yaml || return 1
    below "pins of a sheet in a gust" \
        "$(largest 'c("p.total.ry") / 92.16 + (c("time") < 0.1 ? c("time") / 0.1 : c("time") < 0.3 ? 1.25 - c("time") / 0.4 : 0.5) ^ 2')" 1e-12 && row "the pins of a sheet across a gust: force" "ρ/2 C A (U s)²"
}
ok "a gust" gust

# A run does not rest while a load may vary yet.
rests() {
    run driven.yaml --set 'time.rest={speed: 1, hold: 0.01}' --report report \
        --set 'cloths[0].loads=[{vertices: [1], force: [1e-6, 0, 0], curve: {keys: [[0, 0], [0.3, 0], [0.4, 1]]}}]' || return 1
    near "when a run rests whose load grows for 0.4 s" "$(sed -n 's/^ *"rest_seconds": *\([^,]*\).*/\1/p' report)" 0.409 3e-3
}
ok "a run does not rest before its loads do" rests

# Loads on vertices and edges of several blocks, in halved steps, too: the same bits on ranks and threads.
cat > many.yaml << 'END'
schema: 1
cloths:
  - mesh: {grid: {width: 1, height: 1, nx: 6, ny: 6}}
    material: silk
    pins: [{vertices: [0, 5]}]
    loads:
      - {box: [[-1, -1, -1], [0, 1, 1]], force: [0, 0.01, 0], curve: {sine: {frequency: 20, phase: 0.125}}}
      - {edges: [[34, 35], [33, 34]], force: [0, 0, 2], curve: {keys: [[0, 0], [0.01, 1]]}}
      - {vertices: [35], force: [0, 0.01, 0]}
time: {h: 0.01, end: 0.05, stretch_growth: 0.002}
grain: 7
probes: [{name: p, vertices: [0, 14, 35]}]
END
same() {
    run many.yaml --report report && cp out/probes.csv one.csv && ! grep -q '"steps_halved": 0,' report &&
        ranks 2 "$DUITE_CLOTH" many.yaml --quiet --output out --threads 2 && cmp out/probes.csv one.csv
}
ok "varying loads on 2 ranks" same
ok "docs/accuracy.md has these rows" table
