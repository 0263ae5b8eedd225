#!/bin/sh
# What a rank keeps of tasks and objects that are other ranks'.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

for n in 1 2 3; do
    ok "forks of other ranks, on $n" ranks $n tests/runtime/ranks_prune
done
