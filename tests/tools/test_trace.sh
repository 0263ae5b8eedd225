#!/bin/sh
# Traces: their sums are the counters, viewers can read them, broken files are refused with the byte, and a file that cannot
# be written costs nothing but itself.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
skip_unless ./duite-trace
plan_later

cloth() { # FILE OPTION...: a traced run in the scratch folder
    file=$1
    shift
    "$DUITE_CLOTH" "$srcdir/cloth/scenes/sheet.yaml" --set 'cloths[0].mesh.grid.nx=30' --set 'cloths[0].mesh.grid.ny=30' \
        --set 'cloths[0].pins=[]' --grain 100 --end 0.004 --quiet --trace "$scratch/$file" "$@"
}

untraced() {
    "$DUITE_CLOTH" "$srcdir/cloth/scenes/sheet.yaml" --set 'cloths[0].mesh.grid.nx=30' --set 'cloths[0].mesh.grid.ny=30' \
        --set 'cloths[0].pins=[]' --grain 100 --end 0.004 --quiet --report "$scratch/plain.json"
}

hash_of() { sed -n 's/.*"state_hash": "\(.*\)".*/\1/p' "$scratch/$1"; }

same_result() { untraced && test -n "$(hash_of plain.json)" && test "$(hash_of plain.json)" = "$(hash_of "$1")"; }

ok "a traced run on 2 threads" cloth two --threads 2 --report "$scratch/two.json"
ok "the result is that of an untraced one" same_result two.json
ok "events add up to the counters" ./duite-trace --check "$scratch/two"
ok "traced on 2 ranks" eval 'limited "${MPIRUN:-mpirun}" -n 2 "$DUITE_CLOTH" \
    "$srcdir/cloth/scenes/sheet.yaml" --set "cloths[0].mesh.grid.nx=30" --set "cloths[0].mesh.grid.ny=30" \
    --set "cloths[0].pins=[]" --grain 100 --end 0.004 --threads 2 --balance scatter --quiet --trace "$scratch/ranks"'
ok "events of 2 ranks add up, messages and delegated tasks too" ./duite-trace --check "$scratch/ranks"

added() { # kernels that the program adds while it runs
    (DUITE_TRACE=$scratch/added; export DUITE_TRACE; ranks 2 tests/runtime/ranks kernels) > "$scratch/said" &&
        ./duite-trace --check "$scratch/added" && ./duite-trace "$scratch/added" | grep '^ *many 39 '
}
ok "kernels that are added have their names" added

# Each share is there once; together they are the workers' time. On ranks some of it goes to messages, if only a moment.
states=paje.worker_state.csv
shares() { # FILE EVENTS: whether there are any of messages
    ./duite-trace "$scratch/$1" > "$scratch/table"
    cat "$scratch/table"
    ./duite-trace "$scratch/$1" --csv "$scratch/$1.csv" > /dev/null && test "$(grep -c ',messages,' "$scratch/$1.csv/$states")" "$2" 0 || return 1
    sed -n "/of the workers' time/,/kernel/p" "$scratch/table" | awk '
        /%/ { if ($1 in share) twice = 1; share[$1] = $2 + 0; sum += $2; n++ }
        END { exit !(n == 6 && !twice && sum > 99.6 && sum < 100.4 && "busy" in share && "own" in share &&
            "rest" in share && "messages" in share) }'
}
ok "what the workers did adds up to their time" shares two -eq
ok "... on 2 ranks, too, where messages take some" shares ranks -gt

bounds() { # positive; the path not above the bound, the bound not above the run
    sed -n 's/.*"critical_path_seconds": \(.*\),/path \1/p; s/.*"lower_bound_seconds": \(.*\),/bound \1/p
        s/.*"graphs_recorded": \(.*\),/graphs \1/p' "$scratch/two.json" | tee "$scratch/bounds"
    limit=$(./duite-trace "$scratch/two" | sed -n 's/  time *\(.*\) s/\1/p')
    awk -v limit="$limit" '{ v[$1] = $2 } END { exit !(v["path"] > 0 && v["bound"] >= v["path"] && v["bound"] <= limit && v["graphs"] > 0) }' \
        "$scratch/bounds"
}
ok "the report has critical path and lower bound" bounds
ok "... which are null without a trace" grep '"lower_bound_seconds": null' "$scratch/plain.json"

