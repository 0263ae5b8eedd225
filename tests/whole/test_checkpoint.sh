#!/bin/sh
# Checkpoints: a run that is killed at any moment, by SIGKILL, and restarted on other ranks and threads ends with the state, the report and
# all files of one that was left alone: meshes, frames of each kind with their indexes, tables. Then a later end, and bad input.
# shellcheck disable=SC2086 # commands of several words
. "${srcdir:-.}/tests/support/tap.sh"
. "$srcdir/tests/support/bodies.sh"
skip_unless "$DUITE_CLOTH"
plan_later
here=$PWD
cd "$scratch" || exit 99
kills=2 rounds=2
if quick; then kills=1 rounds=1; fi
if test "${DUITE_LONG:-}" = 1; then kills=4 rounds=6; fi
mpi="${MPIRUN:-mpirun} -n"

cat > sheet.yaml << 'END'
schema: 1
name: sheet
cloths:
  - mesh: {grid: {width: 1, height: 1, nx: 20, ny: 20}}
    material: cotton
    pins: [{vertices: [0, 19]}]
materials:
  cotton: {density: 0.2, stretch: 500, damping: {mass: 1}}
probes:
  - {name: corner, vertices: [399]}
time: {h: 0.002, end: 2, fps: 27}
grain: 60
END
cat > pile.yaml << 'END'
schema: 1
name: pile
cloths:
  - {name: a, material: m, mesh: {grid: {width: 0.3, height: 0.3, nx: 16, ny: 16}}, transform: {translate: [0, 0.05, 0]}}
  - {name: b, material: m, mesh: {grid: {width: 0.3, height: 0.3, nx: 17, ny: 17}}, transform: {translate: [0.02, 0.08, 0.03], rotate: [0.924, 0, 0.383, 0]}}
  - {name: c, material: m, mesh: {grid: {width: 0.3, height: 0.3, nx: 15, ny: 15}}, transform: {translate: [0.02, 0.11, 0.03], rotate: [1, 0, 0.2, 0]}}
materials:
  m: {density: 0.2, stretch: 1000, shear: 300, bend: 1, damping: {viscous: 2e-5, stiffness: 0.004}}
contact: {mode: certified, self: on, thickness: 0.002, friction: 0.3, force: on}
obstacles:
  - {plane: {point: [0, 0, 0], normal: [0, 1, 0]}}
  - {sphere: {centre: [0, 0, 0], radius: 0.03}}
  - {body: {obj: low.obj, translate: [1, 0, 0], frames: {obj: [low.obj, high.obj], fps: 10}}}
probes:
  - {name: corner, cloth: a, vertices: [1, 200], values: [position, contact]}
time: {h: 0.004, end: 0.2, fps: 50}
grain: 120
END
box_obj 0 0 0 0.1 0.1 0.1 > low.obj
box_obj 0 0 0 0.1 0.11 0.1 > high.obj
sed 's/end: 2,/end: 1,/; s/h: 0.002/h: 0.005/' sheet.yaml > phases.yaml
cat >> phases.yaml << 'END'
phases: [{name: one}, {name: two, set: {gravity: [3, -9, 0]}}, {name: three, set: {gravity: [0, -9, 2], time.h: 0.0025}}]
END
if grep -q '^#define HAVE_HDF5 1' "$here/config.h"; then # but for the rank of a block, which is another one on other ranks
    echo 'output: {hdf5: {fields: [velocity, block, strain, contact_force], every: 2}}' >> pile.yaml
    echo 'output: {hdf5: {fields: [velocity, block, strain]}}' >> phases.yaml
fi

# The keys of a report that neither times nor the machine decide.
totals() {
    sed -E '/"(ranks|threads|cores|cores_from|limited_by|[a-z_]*seconds_[a-z_]*|wall_seconds|tasks[a-z_]*|messages|bytes_moved|[a-z_]*fraction|overhead_ns_per_task|peak_memory_bytes|delegated_tasks|migrated_objects|critical_path_seconds|lower_bound_seconds|graphs_recorded)":/ { /"phases"/ !{ /"name":/ !d } }; s/"wall_seconds": [^,}]*/"wall_seconds": 0/' "$1"
}
same_as() { # SCENE FOLDER REPORT: as the run that was left alone
    for file in cloth.pc2 frames.csv probes.csv contact.pc2 cloth.obj scene.json body-0.obj body-0.pc2 cloth.xmf cloth.vtkhdf.series hdf5; do
        test ! -e "$1/$file" || diff -r "$1/$file" "$2/$file" || return 1
    done
    totals "$1.json" > alone.totals && totals "$3" | diff alone.totals - && test "$(value state_hash "$1.json")" = "$(value state_hash "$3")"
}
alone() { # SCENE: the run that is left alone
    limited "$DUITE_CLOTH" "$1.yaml" --threads 1 --quiet --output "$1" --report "$1.json"
}
for scene in sheet pile phases; do ok "$scene, left alone" alone $scene; done

