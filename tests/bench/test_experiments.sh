#!/bin/sh
# The papers' experiments run in tiny sizes and print their tables. With DUITE_LONG=1 all of them.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later
# A user's general settings for programs of duite, even if they make no sense, are not measured.
export DUITE_SCHEDULER=nobody DUITE_MAPPING=nowhere DUITE_BALANCE=never DUITE_THREADS=none DUITE_SEED=no DUITE_TRACE=/no/such/folder/trace

experiments=$(cd "$srcdir" && pwd)/bench/experiments
mkdir -p "$scratch/bench/vassilev" # what it leaves lies there
ln -s "$PWD/duite-cloth" "$PWD/duite-predict" "$PWD/duite-compare" "$scratch"
ln -s "$PWD/bench/contact-partition" "$scratch/bench"
ln -s "$PWD/bench/vassilev/vassilev" "$scratch/bench/vassilev"
# The runs are named above the table and below it: sizes and lengths are those of --quick.
revision=$(git -C "$srcdir" describe --always --dirty --abbrev=12 2> /dev/null || echo unknown)
table() { # NAME LINES [WORDS]: so many rows, none of them without figures, and a caption with these words
    status=0
    (cd "$scratch" && limited sh "$experiments" --quick "$1") > "$scratch/said" 2>&1 || status=$?
    cat "$scratch/said"
    if test $status = 77; then return 0; fi # no hosts here, which it says
    test $status = 0 && test "$(grep -c '^| ' "$scratch/said")" = "$2" && ! grep -q '|  *|  *|.*nan\|inf' "$scratch/said" &&
        grep -q "^--quick: small sizes and short runs; .*figures mean nothing" "$scratch/said" && grep -q "${3:-.}" "$scratch/said" &&
        grep -Fq ", revision $revision, " "$scratch/said" && grep -q "^..*, [1-9][0-9]* cores, .*[Mm][Pp][Ii].*[0-9], .*[0-9] runs*[.]$" "$scratch/said"
}
unknown() {
    status=0
    sh "$experiments" garment > "$scratch/said" 2>&1 || status=$?
    test $status = 2 && grep -q "zara|partutex|resolution|grain|link|scaling|contact-partition|vassilev|partutex-shirt" "$scratch/said"
}
ok "an unknown experiment" unknown
ok "resolution" table resolution 3 "after 0.01 s"
ok "grain" table grain 8 "a step of 900 vertices, .*median of 1 run"
ok "scaling" table scaling 22 "A step of 3600 vertices"
ok "contact-partition" table contact-partition 17 "median of 1 run"
ok "vassilev" table vassilev 17 "median of 1 run of 10 iterations"
ok "fabrics" table fabrics 3 "drape coefficient (%) and nodes"
# Panels of so many vertices that joints pull together around the figure.
awk -v n=300 -f "$srcdir/bench/vassilev/panels.awk" > "$scratch/panels.yaml"
# The loops' results: on two threads as many pairs repel each other, and vertices are in the body, as on one, or nearly so.
loops() { # THREADS: prints pieces, vertices in the body, pairs that repel each other, mean of all iterations
    limited bench/vassilev/vassilev run "$1" 300 on 0 "$scratch/panels.yaml" contact.thickness=0.02 | cut -d ' ' -f 4,12,13
}
threads_agree() {
    loops 1 > "$scratch/one" && loops 2 > "$scratch/two" && cat "$scratch/one" "$scratch/two" &&
        paste -d ' ' "$scratch/one" "$scratch/two" | awk '{ ok = $1 == 2 && $2 > 1 && $3 > 0 && $4 == 2 && near($2, $5) && near($3, $6) }
            function near(a, b) { return a - b < 0.01 * a && b - a < 0.01 * a }
            END { exit !ok }'
}
refused() { # KEY=VALUE SENTENCE
    ! limited bench/vassilev/vassilev run 1 1 off 0 "$scratch/panels.yaml" "$1" > "$scratch/said" 2>&1 && grep "$2" "$scratch/said"
}
agree() ( # with duite-cloth, to roundoff
    unset DUITE_SCHEDULER DUITE_MAPPING DUITE_BALANCE DUITE_THREADS DUITE_SEED DUITE_TRACE
    limited bench/vassilev/vassilev check 20 "$1"
)
ok "six loops of panels, with joints on edges" agree "$scratch/panels.yaml"
ok "six loops of jeans" agree "$srcdir/bench/vassilev/jeans.yaml"
ok "six loops on one thread and on two" threads_agree
ok "six loops of what they do not know" refused 'obstacles=[{plane: {point: [0, 0, 0], normal: [0, 1, 0]}}]' "met by image"
ok "six loops of triangles" refused 'materials.cloth={model: triangles, density: 0.2, stretch: 40, shear: 10}' "springs alone"
if test "${DUITE_LONG:-}" = 1; then
    ok "zara" table zara 35 "at 1600 particles"
    ok "partutex" table partutex 7 "22,500 vertices, 2 steps"
    ok "partutex-shirt" table partutex-shirt $((2 * $(nproc))) "mean of 1 run"
    ok "link" table link 9 "at 900 particles, implicit, over 2 steps"
fi
