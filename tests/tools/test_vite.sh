#!/bin/sh
# ViTE opens what we write for it: a run on two ranks, and a predicted one, are drawn without a display.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
skip_unless ./duite-trace
command -v vite > /dev/null || skip_all "vite is not installed"
plan_later
QT_QPA_PLATFORM=offscreen XDG_RUNTIME_DIR=$scratch
export QT_QPA_PLATFORM XDG_RUNTIME_DIR

run() {
    ranks 2 "$DUITE_CLOTH" "$srcdir/cloth/scenes/sheet.yaml" --set 'cloths[0].mesh.grid.nx=30' --set 'cloths[0].mesh.grid.ny=30' \
        --set 'cloths[0].pins=[]' --grain 100 --end 0.002 --threads 2 --quiet --trace "$scratch/ranks"
}
# ViTE says on standard output what it could not read, and leaves with 0 whatever that was. States that are short in the whole
# picture are not in it: where a rank was held up, few are.
drawn() { # TRACE WORKERS: each rank and worker has its name, and there are states
    limited vite -e "$scratch/$1.svg" "$scratch/$1.paje" > "$scratch/said" 2>&1
    cat "$scratch/said"
    grep -q '^0 errors and 0 warnings' "$scratch/said" &&
        test "$(grep -c '>rank [0-9]* worker [0-9]*<' "$scratch/$1.svg")" = "$2" &&
        grep -q 'fill="rgb([0-9,]*)"' "$scratch/$1.svg"
}
ok "a run on 2 ranks" run
ok "... as a Paje trace" ./duite-trace "$scratch/ranks" --paje "$scratch/ranks.paje"
ok "... is drawn" drawn ranks 4
arrows() {
    messages=$(grep -c '^11 ' "$scratch/ranks.paje")
    test "$messages" -gt 100 && test "$(grep -c '<polygon' "$scratch/ranks.svg")" = "$messages"
}
ok "... with an arrow for each message" arrows
ok "predicted on 3 hosts" ./duite-predict "$scratch/ranks" --hosts 3 --cores 2 --paje "$scratch/predicted.paje"
ok "... is drawn, too" drawn predicted 6
