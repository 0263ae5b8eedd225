#!/bin/sh
# duite-compare on tiny graphs and a tiny scene: all files are there, an interrupted comparison goes on, what cannot be is told.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

bin=$PWD
# A user's general settings for programs of duite, even if they make no sense, are not compared.
tiny() {
    (export DUITE_SCHEDULER=nobody DUITE_MAPPING=nowhere DUITE_BALANCE=never DUITE_THREADS=none DUITE_SEED=no DUITE_TRACE=/no/such/folder/trace
     cd "$scratch" && DUITE_REPORT=/no/such/folder/report limited "$bin/duite-compare" "$@" --tasks 40 --cost 1e-6 --steps 2 --seed 3)
}
of_scenes() { if test -x "$DUITE_CLOTH"; then ok "$@"; else skip "$1" "configure --disable-cloth"; fi; }
product="stencil irregular --scheduler steal,priority --mapping block,list --ranks 1,2 --threads 1"

first() { # shellcheck disable=SC2086 # a list of options
    tiny $product --rounds 1 --output c > "$scratch/said" || { cat "$scratch/said" && return 1; }
    test "$(grep -c ',fine$' "$scratch/c/summary.csv")" = 16 && test "$(wc -l < "$scratch/c/summary.csv")" = 17 &&
        grep -q "^build: duite" "$scratch/c/about.txt" && grep -q "seed 3" "$scratch/said" &&
        grep -q "<h2>irregular</h2>" "$scratch/c/compare.html"
}
# The last line is cut off in the middle, and another round asked for.
again() { # shellcheck disable=SC2086
    kept=$(head -n 9 "$scratch/c/summary.csv")
    printf '%s\n0,stencil,0' "$kept" > "$scratch/c/summary.csv"
    before=$(grep -c ',fine$' "$scratch/c/summary.csv")
    tiny $product --rounds 2 --output c > "$scratch/said" || { cat "$scratch/said" && return 1; }
    grep -qx "$before runs are there already" "$scratch/said" && test "$(grep -c ',fine$' "$scratch/c/summary.csv")" = 32
}
# Another scheduler: what ran is kept, and the page says that its runs were not in turns with the others'.
grown() { # shellcheck disable=SC2086
    tiny $product --scheduler priority,locality,steal --rounds 2 --output c > "$scratch/said" 2>&1 || { cat "$scratch/said" && return 1; }
    cat "$scratch/said"
    grep -qx "32 runs are there already" "$scratch/said" && test "$(grep -c ',fine$' "$scratch/c/summary.csv")" = 48 &&
        grep '^Warning: .*, scheduler locality and 7 others joined later' "$scratch/c/compare.html" &&
        tiny $product --scheduler priority,locality,steal --rounds 2 --output c > "$scratch/said" 2>&1 &&
        grep -qx "48 runs are there already" "$scratch/said" && test "$(grep -c 'joined later' "$scratch/c/compare.html")" = 1
}
# Two rounds tell nothing, whatever their ratios are. A second one has runs, and the page whose they are.
told() {
    grep '^<tr>' "$scratch/c/compare.html"
    ! grep -q '<td>within the noise\|<td>slower' "$scratch/c/compare.html" && test "$(grep -c '<td>too few rounds</td>' "$scratch/c/compare.html")" = 22 &&
        grep -qx "revision: $(git -C "$top" describe --always --dirty --abbrev=12 2> /dev/null || echo unknown)" "$scratch/c/compare.html" &&
        grep -qx "processor: ..*" "$scratch/c/compare.html" && grep -qx "cores: [1-9][0-9]*" "$scratch/c/compare.html" &&
        grep -qx "mpi: .*[0-9].*" "$scratch/c/compare.html"
}
# With rounds enough: what is three times as long is slower, and what is as long is not.
judged() {
    refused 0 "6 rounds" tree --threads 1 --mapping block,cyclic --grain 1 --rounds 6 --output j || return 1
    cp "$scratch/j/summary.csv" "$scratch/six"
    sed 's/^\([0-5],tree,1,1,1,none,\)\(block\|cyclic\),steal,[^,]*,/\1\2,steal,1e-3,/; s/,cyclic,steal,1e-3,/,cyclic,steal,3e-3,/' "$scratch/six" > "$scratch/j/summary.csv"
    refused 0 "12 runs are there already" tree --threads 1 --mapping block,cyclic --grain 1 --rounds 6 --output j &&
        grep '^<tr><td>cyclic</td>.*>3.000 .*<td>slower</td>' "$scratch/j/compare.html" || return 1
    sed -i 's/^0\(,.*,cyclic,steal,\)3e-3,/0\10.9e-3,/' "$scratch/j/summary.csv"
    refused 0 "12 runs are there already" tree --threads 1 --mapping block,cyclic --grain 1 --rounds 6 --output j &&
        grep '^<tr><td>cyclic</td>.*>3.000 .*<td>within the noise</td>' "$scratch/j/compare.html"
}
# The runs of another build stay, with a warning that names it.
other_build() { # shellcheck disable=SC2086
    sed -i 's/^revision: .*/revision: 0123456789ab/' "$scratch/j/about.txt"
    refused 0 "warning: runs that were there already are of another build: revision: 0123456789ab" tree --threads 1 --mapping block,cyclic \
        --grain 1 --rounds 6 --output j && grep -q "another build: revision: 0123456789ab" "$scratch/j/compare.html"
}
refused() { # STATUS SENTENCE OPTIONS...
    wanted=$1 sentence=$2
    shift 2
    status=0
    tiny "$@" > "$scratch/said" 2>&1 || status=$?
    cat "$scratch/said"
    test $status = "$wanted" && grep -q "$sentence" "$scratch/said"
}
wrong() { # shellcheck disable=SC2086
    last=$(grep -n ',fine$' "$scratch/c/summary.csv" | tail -n 1 | cut -d : -f 1) # a warning may follow
    sed -i "${last}s/,[0-9a-f]\{16\},/,0123456789abcdef,/" "$scratch/c/summary.csv"
    refused 1 "WRONG: .* hash" $product --scheduler priority,locality,steal --rounds 3 --output c
}
full() {
    mkdir "$scratch/full" && ln -s /dev/full "$scratch/full/summary.csv" && refused 1 "No space left" tree --output full
}
hash_of() { (cd "$scratch" && "$bin/duite-graph" "$@" --tasks 40 --cost 1e-6 --rounds 1 --threads 1) | sed -n 's/.*hash": "\(.*\)"/\1/p'; }
graph_file() {
    hash_of irregular --save g.graph
    test -n "$(hash_of g.graph)" && test "$(hash_of g.graph)" = "$(hash_of irregular)"
}
of_a_trace() { # its blocks stay together, so that two ranks send what blocks show each other
    "$DUITE_CLOTH" "$top/cloth/scenes/sheet.yaml" --set 'cloths[0].mesh.grid.nx=12' --set 'cloths[0].mesh.grid.ny=12' --grain 40 \
        --end 0.002 --threads 1 --quiet --trace "$scratch/t" && ./duite-trace "$scratch/t" --graph "$scratch/t.graph" &&
        (cd "$scratch" && "$bin/duite-graph" t.graph --rounds 1 --threads 1 && ranks 2 "$bin/duite-graph" t.graph --rounds 1 --threads 1) > "$scratch/said"
    cat "$scratch/said"
    test "$(sed -n 's/.*hash": "\(.*\)"/\1/p' "$scratch/said" | sort -u | wc -l)" = 1 && grep -q '"messages": [1-9]' "$scratch/said"
}
bad_file() {
    printf 'duite-graph 1\n1e-6 8 0\n1e-6 8 1 1\n' > "$scratch/bad.graph"
    ! hash_of bad.graph 2> "$scratch/said" || test -z "$(hash_of bad.graph 2> "$scratch/said")"
    grep -q "bad.graph:3: .* tasks before it" "$scratch/said"
}
scene() {
    refused 0 "sheet.yaml" "$top/cloth/scenes/sheet.yaml" --set 'cloths[0].mesh.grid.nx=12' --set 'cloths[0].mesh.grid.ny=12' \
        --set time.end=0.002 --grain 40,70 --rounds 1 --output s && test "$(grep -c ',fine$' "$scratch/s/summary.csv")" = 2
}