# A number below $1, of a sequence that is the same in every run of this test.
seed=1
random() { # MAX
    seed=$(((seed * 1103515245 + 12345) % 2147483648))
    chosen=$((seed / 65536 % $1))
}
gone() { ! kill -0 "$1" 2> /dev/null; }
# Starts a run in the background: `job`, and `main` is the process of rank 0.
launch() { # OPTION...
    random 3 && ranks=$((chosen + 1))
    random 2 && threads=$((chosen + 1))
    rm -f main
    set -- sh -c 'test "${OMPI_COMM_WORLD_RANK:-${PMI_RANK:-0}}" != 0 || echo $$ > main; exec "$@"' - "$DUITE_CLOTH" "$scene.yaml" --threads $threads --quiet --report killed.json "$@"
    test $ranks = 1 || set -- $mpi $ranks "$@"
    "$@" > said 2>&1 &
    job=$!
}
saved() { ls killed/checkpoints/*.checkpoint > listed 2> /dev/null; }
# Kills rank 0 at some moment after there is a checkpoint that was not there before.
kill_once() {
    saved
    cp listed before 2> /dev/null || : > before
    while ! gone $job && { ! saved || cmp -s listed before; }; do sleep 0.01; done
    random 20
    sleep "0.$(printf %02d $chosen)"
    test -s main && kill -KILL "$(cat main)" 2> /dev/null
    wait $job
    status=$?
    while test -s main && ! gone "$(cat main)"; do sleep 0.01; done
}
killed() { # SCENE: killed some times, then left alone
    scene=$1
    rm -rf killed
    launch --output killed --checkpoint 0.02
    for kill in $(seq $kills); do
        kill_once
        echo "kill $kill: status $status on $ranks ranks, $(cat listed)"
        test $status != 0 || break
        launch --restart killed --checkpoint 0.02
    done
    if test $status != 0; then
        wait $job
        status=$?
    fi
    cat said
    test $status = 0 && same_as $scene killed killed.json
}
for round in $(seq $rounds); do
    for scene in sheet pile phases; do ok "$scene, killed and restarted, round $round" killed $scene; done
done

# ---- A later end, and what is refused

again() { limited "$DUITE_CLOTH" "$@" > said 2>&1; }
short() { rm -rf short && again sheet.yaml --quiet --end 0.7 --output short --checkpoint 100 && rm -rf kept && cp -r short kept; }
ok "the end leaves a checkpoint" eval 'short && test "$(ls short/checkpoints)" = 000001.checkpoint'
later() { rm -rf short && cp -r kept short && again sheet.yaml --quiet --restart short --report later.json && cat said && same_as sheet short later.json; }
ok "a later end is the run to that end" later
over() { rm -rf short && cp -r kept short && again sheet.yaml --quiet --restart short --end 0.7 --report over.json && cmp kept/cloth.pc2 short/cloth.pc2 && cmp kept/probes.csv short/probes.csv; }
ok "a run that was over stays what it was" over

refused() { # SENTENCE OPTION...: status 2, and the folder is as it was
    sentence=$1
    shift
    again sheet.yaml --quiet "$@"
    status=$?
    cat said
    test $status = 2 && grep -qF -e "$sentence" said && diff -r kept short
}
rm -rf short && cp -r kept short
ok "another scene, by its key" refused "is of another scene: time.h is 0.002 there, here it is 0.001; only time.end, and what changes no state, may be others" --restart short --set time.h=0.001
ok "another grain" refused "is of another scene: grain is 60 there, here it is 61" --restart short --grain 61
ok "a key that is in one scene alone" refused "materials.cotton.bend" --restart short --set materials.cotton.bend=1
ok "an earlier end" refused "the run of the checkpoint is to end at 0.7 s: an end may be later, not 0.5 s" --restart short --end 0.5
ok "another folder" refused "--restart DIR goes on writing into DIR: leave --output out" --restart short --output other
ok "no folder" refused "--checkpoint needs --output DIR" --checkpoint 1
ok "no checkpoint" refused "nowhere/checkpoints holds no checkpoint: a run writes them with --checkpoint SECONDS" --restart nowhere
rm -rf nowhere
ok "no seconds" refused "--checkpoint 0: seconds, > 0 and at most 1e9, are expected" --restart short --checkpoint 0
fewer() { printf '\003\000\000\000' | dd of=short/cloth.pc2 bs=1 seek=28 conv=notrunc 2> /dev/null; }
changed() { fewer && again sheet.yaml --quiet --restart short; test $? = 2 && cat said && grep -qF "short/cloth.pc2 has 3 frames, the checkpoint comes after 19: the folder was changed since the checkpoint was written" said; }
ok "frames that were taken away" changed

# ---- Damage

many() { rm -rf short && again sheet.yaml --quiet --end 0.7 --output short --checkpoint 0.02 && test "$(ls short/checkpoints | wc -l)" = 3; }
ok "three are kept" many
damaged() { # COMMAND: the newest is damaged by it; the one before it serves
    many || return 1
    newest=$(ls short/checkpoints/*.checkpoint | tail -n 1) older=$(ls short/checkpoints/*.checkpoint | tail -n 2 | head -n 1)
    "$@" "$newest" && again sheet.yaml --quiet --restart short --report later.json
    status=$?
    cat said
    test $status = 0 && grep -q "^duite-cloth: warning: $newest .*; the one before it is used: $older$" said && same_as sheet short later.json
}
cut_off() { truncate -s 1000 "$1"; }
flip() { printf x | dd of="$1" bs=1 seek=2000 conv=notrunc 2> /dev/null; }
foreign() { echo "a letter" > "$1"; }
ok "a checkpoint that is cut off" damaged cut_off
ok "one with another byte" damaged flip
ok "a foreign file" damaged foreign
all() { for file in short/checkpoints/*; do : > "$file"; done; again sheet.yaml --quiet --restart short; test $? = 2 && cat said && grep -q "short/checkpoints holds no checkpoint that is whole" said; }
ok "none that is whole" all
fresh() { many && again sheet.yaml --quiet --end 0.01 --output short && test ! -e short/checkpoints; }
ok "a run from the start leaves no checkpoints of an earlier one" fresh

# Checkpoints whose hash is right: a checkpoint made by hand, or by a fault of ours. Each is refused by a sentence, before a frame is written.
spoil=$here/tests/whole/spoil
spoilt() { # SCENE WHAT
    rm -rf short && cp -r "kept.$1" short && "$spoil" "$(ls short/checkpoints/*.checkpoint | tail -n 1)" "$2" || return 1
    end=
    test "$1" = pile || end='--end 0.5' # of phases that are over
    again "$1.yaml" --quiet --threads 1 $end --restart short --report spoilt.json
    status=$?
    cat said
}
by_hand() { # SCENE SENTENCE WHAT
    spoilt "$1" "$3" && test $status = 2 && grep -qF -e "$2" said && cmp "kept.$1/cloth.pc2" short/cloth.pc2
}
part() { # SCENE END: a run up to there, with its checkpoint
    rm -rf "kept.$1" && again "$1.yaml" --quiet --threads 1 --end "$2" --output "kept.$1" --checkpoint 100
}
ok "a part of a pile and of a run in phases" eval 'part pile 0.12 && part phases 0.5'
while read -r scene what sentence; do
    ok "spoilt by hand, $what" by_hand $scene "$sentence" $what
done << 'END'
pile length has a time or a length of a step that no run comes to
pile time has a time or a length of a step that no run comes to
pile flag has a flag that is neither on nor off
pile frames counts steps or frames that cannot be
pile ties has ties between blocks that this scene cannot have
pile other has ties between blocks that this scene cannot have
pile side has contacts between blocks or obstacles that this scene does not have
pile room has contacts between blocks or obstacles that this scene does not have
pile kept has contacts between blocks or obstacles that this scene does not have
pile point has places or contacts that no run comes to
pile row has places or contacts that no run comes to
pile next has places or contacts that no run comes to
pile corners has places or contacts that no run comes to
pile place has places or contacts that no run comes to
pile size has a block of another size
phases word does not fit this scene
END
healed() { spoilt pile index && test $status = 0 && same_as pile short spoilt.json; }
ok "an index that is spoilt is made again" healed

# A limit on the size of files stands for a full disk: checkpoints are larger than all else. The last good one stays, and the run goes on.
full() {
    rm -rf short && again sheet.yaml --quiet --end 0.1 --set time.fps=1 --set 'probes=[]' --output short --checkpoint 100 || return 1
    (ulimit -f 64 && exec env UCX_TLS=self "$DUITE_CLOTH" sheet.yaml --quiet --set time.fps=1 --set 'probes=[]' --restart short --checkpoint 0.02 --report full.json) > said 2>&1
    status=$?
    cat said
    ls -l short/checkpoints
    test $status = 0 && test "$(value state_hash full.json)" = "$(value state_hash sheet.json)" && test "$(grep -c 'cannot write the checkpoint .*; the run goes on' said)" = 1 && test -s short/checkpoints/000001.checkpoint
}
ok "a full disk keeps the last good one" full
