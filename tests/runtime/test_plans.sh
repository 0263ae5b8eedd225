#!/bin/sh
# Recorded graphs on several ranks: how many messages a round takes, and what ranks compute alike instead of sending it.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

for n in 1 2 3; do
    ok "replicated kernels on $n ranks" ranks $n tests/runtime/ranks_replicated
    ok "plans of $n ranks" ranks $n tests/runtime/ranks_plans
    ok "few tags on $n ranks" ranks $n tests/runtime/ranks_tags
done
for n in 5 8 16; do ok "plans of $n ranks, whose sums go from rank to rank" ranks $n tests/runtime/ranks_plans; done
