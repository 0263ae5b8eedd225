#!/bin/sh
# test_capstan.sh with all widths, steps and coefficients, and long times.
DUITE_LONG=1
export DUITE_LONG
. "${srcdir:-.}/tests/whole/test_capstan.sh"
