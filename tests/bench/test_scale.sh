#!/bin/sh
# duite-bench scale runs in tiny sizes, and has its figures; counts of messages are exact, where eight hosts can be played. From nothing, it
# runs each motion once.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless bench/duite-bench
plan_later

rows() { # each metric with a number, or why there are no hosts
    limited bench/duite-bench scale --quick --repeats 1 --states "$scratch/states" > "$scratch/said" 2>&1 || { cat "$scratch/said"; return 1; }
    cat "$scratch/said"
    for metric in messages_per_iteration_r8 wait_messages_r8 prediction_error_r2 prediction_error_r2_from_r1 scaling_1x16_tcp scaling_16x16_tcp \
        scaling_1x16_fast scaling_16x16_fast coarse_path_share iterations_large_vs_exact iterations_large_vs_one_patch \
        iterations_million_vs_exact iterations_million_vs_one_patch iterations_million_h20_exact iterations_small_vs_one_factor \
        iterations_landed_h20 iterations_folded_h20 touches_landed_h20 scaling_64x64_fast; do
        grep -Eq "^$metric: ([0-9]|hosts.sh: |no hosts)" "$scratch/said" || return 1
    done
}

waits() { # the rank in the middle of both trees sends log2 8 messages
    sed -n 's/^wait_messages_r8: \([0-9.]*\).*/\1/p' "$scratch/said" | awk '{ wrong = $1 < 2.5 || $1 > 6 } END { exit wrong }'
}

folded() { # cloth that touches itself has springs there in its system
    for metric in h1 h8_bend h20; do
        grep -Eq "^touches_itself_folded_$metric: [1-9]" "$scratch/said" || return 1
    done
}

motions() { # in any order of the states; the dress may be missing
    sed -n 's/^duite-bench: running the motion \([a-z]*\): .*/\1/p' "$scratch/said" | sort > "$scratch/motions"
    grep -v dress "$scratch/motions" | tr '\n' ' ' > "$scratch/ran" && cat "$scratch/ran" &&
        test "$(cat "$scratch/ran")" = "crumpled falling folded hanging irregular landed " && test "$(grep -c dress "$scratch/motions")" -le 1
}

none_left() { # the traces and reports of the rows above
    ls -A "$scratch/temporary" > "$scratch/left" && cat "$scratch/left" && test ! -s "$scratch/left"
}
mkdir "$scratch/temporary"
export TMPDIR="$scratch/temporary"
ok "messages and predictions are measured" rows
if grep -q '^wait_messages_r8: [0-9]' "$scratch/said"; then ok "a wait sends few messages" waits; else skip "a wait sends few messages" "no hosts here"; fi
ok "cloth touches itself" folded
ok "each motion runs once" motions
ok "traces and reports are removed at the end" none_left
