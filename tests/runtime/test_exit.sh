#!/bin/sh
# A program that ends without a stop, in the middle of its work: its status is kept and nothing hangs.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

DUITE_TIMEOUT=${DUITE_TIMEOUT:-60}
times=2
if quick; then times=1; fi
for round in $(seq $times); do
    exits 3 "one process" limited tests/runtime/ranks_exit 3
    exits 0 "one process, without a failure" limited tests/runtime/ranks_exit 0
    exits 4 "one rank of two" ranks 2 tests/runtime/ranks_exit 4
    exits 5 "both ranks" ranks 2 tests/runtime/ranks_exit 5 --all
done
not_ok_expected "both ranks without a failure: mpirun tells" ranks 2 tests/runtime/ranks_exit 0 --all