top=$(cd "$srcdir" && pwd)
ok "a product of graphs" first
ok "it goes on where it was interrupted" again
ok "a list grows" grown
ok "two rounds are too few, and the page says where they ran" told
ok "six rounds are not" judged
ok "runs of another build" other_build
ok "a folder of another comparison" refused 1 "another comparison" stencil --output c
ok "... or of other scenes" eval 'refused 1 "another comparison" $product --scheduler priority,locality,steal --set a=1 --output c'
ok "a wrong result is told" wrong
of_scenes "a scene over grains" scene
ok "a graph from a file is the same" graph_file
of_scenes "... and so is that of a trace, on any number of ranks" of_a_trace
ok "a damaged one names its line" bad_file
ok "a full disk" full
ok "an unknown scheduler lists the known ones" refused 2 "known are steal, locality" tree --scheduler best
# Every runtime leaves the same results, on every kind of rows: those of other runtimes that were built, forks and replays, two ranks.
alike() {
    members=steal,forks:steal$others
    refused 0 "$((8 * (4 + n_others))) configurations" stencil nearest fft spread tree random cholesky irregular --scheduler "$members" --threads 2 --ranks 1,2 \
        --rounds 1 --output alike && test "$(grep -c ',fine$' "$scratch/alike/summary.csv")" = $((8 * (4 + n_others))) &&
        test "$(sed -n 's/.*,\([0-9a-f]\{16\}\),fine$/\1/p' "$scratch/alike/summary.csv" | sort -u | wc -l)" = 8
}
unknown_there() { # RUNTIME NAME
    refuses "there is no scheduler of this name; known are" limited "$bin/bench/rivals/$1-graph" irregular --scheduler nope &&
        refused 2 "$1:nope: there is no scheduler of this name; known are .*$2" irregular --scheduler "steal,$1:nope" --output n && test ! -e "$scratch/n"
}
starpu_runs() {
    STARPU_SCHED=nope refused 0 "1 rounds" irregular --scheduler starpu:eager --rounds 1 --output e &&
        test "$(grep -c '^0,irregular,.*,starpu:eager,.*,fine$' "$scratch/e/summary.csv")" = 1 && ! grep nope "$scratch/e/run.log"
}
others='' n_others=0
for other in starpu:lws libgomp:tasks libomp:tasks mpi:isend; do
    test -x "$bin/bench/rivals/${other%:*}-graph" || continue
    others=$others,$other n_others=$((n_others + 1))
    ok "a scheduler that ${other%:*} does not have lists those that it has" unknown_there "${other%:*}" "${other#*:}"
