#!/bin/sh
# Beside programs that use all cores, a rank that waits for another one sleeps.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

# Open MPI's own way to give cores away, which run.sh asks for, would be counted as well.
export OMPI_MCA_mpi_yield_when_idle=0

name="two ranks beside eight loops"
if test "$(nproc)" -lt 2; then
    skip "$name" "fewer than 2 cores"
else
    ok "$name" ranks 2 tests/runtime/ranks_loaded
fi