bound_is_told() {
    ./duite-trace "$scratch/ranks" | sed -n 's/.*agree within \(.*\) us/\1/p' | awk '{ exit !($1 > 0 && $1 < 1e5) }'
}
ok "clocks are aligned within a bound" bound_is_told

# ---- What viewers get ----

csv_is_whole() { # FILE: as StarVZ reads it, each number a number
    ./duite-trace "$scratch/$1" --csv "$scratch/$1.csv" && awk -F, '
        FNR == 1 { columns = NF; table++; next }
        NF != columns { print; bad = 1 }
        table == 1 && ($4 !~ /^-?[0-9.]+$/ || $5 < $4 + 0 || $6 !~ /^[0-9.]+$/ || $7 !~ /^[0-9]+$/ || $1 $3 != "StateWorker State") { print; bad = 1 }
        table == 1 { n[$21]++; if (($13 != "") != ($21 == "task")) { print; bad = 1 } }
        table == 2 { n[$3]++ }
        table == 3 && $8 != $9 { links++ }
        table == 4 && $3 == "Worker" { workers++ }
        END { print n["task"], n["runtime"], n["step"], n["send"] + 0, links + 0
              exit bad || n["task"] < 100 || !n["runtime"] || !n["step"] || n["step"] % 4 || links + 0 != n["send"] + 0 || workers != wanted }' \
        wanted="$2" "$scratch/$1.csv/$states" "$scratch/$1.csv/paje.events.csv" "$scratch/$1.csv/paje.link.csv" "$scratch/$1.csv/entities.csv"
}
# By the nesting that Depth tells, the bodies of a worker do not overlap; pandas reads the tables, or else csv does.
csv_is_nested() {
    python3 -c '
import csv, sys
try:
    import pandas
    rows = pandas.read_csv(sys.argv[1]).to_dict("records")
except ImportError:
    rows = list(csv.DictReader(open(sys.argv[1])))
last = {}
for row in sorted(rows, key=lambda row: (float(row["Start"]), -float(row["End"]))):
    place = row["ResourceId"], int(row["Depth"])
    assert float(row["Start"]) >= last.get(place, -1) - 2e-6, row
    if place[1]:
        assert float(row["End"]) <= last[place[0], place[1] - 1] + 2e-6, row
    last[place] = float(row["End"])
print(len(rows), "spans,", max(int(row["Depth"]) for row in rows), "deep")' "$scratch/$1.csv/$states"
}
paje_is_whole() { # times in order, each pop after a push of its own worker, none left; a link of another rank for each send
    ./duite-trace "$scratch/$1" --paje "$scratch/$1.paje" && awk '
        /^[6789] / { if ($2 + 0 < last) { print "goes back: " $0; bad = 1 } last = $2 + 0 }
        $1 == 5 { known[$3] = 1 }
        $1 == 7 { if (!known[$4]) bad = 1; depth[$4]++; n++ }
        $1 == 8 { if (--depth[$4] < 0) { print "nothing to pop: " $0; bad = 1 } }
        $1 == 9 && /"send"/ { sends++; sent[$2, $4] = 1 }
        $1 == 5 && $4 == "W" { rank[$3] = $5 }
        $1 == 11 { if (!(($2, $5) in sent) || $7 in from) { print "no such send: " $0; bad = 1 } from[$7] = $5; links++ }
        $1 == 12 { if (!($7 in from) || rank[from[$7]] == rank[$5]) { print "goes nowhere: " $0; bad = 1 } ends++ }
        END { for (w in depth) if (depth[w]) { print "left open: " w; bad = 1 }
              print sends + 0, "sends,", links + 0, "links,", ends + 0, "ends"
              exit bad || n < 100 || links != sends || ends != sends || (sends > 100) != wanted }' wanted="$2" "$scratch/$1.paje"
}
pj_dump_agrees() { # as many states, events and links as the tables have
    pj_dump "$scratch/$1.paje" > "$scratch/dumped" && awk -F', *' '{ n[$1]++ } END { print n["State"] + 0, n["Event"] + 0, n["Link"] + 0 }' \
        "$scratch/dumped" | tee "$scratch/counts"
    awk -F, 'FNR == 1 { table++; next } table > 1 || $6 > 0 { n[table]++ } END { print n[1] + 0, n[2] + 0, n[3] + 0 }' \
        "$scratch/$1.csv/$states" "$scratch/$1.csv/paje.events.csv" "$scratch/$1.csv/paje.link.csv" | tee "$scratch/wanted"
    cmp "$scratch/counts" "$scratch/wanted"
}
otf2_is_whole() { # each region is left where it was entered last, as often as the tables say; a message is received for each that is sent
    ./duite-trace "$scratch/$1" --otf2 "$scratch/$1.otf2" && otf2-print "$scratch/$1.otf2/traces.otf2" > "$scratch/printed" 2> "$scratch/warned" &&
        test ! -s "$scratch/warned" && otf2-print -G "$scratch/$1.otf2/traces.otf2" > "$scratch/defined" && awk '
        $1 == "ENTER" { open[$2, ++depth[$2]] = $0; sub(/.*Region: /, "", open[$2, depth[$2]]); n++; if ($3 + 0 < at[$2]) bad = 1; at[$2] = $3 + 0 }
        $1 == "LEAVE" { left = $0; sub(/.*Region: /, "", left); if (!depth[$2] || open[$2, depth[$2]--] != left) { print; bad = 1 } }
        $1 == "MPI_SEND" { sent++ }
        $1 == "MPI_RECV" { received++ }
        END { for (w in depth) if (depth[w]) bad = 1; print n, sent + 0, received + 0; exit bad }' "$scratch/printed" > "$scratch/counts"
    status=$?
    cat "$scratch/counts"
    awk -F, 'FNR == 1 { table++; next } table > 1 || $6 > 0 { n[table]++ } END { print n[1] + 0, n[2] + 0, n[2] + 0 }' \
        "$scratch/$1.csv/$states" "$scratch/$1.csv/paje.link.csv" | tee "$scratch/wanted"
    cmp "$scratch/counts" "$scratch/wanted" && test "$(grep -c '^LOCATION .*rank . worker' "$scratch/defined")" = "$(grep -c ,Worker, "$scratch/$1.csv/entities.csv")" &&
        test $status = 0
}
otf2_is_missing() {
    ./duite-trace "$scratch/$1" --otf2 "$scratch/none" 2> "$scratch/said"
    test $? = 1 && grep libopen-trace-format2-dev "$scratch/said"
}
chrome_is_json() { # as Perfetto takes it: no process or thread 0, no time below 0, spans of a thread nested or apart, all named
    ./duite-trace "$scratch/$1" --chrome "$scratch/$1.json" && python3 -c '
import json, sys
from collections import defaultdict
events = json.load(open(sys.argv[1]))["traceEvents"]
ranks = int(sys.argv[2])
tasks = [e for e in events if e.get("cat") == "task"]
assert len(tasks) > 100 and all(e["ph"] == "X" for e in tasks)
assert {e["pid"] for e in tasks} <= set(range(1, ranks + 1))
named = {(e["pid"], e["tid"]): e["args"]["name"] for e in events if e["name"] == "thread_name"}
assert len(named) == 2 * ranks and len({t for p, t in named}) == len(named) and min(t for p, t in named) > 0
assert {e["pid"]: e["args"]["name"] for e in events if e["name"] == "process_name"} == {r + 1: "rank %d" % r for r in range(ranks)}
spans = defaultdict(list)
for e in events:
    assert (e["pid"], e["tid"]) in named and e["ph"] in "MXisf", e
    assert e["ph"] == "M" or e["ts"] >= 0 and e.get("dur", 0) >= 0, e
    if e["ph"] == "X":
        begin = round(1000 * e["ts"])
        spans[e["tid"]].append((begin, -begin - round(1000 * e["dur"])))
# ... and in doubles of microseconds, as viewers add them.
for tid in spans:
    open_until = []
    for e in sorted((e for e in events if e["ph"] == "X" and e["tid"] == tid), key=lambda e: (e["ts"], -e["dur"])):
        while open_until and open_until[-1] <= e["ts"]:
            open_until.pop()
        assert not open_until or e["ts"] + e["dur"] <= open_until[-1] + 1e-6, (e, open_until)
        open_until.append(e["ts"] + e["dur"])
for row in spans.values():
    open_until = []
    for begin, end in sorted(row):
        while open_until and open_until[-1] <= begin:
            open_until.pop()
        assert not open_until or -end <= open_until[-1], (begin, -end, open_until)
        open_until.append(-end)
# Arrows: Perfetto binds an end to what began last on its thread. So a start lies at its send, and behind it in the file.
flows, behind, sends = {}, set(), 0
for e in events:
    if e["ph"] == "i" and e["cat"] in ("send", "receive"):
        behind.add((e["cat"], e["tid"], e["ts"]))
        sends += e["cat"] == "send"
    elif e["ph"] == "s":
        assert ("send", e["tid"], e["ts"]) in behind and e["id"] not in flows, e
        flows[e["id"]] = e
    elif e["ph"] == "f":
        start = flows[e["id"]]
        assert start is not None and (start["name"], start["cat"]) == (e["name"], e["cat"]) and e["bp"] == "e", e
        assert e["pid"] != start["pid"] and e["ts"] > start["ts"], (start, e)
        flows[e["id"]] = None
print(sends, "sends,", len(flows), "arrows")
assert len(flows) == sends and not any(flows.values()) and (sends > 100) == (ranks > 1)' "$scratch/$1.json" "$2"
}
for trace in two ranks; do
    ok "CSV of $trace" csv_is_whole $trace "$(test $trace = two && echo 2 || echo 4)"
    ok "Paje of $trace" paje_is_whole $trace "$(test $trace = two && echo 0 || echo 1)"
    if command -v python3 > /dev/null; then
        ok "... whose spans lie in one another" csv_is_nested $trace
        ok "Chrome's JSON of $trace" chrome_is_json $trace "$(test $trace = two && echo 1 || echo 2)"
    else
        skip "Chrome's JSON of $trace" "no python3"
    fi
    if command -v pj_dump > /dev/null; then
        ok "pj_dump reads the Paje of $trace" pj_dump_agrees $trace
    else
        skip "pj_dump reads the Paje of $trace" "no pj_dump (package pajeng)"
    fi
    if ! grep -q '^#define HAVE_OTF2 1' config.h; then
        ok "no OTF2 of $trace, and the package is named" otf2_is_missing $trace
    elif command -v otf2-print > /dev/null; then
        ok "otf2-print reads the OTF2 of $trace" otf2_is_whole $trace
    else
        skip "otf2-print reads the OTF2 of $trace" "no otf2-print (package otf2-tools)"
    fi
