#!/bin/sh
# A balloon: a sphere of cloth under pressure rests where p = 2 T / r. With T = Y / (1 - nu) e of an isotropic membrane, e = r / R - 1, that
# is at r = R / (1 - p R (1 - nu) / 2 Y).
. "${srcdir:-.}/tests/support/cloth.sh"

# An octahedron of edges of n parts, blown up to a sphere of 0.2 m.
awk -v n=12 'function vertex(x, y, z,    key, r) {
        key = x "," y "," z
        if (!(key in at)) { r = 0.2 / sqrt(x * x + y * y + z * z); printf "v %.17g %.17g %.17g\n", x * r, y * r, z * r; at[key] = ++vertices }
        return at[key]
    }
    function face(i, j, sx, sy, sz) { return vertex(sx * i, sy * j, sz * (n - i - j)) }
    function triangle(a, b, c, out) { faces = faces (out > 0 ? "f " a " " b " " c : "f " a " " c " " b) "\n" }
    BEGIN {
        for (sx = -1; sx <= 1; sx += 2) for (sy = -1; sy <= 1; sy += 2) for (sz = -1; sz <= 1; sz += 2)
            for (i = 0; i < n; i++) for (j = 0; i + j < n; j++) {
                out = sx * sy * sz
                triangle(face(i, j, sx, sy, sz), face(i + 1, j, sx, sy, sz), face(i, j + 1, sx, sy, sz), out)
                if (i + j + 2 <= n)
                    triangle(face(i + 1, j, sx, sy, sz), face(i + 1, j + 1, sx, sy, sz), face(i, j + 1, sx, sy, sz), out)
            }
        printf "%s", faces
    }' > sphere.obj
cat > balloon.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
cloths: [{name: skin, mesh: {file: sphere.obj}, material: rubber, pressure: 100}]
materials: {rubber: {density: 0.2, model: triangles, stretch: 1000, shear: 384.615, poisson: 0.3, damping: {mass: 20}}}
time: {h: 0.002, end: 1}
probes: [{name: skin, box: [[-1, -1, -1], [1, 1, 1]], values: [position]}]
grain: 100
END
run() { limited "$DUITE_CLOTH" balloon.yaml --quiet --output out "$@"; }

rests_at() { # PRESSURE ARGUMENT...: the mean strain of the radius within 2 % of the closed form, and no drift of the middle
    p=$1
    shift
    rm -rf out
    run --set cloths.skin.pressure="$p" "$@" && tail -n 1 out/probes.csv | awk -F, -v p="$p" '{
        for (i = 10; i + 2 <= NF; i += 3) { r += sqrt($i ^ 2 + $(i + 1) ^ 2 + $(i + 2) ^ 2); n++; x += $i; y += $(i + 1); z += $(i + 2) }
        strain = r / n / 0.2 - 1; right = 1 / (1 - p * 0.2 * 0.7 / 2000) - 1
        print n " vertices, strain " strain ", closed form " right ", middle " x / n, y / n, z / n
        exit !(n == 578 && strain / right > 0.98 && strain / right < 1.02 && x ^ 2 + y ^ 2 + z ^ 2 < 1e-16)
    }'
}
for p in 50 100; do
    ok "a balloon at $p Pa" rests_at $p
done
ok "the same of springs of its edges is blown up, too" run --set materials.rubber.model=springs --set time.end=0.01
same() {
    for how in "--threads 1" "--threads 2 --scheduler lifo"; do
        # shellcheck disable=SC2086 # options
        run --set time.end=0.02 $how && cp out/*.pc2 "hash$(printf %s "$how" | tr -dc 'a-z0-9')" || return 1
    done
    cmp hash*1 hash*lifo
}
ok "the same bits by threads and schedulers" same
sudden() {
    run --set cloths.skin.pressure=1e6 --set time.end=0.002 --set time.halving=off 2>&1 | tee said
    grep -q 'beyond the limit of the pressure' said
}
ok "too much for its steps draws a warning" sudden
