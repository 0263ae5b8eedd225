#!/bin/sh
# The options of duite-cloth, its output, and how it ends.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
plan_later
top=$srcdir
cd "$scratch" || exit 99
# mpirun gives the other ranks a second when the first ends with an error; all of ours end by themselves, with the same one.

cat > scene.yaml << 'END'
schema: 1
name: handkerchief
cloths:
  - mesh: {grid: {width: 1, height: 1, nx: 8, ny: 8}}
    material: cotton
    pins: [{vertices: [0, 7]}]
materials:
  cotton: {density: 0.2, stretch: 500, damping: {mass: 1}}
time: {h: 0.001, end: 0.08, fps: 50}
END

run() { limited "$DUITE_CLOTH" "$@"; }
is() { test "$(value "$1")" = "$2" || { echo "$1 is '$(value "$1")', not '$2'" && return 1; }; }
prints() { "$@" > printed 2> complained; }

# ---- Words

short_answer() { # WORD OPTION: a text on standard output, nothing else, without a scene
    prints run "$2" && grep -q -e "$1" printed && test ! -s complained
}
ok "--help lists the options" short_answer '--scheduler' --help
ok "--usage is short" short_answer 'SCENE.yaml' --usage
ok "--version names the version" short_answer '^duite-cloth (duite [0-9]' --version
ok "--keys lists keys, units and defaults" short_answer '^gravity: a list of 3 numbers (m/s^2); default' --keys
ok "--keys knows deep keys" short_answer '^cloths\[\].pins\[\].nearest: ' --keys
said_once() { prints ranks 2 "$DUITE_CLOTH" "$1" && cat printed && test "$(wc -l < printed)" -eq 1 && test ! -s complained; }
ok "--version is said once on 2 ranks" said_once --version

documented() { # every option of --help stands in the manual page
    run --help | grep -o -e '--[a-z]*' | sort -u > options
    test "$(wc -l < options)" -gt 10 || return 1
    while read -r option; do
        grep -q -e "$option" "$top/cloth/app/duite-cloth.1" || { echo "$option is not in the page" && return 1; }
    done < options
}
ok "the manual page has all options" documented

# ---- Wrong command lines

wrong_run=run
wrong() { # SENTENCE ARGUMENT...: status 2, the sentence once, nothing on standard output
    wrong_what=$1
    shift
    status=0
    # shellcheck disable=SC2086 # two words and more
    prints $wrong_run "$@" || status=$?
    echo "exit status $status"
    cat complained
    test $status = 2 && test ! -s printed && test "$(grep -c -F -e "$wrong_what" complained)" = 1
}
wrong_on_two() { # the same on one rank and, but for the quick subset, on two: once for each place that finds faults
    wrong "$@" && { quick || (wrong_run="ranks 2 $DUITE_CLOTH" && wrong "$@"); }
}
ok "no scene" wrong_on_two "duite-cloth: a scene file is expected; see duite-cloth --help"
ok "two scenes" wrong "duite-cloth: other.yaml: a second scene file; one is expected" scene.yaml other.yaml
ok "an unknown option" wrong "unrecognized option '--layers'" scene.yaml --layers 3
ok "an option without its value" wrong "option '--end' requires an argument" scene.yaml --end
ok "a report of no name" wrong "duite-cloth: --report: an empty name" scene.yaml --report ''
ok "a folder of no name" wrong "duite-cloth: --output: an empty name" scene.yaml --output ''
ok "no threads" wrong_on_two "duite-cloth: --threads 0: a whole number from 1 to 4096 is expected" scene.yaml --threads 0
ok "a format of keys that is none" wrong "duite-cloth: --keys=html: markdown is expected, or no format" --keys=html
ok "half a number" wrong "duite-cloth: --threads 2x: a whole number from 1 to 4096 is expected" scene.yaml --threads 2x
ok "a negative seed" wrong "duite-cloth: --seed -1: a whole number from 0 to 18446744073709551615 is expected" scene.yaml \
    --seed -1
ok "a scheduler of no name" wrong "duite-cloth: --scheduler lazy: there is no scheduler of this name; known are " scene.yaml \
    --scheduler lazy
ok "a check of a run that goes on" wrong_on_two "duite-cloth: --check is of a run from its start, and writes nothing" --check --restart frames \
    scene.yaml
