#!/bin/sh
# How many messages ranks need to agree: the program prints TAP of its own; here it must end well, on time.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

for n in 2 5 8; do
    ok "control messages of $n ranks" ranks $n tests/runtime/ranks_control
done
