# Sourced by tests that run duite-cloth, in place of tap.sh: skips where it is not built, plans later, and works in $scratch.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
plan_later
cd "$scratch" || exit 99
