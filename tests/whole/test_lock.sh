#!/bin/sh
# A folder belongs to one run at a time: a second one is refused before it touches anything, with a sentence that names the first.
# A lock that a dead process left is replaced on the same host only, whoever has its number now, and whether or not its parent knows.
# shellcheck disable=SC2086 # commands of several words
. "${srcdir:-.}/tests/support/cloth.sh"

cat > scene.yaml << 'END'
schema: 1
cloths:
  - mesh: {grid: {width: 1, height: 1, nx: 8, ny: 8}}
    material: cotton
    pins: [{vertices: [0, 7]}]
materials:
  cotton: {density: 0.2, stretch: 500, damping: {mass: 1}}
time: {h: 0.001, end: 5000, fps: 1000}
grain: 20
END
two="${MPIRUN:-mpirun} -n 2"
host=$(uname -n)
dead=$(sh -c 'echo $$') # a process that was

over() { ! kill -0 "$1" 2> /dev/null; }
begin() { # COMMAND...: a run of hours, in the background, that has frames
    rm -rf frames
    "$@" "$DUITE_CLOTH" scene.yaml --threads 1 --quiet --output frames > first 2>&1 &
    job=$!
    awaits $job test -e frames/cloth.pc2
}
stop() { # PROCESS: a run of hours that ends as it is asked to
    kill -USR1 "$1"
    status=0
    wait "$1" || status=$?
    test $status = 5 && test ! -e frames/duite.lock
}
run() { # a short run into the folder; leaves its status and what it said
    status=0
    limited "$DUITE_CLOTH" scene.yaml --end 0.002 --quiet "$@" > second 2>&1 || status=$?
    echo "exit status $status"
    cat second
}
refused() { # SENTENCE [OPTION...]: and nothing in the folder is another
    sentence=$1
    shift
    (cd frames && ls -l -i --time-style=full-iso -- *.json *.obj) > before
    run --output frames "$@"
    (cd frames && ls -l -i --time-style=full-iso -- *.json *.obj) | cmp - before && test $status = 2 &&
        test "$(cat second)" = "duite-cloth: $sentence"
}
owner() { sed -n 's/^process //p' frames/duite.lock; }
taken() { echo "frames: another run writes into this folder, process $(owner) on host $host; give another folder, or wait for the end of that run; if it has died, remove frames/duite.lock"; }

second() { begin "$@" && refused "$(taken)" && cat first && stop $job && test "$(grep -c 'removed or replaced' first)" = 0; }
ok "a second run in a folder" second env
ok "a second run in a folder, 2 ranks" second $two

at_once() { # of two runs that begin together one goes on
    rm -rf frames
    for number in 1 2; do
        "$DUITE_CLOTH" scene.yaml --threads 1 --quiet --output frames > run$number 2>&1 &
        eval "run$number=$!"
    done
    awaits $$ eval 'over $run1 || over $run2'
    over $run1 && set -- $run1 $run2 1 || set -- $run2 $run1 2
    status=0
    wait "$1" || status=$?
    awaits "$2" test -e frames/cloth.pc2
    echo "exit status $status"
    cat run1 run2
    test $status = 2 && grep -q "another run writes into this folder" "run$3" && stop "$2"
}
ok "two runs that begin together" at_once

result() { run --output frames && test $status = 0 && test ! -e frames/duite.lock; }
ok "a run leaves no lock" result
left() { printf 'host %s\nprocess %s\n' "$1" "$2" > frames/duite.lock; }
left elsewhere "$dead"
ok "a lock of another host" refused "frames: another run writes into this folder, process $dead on host elsewhere; give another folder, or wait for the end of that run; if it has died, remove frames/duite.lock"
: > frames/duite.lock
ok "a lock without a name" refused "frames: another run writes into this folder, or died as it began to: frames/duite.lock names no process; give another folder, or, if no run uses this one, remove that file"
left "$host" "$dead"
: > frames/duite.lock.take
ok "a lock that another run is about to replace" refused "frames: another run writes into this folder, or died as it began to: frames/duite.lock.take names no process; give another folder, or, if no run uses this one, remove that file"
rm frames/duite.lock.take
replaced() {
    result && test "$(cat second)" = "duite-cloth: warning: frames: process $dead of this host left frames/duite.lock and runs no more; this run has the folder now"
}
ok "a lock of a dead process" replaced
killed() { # SIGNAL, which a shell has its background jobs ignore if it is INT: ends a run; whether it leaves its lock
    begin env --default-signal && kill -s "$1" $job && awaits $$ over $job
    wait $job
    echo "exit status $?"
    test -e frames/duite.lock
}
ended() { ! killed "$1" && result && test ! -s second; }
ok "SIGTERM removes the lock" ended TERM
ok "SIGINT removes the lock" ended INT
crashed() { killed KILL && dead=$job && replaced; }
ok "SIGKILL leaves a lock, which the next run replaces" crashed
unreaped() { # as in a container without an init: nobody waits for the process that was killed
    rm -rf frames zombie
    # shellcheck disable=SC2016
    sh -c '"$@" --threads 1 --quiet --output frames > first 2>&1 & echo $! > zombie; exec sleep 1000' - "$DUITE_CLOTH" scene.yaml &
    job=$!
    awaits $job test -e frames/cloth.pc2 && dead=$(cat zombie) && kill -KILL "$dead" && awaits $job grep -q '^State:.*Z' "/proc/$dead/status" && replaced
    status=$?
    kill $job
    return $status
}
# A lock of this shell, as if it had begun then.
begun() { left "$host" $$ && echo "start $1" >> frames/duite.lock; }
alive() { begun "$(sed 's/.*) //' "/proc/$$/stat" | cut -d ' ' -f 20)" && refused "$(taken)"; }
reused() { begun 1 && dead=$$ && replaced; }
if test -e "/proc/$$/stat"; then
    ok "SIGKILL of a run that nobody waits for leaves one, too" unreaped
    ok "a lock of a process that runs" alive
    ok "a lock of an earlier process with the same number" reused
else
    skip "processes that nobody waits for, and numbers that come again" "no /proc"
fi
failed() {
    run --output frames --set integrator=explicit_euler --set time.halving=off --set time.h=0.1 --end 500
    test $status = 1 && test ! -e frames/duite.lock
}
ok "a run that fails leaves no lock" failed
both() { run --output frames --save-system ./frames && test $status = 0 && test ! -s second && test ! -e frames/duite.lock && test -e frames/matrix.mtx; }
ok "frames and system in one folder" both
system() { rm -rf system && mv frames system && left_in system && run --save-system system && test $status = 2 && test -e system/matrix.mtx; }
left_in() { printf 'host elsewhere\nprocess 1\n' > "$1/duite.lock"; }
ok "a folder of a system that another run has" system
