#!/bin/sh
# Programs as a user writes them, which check their own answers: alone under every scheduler (quick: under two), on 2 and 3 ranks,
# and in checking mode (quick: but for fib).
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

schedulers='steal fifo lifo priority static shuffle'
if quick; then schedulers='steal shuffle'; fi
checking() { (DUITE_CHECK=accesses; export DUITE_CHECK; "$@"); }

for example in dot stencil cholesky cg fib quicksort adopt ring; do
    program=tests/examples/$example
    for scheduler in $schedulers; do
        ok "$example under $scheduler" limited $program $scheduler
    done
    ok "$example on 2 ranks" ranks 2 $program
    ok "$example on 3 ranks, shuffled" ranks 3 $program shuffle
    if quick && test $example = fib; then continue; fi # its many small tasks take half a minute in checking mode
    ok "$example in checking mode" checking limited $program
    ok "$example in checking mode on 2 ranks" checking ranks 2 $program
done
ok "a stencil with other neighbours" limited tests/examples/stencil steal -4 0 2 3
ok "on 3 ranks, too" ranks 3 tests/examples/stencil steal -4 0 2 3
exits 1 "a stencil that names a neighbour twice fails" limited tests/examples/stencil steal 1 1
exits 1 "an example fails under a scheduler that does not exist" limited tests/examples/dot none
