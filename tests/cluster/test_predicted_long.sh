#!/bin/sh
# Runs of sheets on two, four and eight hosts against what duite-predict makes of their traces: as many messages, and as many bytes. Also by
# groups of blocks as the coarse space, on one level and on two.
. "${srcdir:-.}/tests/support/tap.sh"
. "$srcdir/tests/support/predicted.sh"
. "$srcdir/tests/cluster/cluster.sh"
on_hosts 8

same() { # HOSTS SIDE GRAIN STEPS
    hosts=h1
    for i in $(seq 2 "$1"); do hosts=$hosts,h$i; done
    limited "${MPIRUN:-mpirun}" --host "$hosts" -n "$1" "$DUITE_CLOTH" "$srcdir/cloth/scenes/sheet.yaml" --quiet --threads 1 --end "0.00$4" \
        --set "cloths[0].mesh.grid.nx=$2" --set "cloths[0].mesh.grid.ny=$2" --grain "$3" --trace "$scratch/trace" &&
        as_predicted "$scratch/trace"
}

plan_later
for n in 2 4 8; do
    ok "45 blocks on $n hosts" same $n 150 500 2
    ok "320 blocks on $n hosts, in groups" same $n 80 20 2
    ok "2,132 blocks on $n hosts, in groups of groups" same $n 80 3 1
done
