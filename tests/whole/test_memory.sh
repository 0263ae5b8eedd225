#!/bin/sh
# A rank has the memory of its own blocks: of four ranks none takes half of what one alone takes, nor does rank 0, which reads
# and cuts. Counted is what comes on top of a scene of a few vertices, which libraries and buffers of MPI take.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
test -z "$SANITIZER" || skip_all "a sanitizer has memory of its own for all that a program has"
plan_later

cat > "$scratch/scene.yaml" << 'END'
schema: 1
cloths: [{mesh: {grid: {width: 1, height: 1, nx: 16, ny: 16}}, material: cloth, pins: [{vertices: [0]}]}]
materials: {cloth: {density: 0.2, stretch: 5000, shear: 2500, diagonals: one}}
time: {h: 0.001, end: 0.001}
solver: {stop: {count: 2}}
END

# peak RANKS ARGUMENT...: prints the bytes of the rank that had most.
peak() {
    peak_ranks=$1
    shift
    ranks "$peak_ranks" "$DUITE_CLOTH" "$scratch/scene.yaml" --threads 1 --quiet --report "$scratch/report.json" "$@" >&2 &&
        sed -n 's/.*"peak_memory_bytes": *\([0-9]*\).*/\1/p' "$scratch/report.json"
}

# own RANKS: bytes that the large sheet takes on top of the small one.
own() {
    own_small=$(peak "$1" --grain 32) && own_large=$(peak "$1" --set 'cloths[0].mesh.grid.nx=400' \
        --set 'cloths[0].mesh.grid.ny=400') && test -n "$own_small" && test -n "$own_large" &&
        echo $((own_large - own_small))
}

few() {
    few_one=$(own 1) && few_four=$(own 4) || return 1
    echo "one rank: $few_one bytes, the largest of four: $few_four"
    test "$few_one" -gt 50000000 && test $((2 * few_four)) -lt "$few_one"
}

ok "the largest of 4 ranks has less than half of what one has" few
