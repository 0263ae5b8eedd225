#!/bin/sh
# The models with more threads and longer programs.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

for model in explorer deque queue handover version gate sleep sleep_queues; do
    ok "test_$model --deep" "tests/model/test_$model" --deep
done