done
exits 1 "tables where no folder can be" ./duite-trace "$scratch/two" --csv "$scratch/two/tables"

dot_is_whole() { # nodes are named before edges, which never point back
    ./duite-trace "$scratch/$1" --dot "$scratch/$1.dot" && awk '
        /->/ { from = substr($1, 2); to = substr($3, 2); if (from + 0 >= to + 0) { print; bad = 1 } n++ }
        END { exit bad || n < 100 }' "$scratch/$1.dot" && grep -q 'label="implicit_next [0-9]*.nrank [01]' "$scratch/$1.dot"
}
ok "dot of two" dot_is_whole two

# A line a task, which reads earlier ones, each once; other blocks are read, too. Costs are the seconds in bodies; a task of the
# runtime costs the median of its kind, at most twice the mean: one that lost its core for a while costs no more than others.
graph_is_whole() {
    ./duite-trace "$scratch/two" --graph "$scratch/two.graph" && awk -F, '$21 == "task" || $21 == "runtime" { s[$21] += $6 - $23 }
        END { print s["task"] / 1000, (s["task"] + 2 * s["runtime"]) / 1000 }' "$scratch/two.csv/$states" > "$scratch/seconds" &&
        read -r least most < "$scratch/seconds" && awk -v least="$least" -v most="$most" '
        NR == 1 { bad = $0 != "duite-graph 1"; next }
        { at = NR - 2; cost += $1; split("", seen); place[at] = $(NF - 1) == "@" ? $NF : -1 }
        { for (k = 4; k < 4 + $3; k++) { if ($k >= at || $k in seen) { print; bad = 1 } seen[$k] = 1; others += $2 > 0 && place[$k] != place[at] } }
        NF != 3 + $3 + 2 * (place[at] >= 0) { print; bad = 1 }
        END { print cost, "of", least, "to", most, NR - 1, others
            exit bad || cost > 1.001 * most || cost < 0.999 * least || NR < 101 || !others }' "$scratch/two.graph"
}
ok "a graph for schedulers of two" graph_is_whole

