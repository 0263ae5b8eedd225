# Sourced by the shell tests: . "${srcdir:-.}/tests/support/tap.sh"
#
# Tests run in the top build folder; sources are under $srcdir. A test says `plan_later`, then any number of
#     ok NAME COMMAND...               passes when COMMAND exits with 0
#     in_full NAME COMMAND...          likewise, only where the whole of each test is wanted (DUITE_QUICK=0)
#     exits STATUS NAME COMMAND...     passes when COMMAND exits with STATUS
#     not_ok_expected NAME COMMAND...  passes when COMMAND fails by itself: neither a signal nor the time limit
#     refuses SENTENCE COMMAND...      for these: COMMAND ends with 2, prints nothing, and says why in one line, which has the sentence
#     skip NAME REASON                 one case that cannot run here
#     skip_all REASON                  ends the script as skipped (77)
# and the plan and the exit status follow at its end. COMMAND's output is kept in $scratch/output, and shown as
# TAP comments when the case fails. Also:
#     ranks N COMMAND...               COMMAND under mpirun on N ranks, at most $DUITE_TIMEOUT seconds (default 1800): an
#                                      end for what hangs, far above what any command takes on a busy machine. Leaks are
#                                      looked for on at most two ranks
#     cases PROGRAM < TABLE            a case for each line "ARGUMENT... | RANKS... | NAME | SETTING..." and each of its numbers of ranks;
#                                      those with a + only where all is wanted. PROGRAM's status 77 skips. A build with sanitizers takes
#                                      the first number: the others are the same code
#     limited COMMAND...               COMMAND with the same time limit
#     awaits PID COMMAND...            waits until COMMAND passes, as long as the process lives: no time limit of its own
#     quick                            whether only the quick subset is wanted (DUITE_QUICK=1)
#     skip_unless FILE                 skip_all unless the program FILE was built
#     value KEY [FILE]                 what a report has of a key; FILE: report.json
#     install_duite PREFIX             make install there, whatever configure was told; `locations PREFIX` are its settings
# $scratch is a folder of the test's own, removed at its end. $DUITE_CLOTH and $DUITE_VIEW are the programs.
#
# A pipeline fails when one of its commands does: a test whose sh cannot do that goes on in bash (by POSIX, or
# `ulimit -f` counts other blocks). So what reads a pipe reads it to its end:
# grep -c in place of grep -q, which would end its writer by a signal.

if (set -o pipefail) 2> /dev/null; then
    set -o pipefail
elif command -v bash > /dev/null; then
    exec bash --posix -o pipefail "$0" "$@"
fi
srcdir=$(cd "${srcdir:-.}" && pwd) || exit 99
export srcdir
DUITE_CLOTH=${DUITE_CLOTH:-$PWD/duite-cloth}
DUITE_VIEW=${DUITE_VIEW:-$PWD/duite-view}
scratch=$(mktemp -d "${TMPDIR:-/tmp}/duite-test.XXXXXX") || exit 99
tap_cases=0
tap_failed=0
tap_plan=no

. "$srcdir/tests/support/mpi.sh"

tap_end() {
    tap_status=$?
    trap - EXIT
    rm -rf "$scratch"
    if test $tap_plan = yes; then
        echo "1..$tap_cases"
        if test $tap_status = 0 && test $tap_failed != 0; then tap_status=1; fi
    fi
    exit $tap_status
}
trap tap_end EXIT
trap 'exit 99' HUP INT TERM

plan_later() { tap_plan=yes; }

tap_result() { # PASSED NAME
    tap_cases=$((tap_cases + 1))
    if test "$1" = 0; then
        echo "ok $tap_cases - $2"
    else
        tap_failed=$((tap_failed + 1))
        echo "not ok $tap_cases - $2"
        sed 's/^/# /' "$scratch/output"
    fi
}

tap_run() { # COMMAND...: leaves its status in $tap_got
    tap_got=0
    rm -f "$scratch/noted"
    "$@" > "$scratch/output" 2>&1 < /dev/null || tap_got=$?
}

ok() {
    tap_name=$1
    shift
    tap_run "$@"
    test $tap_got = 0 || echo "(exit status $tap_got)" >> "$scratch/output"
    tap_result $tap_got "$tap_name"
}

in_full() { quick || ok "$@"; }

