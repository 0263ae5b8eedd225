#!/bin/sh
# The report tells how much of the wait for messages was hidden behind tasks: a number from 0 to 1, and a smaller one the slower the
# network; nothing on one rank.
. "${srcdir:-.}/tests/support/tap.sh"
. "$srcdir/tests/cluster/cluster.sh"
on_hosts 2

hidden() { # RATE: prints it
    for host in h1 h2; do limit $host "$1" || return; done
    limited "${MPIRUN:-mpirun}" -n 2 "$DUITE_CLOTH" "$srcdir/cloth/scenes/sheet.yaml" --quiet --threads 1 --end 0.002 --grain 200 \
        --set 'cloths[0].mesh.grid.nx=60' --set 'cloths[0].mesh.grid.ny=60' --report "$scratch/$1.json" && report communication_hidden_fraction "$scratch/$1.json" | tee "$scratch/$1"
}
below() { awk 'NR == 1 { a = $1 } NR == 2 { b = $1 } END { exit !(NR == 2 && 0 <= a && a < b && b <= 1) }' "$@"; }

plan_later
ok "a sheet on a fast network" hidden none
ok "at 100 Mbit/s" hidden 100mbit
ok "at 5 Mbit/s" hidden 5mbit
ok "less is hidden at 5 Mbit/s than without a limit" below "$scratch/5mbit" "$scratch/none"
ok "and less than at 100 Mbit/s" below "$scratch/5mbit" "$scratch/100mbit"
alone() {
    "$DUITE_CLOTH" "$srcdir/cloth/scenes/sheet.yaml" --quiet --end 0.001 --report "$scratch/alone.json" &&
        test "$(report communication_hidden_fraction "$scratch/alone.json")" = null
}
ok "nothing on one rank" alone
