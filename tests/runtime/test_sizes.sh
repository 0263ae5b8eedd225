#!/bin/sh
# Objects that change size, on one rank and on several.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

for n in 1 2 3; do
    ok "a list goes round $n ranks" ranks $n tests/runtime/ranks_sizes
done
