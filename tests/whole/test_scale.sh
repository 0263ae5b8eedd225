#!/bin/sh
# No number of contact is a length of its own: a scene 128 times as large, and one 128 times as small, with gravity, densities and pressure
# that fit, has the same motion and the same counts. Sizes are powers of two, so all of it is equal to the last bit. Certificates try less for
# features that are 2 m long (cloth/contact/certificate.c), so the edges of the large one are of 1 m.
. "${srcdir:-.}/tests/support/cloth.sh"

# scene SIZE MODE: two sheets fall onto a ball and a floor, and onto each other.
scene() {
    awk -v s="$1" -v mode="$2" '
        function sheet(name, x, y) {
            printf "  - {name: %s, material: m, mesh: {grid: {width: %.17g, height: %.17g, nx: 31, ny: 31}}, ", name, s * 0.25, s * 0.25
            printf "transform: {translate: [%.17g, %.17g, 0]}}\n", s * x, s * y
        }
        BEGIN {
            print "schema: 1\nname: scale\ncloths:"
            sheet("below", 0.015625, 0.078125)
            sheet("above", -0.015625, 0.09375)
            printf "materials: {m: {density: %.17g, stretch: 500, shear: 100, bend: 0.5, friction: 0.25, damping: {viscous: 2e-6, stiffness: 0.004}}}\n", 0.25 / s / s
            printf "obstacles: [{sphere: {centre: [0, 0, 0], radius: %.17g, friction: 0.25}}, {plane: {point: [0, %.17g, 0], normal: [0, 1, 0]}}]\n", s * 0.0625, s * -0.0625
            printf "contact: {mode: %s, self: on, thickness: %.17g%s}\ngravity: [0, %.17g, 0]\n", mode, s * 0.001953125, mode == "certified" ? ", pressure: " 4096 / s : "", s * -9.8125
            print "probes: [{name: low, cloth: below, vertices: [0, 7, 480, 960], values: [position, velocity]},"
            print "         {name: high, cloth: above, vertices: [0, 7, 480, 960], values: [position, velocity]}]"
            print "time: {h: 0.0078125, end: 0.25, fps: 16}\nintegrator: implicit_euler"
        }'
}
# Places and velocities of all steps, by the unit of the size, then the counts.
motion() { # SIZE MODE
    scene "$1" "$2" > scene.yaml && rm -rf out && limited "$DUITE_CLOTH" scene.yaml --grain 50 --threads 2 --quiet --output out --report report.json 2> said || return
    awk -F, -v s="$1" '
        NR == 1 { for (i = 1; i <= NF; i++) if ($i ~ /^(low|high)\.[0-9]/) taken[++n] = i; next }
        { for (i = 1; i <= n; i++) printf "%.17g ", $taken[i] / s; print "" }' out/probes.csv
    for key in steps steps_halved contacts contact_solves contact_cuts contact_queries; do echo "$key $(value $key)"; done
}
same() { # MODE
    motion 1 "$1" > one && test "$(wc -l < one)" -ge 32 && { test "$1" = project || grep -q '^contacts [1-9]' one; } || return 1
    for size in 128 0.0078125; do motion $size "$1" > other && cmp one other || return 1; done
}
for mode in certified repulsion project; do ok "a scene of any size moves alike, $mode" same $mode; done
