#!/bin/sh
# Ranks whose environments choose different things end with the same error, which names two ranks and the variable; what may differ
# does.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later
dot=tests/examples/dot

# between SETTINGS SETTINGS: dot on two ranks, each with an environment of its own
between() {
    limited "${MPIRUN:-mpirun}" -n 1 env $1 $dot : -n 1 env $2 $dot
}
differs() { # WORD SETTINGS SETTINGS
    differs_word=$1
    shift
    if between "$@" > "$scratch/said" 2>&1; then return 1; fi
    cat "$scratch/said"
    test "$(grep -c "dot: ranks 0 and 1 start with different $differs_word" "$scratch/said")" = 2
}

ok "one scheduler" between DUITE_SCHEDULER=fifo DUITE_SCHEDULER=fifo
ok "two schedulers" differs "schedulers.*DUITE_SCHEDULER" DUITE_SCHEDULER=fifo DUITE_SCHEDULER=lifo
ok "a scheduler on one rank" differs "schedulers.*DUITE_SCHEDULER" DUITE_SCHEDULER=fifo ""
ok "two mappings" differs "mappings.*DUITE_MAPPING" DUITE_MAPPING=block DUITE_MAPPING=cyclic
ok "two balancers" differs "balancers.*DUITE_BALANCE" "" DUITE_BALANCE=delegate
ok "two seeds" differs "seeds.*DUITE_SEED" DUITE_SEED=2 DUITE_SEED=3
ok "a trace on one rank" differs "traces.*DUITE_TRACE" "DUITE_TRACE=$scratch/trace" ""
ok "two traces" differs "traces.*DUITE_TRACE" "DUITE_TRACE=$scratch/trace" "DUITE_TRACE=$scratch/other"
ok "one trace" between "DUITE_TRACE=$scratch/trace" "DUITE_TRACE=$scratch/trace"
ok "it has a file for each rank" test -s "$scratch/trace" -a -s "$scratch/trace.1"
ok "numbers of threads may differ" between DUITE_THREADS=1 DUITE_THREADS=3
alone() { # a variable that is wrong on one rank only
    if between "" DUITE_SCHEDULER=lazy > "$scratch/said" 2>&1; then return 1; fi
    cat "$scratch/said"
    grep -q 'dot: .*DUITE_SCHEDULER=lazy.*known are steal' "$scratch/said" && grep -q 'duite_start failed on rank 1' "$scratch/said"
}
ok "a wrong name on one rank" alone
