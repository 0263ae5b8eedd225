#!/bin/sh
# Programs as a user writes them: alone, and on 3 ranks. Each checks its own answer.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

for example in dot stencil cg; do
    ok "$example alone" limited tests/examples/$example
    ok "$example on 3 ranks" ranks 3 tests/examples/$example
done
