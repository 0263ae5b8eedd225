#!/bin/sh
# The long form of test_checkpoint.sh: 18 runs, each killed four times where it lasts so long.
DUITE_LONG=1 exec "${srcdir:-.}/tests/whole/test_checkpoint.sh"