done
ok "forks, replays and other runtimes leave the same ($others)" alike
if test -x "$bin/bench/rivals/starpu-graph"; then ok "StarPU's is the one asked for, also if the environment names another" starpu_runs; fi
mkdir "$scratch/alone" && cp "$bin/duite-compare" "$bin/duite-graph" "$scratch/alone" # no rivals beside it
ok "StarPU's twin is not there" refuses "alone/bench/rivals/starpu-graph is not there" limited "$scratch/alone/duite-compare" \
    irregular --scheduler starpu:lws --output "$scratch/n"
ok "duite-graph has none of StarPU's schedulers" refuses "bench/rivals/starpu-graph --schedulers lists them" limited "$bin/duite-graph" \
    irregular --scheduler starpu:lws
# How short tasks may be, from made-up times: grains of half, the whole and four times a microsecond take 1.5, 2 and 4 us a task of 39.
metg() {
    set -- tree random spread:3 --metg --scheduler steal --threads 1 --grain 0.5,1,4 --rounds 1 --output m
    refused 0 "9 configurations, 1 rounds" "$@" || return 1
    sed -i 's/^\(0,tree,0.5,.*,steal\),[^,]*,/\1,58.5e-6,/; s/^\(0,tree,1,.*,steal\),[^,]*,/\1,78e-6,/; s/^\(0,tree,4,.*,steal\),[^,]*,/\1,156e-6,/' "$scratch/m/summary.csv"
    refused 0 "^| tree *|  *2 |$" "$@" || return 1
    cat "$scratch/m/metg.csv"
    grep -q "^| spread:3 *| " "$scratch/m/compare.html" && grep -qx "| tree *|  *2 |" "$scratch/m/compare.html" && grep -qx "tree,1,1,none,metis,steal,1.5,0.3333" "$scratch/m/metg.csv" &&
        grep -qx "tree,1,1,none,metis,steal,4,1.0000" "$scratch/m/metg.csv" && test "$(grep -c '^random,' "$scratch/m/metg.csv")" = 3 &&
        test "$(grep -c '^<title>tree: efficiency' "$scratch/m/compare.html")" = 1
}
metg_by_itself() { # six kinds, all that is there; what is not is named
    status=0
    (cd "$scratch" && limited alone/duite-compare --metg --tasks 40 --cost 1e-6 --grain 1,2 --steps 2 --rounds 1 --output a > said 2>&1) || status=$?
    cat "$scratch/said"
    test $status = 0 && grep -q "^without libomp:tasks: .*libomp-graph is not there" "$scratch/said" &&
        grep -q "^24 configurations, 1 rounds" "$scratch/said" && test "$(grep -c '^| [a-z]* *| *[&lgt;]* *[0-9.]* | *[&lgt;]* *[0-9.]* |$' "$scratch/a/compare.html")" = 6
}
ok "METG: the curves of two kinds" metg
ok "... by one command" metg_by_itself
ok "... of a file" refused 2 "metg: ./g.graph: one of stencil, .* is expected" --metg ./g.graph --output u
ok "... of a grain that is none" refused 2 "grain 0: a number above 0" --metg tree --grain 0 --output u
# A member that fails beside one that does not: the page names it and says why; no table and no file has a figure of it.
failed() {
    refused 1 "duite-compare: 2 runs failed: f/compare.html says which, and why" tree --threads 1,5000 --rounds 2 --output f || return 1
    cat "$scratch/f/summary.csv"
    grep -q ": 5000: failed; exit status 1: duite-graph: .*5000 threads are more than 4096" "$scratch/said" &&
        grep -q "^- tree, threads 5000: 2 of 2 runs; the first: exit status 1: duite-graph: .*5000 threads" "$scratch/f/compare.html" &&
        grep -qx '<tr><td>5000</td>\(<td[^>]*></td>\)\{6\}<td>failed</td></tr>' "$scratch/f/compare.html" &&
        test "$(grep -cx "[01],tree,0,1,5000,none,metis,steal,,,,,,,failed" "$scratch/f/summary.csv")" = 2 &&
        grep -q "5000 threads" "$scratch/f/failed.log" && ! grep -iw nan "$scratch/said" "$scratch/f/"*.csv "$scratch/f/compare.html"
}
all_failed() {
    refused 1 "duite-compare: 1 run failed: u/compare.html" "$top/cloth/scenes/sheet.yaml" --set grain=0 --rounds 1 --output u &&
        grep -q "^- .*sheet.yaml: 1 of 1 runs; exit status [1-9][0-9]*: duite-cloth: .*grain" "$scratch/u/compare.html" &&
        ! grep "<svg" "$scratch/u/compare.html"
}
timed_out() {
    (cd "$scratch" && limited "$bin/duite-compare" tree --tasks 4000 --cost 1 --timeout 1 --rounds 1 --output late > said 2>&1) && return 1
    cat "$scratch/said"
    grep -q "failed; stopped after 1 s (--timeout)" "$scratch/said"
}
# A member whose policy never returns beside one that does: stopped, named, not tried again; the other has all its figures.
hangs() { ${CC:-cc} -Wall -Wextra -Werror -shared -fPIC -I"$top/runtime" -o "$scratch/hangs.so" "$top/tests/support/hangs.c"; }
stopped() { # RANKS...
    members=$#
    refused 1 "duite-compare: $((3 * members)) runs failed: h/compare.html" tree --scheduler steal,./hangs.so --ranks "$(echo "$*" | tr ' ' ,)" \
        --timeout 10 --rounds 3 --output h || return 1
    grep '^- ' "$scratch/h/compare.html"
    for n; do
        test "$members" = 1 || member="ranks $n, "
        grep -q "^- tree, ${member:-}scheduler ./hangs.so: 3 of 3 runs; the first: stopped after 10 s (--timeout): \
duite: rank [01]: worker [01].* is in the place of scheduler hangs, which has not returned" "$scratch/h/compare.html" || return 1
    done
    test "$(grep -c ": failed; not tried again" "$scratch/said")" = $((2 * members)) && test "$(grep -c ',steal,.*,fine$' "$scratch/h/summary.csv")" = $((3 * members))
}
stopped_alone() {
    status=0
    limited "$bin/duite-graph" tree --scheduler "$scratch/hangs.so" --timeout 1 > "$scratch/said" 2>&1 || status=$?
    cat "$scratch/said"
    test $status = 1 && grep -qx "duite-graph: stopped after 1 s (--timeout)" "$scratch/said"
}
# Loops on all cores. The page of a comparison that is taken up again has the warning, too.
busy() {
    loops=
    for _ in $(seq "$(nproc)"); do
        sh -c 'while :; do :; done' &
        loops="$loops $!"
    done
    (cd "$scratch" && limited "$bin/duite-compare" tree --threads 1 --tasks 40 --cost 0.01 --steps 1 --rounds 1 --output b > said 2>&1)
    status=$?
    # shellcheck disable=SC2086
    kill $loops && wait $loops 2> /dev/null
    cat "$scratch/said"
    grep '^duite-compare: warning: in round 1 other programs took [0-9.]* of [0-9]* cores' "$scratch/said" > "$scratch/warned" && test $status = 0 &&
        sed 's/^duite-compare: warning: \(.*\)$/Warning: \1./' "$scratch/warned" | grep -Fxcf - "$scratch/b/compare.html" || return 1
    (cd "$scratch" && limited "$bin/duite-compare" tree --threads 1 --tasks 40 --cost 0.01 --steps 1 --rounds 1 --output b) &&
        sed 's/^duite-compare: warning: \(.*\)$/Warning: \1./' "$scratch/warned" | grep -Fxcf - "$scratch/b/compare.html"
}
ok "a member that fails is named with its reason, and has no figures" failed
of_scenes "... also if all fail" all_failed
ok "... or one takes too long" timed_out
ok "a scheduler that never returns" hangs
if quick; then numbers=2; else numbers="1 2"; fi
# shellcheck disable=SC2086 # a list
ok "... is stopped at the limit and named, and the others go on" stopped $numbers
ok "... and by duite-graph at its own" stopped_alone
ok "a machine that is busy draws a warning" busy
for kind in tree:4 stencil: stencil:0 stencil:x stencil:1000001; do
    ok "rows of $kind" refused 2 "there is no kind of graph $kind; .* width of rows from 1 to 1000000" "$kind" --output u
