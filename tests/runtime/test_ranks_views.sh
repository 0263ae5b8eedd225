#!/bin/sh
# Views, on one rank and on several.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

for n in 1 2 3; do
    ok "views on $n ranks" ranks $n tests/runtime/ranks_views
done
