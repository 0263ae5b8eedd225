#!/bin/sh
# Every kernel of the flow in checking mode, with all pairs of integrators, materials, pins, formats and preconditioners, on one
# rank and on two.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless tests/cloth/flow/test_checked
plan_later

ok "all pairs" limited tests/cloth/flow/test_checked long
ok "all pairs on 2 ranks" ranks 2 tests/cloth/flow/test_checked long
