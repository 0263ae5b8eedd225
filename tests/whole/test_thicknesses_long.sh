#!/bin/sh
# test_thicknesses.sh by more integrators and shapes, and one hash over ranks, threads and schedulers.
DUITE_LONG=1
export DUITE_LONG
. "${srcdir:-.}/tests/whole/test_thicknesses.sh"
