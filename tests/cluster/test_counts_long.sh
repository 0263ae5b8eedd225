#!/bin/sh
# All of test_counts.sh.
DUITE_LONG=1 exec sh "${srcdir:-.}/tests/cluster/test_counts.sh"