# ---- Steps ----

ok "the steps 1 and 2 alone" cloth some --threads 2 --trace-steps 1:3
steps_are() {
    ./duite-trace "$scratch/some" --csv "$scratch/some.csv" && test "$(awk -F, '$3 == "step" { printf "%s ", $5 }' "$scratch/some.csv/paje.events.csv")" = "1 2 "
}
ok "... have no other steps" steps_are
fewer() { test "$(wc -l < "$scratch/some.csv/$states")" -lt "$(wc -l < "$scratch/two.csv/$states")"; }
ok "... and fewer events" fewer
exits 1 "... which cannot be compared with counters" ./duite-trace --check "$scratch/some"
exits 2 "steps that end before they begin" cloth none --trace-steps 3:1
exits 2 "steps that are no numbers" cloth none --trace-steps x
exits 2 "steps without a file" "$DUITE_CLOTH" "$srcdir/cloth/scenes/sheet.yaml" --trace-steps 1:2

# ---- Predictions ----

predicted() { # WORDS OPTION...: predicted with these options, with the words in what is said
    words=$1
    shift
    ./duite-predict "$scratch/two" "$@" > "$scratch/said" 2>&1 || { cat "$scratch/said"; return 1; }
    cat "$scratch/said"
    grep -q "$words" "$scratch/said"
}
ok "predicted where it ran" predicted "1 hosts x 2 cores" --paje "$scratch/predicted.paje"
ok "... with as many tasks as ran" eval 'predicted "tasks  " && test "$(sed -n "s/  tasks *\([0-9]*\),.*/\1/p" "$scratch/said")" = \
    "$(./duite-trace "$scratch/two" | sed -n "s/  tasks *\([0-9]*\),.*/\1/p")"'
