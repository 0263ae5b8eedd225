#!/bin/sh
# test_memcheck.sh with more programs, and on two ranks.
exec sh "${srcdir:-.}/tests/runtime/test_memcheck.sh" --long
