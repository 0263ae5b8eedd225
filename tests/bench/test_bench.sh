#!/bin/sh
# duite-bench runs every case in tiny sizes, against every rival that was built, and checks the answers; its lines and its
# JSON say the same; what makes no sense, answers wrong, dies or is missing is told.
. "${srcdir:-.}/tests/support/tap.sh"
. "${srcdir:-.}/tests/bench/bench.sh"
plan_later

# In place of valgrind, which takes half a minute: runs the program, and says a thousand instructions for each of its tasks.
mkdir "$scratch/tools"
cat > "$scratch/tools/valgrind" << 'END'
#!/bin/sh
while case $1 in --*) ;; *) false ;; esac; do shift; done
"$@" || exit 1
echo "==1== I refs: ${3}000" | sed 's/\([0-9]\)\(...\)$/\1,\2/'
END
chmod +x "$scratch/tools/valgrind"
PATH=$scratch/tools:$PATH

# A user's general settings for programs of duite, even if they make no sense, are not measured.
tasks_in_full() {
    (export DUITE_SCHEDULER=nobody DUITE_MAPPING=nowhere DUITE_BALANCE=never DUITE_THREADS=none DUITE_SEED=no DUITE_TRACE=/no/such/folder/trace
     limited "$bench" tasks "$@")
}
tasks() { tasks_in_full --quick "$@"; }

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

# Promises, and nothing else, have targets.
targets_listed() {
    "$bench" tasks --list > "$scratch/list" || return 1
    targets "$bench" tasks > "$scratch/targets"
    diff - "$scratch/targets" << 'END' && grep -q '^    wake_us (us)$' "$scratch/list" &&
stencil_replay_ns_per_task_vs_libomp <= 0.06
stencil_dynamic_ns_per_task_vs_libomp <= 0.15
stencil_dynamic_ns_per_task_vs_starpu <= 0.04
stencil_once_ns_per_task_vs_libomp <= 0.3
chain_replay_ns_per_task_vs_libomp <= 0.03
chain_dynamic_ns_per_task_vs_libomp <= 0.12
independent_dynamic_ns_per_task_vs_libomp <= 0.7
fib_core_ns_vs_libomp <= 1
fib_core_ns_vs_tbb <= 1
fib_core_ns_vs_taskflow <= 1
fib_speedup_t2 >= 1.8
skynet_core_ns_vs_tbb <= 1
skynet_core_ns_vs_taskflow <= 1
tree_vs_libomp <= 1.3
tiles_vs_libomp <= 1
independent_growth <= 1.5
bytes_per_pending_task <= 192
event_ns <= 500
instructions_per_task_stencil <= 1000
instructions_per_task_chain <= 750
instructions_per_task_independent <= 700
instructions_per_task_fib <= 1200
instructions_per_task_replay <= 300
END
        grep -q '^    idle_cpu_fraction (of_a_core)$' "$scratch/list"
}
no_targets() { # OPTION...: other sizes or threads have none
    "$bench" tasks --list "$@" > "$scratch/list" && ! grep target "$scratch/list"
}

lied_to_in_full() { # ROLE OPTION...
    role=$1
    shift
    LIAR=$role limited "$scratch/bench/duite-bench" tasks --only stencil "$@"
}
lied_to() { lied_to_in_full "$@" --quick; }

# Four rounds after the first: two pairs, each there and back; of five orders not all are the same.
there_and_back() {
    LIAR=log LIAR_LOG=$scratch/log \
        limited "$scratch/turns/duite-bench" tasks --quick --only stencil --repeats 4 || return 1
    awk 'NR % 5 == 1 { round++ }
         { there[round] = there[round] " " $1; back[round] = " " $1 back[round] }
         END { for (i = 1; i <= round; i++) { print there[i]; if (there[i] != there[1]) differ++ }
               exit !(round == 5 && differ && there[2] == back[3] && there[4] == back[5]) }' "$scratch/log"
}

instructions_counted() { grep -q '^instructions_per_task_chain: 1000 instructions' "$scratch/lines"; }