paje_of_prediction() { grep -c '^7 ' "$scratch/predicted.paje" && test "$(grep -c '^7 ' "$scratch/predicted.paje")" -gt 100; }
ok "... and a Paje trace" paje_of_prediction
ok "predicted on 16 hosts" predicted "limited by" --hosts 16 --cores 4 --latency 1e-5 --bandwidth 1e8 --switch 1e9 --mapping cyclic --scheduler fifo
for mapping in list taskgraph; do
    ok "predicted with the mapping $mapping, which sees the tasks" predicted "  migrated " --hosts 3 --cores 2 --mapping $mapping
done
ok "predicted with blocks that move" predicted "balance migrate" --hosts 3 --cores 2 --mapping random --balance migrate
same_twice() {
    predicted "limited by" --hosts 3 --cores 2 && cp "$scratch/said" "$scratch/first" &&
        predicted "limited by" --hosts 3 --cores 2 && cmp "$scratch/said" "$scratch/first"
}
ok "predicted alike twice" same_twice
ok "predicted from 2 ranks, one of which had guests" eval './duite-predict "$scratch/ranks" && ./duite-predict "$scratch/ranks" --hosts 5'
ok "predicted from some steps" ./duite-predict "$scratch/some"
exits 2 "no such scheduler" ./duite-predict "$scratch/two" --scheduler best
exits 2 "hosts that are no number" ./duite-predict "$scratch/two" --hosts x
exits 2 "no bandwidth" ./duite-predict "$scratch/two" --bandwidth 0
exits 2 "tasks that go elsewhere" ./duite-predict "$scratch/two" --hosts 2 --balance delegate
exits 2 "blocks that move without a mapping" ./duite-predict "$scratch/ranks" --balance migrate
exits 1 "a predicted run that cannot be written" ./duite-predict "$scratch/two" --paje "$scratch/nowhere/paje"

