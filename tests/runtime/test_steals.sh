#!/bin/sh
# On a machine with two packages of eight cores, as hwloc is told, `locality` steals less from the other package than `steal`.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later

far() { # SCHEDULER: the share of far steals, in percent
    (unset HWLOC_COMPONENTS && HWLOC_SYNTHETIC='pack:2 l3:1 core:8 pu:1' tests/runtime/steals "$1" 16) > "$scratch/$1" || return 1
    awk '{ print "# '"$1"': " $1 " stolen, " $2 " of them far" > "/dev/stderr"; print $1 ? int(100 * $2 / $1) : 100 }' "$scratch/$1"
}
less_far() { a=$(far locality) && b=$(far steal) && test "$a" -lt "$b"; }
ok "locality steals less from afar" less_far
