#!/bin/sh
# Joints between vertices of any cloths: two masses against the closed form of a damped spring, momentum, a joint of no length, and the
# same bits on one rank and two.
. "${srcdir:-.}/tests/support/probes.sh"
. "$srcdir/tests/whole/joints.sh"

# ---- Two masses of 0.1 and 0.3 kg, joined by 40 N/m and 0.1 kg/s, begin 0.5 m longer than the joint. Their distance d less the joint's
# ---- length obeys mu d'' + c d' + k d = 0, mu = m1 m2 / (m1 + m2); their centre does not move.
distance() { # its largest error over all rows, m
    rows '{ t = c("time"); k = 40; damping = 0.1; mu = 0.1 * 0.3 / 0.4; r = damping / (2 * mu); w = sqrt(k / mu - r * r)
        d = 0.5 + 0.5 * exp(-r * t) * (cos(w * t) + r / w * sin(w * t)) - (c("q.1.x") - c("p.0.x")); if (d < 0) d = -d; if (d > most) most = d }
        END { printf "%.3g\n", most }'
}
ok "frequency and damping of a joint by rk4" swings rk4 1e-3 1e-8
ok "by velocity Verlet" swings verlet 1e-3 1e-4
ok "by BDF2, between two blocks" swings bdf2 1e-4 1e-4
energy() { # the joint's, at the start: k (1 - 0.5)^2 / 2; and it is no edge that stretches
    run two.yaml --set time.end=0.001 && near "energy of a joint" "$(awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "elastic [J]") at = i } NR == 2 { print $at }' out/probes.csv)" 5 1e-12 &&
        below "largest stretch beside it, less 1" "$(less "$(last longest)" 1)" 0.001
}
ok "a joint has energy, and its length is no stretch" energy
rests() {
    run two.yaml --set 'joints[0].length=start' && below "a joint at its length" "$(last p.0.x | tr -d -)" 1e-16
}
ok "a joint whose length is the distance at the start pulls nothing" rests

# Two masses at one place, pulled apart by 1 N: one implicit step has (mu + h^2 k) dv = h F at once.
together() {
    run two.yaml --set 'joints[0].length=0' --set 'joints[0].damping=0' --set 'cloths[1].mesh.inline.vertices=[[5, 0, 0], [0, 0, 0]]' --set time.h=0.1 --set time.end=0.1 \
        --set 'cloths[0].loads=[{vertices: [0], force: [0, 1, 0]}]' --set 'cloths[1].loads=[{vertices: [1], force: [0, -1, 0]}]' || return 1
    # shellcheck disable=SC2046 # two numbers
    set -- $(last p.0.vy q.1.vy)
    near "speed apart from one place" "$(less "$1" "$2")" "$(awk 'BEGIN { printf "%.12g", 0.1 / (0.1 * 0.3 / 0.4 + 0.01 * 40) }')" 1e-6
}
ok "a joint of no length is stiff in every direction from the begin" together

# ---- Two panels, joined by 8 joints that close, over several blocks ----
alike() {
    run panels.yaml --report report.json || return 1
    # shellcheck disable=SC2046 # six numbers
    set -- $(last p.60.x p.60.y p.60.z q.4.x q.4.y q.4.z)
    apart=$(echo "$@" | awk '{ print sqrt(($1 - $4) ^ 2 + ($2 - $5) ^ 2 + ($3 - $6) ^ 2) }')
    below "panels that joints closed, m apart" "$apart" 0.01 || return 1
    for run in '1 2' '2 1' '2 2'; do
        ranks "${run% *}" "$DUITE_CLOTH" panels.yaml --threads "${run#* }" --quiet --report many.json || return 1
        test "$(value state_hash)" = "$(value state_hash many.json)" || { echo "another hash on $run"; return 1; }
    done
}
ok "joints close a seam, with the same bits on any ranks and threads" alike
