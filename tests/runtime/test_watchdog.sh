#!/bin/sh
# Policies that return late, on several ranks.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

ok "functions that hang on one of 2 ranks are named there" ranks 2 tests/runtime/ranks_watchdog
