#!/bin/sh
# run.sh TEST: runs one test for automake's TAP driver, which takes the 77 of a skipped test for a failure. A test that is
# stuck ends after an hour, a long one after eight; one of ten seconds and more says how long it took. Temporary files are in a
# folder of the test's own, those of Open MPI too: programs of several tests that start at the same moment trip over each other
# in the one that all runs of a user share.
. "${0%/*}/mpi.sh"
case $1 in
    # AddressSanitizer's slow unwinder, which sees through Open MPI, waits for itself in the loader of llvmpipe's code. Without it leaks of
    # ours are not told from those of Open MPI and fontconfig.
    *tests/cloth/view/*.sh) export ASAN_OPTIONS=detect_leaks=0 ;;
    *tests/cloth/view/*) unset ASAN_OPTIONS ;;
    # fontconfig, which cairo draws text with, keeps what it found.
    *tests/tools/test_chart.sh) export ASAN_OPTIONS="$ASAN_OPTIONS:detect_leaks=0" ;;
    # Without Open MPI the fast unwinder sees enough, and takes a tenth of the time.
    *tests/fuzz/* | *tests/cloth/base/* | *tests/cloth/mesh/* | *tests/cloth/garment/* | *tests/cloth/contact/* | *tests/cloth/verify/* | *tests/cloth/physics/* | *tests/cloth/solve/* | *tests/model/*)
        export ASAN_OPTIONS="$ASAN_OPTIONS:fast_unwind_on_malloc=1" ;;
    # With the slow unwinder a rank takes six times as long to start, and a run, which takes memory millions of times, up to ten times as
    # long. Only the slow one can tell leaks from those of Open MPI. These look for them: what runs, what it reads and writes, how it
    # fails; the tests of the runtime, of scenes and output, which stand below, likewise. The others do not.
    *tests/cloth/flow/test_run | *tests/cloth/flow/test_failures | *tests/cloth/flow/test_memory | *tests/cloth/flow/test_ranks*.sh) ;;
    *tests/whole/test_input.sh | *tests/whole/test_lock.sh | *tests/whole/test_signals.sh) ;;
    *tests/cloth/flow/* | *tests/whole/* | *tests/examples/* | *tests/negative/test_environment.sh | *tests/negative/test_lost*.sh | \
        *tests/runtime/test_exit.sh | *tests/runtime/test_stuck.sh | *tests/runtime/test_loaded.sh)
        export ASAN_OPTIONS="$ASAN_OPTIONS:fast_unwind_on_malloc=1:detect_leaks=0" ;;
esac
folder=$(mktemp -d "${TMPDIR:-/tmp}/duite.XXXXXX") || exit 99
trap 'rm -rf "$folder"' EXIT
trap 'exit 99' HUP INT TERM
case $1 in
    *_long.sh) seconds=28800 ;;
    *) seconds=3600 ;;
esac
began=$(date +%s)
TMPDIR=$folder timeout --kill-after=10 $seconds "$@"
status=$?
took=$(($(date +%s) - began))
test $took -lt 10 || echo "# took $took s"
test $status = 77 || exit $status
