#!/bin/sh
# The shell harness itself: what passes, fails and is skipped is said so, in the output, the status and the sums.
. "${srcdir:-.}/tests/support/tap.sh"

# A test of the given lines: its output and "status N" after it must be what standard input says.
gives() {
    { echo '. "$srcdir/tests/support/tap.sh"' && echo "$1"; } > "$scratch/inner.sh"
    printf '%s\n' "$2" > "$scratch/want"
    inner=0
    limited sh "$scratch/inner.sh" > "$scratch/got" 2>&1 || inner=$?
    echo "status $inner" >> "$scratch/got"
    diff -u "$scratch/want" "$scratch/got"
}

sums() { # LINE FILE...
    want=$1
    shift
    test "$(sh "$srcdir/tests/support/count.sh" "$@")" = "$want"
}

results() { # FILE RESULT...
    file=$scratch/$1.trs
    shift
    : > "$file"
    for result; do echo ":test-result: $result some case" >> "$file"; done
}

plan_later
ok "a case that passes" gives 'plan_later; ok good true' 'ok 1 - good
1..1
status 0'
ok "a case that fails, with what it printed" gives 'plan_later; ok bad sh -c "echo why; exit 3"; ok good true' 'not ok 1 - bad
# why
# (exit status 3)
ok 2 - good
1..2
status 1'
ok "a case of the whole of a test" gives 'plan_later; DUITE_QUICK=1; in_full left false; DUITE_QUICK=0; in_full taken true' 'ok 1 - taken
1..1
status 0'
ok "an expected status" gives 'plan_later; exits 2 two sh -c "exit 2"; exits 2 one false' 'ok 1 - two
not ok 2 - one
# (exit status 1, not 2)
1..2
status 1'
ok "an expected failure, which a signal is not" gives 'plan_later; not_ok_expected fails false
not_ok_expected succeeds true; not_ok_expected dies sh -c "exit 139"' 'ok 1 - fails
not ok 2 - succeeds
# (exit status 0; a plain failure was expected)
not ok 3 - dies
# (exit status 139; a plain failure was expected)
1..3
status 1'
ok "a refusal, in one line and nothing else" gives 'plan_later; ok plain refuses why sh -c "echo why >&2; exit 2"
ok works refuses why sh -c "echo why >&2"; ok talks refuses why sh -c "echo why >&2; echo and >&2; exit 2"' 'ok 1 - plain
not ok 2 - works
# why
# (exit status 1)
not ok 3 - talks
# why
# and
# (exit status 1)
1..3
status 1'
ok "one case skipped" gives 'plan_later; skip this "no such thing"' 'ok 1 - this # SKIP no such thing
1..1
status 0'
ok "all skipped" gives 'plan_later; skip_all "nothing here"; ok never true' '1..0 # SKIP nothing here
status 77'
ok "the time limit" gives 'DUITE_TIMEOUT=1; plan_later; exits 124 slow limited sleep 20' 'ok 1 - slow
1..1
status 0'
ok "a script that stops early fails" gives 'plan_later; ok good true; exit 5' 'ok 1 - good
1..1
status 5'
ok "a pipeline fails when its first command does" gives 'plan_later; ok piped eval "cat no-such-file | sort"' 'not ok 1 - piped
# cat: no-such-file: No such file or directory
# (exit status 1)
1..1
status 1'
ok "ranks start as many processes as asked for" gives 'plan_later
three() { test "$(ranks 3 sh -c "echo one" | grep -c one)" = 3; }; ok three three' 'ok 1 - three
1..1
status 0'

results good PASS PASS SKIP
results bad PASS FAIL ERROR
results dead ERROR
ok "sums of cases" sums "2 passed, 0 failed, 1 skipped" "$scratch/good.trs"
ok "a failed script counts by its cases" sums "1 passed, 1 failed, 0 skipped" "$scratch/bad.trs"
ok "a script that died counts once" sums "0 passed, 1 failed, 0 skipped" "$scratch/dead.trs"
ok "sums of files" sums "3 passed, 2 failed, 1 skipped" "$scratch/good.trs" "$scratch/bad.trs" "$scratch/dead.trs"
ok "sums of nothing" sums "0 passed, 0 failed, 0 skipped"
