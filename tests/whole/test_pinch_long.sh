#!/bin/sh
# test_pinch.sh with ten seconds of each length of step.
DUITE_LONG=1
export DUITE_LONG
. "${srcdir:-.}/tests/whole/test_pinch.sh"
