#!/bin/sh
# One state_hash of the scenes whose contact is certified, coarse and short, over 1 to 4 ranks, threads, schedulers, mappings and
# balancers; in some of them steps are halved, in others pairs pushed apart.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
plan_later
exec 3>&1

value() { sed -n "s/^ *\"$1\": *\([^,]*\),\{0,1\}\$/\1/p" "$scratch/report.json"; }
coarse() { # SCENE BLOCKS HALVED KEY=VALUE...: so many blocks and halved steps at least; then the hashes
    coarse_scene=$1 coarse_name=${1##*/} coarse_blocks=$2 coarse_halved=$3
    shift 3
    for set; do printf -- '--set\n%s\n' "$set"; done > "$scratch/sets"
    # shellcheck disable=SC2046 # no blanks in them
    limited "$DUITE_CLOTH" "$coarse_scene" $(cat "$scratch/sets") --quiet --output "$scratch/out" --report "$scratch/report.json" || return 1
    printf '# %s: %s blocks, %s steps, %s halved, %s contacts, %s more solves, %s cuts\n' "$coarse_name" "$(value blocks)" "$(value steps)" \
        "$(value steps_halved)" "$(value contacts)" "$(value contact_solves)" "$(value contact_cuts)" >&3
    test "$(value blocks)" -ge "$coarse_blocks" && test "$(value steps_halved)" -ge "$coarse_halved" && test "$(value contacts)" -gt 0 &&
        ranks 4 tests/whole/same_hash "$coarse_scene" some 0 "$@"
}
side() { # N CLOTH...: their grids are N vertices wide
    side_n=$1
    shift
    for i; do printf 'cloths[%s].mesh.grid.nx=%s cloths[%s].mesh.grid.ny=%s ' "$i" "$side_n" "$i" "$side_n"; done
}
scenes=$srcdir/cloth/scenes
# shellcheck disable=SC2046
ok "sphere.yaml" coarse "$scenes/sphere.yaml" 8 0 $(side 30 0) time.end=0.4 grain=100
# shellcheck disable=SC2046
ok "stack.yaml, steps halved" coarse "$scenes/stack.yaml" 8 1 $(side 12 0 1 2 3 4) time.end=0.35 grain=80
ok "drape.yaml" coarse "$scenes/drape.yaml" 5 0 cloths[0].mesh.disc.rings=12 time.end=0.2 grain=80
ok "twist.yaml, pairs pushed" coarse "$scenes/twist.yaml" 6 0 cloths[0].mesh.grid.nx=33 cloths[0].mesh.grid.ny=11 time.end=1.6 grain=60
# shellcheck disable=SC2046
ok "slope.yaml" coarse "$scenes/slope.yaml" 6 0 $(side 12 0 1) 'probes[0].vertices=[70]' 'probes[1].vertices=[70]' time.end=0.4 grain=40

# ---- Scenes that others published

peers=$srcdir/bench/contact/peers
turned() { awk -v shape="$1" -v n="$2" -f "$peers/turned.awk" > "$scratch/$1.obj"; }
turned tube 20 && turned cone 16 && turned bowl 64
peer() { # SCENE GRID BLOCKS HALVED KEY=VALUE...: grids of GRID
    sed "s/nx: [0-9]*, ny: [0-9]*/$2/" "$peers/$1.yaml" > "$scratch/$1.yaml"
    peer_scene=$scratch/$1.yaml
    shift 2
    coarse "$peer_scene" "$@"
}
ok "drape of peers, steps halved" peer drape "nx: 10, ny: 10" 8 1 time.end=0.25 grain=60
ok "curtain of peers, steps halved" peer curtain "nx: 8, ny: 8" 8 1 time.end=0.9 grain=80
ok "twist of peers, steps halved" peer twist "" 8 1 time.end=0.24 grain=80
ok "needle of peers, steps halved" peer needle "nx: 11, ny: 11" 8 1 time.end=0.3 grain=70
ok "stack of peers, steps halved" peer stack "nx: 8, ny: 8" 8 1 time.end=0.1 grain=70
ok "ribbon of peers" peer ribbon "nx: 2, ny: 30" 8 0 time.end=0.15 grain=100
ok "layers of peers" peer layers "nx: 4, ny: 4" 8 0 time.end=0.04 grain=90
ok "ring of peers, steps halved" peer ring "nx: 15, ny: 15" 6 1 time.end=0.1 grain=40
