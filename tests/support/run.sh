#!/bin/sh
# run.sh TEST: runs one test for automake's TAP driver, which takes the 77 of a skipped test for a failure. A test that is
# stuck ends after an hour, a long one after eight. Temporary files are in a folder of the test's own, those of Open MPI too: programs of several tests
# that start at the same moment trip over each other in the one that all runs of a user share.
. "${0%/*}/mpi.sh"
case $1 in
    # AddressSanitizer's slow unwinder, which sees through Open MPI, waits for itself in the loader of llvmpipe's code.
    *tests/cloth/view/*) unset ASAN_OPTIONS ;;
    # Without Open MPI the fast unwinder sees enough, and takes a tenth of the time.
    *tests/cloth/base/* | *tests/cloth/mesh/* | *tests/cloth/physics/* | *tests/cloth/solve/*)
        export ASAN_OPTIONS="$ASAN_OPTIONS:fast_unwind_on_malloc=1" ;;
    # The tests of runs take memory millions of times, and with it the slow unwinder ten times as long as without. These look for leaks,
    # which only the slow one can tell from those of Open MPI; the others do not.
    *tests/cloth/flow/test_run | *tests/cloth/flow/test_failures | *tests/cloth/flow/test_memory | *tests/cloth/flow/test_ranks*.sh) ;;
    *tests/whole/test_input.sh | *tests/whole/test_world.sh | *tests/whole/test_lock.sh | *tests/whole/test_signals.sh) ;;
    *tests/cloth/flow/* | *tests/whole/*) export ASAN_OPTIONS="$ASAN_OPTIONS:fast_unwind_on_malloc=1:detect_leaks=0" ;;
esac
folder=$(mktemp -d "${TMPDIR:-/tmp}/duite.XXXXXX") || exit 99
trap 'rm -rf "$folder"' EXIT
trap 'exit 99' HUP INT TERM
case $1 in
    *_long.sh) seconds=28800 ;;
    *) seconds=3600 ;;
esac
TMPDIR=$folder timeout --kill-after=10 $seconds "$@"
status=$?
test $status = 77 || exit $status
