#!/bin/sh
# All of test_lost.sh.
DUITE_LONG=1 exec sh "${srcdir:-.}/tests/negative/test_lost.sh"
