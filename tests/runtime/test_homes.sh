#!/bin/sh
# Which calls settle the homes of new objects.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

for n in 2 3; do
    ok "homes are settled on $n ranks" ranks $n tests/runtime/ranks_homes
done
