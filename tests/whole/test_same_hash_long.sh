#!/bin/sh
# test_same_hash.sh on the whole product for the sheet of 22,500 vertices.
DUITE_LONG=1
export DUITE_LONG
. "${srcdir:-.}/tests/whole/test_same_hash.sh"
