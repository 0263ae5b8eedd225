#!/bin/sh
# A preconditioner of three and four levels (blocks, groups of them, groups of groups, one factor on top) has one state_hash on 1 to 16
# ranks, on more of them than there are cores.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
plan_later
DUITE_TIMEOUT=600
export DUITE_TIMEOUT
scene=$srcdir/cloth/scenes/sheet.yaml

# one_hash GRAIN: of a sheet of 80 x 80 vertices, three steps.
one_hash() {
    first=
    for count in 1 2 3 4 5 7 8 16; do
        ranks $count "$DUITE_CLOTH" "$scene" --set 'cloths[0].mesh.grid.nx=80' --set 'cloths[0].mesh.grid.ny=80' --set "grain=$1" \
            --set time.end=0.003 --threads 1 --quiet --report "$scratch/report.json" || return 1
        hash=$(sed -n 's/.*"state_hash": "\([0-9a-f]*\)".*/\1/p' "$scratch/report.json")
        echo "$count ranks: $hash"
        test -n "$hash" && test "${first:=$hash}" = "$hash" || return 1
    done
}

ok "320 blocks: three levels, one of groups" one_hash 20
ok "2,132 blocks: four levels, two of groups" one_hash 3