# A verdict says how the median and the target compare, whichever side it should be on.
verdicts_right() {
    tasks_in_full --only fib --repeats 1 > "$scratch/lines" || return 1
    awk '{ print }
         /, target .*: (pass|miss)$/ {
             least += />=/
             bound = $(NF - 1) + 0
             if (($NF == "pass") != (/<=/ ? $2 <= bound : $2 >= bound)) bad++ }
         END { exit !(least == 1 && !bad) }' "$scratch/lines"
}

# The targets of a stencil against a StarPU that is very slow, or as fast as it says, and no other rival.
judged() { # ROLE VERDICT PASSED MISSED
    lied_to_in_full "$1" --repeats 2 --json "$scratch/judged" > "$scratch/lines" || return 1
    cat "$scratch/lines"
    grep -q "^stencil_dynamic_ns_per_task_vs_starpu: [-0-9.e]* x .*\], target <= 0.04: $2\$" "$scratch/lines" &&
        grep -q '^stencil_replay_ns_per_task_vs_libomp: not built: .*, target <= 0.06: not measured$' "$scratch/lines" &&
        grep -q "^# targets_passed: $3\$" "$scratch/lines" && grep -q "^# targets_missed: $4\$" "$scratch/lines" &&
        grep -q '^# targets_not_measured: 3$' "$scratch/lines" && well_formed "$scratch/judged" &&
        grep -q '"stencil_dynamic_ns_per_task_vs_starpu_target": 0.04,' "$scratch/judged"
}
# 48 tasks; the first round, which is left out, and four that count take 1, 2, 3, 4, 5 ms.
counted() { says "stencil_starpu_ns_per_task: 72917 ns [57292 .. 88542]" lied_to count --repeats 4 --json "$scratch/lied"; }
nothing_written() { ! lied_to wrong --json "$scratch/wrong" && test ! -e "$scratch/wrong"; }

ok "runs every case and checks the answers" tasks --json "$scratch/json"
cp "$scratch/output" "$scratch/lines"
ok "its JSON is well-formed" well_formed "$scratch/json"
ok "its JSON has the figures of its lines" same_figures "$scratch/lines" "$scratch/json"
ok "every metric listed has its line" every_metric "$scratch/lines" "not built: |not found " tasks
ok "instructions a task are counted" instructions_counted
ok "the metrics that have a target, and which" targets_listed
ok "no targets with --quick" no_targets --quick
ok "no targets with other threads" no_targets --threads 3
ok "runs one case, three threads, another scheduler and seed" tasks --only stencil --threads 3 --scheduler fifo --seed 7
exits 2 "an unknown bench" says "there is no bench tusks; known are" "$bench" tusks
exits 2 "an unknown case" says "--only stensil" tasks --only stensil
exits 2 "an unknown option" tasks --fast
exits 2 "a number that is none" says "--repeats many" tasks --repeats many
exits 2 "an unknown scheduler" says "there is no scheduler" tasks --scheduler none
exits 2 "no bench" says "which bench" "$bench"
readme() { BENCH=$bench sh "${srcdir:-.}/bench/readme.sh" --list; }
ok "each row of the table in README has its case" readme
ok "help" says "first and third quartile" "$bench" --help
exits 1 "a file that cannot be written" says "cannot be written" tasks --only wake --json "$scratch/none/json"

if liars_bench bench starpu > "$scratch/output" 2>&1 &&
    liars_bench turns starpu libomp libgomp > "$scratch/output" 2>&1; then
    ok "rounds go there and back" there_and_back
    if ! "$bench" tasks --only wake --repeats 1 2>&1 | grep -c "only --quick"; then
        ok "a target that is kept" judged slow pass 1 0
        ok "a target that is missed" judged count miss 0 1
        ok "targets on either side" verdicts_right
    fi
    ok "medians and quartiles, without the first round" counted
    ok "a rival that is not there is said" says "stencil_libomp_ns_per_task: not built: " lied_to count
    ok "JSON has null for it, and quotes what needs it" well_formed "$scratch/lied"
    exits 1 "a wrong answer is an error" says "stencil, starpu" lied_to wrong
    ok "and leaves no file" nothing_written
    exits 1 "a rival that dies" says "no answer" lied_to die
    exits 1 "a rival that does not start" says "ended before it was asked" lied_to ""
    exits 1 "a rival that ends badly" says "did not end well (status 5)" lied_to end
fi
