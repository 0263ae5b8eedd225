#!/bin/sh
# run.sh TEST: runs one test for automake's TAP driver, which takes the 77 of a skipped test for a failure. A test that is
# stuck ends after an hour. Open MPI keeps its sockets in a folder of the test's own: programs that start at the same moment
# trip over each other in the one that all users' runs share. Paths of sockets are short, so it is always in /tmp.
. "${0%/*}/mpi.sh"
case $1 in
    # AddressSanitizer's slow unwinder, which sees through Open MPI, waits for itself in the loader of llvmpipe's code.
    *tests/cloth/view/*) unset ASAN_OPTIONS ;;
    # Without Open MPI the fast unwinder sees enough, and takes a tenth of the time.
    *tests/cloth/base/* | *tests/cloth/mesh/* | *tests/cloth/physics/* | *tests/cloth/solve/*)
        export ASAN_OPTIONS="$ASAN_OPTIONS:fast_unwind_on_malloc=1" ;;
esac
folder=$(mktemp -d /tmp/duite-mpi.XXXXXX) || exit 99
trap 'rm -rf "$folder"' EXIT
trap 'exit 99' HUP INT TERM
OMPI_MCA_orte_tmpdir_base=$folder timeout --kill-after=10 3600 "$@"
status=$?
test $status = 77 || exit $status
