#!/bin/sh
# The live view: what viewers get of a run, that none of them changes or holds it up, and what is said of all that can be wrong on
# either side.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
scene=$srcdir/cloth/scenes/sheet.yaml
small='--set cloths[0].mesh.grid.nx=20 --set cloths[0].mesh.grid.ny=20 --set time.fps=100'
peer=$PWD/tests/whole/live_peer
# Runs last for some seconds, so that viewers that begin beside them find them: s of simulated time.
case "${SANITIZER:-}" in *address*) end=1 ;; *) end=5 ;; esac

if ! grep -q '^#define HAVE_ZMQ 1' config.h; then
    plan_later
    cd "$scratch" || exit 99
    ok "without ZeroMQ --live says so" refuses "built without ZeroMQ" limited "$DUITE_CLOTH" "$scene" --live 5555
    exit
fi
plan_later
cd "$scratch" || exit 99

run() { # ARGUMENT...
    # shellcheck disable=SC2086 # words
    limited "$DUITE_CLOTH" "$scene" $small --threads 1 --quiet "$@"
}
# Starts a run with --live, which goes on until it is told to stop; leaves its process and address.
start() { # ARGUMENT...
    rm -f live
    # shellcheck disable=SC2086 # words
    "$DUITE_CLOTH" "$scene" $small --threads 1 --quiet --live 0 "$@" 2> live &
    simulator=$!
    awaits $simulator grep -q 'duite-view --connect' live || return 1
    address=$(sed -n 's/.*--connect \([0-9.:]*\) on .*/\1/p' live)
}
stop() { # STATUS
    got=0
    kill -USR1 $simulator 2> /dev/null
    wait $simulator || got=$?
    simulator=
    cat live
    test $got = "$1"
}
simulator= follower= server=
end_all() {
    for process in $follower $simulator $server; do
        kill -CONT $process
        kill $process
    done 2> /dev/null
}
trap 'status=$?; end_all; (exit $status); tap_end' EXIT

# ---- Frames

ok "a run without" run --end $end --output plain --report plain.json
hash=$(value state_hash plain.json)
frames() { "$peer" frames "$1" > frames && test -s frames; } # DIR
# Begins a viewer that takes every frame into a file, which is there when the first frame is.
follow() { # FILE
    rm -f "$1"
    "$peer" follow "$address" > "$1" &
    follower=$!
    awaits $follower test -s "$1"
}
# Each line of a follower is one of the folder's.
are_of_folder() { test -s "$1" && grep -v '^#' "$1" | sort > got && sort frames | comm -23 got - > others && cat others && test ! -s others; }
followed() { # a follower that is there before the run: it gets the first frames and the last
    port=$((10000 + $$ % 20000))
    rm -f followed
    "$peer" follow 127.0.0.1:$port > followed &
    follower=$!
    run --end $end --live $port --output seen --report seen.json || return 1
    wait $follower || return 1
    follower=
    frames seen && cat followed && are_of_folder followed && test "$(value state_hash seen.json)" = "$hash" &&
        grep -q "^# the run has ended at frame ${end}00; waits for the next one" followed && grep -q "^$(tail -n 1 frames)\$" followed
}
ok "a viewer gets frames of the folder, and the last one; the hash is the same" followed
ok "the folder is the same" cmp plain/cloth.pc2 seen/cloth.pc2
late() { # the newest frame at once, however old
    start --end 1000 --output late || return 1
    sleep 0.5
    follow followed || return 1
    stop 5 && wait $follower && follower= && frames late && are_of_folder followed && test "$(head -n 1 followed | cut -d ' ' -f 1)" -gt 0
}
ok "a late viewer gets the newest" late
stopped() { # it stops at its first frame
    start --end $end --report stopped.json || return 1
    follow followed && kill -STOP $follower && wait $simulator || return 1
    simulator=
    kill -CONT $follower && kill $follower
    follower=
    test "$(value state_hash stopped.json)" = "$hash"
}
ok "a viewer that is stopped holds nothing up" stopped
two() {
    start --end 1000 || return 1
    follow one || return 1
    second=$follower
    follow other && stop 5 && wait $follower && wait $second && follower=
}
ok "two viewers" two
on_ranks() {
    ranks 2 "$DUITE_CLOTH" "$scene" --set 'cloths[0].mesh.grid.nx=20' --set 'cloths[0].mesh.grid.ny=20' --set time.fps=100 --grain 100 --threads 1 --quiet --end 0.2 \
        --live 0 --report ranks.json && run --end 0.2 --grain 100 --report one.json && test "$(value state_hash ranks.json)" = "$(value state_hash one.json)"
}
ok "on two ranks" on_ranks

