# Sourced by the tests of this folder after tap.sh.
#
#     on_hosts N [--rate RATE]   goes on on the first of N hosts (hosts.sh), or skips the whole test where there can be none
#     report KEY FILE            the value of a key in a report of duite-cloth

on_hosts() {
    test -z "${DUITE_HOSTS:-}" || return 0
    why=$("$srcdir/tests/cluster/hosts.sh" "$1" true 2>&1 < /dev/null)
    case $? in
        0) rm -rf "$scratch" && exec "$srcdir/tests/cluster/hosts.sh" "$@" /bin/sh "$0" ;;
        77) skip_all "$why" ;;
        *) echo "Bail out! $why" && exit 99 ;;
    esac
}

report() { sed -n "s/^ *\"$1\": *\"\\{0,1\\}\\([^\",]*\\).*/\\1/p" "$2"; }
