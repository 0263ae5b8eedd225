#!/bin/sh
# The table of probes and the end of a run at rest, as a user sees them.
. "${srcdir:-.}/tests/support/cloth.sh"

cat > sheet.yaml << 'END'
schema: 1
cloths:
  - name: sheet
    mesh: {grid: {width: 1, height: 1, nx: 12, ny: 12}}
    material: cotton
    pins: [{vertices: [0, 11]}]
  - name: chain
    mesh: {inline: {vertices: [[2, 0, 0], [2, -0.1, 0], [2, -0.2, 0]], edges: [[0, 1], [1, 2]]}}
    mass_per_vertex: 0.02
    material: cotton
    pins: [{vertices: [0]}]
materials:
  cotton: {density: 0.2, stretch: 200, shear: 50, ea: 20, damping: {mass: 1, stiffness: 0.01}}
time: {h: 0.002, end: 0.04}
grain: 20
probes:
  - {name: corners, cloth: sheet, vertices: [11, 0], values: [reaction, total]}
  - {name: tip, cloth: chain, nearest: [2, -9, 0]}
  - {cloth: sheet, box: [[-1, -1, 0.49], [1, 1, 1]], values: [position]}
END

run() { limited "$DUITE_CLOTH" "$@" --quiet; }
column() { # FILE NAME: the numbers of a column
    awk -F, -v name="$2" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) at = i; if (!at) exit 1; next } { print $at }' "$1"
}

whole() { # FILE ROWS: a header and so many rows of as many fields, steps from 0 on
    awk -F, -v rows="$2" 'NR == 1 { n = NF } NF != n || (NR > 1 && $1 != NR - 2) { bad = 1 }
        END { exit bad || NR != rows + 1 || n != 9 + 9 + 9 + 36 }' "$1"
}
table() { run sheet.yaml --output one --threads 1 && whole one/probes.csv 21; }
ok "a row for the start and for each step" table
named() {
    head -n 1 one/probes.csv | grep -F 'loads [J],corners.11.rx [N],corners.11.ry [N]' &&
        head -n 1 one/probes.csv | grep -F ',corners.total.rz [N],tip.2.x [m],' && head -n 1 one/probes.csv | grep -F ',probe3.132.x [m],'
}
ok "columns are named with their units" named

same() { # the same bytes
    run sheet.yaml --output two --threads 2 --scheduler shuffle --seed 7 && cmp one/probes.csv two/probes.csv &&
        ranks 3 "$DUITE_CLOTH" sheet.yaml --quiet --output three --threads 2 --balance delegate && cmp one/probes.csv three/probes.csv
}
ok "the same bytes on threads and ranks" same
energies() { # of the last row, as the report has them
    run sheet.yaml --output one --threads 1 --report report.json || return 1
    for name in kinetic elastic gravity loads; do
        column one/probes.csv "$name [J]" | tail -n 1 > last
        sed -n "s/.*\"energy_$name\": \([^,]*\),*/\1/p" report.json | cmp - last || { cat last && return 1; }
    done
}
ok "energies are those of the report" energies
unseen() { # INTEGRATOR: whether there are probes or not makes no difference
    run sheet.yaml --report report.json --set integrator=$1 --set time.h=0.001 --end 0.01 2> /dev/null &&
        run sheet.yaml --report told.json --output told --set integrator=$1 --set time.h=0.001 --end 0.01 &&
        grep '"state_hash"' report.json > hash && grep '"state_hash"' told.json | cmp - hash
}
for integrator in implicit_euler symplectic_euler verlet rk4; do
    ok "probes change nothing, $integrator" unseen $integrator
done
explicit() {
    run sheet.yaml --output one --threads 1 --set integrator=explicit_euler --set time.h=0.001 --end 0.01 && whole one/probes.csv 11 &&
        ranks 2 "$DUITE_CLOTH" sheet.yaml --quiet --output three --set integrator=explicit_euler --set time.h=0.001 --end 0.01 &&
        cmp one/probes.csv three/probes.csv
}
ok "of explicit runs, too" explicit