ok "a mapping of no name" wrong "duite-cloth: --mapping flat: there is no mapping of this name; known are " scene.yaml \
    --mapping flat
ok "a balancer of no name" wrong "duite-cloth: --balance fair: there is no balancer of this name; known are none, " \
    scene.yaml --balance fair
ok "a time that is none" wrong_on_two "duite-cloth: --end soon: time.end is soon; a finite number > 0 (s) is expected" scene.yaml \
    --end soon

# ---- Runs

ok "a run" prints run scene.yaml --report report.json --output frames --grain 20
hash=$(value state_hash)
ok "the summary names scene, hash and folder" sh -c 'grep -q "^handkerchief$" printed && grep -q "state hash  *$1$" printed &&
    grep -q "frames .* in frames$" printed' sh "$hash"
ok "the report says what was run" eval 'is scene handkerchief && is vertices 64 && is triangles 98 && is grain 20 &&
    is blocks 4 && is ranks 1 && is scheduler steal && is mapping metis && is steps 80 && is balance none &&
    is delegated_tasks 0'
ok "hashes have 16 digits" eval 'echo "$hash $(value partition_hash)" | grep -cxE "[0-9a-f]{16} [0-9a-f]{16}"'

all_keys() { # exactly the keys of the manual page, in its order
    sed -n '/^\.SH REPORT/,/^\.SH SIGNALS/s/^\.B //p' "$top/cloth/app/duite-cloth.1" | tr -d ' ' | tr ',' '\n' > documented
    sed -n 's/^ *"\([A-Za-z0-9_]*\)":.*/\1/p' report.json | sed 's/^material_cotton_/material_NAME_/' > reported
    sort documented > documented.sorted
    sort reported | diff documented.sorted - && test "$(wc -l < reported)" -gt 40
}
ok "the report has every key" all_keys
frames_are() { # LAST: their index and the cache end with it
    cat frames/frames.csv
    test "$(tail -n 1 frames/frames.csv | cut -d , -f 1)" = "$1" && test -s frames/cloth.obj &&
        test "$(wc -c < frames/cloth.pc2)" -eq $((32 + 12 * 64 * ($1 + 1)))
}
ok "the frames are there" frames_are 4

again() { # ARGUMENT...: the same state whatever the machine does
    rm -f report.json
    "$@" --report report.json --grain 20 --quiet && is state_hash "$hash"
}
ok "the same on 2 ranks" again ranks 2 "$DUITE_CLOTH" scene.yaml --threads 1
ok "the same on 2 ranks with 2 threads, cyclic, shuffled" again ranks 2 "$DUITE_CLOTH" scene.yaml --threads 2 \
    --mapping cyclic --scheduler shuffle --seed 7
ok "the report names them" eval 'is ranks 2 && is threads 2 && is scheduler shuffle && is mapping cyclic'
ok "the same on 2 ranks with tasks that run on either" again ranks 2 "$DUITE_CLOTH" scene.yaml --threads 1 --balance scatter
ok "the report counts these" eval 'is balance scatter && test "$(value delegated_tasks)" -gt 0'
ok "the same on 2 ranks with blocks that move" again ranks 2 "$DUITE_CLOTH" scene.yaml --threads 1 --balance wander
ok "the report counts them" eval 'is balance wander && test "$(value migrated_objects)" -gt 0'
ok "the same with tasks for who is idle" again ranks 2 "$DUITE_CLOTH" scene.yaml --threads 1 --balance delegate
ok "the same with blocks for who has less to do" again ranks 2 "$DUITE_CLOTH" scene.yaml --threads 1 --balance migrate
checked() { # the kernels keep to their declarations
    run scene.yaml --end 0.004 --report report.json --quiet || return 1
    plain=$(value state_hash)
    DUITE_CHECK=accesses run scene.yaml --end 0.004 --report report.json --quiet && is state_hash "$plain"
}
ok "the same in checking mode" checked

quietly() { prints run scene.yaml --end 0.002 --quiet && test ! -s printed && test ! -s complained; }
ok "--quiet says nothing" quietly
ok "--end ends" eval 'run scene.yaml --end 0.01 --report report.json && is steps 10 && is simulated_seconds 0.01'
ok "--set sets, in the order given" eval 'run scene.yaml --end 1 --set time.end=0.03 --set time.h=0.002 \
    --set "cloths[0].mesh.grid.nx=9" --report report.json && is steps 15 && is vertices 72'
