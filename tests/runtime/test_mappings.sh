#!/bin/sh
# Mappings that fail on some rank, and such that are not the same on all.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

ok "wrong mappings on 2 ranks" ranks 2 tests/runtime/ranks_mappings
