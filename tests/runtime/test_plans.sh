#!/bin/sh
# What ranks compute alike instead of sending it.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

DUITE_TIMEOUT=${DUITE_TIMEOUT:-60}
for n in 1 2 3; do
    ok "replicated kernels on $n ranks" ranks $n tests/runtime/ranks_replicated
done
