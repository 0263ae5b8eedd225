#!/bin/sh
# One state_hash with AVX-512, AVX2 and neither, in every format of the matrix and with every preconditioner; what the machine lacks
# is skipped, and refused when it is asked for.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
plan_later
scene=$srcdir/cloth/scenes/sheet.yaml
cd "$scratch" || exit 99

run() { # SIMD ARGUMENT...
    DUITE_SIMD=$1 limited "$DUITE_CLOTH" "$scene" --quiet --report report.json --end 0.004 --grain 100 \
        --set 'cloths[0].mesh.grid.nx=30' --set 'cloths[0].mesh.grid.ny=30' --set 'gravity=[4,-9.81,2]' \
        --set materials.cloth.bend=3 --set solver.stop.relative=1e-6 --set "solver.$2"
}

has() { # SIMD: whether it is there; one that is not is refused
    status=0
    run "$1" format=springs > said 2>&1 || status=$?
    test $status = 0 && return
    grep -q "DUITE_SIMD asks for $1, which this processor lacks" said && return 1
    cat said
    return 1
}
same() { # SIMD: as without
    for setting in format=springs format=half preconditioner=none preconditioner=jacobi preconditioner=coarse; do
        if ! test -s "$setting"; then
            run none "$setting" && test "$(value simd)" = none && value state_hash > "$setting" || return 1
        fi
        plain=$(cat "$setting")
        run "$1" "$setting" && test "$(value simd)" = "$1" || return 1
        echo "$setting: $plain with none, $(value state_hash) with $1"
        test "$plain" = "$(value state_hash)" || return 1
    done
}
for simd in avx2 avx512; do
    if has $simd; then
        ok "$simd makes the same bits" same $simd
    else
        ok "$simd is not there and is refused" grep -q "DUITE_SIMD asks for $simd, which this processor lacks" said
    fi
done
unknown() {
    status=0
    run mmx format=half > said 2>&1 || status=$?
    cat said
    test $status = 2 && grep -qx "duite-cloth: DUITE_SIMD is 'mmx'; none, avx2 and avx512 are allowed" said
}
ok "a word that is not known" unknown
