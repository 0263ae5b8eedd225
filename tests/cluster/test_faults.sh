#!/bin/sh
# A simulation on two hosts, of which the second one suffers: it goes on, or it ends within fifteen seconds on both,
# with a sentence that names rank and host, without a process left, and with whole frames on disk. With DUITE_LONG=1: all of it.
. "${srcdir:-.}/tests/support/tap.sh"
. "$srcdir/tests/cluster/cluster.sh"
on_hosts 2

# Open MPI notices within seconds that a host does not answer (docs/cluster.md).
keep="--mca oob_tcp_keepalive_time 1 --mca oob_tcp_keepalive_intvl 1 --mca oob_tcp_keepalive_probes 5"
out=$scratch/frames

# A cable that was pulled just now has hosts believe for a while that there is nobody at its other end.
forget_faults() {
    for wait in $(seq 50); do
        on h2 ip -o link show e0 | grep -c LOWER_UP && break
        sleep 0.1
    done
    on h1 ip neigh flush dev e0 && on h2 ip neigh flush dev e0
}

# A sheet that takes long, on two ranks; returns once it has written some frames.
begin() { # [ARGUMENT of mpirun...]
    plug h2 && forget_faults && rm -rf "$out"
    "${MPIRUN:-mpirun}" -n 2 "$@" "$DUITE_CLOTH" "$srcdir/cloth/scenes/sheet.yaml" --quiet --threads 2 --end 100 --output "$out" \
        --set 'cloths[0].mesh.grid.nx=40' --set 'cloths[0].mesh.grid.ny=40' --grain 200 --set time.fps=1000 > "$scratch/log" 2>&1 &
    job=$!
    frames 2
}
frames() { # COUNT: so many are there, within half a minute
    for wait in $(seq 300); do
        test "$(cat "$out/frames.csv" 2> /dev/null | wc -l)" -gt "$1" && return 0
        kill -0 $job 2> /dev/null || break
        sleep 0.1
    done
    cat "$scratch/log"
    return 1
}
progress() { frames $(($(wc -l < "$out/frames.csv") + 2)); }

ends() { # STATUS [SECONDS]: of mpirun
    for wait in $(seq $((10 * ${2:-15}))); do
        kill -0 $job 2> /dev/null || break
        sleep 0.1
    done
    if kill -0 $job 2> /dev/null; then
        echo "mpirun goes on after ${2:-15} s"
        kill -KILL $job
    fi
    got=0
    wait $job 2> /dev/null || got=$?
    grep -v '^--*$' "$scratch/log"
    test $got = "$1" || { echo "status $got" && return 1; }
}
nobody() { # is left on either host
    for wait in $(seq 20); do
        test -z "$(pids h1 duite-cloth; pids h2 duite-cloth; pids h2 orted)" && return 0
        sleep 0.1
    done
    ps -e
    return 1
}
says() { grep -q "$1" "$scratch/log" || { cat "$scratch/log" && return 1; }; }

# The point cache has at least as many frames as its header says, and not a vertex less.
whole() {
    set -- $(od -A n -t d4 -j 16 -N 4 "$out/cloth.pc2") $(od -A n -t d4 -j 28 -N 4 "$out/cloth.pc2") $(wc -c < "$out/cloth.pc2")
    echo "$1 vertices, $2 frames, $3 bytes"
    test "$2" -ge 2 && test "$3" -ge $((32 + $2 * $1 * 12)) && test "$(wc -l < "$out/frames.csv")" -ge $(($2))
}
stops() { kill -USR1 $job && ends 5 30 && says "stopped as asked"; }

second() { pids h2 "$1" | head -n 1; }
killed() { begin "$@" && kill -KILL "$(second duite-cloth)" && ends 137 && says "process rank 1 .* on node h2 exited on signal 9"; }
bereft() { begin "$@" && kill -KILL "$(second orted)" && ends 205; } # the host without its daemon
# Mpirun reacts to a cut within the seconds that follow. How long ago it heard of the host when a cut begins differs by
# half a second from cut to cut.
apart() { # CUTS [ARGUMENT of mpirun...]
    cuts=$1
    shift
    begin "$@" || return 1
    for cut in $(seq "$cuts"); do unplug h2 && sleep 3 && plug h2 && sleep 8.5; done
    progress && stops
}
asleep() { begin "$@" && kill -STOP "$(second duite-cloth)" && sleep 3 && kill -CONT "$(second duite-cloth)" && progress && stops; }
comatose() {
    begin "$@" && kill -STOP "$(second duite-cloth)" && ends 3 &&
        says "duite-cloth: rank 0 ends: rank 1 on host h2 is lost: nothing was heard of it for 8 s"
}
cut_off() { begin "$@" && unplug h2 && ends 205 && says "lost communication with a remote daemon"; }

different() { # scenes on the two ranks
    for size in 40 41; do
        set -- "$@" : -n 1 "$DUITE_CLOTH" "$srcdir/cloth/scenes/sheet.yaml" --quiet --threads 1 --grain 200 --end 0.002 \
            --set "cloths[0].mesh.grid.nx=$size" --set "cloths[0].mesh.grid.ny=40"
    done
    shift
    limited "${MPIRUN:-mpirun}" "$@" > "$scratch/log" 2>&1
    test $? = 2 && says "ranks 0 and 1 were started with different scenes"
}

# After a fault no process is left, and files are whole.
after() {
    ok "... and no process is left" nobody
    ok "... and the frames are whole" whole
}

plan_later
ok "different scenes on two ranks" different
ok "a body fails on one rank" limited "${MPIRUN:-mpirun}" -n 2 tests/negative/ranks failures
if test "${DUITE_LONG:-}" = 1; then
    export OMPI_MCA_odls_base_sigkill_timeout=1 # as users have it
    ok "a rank is stopped for good" comatose
    after
    ok "a rank is killed" killed
    after
    # shellcheck disable=SC2086 # a list of options
    ok "memory runs out on one rank" limited "${MPIRUN:-mpirun}" -n 2 tests/negative/starved memory
    ok "a daemon is killed" bereft
    after
    ok "a host is cut off" cut_off $keep
    after
    ok "a host is cut off for three seconds" apart 1
    after
    # shellcheck disable=SC2086
    ok "a host is cut off for three seconds, four times, and mpirun watches" apart 4 $keep
    after
    ok "a rank is stopped for three seconds" asleep
    after
fi
