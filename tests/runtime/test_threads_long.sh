#!/bin/sh
# Random programs a hundred times each, in a build with ThreadSanitizer: it must find no race, whatever comes first.
# Window 1 is among them by name, other windows by the seeds.
. "${srcdir:-.}/tests/support/tap.sh"

case "${SANITIZER:-}" in *thread*) ;; *) skip_all "built without --enable-sanitizer=thread" ;; esac
plan_later

# repeat NAME OPTIONS...: the programs of some seeds, a hundred times each
repeat() {
    name=$1
    shift
    ok "$name" limited tests/runtime/random_programs --repeat 100 "$@"
}

DUITE_TIMEOUT=${DUITE_TIMEOUT:-3600}
programs=200
if quick; then programs=2; fi
repeat "$programs programs a hundred times" --base 51000000 --programs $programs
repeat "with window 1" --base 52000000 --programs $programs --window 1
for scheduler in steal fifo lifo priority static shuffle; do
    repeat "by $scheduler on four threads" --base 55000000 --programs $programs --threads 4 --scheduler $scheduler
done
repeat "with repeated forks" --base 57000000 --programs $programs --with repeats --memo 2
ok "programs that nest" limited tests/runtime/random_programs --base 56000000 --programs $((100 * programs)) --with nests
