# Sourced after tap.sh by tests whose figures docs/accuracy.md shows; works in $scratch, prints to fd 3.
#     noted ERROR                 an error of this case, a number: near and below of probes.sh note theirs
#     row CHECK FORM [RESULT]     a row of the test's table: RESULT, else the largest error that this case noted
#     digit ERROR                 the error with one digit; below 1e-9 a bound, 1e-12 or more: the rest is rounding
#     table [OF]                  passes where docs/accuracy.md has just the rows since the last table, after the line that
#                                 names the test (`test.sh` prints: or `test.sh` prints, OF:); then begins another one.
#                                 With DUITE_TABLES=write it writes them there first

noted() { echo "$1" >> "$scratch/noted"; }

digit() {
    awk -v e="$1" 'BEGIN {
        if (e < 0) e = -e
        if (e >= 1e-9) { s = sprintf("%.0e", e); sub(/e-0/, "e-", s); print s; exit }
        p = 12
        while (p > 9 && 10 ^ -p < 3 * e) p--
        print "below 1e-" p }'
}

row() {
    test $# = 3 || set -- "$1" "$2" "$(digit "$(awk '{ e = $1 < 0 ? -$1 : $1 + 0; if (e > most) most = e } END { print most + 0 }' "$scratch/noted")")"
    echo "| $1 | $2 | $3 |" >> "$scratch/table"
    echo "# | $1 | $2 | $3 |" >&3
}

table_write() { # LINE
    awk -v line="$1" -v rows="$scratch/table" '
        inside && /^\|/ { if (++n < 3) print; next }
        inside && n { put() }
        { print }
        $0 == line { inside = 1 }
        END { if (inside) put() }
        function put(    r) { while ((getline r < rows) > 0) print r; inside = 0 }' "$srcdir/docs/accuracy.md" > "$scratch/page" &&
        cp "$scratch/page" "$srcdir/docs/accuracy.md"
}

table() {
    table_line="\`tests/whole/$(basename "$0")\` prints${1:+, $1}:"
    test "${DUITE_TABLES:-}" != write || table_write "$table_line" || return
    awk -v line="$table_line" 'inside && /^\|/ && ++n > 2; inside && n && !/^\|/ { exit } $0 == line { inside = 1 }' "$srcdir/docs/accuracy.md" > "$scratch/shown"
    table_status=0
    diff "$scratch/shown" "$scratch/table" || table_status=$?
    rm -f "$scratch/table"
    return $table_status
}
