#!/bin/sh
# Promise 1 across hosts: a sheet has one state_hash on one host, two and four, and random programs are right on groups of
# up to four ranks of four hosts; with and without a limit to the network. With DUITE_LONG=1: more of them.
. "${srcdir:-.}/tests/support/tap.sh"
. "$srcdir/tests/cluster/cluster.sh"
on_hosts 4

sheet() { # NAME [ARGUMENT of mpirun...]: its hash is to be that of the first one
    name=$1
    shift
    limited "${MPIRUN:-mpirun}" "$@" "$DUITE_CLOTH" "$srcdir/cloth/scenes/sheet.yaml" --quiet --threads 2 --end "$end" \
        --balance "${balance:-none}" --set 'cloths[0].mesh.grid.nx=60' --set 'cloths[0].mesh.grid.ny=60' --grain 200 --report "$scratch/$name.json" &&
        report state_hash "$scratch/$name.json" > "$scratch/$name" && test "$(wc -c < "$scratch/$name")" = 17 &&
        cmp "$scratch/$name" "$scratch/one" && report ranks "$scratch/$name.json" | grep -x $ranks
}

plan_later
end=0.003 programs=100
if test "${DUITE_LONG:-}" = 1; then end=0.02 programs=5000; fi
if quick; then programs=20; fi
ranks=1
ok "a sheet on one host" sheet one --host h1 -n 1
ranks=2
ok "on two hosts" sheet two -n 2 --host h1,h2
ranks=4
ok "on four hosts" sheet four -n 4
balance=wander
ok "on four hosts, blocks and tasks on any" sheet any -n 4
balance=
ranks=6
if test "${DUITE_LONG:-}" = 1; then ok "on four hosts, several ranks each" sheet six -n 6; fi
ok "random programs" limited "${MPIRUN:-mpirun}" -n 4 tests/runtime/random_programs --base 300000 --programs $programs
ok "random programs whose objects move" limited "${MPIRUN:-mpirun}" -n 4 tests/runtime/random_programs --base 400000 --programs $programs \
    --balance wander
if test "${DUITE_LONG:-}" = 1; then
    ok "random programs, nested" limited "${MPIRUN:-mpirun}" -n 4 tests/runtime/random_programs --base 500000 --programs $programs --with nests
fi