# ---- Kernels with many listed parameters ----

ok "40 listed parameters, traced" ranks 2 tests/runtime/ranks wide "$scratch/wide"
ok "... is whole" ./duite-trace --check "$scratch/wide"
wide_and_plain() { ./duite-trace "$scratch/wide" > "$scratch/table" && cat "$scratch/table" && grep -q wide "$scratch/table" && grep -q plain "$scratch/table"; }
ok "... and names both kernels" wide_and_plain
ok "... and is predicted for other hosts" ./duite-predict "$scratch/wide" --hosts 3

# ---- What is no trace ----

refused() { # FILE WORDS: refused with a sentence that has these words
    if ./duite-trace "$scratch/$1" > "$scratch/said" 2>&1; then return 1; else test $? = 2 || return 1; fi
    grep "$2" "$scratch/said"
}
bytes=$(wc -c < "$scratch/two")
head -c $((bytes - 100)) "$scratch/two" > "$scratch/short"
ok "a truncated file" refused short "byte $((bytes - 100)): truncated: the file had $bytes bytes"
head -c 50 "$scratch/two" > "$scratch/short"
ok "truncated in the header" refused short "byte 50: truncated in its header"
: > "$scratch/short"
ok "an empty file" refused short "byte 0: "
cp "$srcdir/README.md" "$scratch/foreign"
ok "a foreign file" refused foreign "byte 0: this is no trace"
cp "$scratch/two" "$scratch/newer"
printf '\004' | dd of="$scratch/newer" bs=1 seek=8 conv=notrunc 2> /dev/null
ok "a newer one" refused newer "byte 8: a trace of version 4; this program reads version 3"
cp "$scratch/two" "$scratch/older"
printf '\001' | dd of="$scratch/older" bs=1 seek=8 conv=notrunc 2> /dev/null
ok "an older one" refused older "byte 8: a trace of version 1; this program reads version 3"
cp "$scratch/two" "$scratch/turned"
printf '\001\002\003\004' | dd of="$scratch/turned" bs=1 seek=12 conv=notrunc 2> /dev/null
ok "one of another order of bytes" refused turned "byte 12: written on a machine with another order of bytes"
cp "$scratch/two" "$scratch/damaged"
printf '\377\377\377' | dd of="$scratch/damaged" bs=1 seek=$((bytes / 2)) conv=notrunc 2> /dev/null
# Whatever was hit there, nothing but a sentence comes of it.
survives() { ./duite-trace "$scratch/damaged" > "$scratch/said" 2>&1 || test $? -le 2; }
ok "a damaged one" survives
printf '\377' | dd of="$scratch/damaged" bs=1 seek=104 conv=notrunc 2> /dev/null
ok "a damaged section" refused damaged "byte 104: "
# Heads whose numbers nothing stands for: no room is made for them.
ok "some steps on 2 threads, in a small file" eval 'cloth small --threads 2 --trace-steps 1:2 && test "$(wc -c < "$scratch/small")" -lt 200000'
cp "$scratch/small" "$scratch/many"
printf '\000\000\000\001' | dd of="$scratch/many" bs=1 seek=20 conv=notrunc 2> /dev/null
ok "16777216 ranks" refused many "many[.]16777215 cannot be read: .* the trace is of 16777216 ranks"
cp "$scratch/small" "$scratch/many"
printf '\000\020\000\000' | dd of="$scratch/many" bs=1 seek=24 conv=notrunc 2> /dev/null
ok "4096 workers" refused many "byte 16: .* nonsense"
cp "$scratch/small" "$scratch/quick"
printf '\000\060' | dd of="$scratch/quick" bs=1 seek=70 conv=notrunc 2> /dev/null
ok "a tick of 1e-77 seconds" refused quick "byte 16: .* nonsense"
mv "$scratch/ranks.1" "$scratch/away"
ok "a rank that is missing" refused ranks "ranks.1 cannot be read"
cp "$scratch/two" "$scratch/ranks.1"
ok "a file of another run" refused ranks "ranks.1: byte [0-9]*: another rank"
ok "no file" refused nothing "nothing cannot be read"
ok "no file in a deep folder" refused "$(printf '%0500d/%0500d/%0500d' 1 2 3)" " [.]\{3\} .*3 cannot be read: "

