#!/bin/sh
# The papers' experiments run in tiny sizes and print their tables. With DUITE_LONG=1 all of them.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later
# What a user chose for programs of duite in general, even if it makes no sense, is not what is measured.
export DUITE_SCHEDULER=nobody DUITE_MAPPING=nowhere DUITE_BALANCE=never DUITE_THREADS=none DUITE_SEED=no DUITE_TRACE=/no/such/folder/trace

experiments=$(cd "$srcdir" && pwd)/bench/experiments
mkdir "$scratch/bench" # what it leaves lies there
ln -s "$PWD/duite-cloth" "$PWD/duite-predict" "$scratch"
ln -s "$PWD/bench/compare" "$PWD/bench/contact-partition" "$scratch/bench"
table() { # NAME LINES: so many rows, none of them without figures
    status=0
    (cd "$scratch" && limited sh "$experiments" --quick "$1") > "$scratch/said" 2>&1 || status=$?
    cat "$scratch/said"
    if test $status = 77; then return 0; fi # no hosts here, which it says
    test $status = 0 && test "$(grep -c '^| ' "$scratch/said")" = "$2" && ! grep -q '|  *|  *|.*nan\|inf' "$scratch/said"
}
unknown() {
    status=0
    sh "$experiments" garment > "$scratch/said" 2>&1 || status=$?
    test $status = 2 && grep -q "zara|partutex|resolution|grain|link|scaling|contact-partition" "$scratch/said"
}
ok "an unknown experiment" unknown
ok "resolution" table resolution 3
ok "grain" table grain 8
ok "scaling" table scaling 24
ok "contact-partition" table contact-partition 17
if test "${DUITE_LONG:-}" = 1; then
    ok "zara" table zara 22
    ok "partutex" table partutex 7
    ok "link" table link 9
fi
