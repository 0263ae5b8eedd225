#!/bin/sh
# test_experiments.sh on all of them.
DUITE_LONG=1
export DUITE_LONG
. "${srcdir:-.}/tests/bench/test_experiments.sh"
