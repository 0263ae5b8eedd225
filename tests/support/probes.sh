# Sourced in place of tap.sh by tests that hold scenes against closed forms through probes alone; works in $scratch.
#     run SCENE...                     duite-cloth on one thread, quietly; its table of probes in out/probes.csv
#     last COLUMN...                   of the table's last row; columns are named without their unit
#     rows PROGRAM [-v NAME=VALUE]...  awk over the rows, where c(COLUMN) is a number of the row
#     near WHAT FOUND EXPECTED MOST    says the relative error, fails beyond MOST
#     below WHAT FOUND MOST            says what was found, fails where it is more than MOST
#     less A B                         their difference
#     row, table                       rows of docs/accuracy.md (tests/support/table.sh)
#     says SENTENCE SCENE...           a hundredth of a second of the scene, which says the sentence
# near and below print to the test's own output, as TAP comments, also when a case passes.

. "${srcdir:-.}/tests/support/cloth.sh"
. "$srcdir/tests/support/table.sh"
exec 3>&1

says() {
    sentence=$1
    shift
    limited "$DUITE_CLOTH" "$@" --end 0.01 > said 2>&1 || { cat said && return 1; }
    cat said
    grep -qF "$sentence" said
}

run() { limited "$DUITE_CLOTH" "$@" --threads 1 --quiet --output out; }

rows() {
    probes_program=$1
    shift
    awk -F, -v OFMT=%.17g "$@" 'function c(name) { if (name in at) return $at[name]; print "there is no column " name; bad = 1; exit }
        NR == 1 { for (i = 1; i <= NF; i++) { split($i, column, " "); at[column[1]] = i } next }
        '"$probes_program"' END { if (bad) exit 2 }' out/probes.csv
}

last() {
    awk -F, -v names="$*" 'NR == 1 { n = split(names, name, " "); for (i = 1; i <= NF; i++) { split($i, w, " "); at[w[1]] = i } next }
        END { for (k = 1; k <= n; k++) printf "%s ", $at[name[k]]; print "" }' out/probes.csv
}

near() {
    noted "$(awk -v a="$2" -v b="$3" 'BEGIN { printf "%.17g", a / b - 1 }')"
    awk -v what="$1" -v a="$2" -v b="$3" -v most="$4" 'BEGIN { e = a / b - 1; e = e < 0 ? -e : e
        printf "# %s: %.8g, closed form %.8g, error %.2g\n", what, a, b, e; exit !(a != "" && e <= most) }' >&3
}
below() {
    noted "$2"
    awk -v what="$1" -v a="$2" -v most="$3" 'BEGIN { printf "# %s: off by %.2g\n", what, a; exit !(a != "" && a + 0 <= most) }' >&3
}
less() { awk -v OFMT=%.17g -v a="$1" -v b="$2" 'BEGIN { print a - b }'; }