exits() {
    tap_want=$1 tap_name=$2
    shift 2
    tap_run "$@"
    test $tap_got = "$tap_want" || echo "(exit status $tap_got, not $tap_want)" >> "$scratch/output"
    tap_result "$((tap_got != tap_want))" "$tap_name"
}

not_ok_expected() {
    tap_name=$1
    shift
    tap_run "$@"
    if test $tap_got -gt 0 && test $tap_got -lt 124; then
        tap_result 0 "$tap_name"
    else
        echo "(exit status $tap_got; a plain failure was expected)" >> "$scratch/output"
        tap_result 1 "$tap_name"
    fi
}

refuses() {
    tap_sentence=$1 tap_status=0
    shift
    "$@" > "$scratch/printed" 2> "$scratch/complained" || tap_status=$?
    cat "$scratch/printed" "$scratch/complained"
    # A sanitizer without its symbolizer adds lines of its own, and argp tells of --help.
    test $tap_status = 2 && test ! -s "$scratch/printed" && grep -qF -e "$tap_sentence" "$scratch/complained" &&
        test "$(grep -vc -e '^==[0-9]*==' -e ': warning: ' -e '^Try `' -e '^information\.$' "$scratch/complained")" = 1
}

skip() {
    tap_cases=$((tap_cases + 1))
    echo "ok $tap_cases - $1 # SKIP $2"
}

skip_all() {
    tap_plan=no
    echo "1..0 # SKIP $*"
    exit 77
}

skip_unless() { test -x "$1" || skip_all "$1 is not built"; }

value() { sed -n "s/^ *\"$1\": *\"\{0,1\}\(.*[^\",]\)\"\{0,1\},\{0,1\}\$/\1/p" "${2:-report.json}"; }
quick() { test "${DUITE_QUICK:-}" = 1; }

limited() { timeout --kill-after=10 "${DUITE_TIMEOUT:-1800}" "$@"; }

awaits() {
    tap_awaited=$1
    shift
    until "$@" 2> /dev/null; do
        kill -0 "$tap_awaited" 2> /dev/null || return 1
        sleep 0.1
    done
}

ranks() {
    tap_n=$1
    shift
    case "$tap_n ${SANITIZER:-}" in
        [12]\ *) ;;
        *address*) set -- env ASAN_OPTIONS="${ASAN_OPTIONS:-}:fast_unwind_on_malloc=1:detect_leaks=0" "$@" ;; # as in run.sh
    esac
    limited "${MPIRUN:-mpirun}" -n "$tap_n" "$@"
}

# shellcheck disable=SC2086 # lists of words
cases() {
    while IFS='|' read -r tap_arguments tap_ranks tap_title tap_settings; do
        tap_title=$(echo $tap_title)
        for tap_number in $tap_ranks; do
            case $tap_number in *+) quick && continue ;; esac
            tap_number=${tap_number%+}
            tap_name="$tap_title, $tap_number rank$(test "$tap_number" = 1 || echo s)"
            tap_run ranks "$tap_number" env $tap_settings "$1" $tap_arguments
            case $tap_got in
                77) skip "$tap_name" "$(head -n 1 "$scratch/output")" ;;
                *) tap_result $tap_got "$tap_name" ;;
            esac
            test -z "${SANITIZER:-}" || break
        done
    done
}

locations() {
    echo "prefix=$1 exec_prefix=$1 bindir=$1/bin libdir=$1/lib includedir=$1/include datarootdir=$1/share" \
        "datadir=$1/share mandir=$1/share/man pkgconfigdir=$1/lib/pkgconfig"
}

tap_moved() { # PREFIX FILE: as configure makes it with this prefix; the file says prefix=... or set(prefix "...")
    sed -e "s|^prefix=.*|prefix=$1|; s|^libdir=.*|libdir=$1/lib|; s|^includedir=.*|includedir=$1/include|" \
        -e "s|set(prefix .*|set(prefix \"$1\")|; s|set(libdir .*|set(libdir \"$1/lib\")|; s|set(includedir .*|set(includedir \"$1/include\")|" "$2"
}

install_duite() {
    # shellcheck disable=SC2046 # a list of settings
    env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL "${MAKE:-make}" install $(locations "$1") &&
        tap_moved "$1" runtime/duite.pc > "$1/lib/pkgconfig/duite.pc" &&
        tap_moved "$1" runtime/duiteConfig.cmake > "$1/lib/cmake/duite/duiteConfig.cmake"
}
