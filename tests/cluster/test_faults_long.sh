#!/bin/sh
# All of test_faults.sh.
DUITE_LONG=1 exec sh "${srcdir:-.}/tests/cluster/test_faults.sh"
