#!/bin/sh
# The hosts that the tests here make for themselves: apart from one another, limited as told, and gone without a trace.
. "${srcdir:-.}/tests/support/tap.sh"

hosts=$srcdir/tests/cluster/hosts.sh
why=$("$hosts" 1 true 2>&1 < /dev/null) || { test $? = 77 && skip_all "$why"; }
on_hosts() { limited "$hosts" "$@"; }

dealt() { on_hosts 3 mpirun -n 6 hostname | sort | tr '\n' ' ' | grep -x "h1 h1 h2 h2 h3 h3 "; }
crossed() { # MESSAGES of 10000 bytes from h1 to h2 are seen at both ends
    on_hosts 2 sh -c 'mpirun -n 2 tests/cluster/ranks_traffic 100 10000 && traffic h1 && traffic h2' | tee "$scratch/crossed" |
        awk 'NR == 2 { h1 = $3 } NR == 3 { h2 = $1 } END { exit !(NR == 3 && h1 > 1000000 && h2 > 1000000) }' || ! cat "$scratch/crossed"
}
pulled() {
    on_hosts 2 sh -c 'without() { on h2 ip -o link show e0 | grep -q NO-CARRIER; }
        ! without && unplug h2 && without && plug h2 && ! without'
}
shaped() { on_hosts 1 --rate 100mbit on h1 tc qdisc show dev e0 | grep "tbf .* rate 100Mbit"; }

# The processes of this machine that sleep so long, or have others do it.
left() { grep -lzx "1000\.$$" /proc/[0-9]*/cmdline 2> /dev/null; }
asleep() { left | sed 's/cmdline$/comm/' | xargs cat | grep -cx sleep; }
gone() { # SIGNAL: the script dies of it, and with it what it started on the other host
    "$hosts" 2 mpirun -n 2 sleep "1000.$$" > /dev/null 2>&1 &
    killed=$!
    for wait in $(seq 100); do
        test "$(asleep)" = 2 && break
        sleep 0.1
    done
    test "$(asleep)" = 2 || return
    kill "-$1" $killed
    wait $killed
    for wait in $(seq 100); do
        test -n "$(left)" || return 0
        sleep 0.1
    done
    left
    return 1
}

plan_later
ok "mpirun deals ranks out to the hosts" dealt
ok "messages cross the cables" crossed
ok "a cable is pulled and put back" pulled
if command -v tc > /dev/null; then ok "a cable has a limit" shaped; else skip "a cable has a limit" "tc is missing"; fi
exits 5 "the status is the command's" on_hosts 2 sh -c 'exit 5'
exits 2 "no hosts" "$hosts" 0 true
ok "nothing is left after SIGTERM" gone TERM
ok "nothing is left after SIGKILL" gone KILL
