#!/bin/sh
# test_ranks.sh on what two ranks compute.
DUITE_LONG=1
export DUITE_LONG
. "${srcdir:-.}/tests/cloth/flow/test_ranks.sh"
