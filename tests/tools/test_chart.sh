#!/bin/sh
# The Gantt chart of a run on 2 ranks: it is SVG, has each rank, kernels, and the numbers of duite-trace's table; what cannot be
# drawn is refused.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
skip_unless ./duite-trace
plan_later

run() {
    ranks 2 "$DUITE_CLOTH" "$srcdir/cloth/scenes/sheet.yaml" --set 'cloths[0].mesh.grid.nx=30' --set 'cloths[0].mesh.grid.ny=30' \
        --set 'cloths[0].pins=[]' --grain 100 --end 0.004 --threads 2 --quiet --trace "$scratch/ranks"
}
ok "a run on 2 ranks" run
ok "... is drawn" ./duite-trace "$scratch/ranks" --svg "$scratch/all.svg"
./duite-trace "$scratch/ranks" > "$scratch/table"

well_formed() {
    if command -v xmllint > /dev/null; then xmllint --noout "$scratch/all.svg"; else tail -n 1 "$scratch/all.svg" | grep -x '</svg>'; fi
}
ok "... as XML" well_formed
rows() { # a name for each rank, one for each of its workers
    test "$(grep -c '>rank [01]</text>' "$scratch/all.svg")" = 2 &&
        test "$(grep -c 'text-anchor="end".*>[01]</text>' "$scratch/all.svg")" = 4
}
ok "... with 2 ranks of 2 workers" rows
caption() { sed -n 's/<title>\(.*\)<.title>/\1/p' "$scratch/all.svg"; }
numbers() { # time, share, critical path and limit are those of the table
    caption
    caption | tr ';' '\n' | awk '
        function seconds(n, unit) { return n * (unit ~ /^s/ ? 1 : unit ~ /^ms/ ? 1e-3 : 1e-6) }
        function apart(a, b) { a -= b; return a > 0.001 * b || -a > 0.001 * b }
        FNR == NR && /with 4 workers/ { time = seconds($1, $2) }
        FNR == NR && /busy/ { busy = $2 }
        FNR == NR && /critical path/ { path = seconds($3, $4) }
        FNR == NR && /limited by/ { sub(/.*: /, ""); limit = $0 }
        FNR == NR { next }
        $1 == "time" { n++; bad += apart(time, $2) }
        $1 == "busy" { n++; bad += busy - $2 > 0.11 || $2 - busy > 0.11 }
        $1 == "critical" { n++; bad += apart(path, $3) }
        $1 == "limited" { n++; sub(/^ *limited by */, ""); bad += limit != $0 }
        END { print n, bad + 0; exit n != 4 || bad }' - "$scratch/table"
}
ok "... and the table's numbers in its caption" numbers
legend() { # the largest kernel comes first, and all shares are 100 %
    largest=$(sed -n '/^  kernel /,$p' "$scratch/table" | sed 1d | grep -v own | sort -k3 -nr | awk 'NR == 1 { print $1 }')
    sed -n 's/.*>\([^<]*\) \([0-9.]*\) %<.*/\1:\2/p' "$scratch/all.svg" | grep -v '^busy' > "$scratch/legend"
    cat "$scratch/legend"
    test "$(head -n 1 "$scratch/legend" | cut -d: -f1)" = "$largest" &&
        awk -F: '{ sum += $2 } END { exit !(NR >= 4 && sum > 99.4 && sum < 100.6) }' "$scratch/legend"
}
ok "... and a legend whose shares are all of the time" legend
drawn() { grep -q 'stroke="#000000"' "$scratch/part.svg" && grep -q '>critical path<' "$scratch/part.svg"; }
middle=$(awk '$1 == "time" { printf "%.6f:%.6f", $2 / 2, $2 / 2 + 0.0005 }' "$scratch/table")
ok "a window of half a millisecond" ./duite-trace "$scratch/ranks" --window "$middle" --svg "$scratch/part.svg"
ok "... has the critical path as a line" drawn
# Shares of the run, for which nobody needs its moments: the caption says how long they are.
half() {
    ./duite-trace "$scratch/ranks" --window 25%:75% --svg "$scratch/half.svg" && sed -n 's/<title>\(.*\)<.title>/\1/p' "$scratch/half.svg" |
        awk -v all="$(awk '$1 == "time" { print $2 }' "$scratch/table")" '{
            print
            t = $1 * ($2 ~ /^s/ ? 1 : $2 ~ /^ms/ ? 1e-3 : 1e-6)
            exit !(t > 0.49 * all && t < 0.51 * all) }'
}
ok "a window of half of the run" half
ok "... or of all behind a third" ./duite-trace "$scratch/ranks" --window 33.3%: --svg "$scratch/part.svg"
sized() { ./duite-trace "$scratch/ranks" --size 800x300 --svg - | grep -q 'width="800" height="300"'; }
ok "a size" sized

refused() { # TEXT OPTION...
    text=$1
    shift
    status=0
    ./duite-trace "$scratch/ranks" "$@" > /dev/null 2> "$scratch/said" || status=$?
    cat "$scratch/said"
    test $status != 0 && grep -q -- "$text" "$scratch/said"
}
ok "a window behind the run" refused "has nothing of the run" --svg - --window 1000:1001
ok "a window that ends first" refused "--window takes FROM:TO" --svg - --window 2:1
for wrong in 50%:0.1 0.1:50% 50%:40% 50%:101% %:50%; do ok "a window $wrong" refused "--window takes FROM:TO" --svg - --window $wrong; done
ok "a size that is too small" refused "400x200 to 4096x4096 pixels, not 10x10" --svg - --size 10x10
ok "a window without a chart" refused "are of charts" --window 0:1
head -c 2000 "$scratch/ranks" > "$scratch/short"
exits 2 "a truncated trace" ./duite-trace "$scratch/short" --svg "$scratch/none.svg"
exits 2 "a foreign file" ./duite-trace "$srcdir/README.md" --svg "$scratch/none.svg"
ok "... of which nothing is drawn" test ! -e "$scratch/none.svg"

# ---- duite-view draws the same ----

if test -x "${DUITE_VIEW:-./none}"; then
    view() { limited "$DUITE_VIEW" --trace "$scratch/ranks" "$@"; }
    same() { view --svg "$scratch/view.svg" && cmp "$scratch/view.svg" "$scratch/all.svg" && test ! -e "$scratch/view.svg.part"; }
    ok "duite-view draws the same chart" same
    png() { view --size 600x300 --png "$scratch/view.png" && test "$(head -c 4 "$scratch/view.png" | tail -c 3)" = PNG; }
    if grep -q '^#define HAVE_CAIRO 1' config.h; then ok "... as PNG" png; else skip "... as PNG" "built without cairo"; fi
    exits 2 "a chart that goes nowhere" view
    exits 2 "a chart with a frame" view --svg "$scratch/none.svg" --frame 1
    exits 2 "a chart with a folder" view --svg "$scratch/none.svg" "$scratch"
    exits 2 "SVG of a folder" limited "$DUITE_VIEW" "$scratch" --svg "$scratch/none.svg"
    exits 2 "a window behind the run" view --svg "$scratch/none.svg" --window 1000:1001
    exits 2 "a truncated trace" limited "$DUITE_VIEW" --trace "$scratch/short" --svg "$scratch/none.svg"
    ok "... of which nothing is drawn" test ! -e "$scratch/none.svg"
else
    skip "duite-view draws the same chart" "not built"
fi
