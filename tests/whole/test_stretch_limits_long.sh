#!/bin/sh
# Implicit steps of 1, 5, 20 and 40 ms keep every scene that states a stretch limit within it, by halving steps where
# they must: a table of how often. Scenes run to their end, at least three steps.
. "${srcdir:-.}/tests/support/cloth.sh"
. "$srcdir/tests/support/table.sh"
exec 3>&1


stays() { # SCENE H
    limit=$(sed -n 's/^time:.*stretch_limit: *\([0-9.]*\).*/\1/p' "$1")
    end=$(sed -n 's/^time:.* end: *\([0-9.]*\).*/\1/p' "$1" | awk -v h="$2" '{ print ($1 > 3 * h ? $1 : 3 * h) }')
    test -n "$limit" || { echo "$1 has no time.stretch_limit" && return 1; }
    limited "$DUITE_CLOTH" "$1" --quiet --report report.json --set integrator=implicit_euler --set time.h="$2" --end "$end" || return 1
    printf '# %-16s %-8s %6s steps, %4s halved, largest stretch %.4f of %s\n' "$(basename "$1")" "$2 s" "$(value steps)" \
        "$(value steps_halved)" "$(value stretch_highest)" "$limit" >&3
    awk -v end="$end" -v limit="$limit" -v stretch="$(value stretch_highest)" -v time="$(value simulated_seconds)" -v h="$2" \
        'BEGIN { exit !(stretch + 0 >= 1 && stretch + 0 <= limit + 0 && time > end - h) }' &&
        row "\`$(basename "$1")\`, h = $2 s" "$limit" "$(value stretch_highest | awk '{ printf "%.3f", $1 }') ($(value steps_halved))"
}
for scene in $(grep -l '^time:.*stretch_limit' "$srcdir"/cloth/scenes/*.yaml); do
    for h in 0.001 0.005 0.02 0.04; do
        ok "$(basename "$scene") in steps of $h s" stays "$scene" $h
    done
done
ok "docs/accuracy.md has these rows" table
