#!/bin/sh
# count.sh FILE.trs...: sums the cases of automake's test results into one plain line. A script that ends with an error
# because cases of it failed counts by those cases alone.
awk '
    function close_file() { if (!bad) failed += errors; failed += bad; bad = errors = 0 }
    FNR == 1 { close_file() }
    /^:test-result: (PASS|XFAIL)/ { passed++ }
    /^:test-result: (FAIL|XPASS)/ { bad++ }
    /^:test-result: ERROR/ { errors++ }
    /^:test-result: SKIP/ { skipped++ }
    END { close_file(); printf "%d passed, %d failed, %d skipped\n", passed, failed, skipped }
' /dev/null "$@"