done
ok "an unknown kind of graph" refused 2 "there is no kind of graph ring; known are stencil, .* chain, and files" ring --output u
ok "a scene that is not there" refused 2 "none.yaml: No such file or directory" tree none.yaml --output u
ok "a set without a value" refused 2 "set grain: KEY=VALUE is expected" tree --set grain --output u

# A script that is no program of duite. FAIL, SLEEP and SILENT: it fails, hangs, prints no figure on this many threads.
cat > "$scratch/any.sh" << 'END'
if test "$OMP_NUM_THREADS" = "${SLEEP-no}"; then sleep 100; fi
if test "$OMP_NUM_THREADS" = "${FAIL-no}"; then echo "any: no such thing" >&2 && exit 3; fi
echo "arguments $* threads $OMP_NUM_THREADS $DUITE_THREADS $STARPU_NCPU scheduler ${DUITE_SCHEDULER-none} kind $KIND" >> all
test "$OMP_NUM_THREADS" = "${SILENT-no}" || printf 'took 99 s of 9\ntook %s0.5 s of %s\n' "$1" "${OMPI_COMM_WORLD_SIZE-${PMI_SIZE-1}}"
echo bye
END
any() { # STATUS SENTENCE OPTIONS...
    wanted=$1 sentence=$2 status=0
    shift 2
    (cd "$scratch" && limited "$bin/duite-compare" --seed 3 "$@" > said 2>&1) || status=$?
    cat "$scratch/said"
    test $status = "$wanted" && grep -q -- "$sentence" "$scratch/said"
}
program() { # the lists come by the environment and in arguments; $ and blanks keep braces
    any 0 "12 configurations, 2 rounds" --threads 1,2,3 --scheduler steal,priority --vary KIND=a,b --rounds 2 --output any \
        -- sh any.sh '{threads}' '{KIND}-{threads}' '${KIND}' '{ KIND }' --rounds 9 || return 1
    sort "$scratch/all" | uniq -c && cat "$scratch/any/summary.csv"
    test "$(sort "$scratch/all" | uniq -c | grep -c '^ *2 arguments \([123]\) [ab]-\1 ${KIND} { KIND } --rounds 9 threads \1 \1 \1 scheduler [sp]')" = 12 &&
        test "$(grep -c '^[01],sh,,,[123],,,[a-z]*,[ab],[0-9][.0-9e-]*,,,,,,fine$' "$scratch/any/summary.csv")" = 24 &&
        grep -q '^round,subject,grain,ranks,threads,balance,mapping,scheduler,KIND,seconds,.*,result,status$' "$scratch/any/summary.csv" &&
        grep -q '^<pre>sh any.sh {threads} ' "$scratch/any/compare.html" && test "$(grep -c '^<svg' "$scratch/any/compare.html")" = 4
}
program_again() { # longer lists and more rounds; another variable, argument or list is another comparison
    set -- --threads 1,2,3 --scheduler steal,priority --rounds 3 --output any
    any 0 "24 runs are there already" "$@" --vary KIND=a,b,c -- sh any.sh '{threads}' '{KIND}-{threads}' '${KIND}' '{ KIND }' --rounds 9 &&
        test "$(grep -c ',fine$' "$scratch/any/summary.csv")" = 54 &&
        any 1 "another comparison" "$@" --vary KIND=a,b,c -- sh any.sh 7 '{KIND}-{threads}' '${KIND}' '{ KIND }' --rounds 9 &&
        any 1 "another comparison" "$@" --vary KIND=a,b,c --vary MORE=1 -- sh any.sh '{threads}' '{KIND}-{threads}' '${KIND}' '{ KIND }' --rounds 9 &&
        test "$(grep -c ',fine$' "$scratch/any/summary.csv")" = 54
}
figure() { # the last line that matches; the least is first
    any 0 ": 10.5 figure" --threads 2,1 --figure 'took ([0-9.]+) s of' --rounds 1 --output figure -- sh any.sh '{threads}' &&
        grep -qx '0,sh,,,1,,,,10.5,,,,,,fine' "$scratch/figure/summary.csv" && grep -qx '0,sh,,,2,,,,20.5,,,,,,fine' "$scratch/figure/summary.csv" &&
        grep -q '^round,.*,threads,.*,figure,' "$scratch/figure/summary.csv" &&
        grep -q '^<tr><td>1</td><td>10.5 .*<td>fastest</td></tr>$' "$scratch/figure/compare.html"
}
of_ranks() {
    any 0 "2 configurations" --ranks 1,2 --figure 'took .*of ([0-9]+)' --rounds 1 --output ranks -- sh any.sh '{ranks}' &&
        grep -q '^0,sh,,1,,,,,1,' "$scratch/ranks/summary.csv" && grep -q '^0,sh,,2,,,,,2,' "$scratch/ranks/summary.csv"
}
# Each beside members that are fine, whose figures stay.
program_fails() {
    export FAIL=2 SLEEP=3 SILENT=4
    any 1 "6 runs failed" --threads 1,2,3,4 --timeout 1 --figure 'took ([0-9.]+) s of' --rounds 2 --output fails -- sh any.sh '{threads}'
    failed=$?
    unset FAIL SLEEP SILENT
    grep '^- ' "$scratch/fails/compare.html"
    test $failed = 0 && grep -q "threads 2: 2 of 2 runs; the first: exit status 3: any: no such thing" "$scratch/fails/compare.html" &&
        grep -q "threads 3: 2 of 2 runs; the first: stopped after 1 s (--timeout)" "$scratch/fails/compare.html" &&
        grep -q "threads 4: 2 of 2 runs; the first: exit status 0, but --figure finds no number above 0: bye" "$scratch/fails/compare.html" &&
        test "$(grep -c ',1,.*,10.5,.*,fine$' "$scratch/fails/summary.csv")" = 2
}
rank_fails() { # mpirun's words behind the program's are not its last
    FAIL=2 any 1 "exit status 3: any: no such thing" --threads 2 --ranks 2 --rounds 1 --output rank -- sh any.sh 1
}
# A program of duite leaves a report, and the best and the worst leave traces for the page.
reported() {
    any 0 ": 39 figure" --threads 1,2 --figure key=tasks --same key=ranks --rounds 2 --output reported -- "$bin/tests/examples/dot" || return 1
    cat "$scratch/reported/summary.csv"
    test "$(grep -c ',39,,[0-9]*,0,0,1,fine$' "$scratch/reported/summary.csv")" = 4 && test "$(ls "$scratch/reported/"*.trace | wc -l)" = 2 &&
        grep -q "^<h3>The best: .*dot, threads [12]</h3>" "$scratch/reported/compare.html" &&
        grep -q "^<p>A run with a trace.*Lower bound: no schedule of its bodies on [12] workers takes less" "$scratch/reported/compare.html" &&
        grep -q "How long bodies took, by kernel: area the best" "$scratch/reported/compare.html" &&
        test "$(grep -c "critical path" "$scratch/reported/compare.html")" -ge 2 && ! grep -q 'href=\|src=' "$scratch/reported/compare.html"
}
reported_time() { # its time is in bodies and outside of them; what ran with another list keeps its own trace
    any 0 "4 configurations" --threads 1,2 --vary DUITE_SEED=1,2 --rounds 1 --output time -- "$bin/tests/examples/dot" &&
        test "$(grep -c '^0,[^,]*dot,,,[12],,,,[12],[0-9][.0-9]*,[0-9.e-]*,[0-9]*,0,0,,fine$' "$scratch/time/summary.csv")" = 4
}
graph_key() { refused 0 "figure" tree --figure key=tasks --threads 1 --rounds 1 --output k && grep -q '^0,tree,.*,[1-9][0-9]*,,.*,[0-9a-f]\{16\},fine$' "$scratch/k/summary.csv"; }
differs() { # round 2 of one member; what --vary changes may differ
    any 0 "2 configurations" --vary KIND=a,b --same 'is ([a-z]+)' --rounds 2 --output same -- sh -c 'echo it is $KIND' || return 1
    any 1 "WRONG: round 2 of sh has the result [0-9]*, not [0-9]* as round 1 of sh" --vary KIND=a \
        --same 'ran ([0-9]+)' --rounds 2 --output differs -- sh -c 'echo >> count; echo ran $(wc -l < count)' || return 1
    grep -q '^Warning: WRONG: ' "$scratch/differs/compare.html" && test "$(grep -c ',fine$' "$scratch/differs/summary.csv")" = 2
}
ok "any program: lists by the environment and in its arguments" program
ok "... it goes on, and grows" program_again
ok "... its figure is a number in its output" figure
ok "... or a key of its report, and the page has its traces" reported
ok "... whose time in bodies it tells" reported_time
ok "... as does that of a graph" graph_key
ok "... a key that the report has not" any 1 "its report has no number above 0 of the key cost" --figure key=cost --rounds 1 --output cost \
    -- "$bin/tests/examples/dot"
