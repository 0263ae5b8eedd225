#!/bin/sh
# duite-bench runs every case in tiny sizes, against every rival that was built, and checks the answers; its lines and its
# JSON say the same; what makes no sense, answers wrong, dies or is missing is told.
. "${srcdir:-.}/tests/support/tap.sh"
bench=$PWD/bench/duite-bench
skip_unless "$bench"
plan_later

tasks() { DUITE_TIMEOUT=120 limited "$bench" tasks --quick "$@"; }

# says TEXT COMMAND...: whether the command's output holds the text; gives the command's status if it does.
says() {
    text=$1
    shift
    status=0
    "$@" > "$scratch/said" 2>&1 || status=$?
    cat "$scratch/said"
    grep -qF -- "$text" "$scratch/said" || { echo "(not said: $text)" && return 99; }
    return $status
}

# The form of the file: one object, on each line a key with a number, a string or null; each key once.
well_formed() {
    awk 'NR == 1 { bad += $0 != "{"; next }
         $0 == "}" { ends++; next }
         { line = $0; last = sub(/,$/, "", line) ? 0 : NR
           if (unlasted && !bad) bad++
           unlasted = last
           if (line !~ /^  "[a-z0-9_]+": (-?[0-9]+(\.[0-9]+)?(e[-+][0-9]+)?|null|"([^"\\]|\\["\\u])*")$/) { print; bad++ }
           split(line, part, "\""); if (seen[part[2]]++) { print "twice: " part[2]; bad++ } }
         END { exit !(ends == 1 && !bad && NR > 20) }' "$1"
}

# Every line "metric: value unit [low .. high]" has its three numbers in the file, to four digits.
same_figures() {
    awk -F'[: ,]+' -v lines="$1" '
        { gsub(/"/, ""); sub(/^ +/, ""); if (NF > 1) value[$1] = $2 }
        function differs(key, text) { return value[key] == "" || (value[key] - text)^2 > (1e-3 * text)^2 }
        END { while ((getline line < lines) > 0)
                  if (line ~ /^[a-z0-9_]+: [-0-9]/) {
                      split(line, word, /[: \[\]]+/); n++
                      if (differs(word[1], word[2]) || differs(word[1] "_low", word[4]) ||
                          differs(word[1] "_high", word[6])) { print line; bad++ } }
              exit !(n > 10 && !bad) }' "$2"
}

# Every metric that --list names has a line: a figure, or why there is none.
all_listed() {
    for metric in $(tasks --list | sed -n 's/^    \([a-z0-9_]*\) (.*/\1/p'); do
        grep -Eq "^$metric: ([-0-9]|not built: |not found )" "$1" || { echo "no line of $metric" && return 1; }
    done
}

issue_names() {
    for name in stencil_dynamic_ns_per_task_vs_libomp stencil_dynamic_ns_per_task_vs_starpu chain_dynamic_ns_per_task_vs_libomp \
        independent_dynamic_ns_per_task_vs_libomp independent_growth bytes_per_pending_task granularity_50_w2_vs_mpi \
        granularity_50_w16_vs_mpi wake_us idle_cpu_fraction; do
        tasks --list | grep -q "^    $name " || { echo "no metric $name" && return 1; }
    done
}

# A bench of its own whose only rival is the liar, as StarPU.
liars_bench() {
    mkdir -p "$scratch/bench/rivals" && cp "$bench" "$scratch/bench" && cp tests/bench/liar "$scratch/bench/rivals/starpu"
}
lied_to() { # ROLE OPTION...
    role=$1
    shift
    LIAR=$role DUITE_TIMEOUT=120 limited "$scratch/bench/duite-bench" tasks --quick --only stencil "$@"
}
# 40 tasks; the first round, which is left out, and four that count take 1, 2, 3, 4, 5 ms.
counted() { says "stencil_starpu_ns_per_task: 87500 ns [68750 .. 106250]" lied_to count --repeats 4 --json "$scratch/lied"; }
nothing_written() { ! lied_to wrong --json "$scratch/wrong" && test ! -e "$scratch/wrong"; }

ok "runs every case and checks the answers" tasks --json "$scratch/json"
cp "$scratch/output" "$scratch/lines"
ok "its JSON is well-formed" well_formed "$scratch/json"
ok "its JSON has the figures of its lines" same_figures "$scratch/lines" "$scratch/json"
ok "every metric listed has its line" all_listed "$scratch/lines"
ok "the metrics have their names" issue_names
ok "runs one case, three threads, another scheduler and seed" tasks --only stencil --threads 3 --scheduler fifo --seed 7
exits 2 "an unknown bench" says "there is no bench tusks; known are" "$bench" tusks
exits 2 "an unknown case" says "--only stensil" tasks --only stensil
exits 2 "an unknown option" tasks --fast
exits 2 "a number that is none" says "--repeats many" tasks --repeats many
exits 2 "an unknown scheduler" says "there is no scheduler" tasks --scheduler none
exits 2 "no bench" says "which bench" "$bench"
ok "help" says "first and third quartile" "$bench" --help
exits 1 "a file that cannot be written" says "cannot be written" tasks --only wake --json "$scratch/none/json"

if liars_bench > "$scratch/output" 2>&1; then
    ok "medians and quartiles, without the first round" counted
    ok "a rival that is not there is said" says "stencil_libomp_ns_per_task: not built: " lied_to count
    ok "JSON has null for it, and quotes what needs it" well_formed "$scratch/lied"
    exits 1 "a wrong answer is an error" says "stencil, starpu" lied_to wrong
    ok "and leaves no file" nothing_written
    exits 1 "a rival that dies" says "no answer" lied_to die
    exits 1 "a rival that does not start" says "ended before it was asked" lied_to ""
    exits 1 "a rival that ends badly" says "did not end well (status 5)" lied_to end
fi
