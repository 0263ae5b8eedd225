#!/bin/sh
# Policies that never return, on several ranks.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

ok "functions that hang on one of 2 ranks" ranks 2 tests/runtime/ranks_guard
