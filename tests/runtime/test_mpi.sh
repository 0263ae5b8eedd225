#!/bin/sh
# Programs that call MPI themselves: the program prints TAP of its own; here it must end well, on time.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

for n in 1 2 3; do
    ok "MPI of the program's own on $n ranks" ranks $n tests/runtime/ranks_mpi
done