# ---- At rest

rests() { # well before the end; the chain's pin carries its weight, stretched by it
    run sheet.yaml --output rest --report rest.json --end 100 --set 'time.rest={speed: 1e-5, hold: 0.1}' --set time.h=0.04 \
        --set 'materials.cotton.damping.mass=10' --set 'solver.stop={mass_norm: 1e-9}' || return 1
    awk -F'[:,]' '/"rest_seconds"/ { rest = $2 } /"simulated_seconds"/ { end = $2 }
        END { print rest, end; exit !(rest > 0.5 && rest < 50 && end >= rest && end <= rest + 0.05) }' rest.json || return 1
    column rest/probes.csv 'tip.2.y [m]' | awk '{ y = $1 } END { want = -0.2 - 9.81 * 0.02 * 3 / 200
        print y, want; exit !(y - want < 1e-6 && want - y < 1e-6) }' || return 1
    column rest/probes.csv 'corners.total.ry [N]' | awk '{ r = $1 } END { print r; exit !(r - 9.81 * 0.2 < 1e-4 && 9.81 * 0.2 - r < 1e-4) }'
}
ok "a run until rest: weight, stretch and where it ends" rests
same_end() {
    ranks 2 "$DUITE_CLOTH" sheet.yaml --quiet --threads 1 --output rest2 --end 100 --set 'time.rest={speed: 1e-5, hold: 0.1}' --set time.h=0.04 \
        --set 'materials.cotton.damping.mass=10' --set 'solver.stop={mass_norm: 1e-9}' && cmp rest/probes.csv rest2/probes.csv
}
ok "the same end on 2 ranks" same_end
restless() {
    run sheet.yaml --report rest.json --set time.rest={} 2> complained && grep -q '"rest_seconds": null' rest.json &&
        grep -q 'warning: the cloth is not at rest at time.end, 0.04 s: .*, or something was still to move or vary' complained
}
ok "a run that does not rest says so" restless

# ---- What goes wrong

has_rows() { test "$(wc -l < killed/probes.csv)" -gt 30; }
killed() { # rows up to then are whole
    "$DUITE_CLOTH" sheet.yaml --quiet --output killed --end 1000 & pid=$!
    awaits $pid has_rows
    kill -KILL $pid && wait $pid
    rows=$(($(wc -l < killed/probes.csv) - 1))
    test $rows -ge 30 && whole killed/probes.csv $rows && tail -c 1 killed/probes.csv | cmp - newline
}
printf '\n' > newline
ok "SIGKILL leaves whole rows" killed

refused() { # STATUS SENTENCE COMMAND...
    refused_want=$1 refused_what=$2 status=0
    shift 2
    "$@" > printed 2> complained || status=$?
    cat complained
    test $status = "$refused_want" && grep -q -F "$refused_what" complained && test "$(wc -l < complained)" = 1
}
mkdir mine && echo "my own" > mine/probes.csv
ok "a table of the user's stays" refused 2 "mine/probes.csv would be replaced, but is no table of probes" run sheet.yaml --output mine
ok "and is not touched" grep -q "my own" mine/probes.csv
gone() { run sheet.yaml --output one --set 'probes=[]' && test ! -e one/probes.csv; }
ok "a run without probes removes the table of one before" gone
warns() { run sheet.yaml 2> complained && grep -q 'warning: the scene has probes' complained; }
ok "without --output there is a warning" warns
small() { # files of at most 32 KiB
    UCX_TLS=self sh -c 'ulimit -f 64 && exec "$@"' sh "$DUITE_CLOTH" sheet.yaml --quiet --output small --end 10 --set time.fps=0.1
}
ok "a file that may not grow" refused 1 "cannot write a row to small/probes.csv: File too large" small
kept() { rows=$(($(wc -l < small/probes.csv) - 1)) && test $rows -gt 3 && whole small/probes.csv $rows; }
ok "keeps its whole rows" kept
