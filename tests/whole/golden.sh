# Sourced after tap.sh by tests of bits, which hold them against a table.
#     golden_of FILE                   the table, of tests/whole; DUITE_GOLDEN=FILE sh tests/whole/test_X.sh writes it again
#     golden NAME BITS                 a case that passes if the table has the line "BITS NAME"
#     same_metis                       whether METIS cuts a graph that metis_cuts.c makes as the table says: bits of scenes depend on it

golden_of() {
    golden_table=$srcdir/tests/whole/$1
    golden_fresh=${DUITE_GOLDEN:-$scratch/fresh}
    case $golden_fresh in /*) ;; *) golden_fresh=$PWD/$golden_fresh ;; esac
    : > "$golden_fresh"
}

golden() {
    echo "$2 $1" >> "$golden_fresh"
    echo "${golden_table##*/} does not have: $2 $1" > "$scratch/output"
    grep -qxF "$2 $1" "$golden_table"
    tap_result $? "$1"
}

same_metis() {
    test -x tests/whole/metis_cuts || env -u MAKEFLAGS -u MAKELEVEL "${MAKE:-make}" -s tests/whole/metis_cuts > /dev/null || exit 99
    golden_metis="$(tests/whole/metis_cuts) METIS, of a graph that metis_cuts.c makes" || exit 99
    echo "$golden_metis" >> "$golden_fresh"
    test -n "${DUITE_GOLDEN:-}" || grep -qxF "$golden_metis" "$golden_table"
}