ok "--set solver.stop" eval 'run scene.yaml --set "solver.stop={count: 3}" --report report.json && is cg_iterations_max 3 &&
    is cg_iterations_mean 3'
ok "an explicit run has no iterations" eval 'run scene.yaml --set integrator=explicit_euler --set time.h=1e-4 --end 0.001 \
    --report report.json && is cg_iterations_mean null && is momentum_lost null'

# ---- The environment, where no option is given

chosen() { # SETTING...: a run with these in its environment
    (for setting; do export "$setting"; done
     run scene.yaml --end 0.004 --report report.json --quiet)
}
ok "the environment chooses" chosen DUITE_SCHEDULER=fifo DUITE_MAPPING=cyclic DUITE_BALANCE=delegate DUITE_THREADS=3 DUITE_SEED=9 \
    DUITE_TRACE=environment.trace
ok "the report names it" eval 'is scheduler fifo && is mapping cyclic && is balance delegate && is threads 3'
ok "the trace is there" test -s environment.trace
options_first() {
    (export DUITE_SCHEDULER=nobody DUITE_MAPPING=nowhere DUITE_BALANCE=never DUITE_THREADS=none DUITE_SEED=no DUITE_TRACE=
     run scene.yaml --end 0.004 --report report.json --quiet --scheduler lifo --mapping block --balance none --threads 2 --seed 3 \
         --trace option.trace) && is scheduler lifo && is mapping block && is balance none && is threads 2 && test -s option.trace
}
ok "options go first" options_first
wrong_variable() { # SENTENCE SETTING [wrong_on_two]: as wrong, and without a folder of frames
    (export "${2?}" && "${3-wrong}" "$1" scene.yaml --output untouched) && test ! -e untouched
}
ok "DUITE_SCHEDULER of no name" wrong_variable \
    "duite-cloth: DUITE_SCHEDULER=lazy in the environment: there is no scheduler of this name; known are steal, " DUITE_SCHEDULER=lazy \
    wrong_on_two
ok "DUITE_MAPPING of no name" wrong_variable \
    "duite-cloth: DUITE_MAPPING=flat in the environment: there is no mapping of this name; known are metis, " DUITE_MAPPING=flat
ok "DUITE_BALANCE of no name" wrong_variable \
    "duite-cloth: DUITE_BALANCE= in the environment: there is no balancer of this name; known are none, " DUITE_BALANCE=
ok "DUITE_THREADS that is no number" wrong_variable \
    "duite-cloth: DUITE_THREADS=2x in the environment: a whole number from 0 to 4096 is expected" DUITE_THREADS=2x
ok "DUITE_SEED that is no number" wrong_variable \
    "duite-cloth: DUITE_SEED=-1 in the environment: a whole number from 0 to 18446744073709551614 is expected" DUITE_SEED=-1
ok "DUITE_TRACE that is empty" wrong_variable "duite-cloth: DUITE_TRACE= in the environment: the name of a file is expected" DUITE_TRACE=
on_one_rank() {
    status=0
    limited "${MPIRUN:-mpirun}" -n 1 "$DUITE_CLOTH" scene.yaml --quiet : \
        -n 1 env DUITE_MAPPING=flat "$DUITE_CLOTH" scene.yaml --quiet > complained 2>&1 || status=$?
    cat complained
    test $status = 2 && grep -q "duite-cloth: DUITE_MAPPING=flat in the environment: there is no mapping" complained
}
ok "DUITE_MAPPING of no name on rank 1 alone" on_one_rank

# The page of all keys. tests/cloth/scene/test_rules.c checks its examples that are parts of a scene.
page=$top/docs/scene.md
made() { # make scene-page writes it
    { cat "$top/cloth/scene/schema/opening.md" && run --keys=markdown; } > page.md && diff "$page" page.md
}
ok "docs/scene.md is what the program prints" made
awk '/^```yaml/ { getline; if (/^schema:/) { n++; inside = 1 } } /^```/ { inside = 0 } inside { print > ("example" n ".yaml") }' "$page"
examples() { for example in example*.yaml; do run "$example" --end 0.01 --quiet || return; done; test "$example" = example2.yaml; }
ok "the scenes in docs/scene.md run" examples

# ---- Ends