# ---- What cannot be written ----

exits 2 "no such folder" cloth nowhere/trace
exits 2 "the scene itself" eval 'cp "$srcdir/cloth/scenes/sheet.yaml" "$scratch/own.yaml" &&
    "$DUITE_CLOTH" "$scratch/own.yaml" --trace "$scratch/own.yaml"'
if test -w /dev/full; then
    exits 1 "a full disk at the start" "$DUITE_CLOTH" "$srcdir/cloth/scenes/sheet.yaml" --end 0.004 --trace /dev/full
else
    skip "a full disk at the start" "no /dev/full"
fi
full() { # the disk has room for 32 KiB: the run ends, and says at its end that the trace is not whole
    status=0
    (ulimit -f 64 && UCX_TLS=self cloth full --threads 2 --report "$scratch/full.json") > "$scratch/said" 2>&1 || status=$?
    cat "$scratch/said"
    test $status = 1 && grep "full is not whole: File too large" "$scratch/said" && test "$(hash_of full.json)" = "$(hash_of plain.json)"
}
ok "a disk that fills up costs the rest of the trace" full
kept() { ./duite-trace "$scratch/full" > "$scratch/said" 2>&1 && cat "$scratch/said" && grep "events or words were lost" "$scratch/said"; }
ok "what was written before is kept, and the loss counted" kept
exits 2 "nothing is predicted from what is left" ./duite-predict "$scratch/full"

# A run of hours that writes a trace, until it is told to stop; then its status and what it said.
victim=
trap 'status=$?; test -z "$victim" || kill -9 $victim 2> /dev/null; (exit $status); tap_end' EXIT
begin() { # FILE
    "$DUITE_CLOTH" "$srcdir/cloth/scenes/sheet.yaml" --set 'cloths[0].mesh.grid={width: 1, height: 1, nx: 20, ny: 20}' \
        --set 'cloths[0].pins=[]' --grain 100 --end 100000 --quiet --trace "$scratch/$1" --trace-steps :10 \
        --report "$scratch/hours.json" 2> "$scratch/said" &
    victim=$!
    awaits $victim test -s "$scratch/$1"
}
stop() { # STATUS: it ends with this one
    kill -USR1 $victim
    status=0
    wait $victim || status=$?
    cat "$scratch/said"
    test $status = "$1" && test -s "$scratch/hours.json"
}
removed() {
    mkdir "$scratch/folder" && begin folder/trace && rm -r "$scratch/folder" && stop 1 &&
        grep -q "^duite-cloth: the trace .*folder/trace was removed or replaced while the run wrote to it$" "$scratch/said"
}
ok "a trace that is removed is told of" removed
replaced() { # the second run's is whole
    begin shared && cloth shared --threads 2 --quiet && stop 1 && grep -q "shared was removed or replaced" "$scratch/said" &&
        ./duite-trace --check "$scratch/shared"
}
ok "a trace that another run replaces" replaced

has_begun() { test -s "$scratch/killed" && test "$(wc -c < "$scratch/killed")" -ge 100000; }
killed() {
    (exec "$DUITE_CLOTH" "$srcdir/cloth/scenes/sheet.yaml" --set 'cloths[0].mesh.grid={width: 1, height: 1, nx: 30, ny: 30}' \
        --set 'cloths[0].pins=[]' --grain 100 --end 20 --quiet --trace "$scratch/killed") & victim=$!
    awaits $victim has_begun
    kill -9 $victim
    wait $victim || true
    refused killed "byte 28: the run did not come to its end" && ./duite-trace --partial "$scratch/killed" | grep "NOT WHOLE"
}
ok "a run that was killed" killed
