#!/bin/sh
# The messages and bytes that the runtime counts are those that cross the network, within 10 %.
#
# A cable counts packets, and bytes with the 66 that frame each: Ethernet 14, IP 20, TCP 32 with its time stamps. Without them the
# bytes are what MPI sent. mpirun talks across the cable as well, and MPI when it starts: a run without messages is subtracted. A
# message has 64 bytes before its values, which the runtime counts, and from Open MPI some 30, which it cannot know: next to a
# kilobyte they stay within the 10 %. Messages are compared with packets where they go one way, far apart and smaller than a packet:
# then each is one. With DUITE_LONG=1: also at 100 Mbit/s.
. "${srcdir:-.}/tests/support/tap.sh"
. "$srcdir/tests/cluster/cluster.sh"
on_hosts 2

# Runs a command; leaves in $scratch/crossed what crossed the cable meanwhile, in both directions together, without frames, and how many
# packets h1 sent; and in $scratch/said what the command printed.
crossed() {
    traffic h1 > "$scratch/before"
    limited "${MPIRUN:-mpirun}" -n 2 "$@" > "$scratch/said" || return
    traffic h1 | cat "$scratch/before" - | awk '
        NR == 1 { for (i = 1; i < 5; i++) before[i] = $i }
        NR == 2 { for (i = 1; i < 5; i++) $i -= before[i]; print $1 + $3 - 66 * ($2 + $4), $4 }' > "$scratch/crossed"
}
near() { # COUNTED CROSSED IDLE
    echo "$1 counted, $2 at the cable, $3 of them without messages"
    awk -v "counted=$1" -v "crossed=$(($2 - $3))" 'BEGIN { exit !(crossed > 0 && counted / crossed > 0.9 && counted / crossed < 1.1) }'
}

# MESSAGES of so many BYTES
messages() {
    crossed tests/cluster/ranks_traffic 0 "$2" && read -r bytes idle < "$scratch/crossed" &&
        crossed tests/cluster/ranks_traffic "$1" "$2" && read -r bytes packets < "$scratch/crossed" && read -r counted bytes < "$scratch/said" &&
        test "$counted" -ge "$1" && near "$counted" "$packets" "$idle"
}
bytes() {
    crossed tests/cluster/ranks_traffic 0 "$2" && read -r idle packets < "$scratch/crossed" &&
        crossed tests/cluster/ranks_traffic "$1" "$2" && read -r bytes packets < "$scratch/crossed" && read -r packets counted < "$scratch/said" &&
        test "$counted" -ge $(($1 * $2)) && near "$counted" "$bytes" "$idle"
}

# A sheet, by the report: two steps against one. Rims of blocks of 5000 vertices are large enough.
steps() {
    crossed "$DUITE_CLOTH" "$srcdir/cloth/scenes/sheet.yaml" --quiet --threads 1 --end "$1" --grain 5000 --report "$scratch/report"
}
sheet() {
    steps 0.001 && read -r idle packets < "$scratch/crossed" && first=$(report bytes_moved "$scratch/report") &&
        steps 0.002 && read -r bytes packets < "$scratch/crossed" && near $(($(report bytes_moved "$scratch/report") - first)) "$bytes" "$idle"
}

plan_later
ok "messages" messages 1000 1000
ok "bytes in middling messages" bytes 500 10000
if test "${DUITE_LONG:-}" = 1; then
    ok "bytes in large messages" bytes 5 2000000
    for host in h1 h2; do ok "$host gets a limit" limit $host 100mbit; done
    ok "messages at 100 Mbit/s" messages 1000 1000
    ok "bytes in large messages at 100 Mbit/s" bytes 5 2000000
    ok "bytes of a sheet" sheet
fi
