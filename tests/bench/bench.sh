# shellcheck shell=sh
# Shared by the tests of duite-bench, to be sourced after tests/support/tap.sh: the bench, and looks at what it prints.
bench=$PWD/bench/duite-bench
skip_unless "$bench"

# every_metric FILE REASONS COMMAND...: each metric that COMMAND --list names has a line in FILE: a figure, or why there is none.
every_metric() {
    lines=$1 reasons=$2
    shift 2
    for metric in $("$@" --list | sed -n 's/^    \([a-z0-9_]*\) (.*/\1/p'); do
        grep -Eq "^$metric: ([-0-9]|$reasons)" "$lines" || { echo "no line of $metric" && return 1; }
    done
}

# targets COMMAND...: the metrics that have a target, and which, a line each.
targets() { "$@" --list | sed -n 's/^    \([a-z0-9_]*\) ([a-z_]*), target /\1 /p'; }

# liars_bench FOLDER RIVAL...: a bench of its own there, whose rivals are the liar.
liars_bench() {
    folder=$scratch/$1
    shift
    mkdir -p "$folder/rivals" && cp "$bench" "$folder" || return 1
    for rival; do
        cp tests/bench/liar "$folder/rivals/$rival" || return 1
    done
}

# lie_told RIVAL SERIES BENCH OPTION...: a rival that answers wrong ends the bench, which says in which series.
lie_told() {
    rival=$1 series=$2
    shift 2
    liars_bench bench "$rival" || return 99
    status=0
    LIAR=wrong limited "$scratch/bench/duite-bench" "$@" > "$scratch/said" 2>&1 || status=$?
    cat "$scratch/said"
    test $status = 1 && grep -q "$series, $rival.*: wrong answer" "$scratch/said"
}
