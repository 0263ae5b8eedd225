#!/bin/sh
# run.sh TEST: runs one test for automake's TAP driver, which takes the 77 of a skipped test for a failure. A test that is
# stuck ends after half an hour, a long one after eight hours; one of ten seconds and more says how long it took. Temporary files are in a
# folder of the test's own, those of Open MPI too: programs of several tests that start at the same moment trip over each other
# in the one that all runs of a user share.
. "${0%/*}/mpi.sh"
# Leaks beside MPI are told from those of MPI by AddressSanitizer's slow unwinder alone. With it a rank takes six times as long to start, and a
# run, which takes memory millions of times, up to ten times as long: so $LEAK_TESTS look for them, and the other tests that begin MPI do not.
# A program without MPI looks for them by the fast one.
case "${SANITIZER:-} $LEAK_TESTS " in
    *address*" tests/${1##*/tests/} "*) ;;
    *address*)
        ASAN_OPTIONS="$ASAN_OPTIONS:fast_unwind_on_malloc=1"
        case $1 in *.sh) false ;; *) ! grep -qE 'MPI_Init|libduite\.so' "$1" ;; esac || ASAN_OPTIONS="$ASAN_OPTIONS:detect_leaks=0" ;;
esac
folder=$(mktemp -d "${TMPDIR:-/tmp}/duite.XXXXXX") || exit 99
trap 'rm -rf "$folder"' EXIT
trap 'exit 99' HUP INT TERM
case $1 in
    *_long.sh) seconds=28800 ;;
    *) seconds=1800 ;;
esac
began=$(date +%s)
TMPDIR=$folder timeout --kill-after=10 $seconds "$@"
status=$?
took=$(($(date +%s) - began))
test $took -lt 10 || echo "# took $took s"
test $status = 77 || exit $status
