#!/bin/sh
# All of test_same.sh.
DUITE_LONG=1 exec sh "${srcdir:-.}/tests/cluster/test_same.sh"
