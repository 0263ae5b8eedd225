#!/bin/sh
# Policies from shared libraries: the scheduler of docs/policies.md is built and used as that page says, all three kinds of one
# library decide and change no result, and what cannot be loaded is answered.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

document=$srcdir/docs/policies.md
: "${CC:=cc}"
sed 's/nx: [0-9]*/nx: 40/; s/ny: [0-9]*/ny: 40/; s/^name: .*/&\ngrain: 200/' "$srcdir/cloth/scenes/sheet.yaml" > "$scratch/sheet.yaml"
awk '/^```c$/ { inside = 1; next } /^```/ { inside = 0 } inside' "$document" > "$scratch/near.c"
cat > "$scratch/three.c" << 'EOF'
#include <duite_policy.h>
#include <stdio.h>
#include <stdlib.h>
static void say(const char *what)
{
    if (getenv("TALKS"))
        fprintf(stderr, "asked for %s\n", what);
}
static unsigned place(void *state, const duite_ready *task)
{
    (void)state, (void)task, say("a queue");
    return DUITE_SHARED_QUEUE;
}
static duite_end serve(void *state) { (void)state; return DUITE_OLDEST; }
static unsigned victim(void *state, unsigned attempt) { (void)state, (void)attempt; return DUITE_NO_QUEUE; }
static int chain(void *state, const duite_ready *task) { (void)state, (void)task; return 0; }
static int map(const duite_object_graph *graph, int n_ranks, uint64_t seed, int *home)
{
    (void)seed, say("homes");
    for (size_t i = 0; i < graph->n; i++)
        home[i] = n_ranks - 1 - (int)(i % (size_t)n_ranks);
    return 0;
}
static void start(void *state, int rank, int n_ranks, unsigned worker, uint64_t seed)
{
    (void)state, (void)rank, (void)n_ranks, (void)worker, (void)seed, say("balance");
}
static int stay(void *state, const duite_leaf *leaf) { (void)state, (void)leaf; return -1; }
const duite_scheduler duite_own_scheduler = {
    .size = sizeof(duite_scheduler), .name = "mine", .summary = "", .state_size = 8, .place = place, .serve = serve, .victim = victim, .chain = chain};
const duite_mapping duite_own_mapping = {.size = sizeof(duite_mapping), .name = "mine", .summary = "", .map = map};
const duite_balancer duite_own_balancer = {.size = sizeof(duite_balancer), .name = "mine", .summary = "", .state_size = 8, .start = start, .place = stay};
EOF

# shellcheck disable=SC2086 # a list of flags
library() { $CC -O2 -Wall -Wextra -Werror -shared -fPIC -I"$srcdir/runtime" -o "$scratch/$1.so" "$scratch/$1.c"; }
cloth() { # RANKS OPTIONS...
    n=$1
    shift
    (cd "$scratch" && ranks "$n" "$DUITE_CLOTH" sheet.yaml --quiet --end 0.004 --threads 2 --report r.json "$@")
}
hash_of() { sed -n 's/.*"state_hash": "\(.*\)".*/\1/p' "$scratch/r.json"; }
same_as_steal() { # RANKS OPTIONS...
    cloth "$1" && wanted=$(hash_of) && rm "$scratch/r.json" && cloth "$@" && test -n "$wanted" && test "$(hash_of)" = "$wanted"
}
talks() { TALKS=1 cloth "$@" > "$scratch/said" 2>&1 && for what in "a queue" homes balance; do
        grep -qx "asked for $what" "$scratch/said" || return 1; done; }
says() { grep -q "^duite: rank [01]: worker [01].* is in the place of scheduler hangs, which has not returned" "$scratch/said"; }
named() { # COMMAND...: says who does not return, and then, since that one does, ends as it should
    rm -f "$scratch/named" "$scratch/said" # what the command before said is not taken for this one's
    (export DUITE_STUCK_SECONDS=0.2 NAMED="$scratch/named" && "$@") > "$scratch/said" 2>&1 &
    pid=$!
    awaits $pid says
    touch "$scratch/named"
    status=0
    wait $pid || status=$?
    cat "$scratch/said"
    test $status = 0 && says
}
named_and_right() { # RANKS OPTIONS...
    cloth 1 && wanted=$(hash_of) && named cloth "$@" && test -n "$wanted" && test "$(hash_of)" = "$wanted"
}
refused() { # SENTENCE OPTIONS...
    sentence=$1
    shift
    status=0
    cloth 1 "$@" > "$scratch/said" 2>&1 || status=$?
    cat "$scratch/said"
    test $status = 2 && grep -q "$sentence" "$scratch/said"
}

DUITE_CLOTH=$(cd "$(dirname "$DUITE_CLOTH")" && pwd)/duite-cloth
ok "the page's scheduler compiles" library near
ok "it is used, and changes nothing" same_as_steal 1 --scheduler ./near.so
ok "nor on two ranks" same_as_steal 2 --scheduler ./near.so
ok "three policies in a library" library three
ok "all three are asked" talks 2 --scheduler ./three.so --mapping ./three.so --balance ./three.so
by_the_environment() { (export DUITE_SCHEDULER=./three.so DUITE_MAPPING=./three.so DUITE_BALANCE=./three.so && talks "$@"); }
ok "by the environment, too" by_the_environment 2
report_names() { grep -q '"scheduler": "./three.so"' "$scratch/r.json" && grep -q '"balance": "./three.so"' "$scratch/r.json"; }
ok "and the report names them" report_names
ok "and change nothing" same_as_steal 2 --scheduler ./three.so --mapping ./three.so --balance ./three.so
for mapping in block random; do ok "mapping $mapping changes nothing" same_as_steal 3 --mapping $mapping; done
ok "a file that is not there" refused "duite-cloth: --scheduler ./no.so: the scheduler cannot be loaded: .*no.so" --scheduler ./no.so
ok "a library without a mapping" refused "duite-cloth: --mapping ./near.so: the library defines no duite_own_mapping" --mapping ./near.so
ok "a name that is none" refused "there is no balancer of this name; known are none, .*, and shared libraries" --balance near.so

cp "$srcdir/tests/support/hangs.c" "$scratch"
ok "a scheduler that returns late" library hangs
for n in 1 2; do ok "is named on $n ranks, and the state is right" named_and_right $n --scheduler ./hangs.so; done
