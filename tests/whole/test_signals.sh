#!/bin/sh
# SIGUSR1 and SIGTERM stop a run: it finishes its step, whenever the next frame is due, and writes the state after it as the last frame. It
# may come to any rank, and before the run begins. Each run here would take hours: one that goes on is killed, and fails.
# shellcheck disable=SC2086 # commands of several words
. "${srcdir:-.}/tests/support/cloth.sh"

cat > scene.yaml << 'END'
schema: 1
name: handkerchief
cloths:
  - mesh: {grid: {width: 1, height: 1, nx: 8, ny: 8}}
    material: cotton
    pins: [{vertices: [0, 7]}]
materials:
  cotton: {density: 0.2, stretch: 500, damping: {mass: 1}}
probes:
  - {name: corner, vertices: [63]}
time: {h: 0.001, end: 100000, fps: 1e-5}
grain: 20
END
two="${MPIRUN:-mpirun} -n 2"
# Says which process a rank is.
cat > rank << 'END'
echo $$ > pid.${OMPI_COMM_WORLD_RANK:-${PMI_RANK:-0}}
exec "$@"
END

rows() { test -e frames/probes.csv && test "$(wc -l < frames/probes.csv)" -gt "$1"; }
ends_well() { # of the run in the background: status 5, though it would take hours
    status=0
    wait $job || status=$?
    echo "exit status $status"
    cat complained
    test $status = 5
}

begin() { # COMMAND...: in the background, until it has made three steps
    rm -rf frames pid.* stopped.json
    "$@" sh rank "$DUITE_CLOTH" scene.yaml --threads 2 --output frames --report stopped.json > printed 2> complained &
    job=$!
    awaits $job rows 3
}
whole() { # frames 0 and 1, the second of the step that the run ended with; the same bits as a run that ends there
    set -- $(sed -n 's/^duite-cloth: stopped as asked by a signal after step \([0-9]*\), at .* of 100000 s; the last frame is 1$/\1/p' complained)
    cat frames/frames.csv
    test -n "$1" && test "$(wc -l < frames/frames.csv)" = 3 && test "$(wc -c < frames/cloth.pc2)" -eq $((32 + 2 * 12 * 64)) &&
        test "$(sed -n 's/^1,//p' frames/frames.csv)" = "$(value simulated_seconds stopped.json)" &&
        test "$(tail -n 1 frames/probes.csv | cut -d , -f 1)" = "$1" &&
        limited "$DUITE_CLOTH" scene.yaml --end "$(value simulated_seconds stopped.json)" --quiet --report whole.json &&
        test "$(value state_hash whole.json)" = "$(value state_hash stopped.json)"
}
stopped() { begin "$@" && kill -USR1 $job && ends_well && whole; }
ok "SIGUSR1 finishes the step" stopped env
ok "SIGUSR1 finishes the step, 2 ranks" stopped $two
terminated() { begin "$@" && kill -TERM $job && ends_well && whole; }
ok "SIGTERM finishes the step" terminated env
to_all() { begin $two && kill -TERM $(cat pid.0 pid.1) && ends_well && whole; }
ok "SIGTERM to two ranks" to_all
one_rank() { begin $two && kill -USR1 "$(cat "pid.$1")" && ends_well && whole; }
ok "SIGUSR1 to rank 0 alone" one_rank 0
ok "SIGUSR1 to rank 1 alone" one_rank 1

due() { # a frame that is due is not written twice
    sed 's/fps: 1e-5/fps: 1000/; s/end: 100000/end: 5000/' scene.yaml > dense.yaml
    rm -rf frames
    "$DUITE_CLOTH" dense.yaml --output frames > printed 2> complained &
    job=$!
    awaits $job rows 3 && kill -USR1 $job && ends_well || return 1
    set -- $(sed -n 's/^duite-cloth: stopped as asked by a signal after step \([0-9]*\), .*; the last frame is \([0-9]*\)$/\1 \2/p' complained)
    tail -n 2 frames/frames.csv
    test "$1" = "$2" && test "$(tail -n 1 frames/frames.csv | cut -d , -f 1)" = "$2"
}
ok "a frame that is due is not written twice" due

# ---- Before the run begins

before() { # COMMAND...: the scene comes through a pipe, which is open when rank 0 reads it, and stays empty
    rm -rf frames pid.* stopped.json
    mkdir frames && echo mine > frames/note && rm -f pipe.yaml && mkfifo pipe.yaml || return 1
    "$@" sh rank "$DUITE_CLOTH" pipe.yaml --output frames --report stopped.json > printed 2> complained &
    job=$!
    exec 3> pipe.yaml
    kill -"$signal" "$(cat "pid.$from")"
    ends_well
    ended=$?
    exec 3>&-
    test $ended = 0 && test ! -s printed && test "$(ls frames)" = note && test ! -e stopped.json &&
        grep -qx "duite-cloth: stopped as asked by a signal before the first step; nothing was written" complained
}
from=0 signal=TERM
ok "SIGTERM while the scene is read" before env
signal=USR1
ok "SIGUSR1 while the scene is read" before env
ok "SIGUSR1 while the scene is read, 2 ranks" before $two
from=1
ok "SIGUSR1 to rank 1 while rank 0 reads the scene" before $two

# A sheet is cut into many blocks, by METIS, which takes a SIGTERM that reaches it for an error of its own.
sed 's/nx: 8, ny: 8/nx: 600, ny: 600/; s/\[0, 7\]/[0]/; s/fps.*/fps: 1}/' scene.yaml > large.yaml
building() {
    for moment in 0.7 1 1.3; do
        "$DUITE_CLOTH" large.yaml --output built > printed 2> complained &
        job=$!
        sleep $moment
        kill -TERM $job && ends_well || return 1
    done
}
ok "SIGTERM while a scene is built" building