ok "... and no report" any 1 "it left no report, which has the key tasks: it is no program of duite" --figure key=tasks --rounds 1 --output no -- true
ok "... results that differ from run to run" differs
ok "... or are not found" any 1 "exit status 0, but --same finds nothing" --same 'sum ([0-9]+)' --rounds 1 --output not -- true
ok "... ranks by mpirun" of_ranks
ok "... one that fails, hangs, or prints no figure" program_fails
ok "... on a rank of two" rank_fails
ok "... that is not there" any 1 "no-such-program.*No such file" --rounds 1 --output none -- no-such-program
ok "a name in braces without a list" any 2 "{threads} in -n{threads}: no list of this name was given" --ranks 2 -- sh '-n{threads}'
ok "a grain that no argument has" any 2 "a program gets it as {grain} in its arguments only" --grain 2 -- sh any.sh
ok "a variable without values" any 2 "vary KIND: NAME=VALUE,VALUE,... is expected" --vary KIND -- sh any.sh
ok "a name that no variable has" any 2 "vary a b: a name has letters, digits and _ only" --vary 'a b=1' -- sh any.sh
ok "a variable twice" any 2 "vary KIND: there is a list of this name already" --vary KIND=1 --vary KIND=2 -- sh any.sh
ok "a figure that is no regular expression" any 2 "figure (: " --figure '(' -- sh any.sh
ok "a figure without a group" any 2 "a group in parentheses is expected around what is looked for" --figure 'took' -- sh any.sh
ok "a figure without a program" any 2 "a regular expression is for a program after --; key=KEY is for all" tree --figure '(.)'
ok "a key that none can have" any 2 "figure key=a b: a key has letters, digits and _ only" --figure 'key=a b' -- sh any.sh
ok "METG of a program" any 2 "metg is for graphs, not for a program after --" --metg -- sh any.sh
ok "a scene's setting for a program" any 2 "are for scenes and graphs, not for a program" --steps 3 -- sh any.sh
ok "a graph beside a program" any 2 "tree: a scene or graph beside a program" tree -- sh any.sh
ok "a program's name with a comma" any 2 "a comma or line in a name cannot stand in the files" -- ./a,b
ok "a command that is too long" any 2 "at most 10000 letters; put them in a script" -- sh any.sh "$(seq 3000 | tr '\n' ' ')"
