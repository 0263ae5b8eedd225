#!/bin/sh
# test_same_hash.sh on the whole product for the sheet of 22,500 vertices, and on all pairs of choices for two panels with joints.
DUITE_LONG=1
export DUITE_LONG
. "${srcdir:-.}/tests/whole/test_same_hash.sh"