# The residual is down to nothing long before: what is left of it must not be taken for an indefinite matrix.
ok "more iterations than there are digits" run scene.yaml --end 0.002 --set time.h=0.0001 --set 'solver.stop={count: 300}'
ok "a cloth that comes to rest" run scene.yaml --set 'gravity=[0, 0, 0]' --set 'cloths[0].velocity=[1, 0, 0]' \
    --set 'cloths[0].pins=[]' --set 'materials.cotton.damping={viscous: 20}' --set time.h=0.01 --end 10 \
    --set 'solver.stop={relative: 1.0e-12}'
few_frames() { run scene.yaml --set time.fps=1.0e-300 --output few && test "$(tail -n 1 few/frames.csv | cut -d , -f 1)" = 0; }
ok "one frame where the next is never due" few_frames

fails() { # a step that is much too long for an explicit run
    status=0
    prints run scene.yaml --set integrator=explicit_euler --set time.halving=off --set time.h=0.1 --set time.end=500 --output diverged || status=$?
    cat complained
    test $status = 1 && test "$(grep -c '^duite-cloth: ' complained)" = 2 &&
        grep -q '^duite-cloth: warning: --set time.h=0.1: steps of 0.1 s are beyond the limit of explicit_euler' complained &&
        grep -q '^duite-cloth: step [0-9]*: .* block [0-9]* .*; the last frame is [0-9]*$' complained
}
ok "a run that diverges names step, block and last frame" fails

too_large() { # each file may have 10 MB: the frames before are whole, and the message says which file and why
    status=0
    prints sh -c 'ulimit -f 20480 && exec "$@"' sh "$DUITE_CLOTH" scene.yaml --set 'cloths[0].mesh.grid={width: 1,
        height: 1, nx: 100, ny: 100}' --set integrator=explicit_euler --set time.h=1e-5 --end 0.001 --set time.fps=100000 \
        --output large --report large.json || status=$?
    echo "exit status $status"
    cat complained
    frame=$(sed -n 's|^duite-cloth: cannot write a frame to large/cloth.pc2: File too large; the last frame is ||p' \
        complained)
    test $status = 1 && test "$(grep -vc ': warning: ' complained)" = 1 && test "$(wc -c < large/cloth.pc2)" -eq $((32 + 120000 * (frame + 1))) &&
        test "$(tail -n 1 large/frames.csv | cut -d , -f 1)" = "$frame" && test ! -e large.json && ! ls large/*.part
}
ok "a file that cannot grow" too_large
ok "a report in the folder of frames" eval 'run scene.yaml --end 0.002 --output both/frames --report both/x.json &&
    test -s both/x.json'
own_output() { # a report to standard output, which is a file: what was there stays, the summary follows
    echo before > whole
    run scene.yaml --end 0.002 --report /dev/stdout >> whole && cat whole && test "$(sed -n 1p whole)" = before &&
        test "$(sed -n 2p whole)" = '{' && grep -q '^  "state_hash": ' whole && grep -q '^  state hash  ' whole &&
        run scene.yaml --end 0.002 --quiet --report /dev/stdout > whole && test "$(sed -n '$p' whole)" = '}'
}
ok "a report to standard output" own_output
full() { # ARGUMENT...: standard output takes nothing
    status=0
    "$DUITE_CLOTH" "$@" > /dev/full 2> complained || status=$?
    cat complained
    test $status = 1 && grep -qx 'duite-cloth: cannot write to standard output: No space left on device' complained
}
ok "a summary that cannot be printed" full scene.yaml --end 0.002
ok "keys that cannot be printed" full --keys
ok "a page that cannot be printed" full --keys=markdown
no_room() {
    status=0
    "$DUITE_CLOTH" scene.yaml --end 0.002 --quiet --report /dev/stdout > /dev/full 2> complained || status=$?
    cat complained
    test $status = 1 && grep -qx 'duite-cloth: cannot write /dev/stdout: No space left on device' complained
}
ok "a report that standard output does not take" no_room

warned() { # a line each: what is said of scenes is in tests/cloth/scene/sentences.txt
    prints run scene.yaml --end 0.002 --set materials.cotton.poisson=0.3 --set integrator=rk4 --set solver.stop.count=3 && cat complained &&
        test "$(wc -l < complained)" = 2 && test "$(grep -c '^duite-cloth: warning: ' complained)" = 2
}
ok "warnings" warned