# ---- Pictures

if test -x "$DUITE_VIEW"; then
    no_run() {
        status=0
        limited "$DUITE_VIEW" --connect 127.0.0.1:9 --wait 0.3 --png none.png > said 2>&1 || status=$?
        cat said
        test $status = 1 && grep -q 'no frame came within 0.3 s: waits for a run at 127.0.0.1:9' said
    }
    ok "no run is there" no_run
    ok "a folder, too" refuses "--connect shows the newest frame of a run" limited "$DUITE_VIEW" plain --connect 127.0.0.1:9
    ok "no port" refuses "--connect takes HOST:PORT, such as localhost:5555, not \`localhost'" limited "$DUITE_VIEW" --connect localhost
    ok "no time" refuses "--wait takes seconds" limited "$DUITE_VIEW" --connect localhost:9 --png a.png --wait 0
    pictured() {
        start --end 1000 || return 1
        limited "$DUITE_VIEW" --connect "$address" --png live.png --size 64x48 || { stop 5; return 1; }
        stop 5 && test -s live.png
    }
    if limited "$DUITE_VIEW" plain --png folder.png --size 64x48 2> /dev/null; then
        ok "a picture of a run" pictured
    else
        skip "a picture of a run" "no OpenGL 3.3 here"
    fi
    served() { # WHAT SENTENCE
        rm -f port
        "$peer" serve "$1" > port &
        server=$!
        awaits $server test -s port
        refuses "$2" limited "$DUITE_VIEW" --connect "127.0.0.1:$(cat port)" --png none.png --wait 20
        found=$?
        kill $server
        server=
        return $found
    }
    ok "foreign bytes come" served foreign "this is no message of a live view"
    ok "another version comes" served version "version 2 of the live view is spoken there, version 1 here"
    ok "a large message comes" served large "a message of the live view is cut off, or too long"
fi

# ---- What is wrong

ok "no port" refuses "--live 65536: PORT, up to 65535, or ADDRESS:PORT is expected" run --live 65536
ok "no address of this host" refuses "--live 192.0.2.1:5555: this machine has no such address" run --live 192.0.2.1:5555 --output none
ok "then nothing is written" test ! -e none
in_use() {
    start --end 1000 || return 1
    refuses "--live $address: the port is in use" run --live "$address" --output none
    found=$?
    stop 5 && test $found = 0 && test ! -e none
}
ok "a port in use" in_use
hostile() { # whatever comes, the run goes on to its hash, and says once what came
    start --end $end --report hostile.json || return 1
    for what in foreign parts version large; do
        "$peer" send "$address" $what > "$what" || return 1
    done
    cat version
    wait $simulator || return 1
    simulator=
    cat live
    test "$(value state_hash hostile.json)" = "$hash" && grep -qx "version 1" version && test "$(grep -c warning live)" = 2 &&
        grep -q 'warning: --live: what came to port [0-9]* is left without an answer: this is no message' live &&
        grep -q 'is left without an answer: version 2 of the live view is spoken there' live
}
ok "hostile bytes" hostile
# A silent crowd takes all of 256 descriptors that it is given: checkpoints are still written, and viewers come through.
crowded() {
    most=$(ulimit -S -n)
    ulimit -S -n 256
    start --end 1000 --output crowded --checkpoint 0.1
    started=$?
    ulimit -S -n "$most"
    test $started = 0 || return 1
    rm -f crowd
    "$peer" crowd "$address" 336 > crowd &
    server=$!
    awaits $server test -s crowd && ls crowded/checkpoints > before
    awaits $simulator eval '! ls crowded/checkpoints | cmp -s before - || grep "the run goes on" live'
    follow followed && kill $server && stop 5 && server= && wait $follower && follower=
    wrong=$?
    ls -l crowded/checkpoints
    test $wrong = 0 && test "$(grep -c warning live)" = 1 && grep -q 'warning: --live: more than 64 connections came to port [0-9]*: all are closed, and viewers connect again' live
}
ok "a crowd of connections" crowded
