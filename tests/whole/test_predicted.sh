#!/bin/sh
# Runs of the sheet on several ranks against what duite-predict makes of their traces: as many messages, and as many bytes. On more than
# four ranks sums go from rank to rank: the state is the same on any number of ranks.
. "${srcdir:-.}/tests/support/tap.sh"
. "$srcdir/tests/support/predicted.sh"
plan_later

same_messages() { # RANKS
    ranks "$1" "$DUITE_CLOTH" "$srcdir/cloth/scenes/sheet.yaml" --quiet --threads 1 --grain 500 --end 0.002 --trace "$scratch/trace" &&
        as_predicted "$scratch/trace"
}

state() { # RANKS: the state_hash
    ranks "$1" "$DUITE_CLOTH" "$srcdir/cloth/scenes/sheet.yaml" --quiet --threads 1 --grain 500 --end 0.002 --report "$scratch/report" &&
        sed -n 's/^ *"state_hash": "\(.*\)".*/\1/p' "$scratch/report"
}
one_state() {
    one=$(state 1) && test -n "$one" || return
    for n in $(quick || echo 3 5 7) 8 16; do
        other=$(state $n) && echo "$one on 1 rank, $other on $n" && test "$one" = "$other" || return
    done
}

ok "one state on any number of ranks" one_state
for n in 2 4 5 8; do ok "messages and bytes on $n ranks" same_messages $n; done
