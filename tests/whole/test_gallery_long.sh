#!/bin/sh
# docs/gallery.md shows the scenes of cloth/scenes/gallery as they are, each with a small picture; each runs, and nothing in it goes through
# anything, by exact arithmetic in each frame.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
plan_later
page=$srcdir/docs/gallery.md
folder=$srcdir/cloth/scenes/gallery
cd "$scratch" || exit 99

printed() { # the block of the page is the file, without the line that says what it shows, which stands above it
    awk -v mark="<!-- cloth/scenes/gallery/$scene.yaml -->" '
        $0 == mark { found = 1; next }
        found && /^```yaml$/ { inside = 1; next }
        inside && /^```$/ { exit }
        inside { print }' "$page" > block
    sed 1d "$folder/$scene.yaml" | diff - block && grep -qxF "$(sed -n '1s/^# //p' "$folder/$scene.yaml")" "$page" &&
        test "$(wc -l < block)" -le 15
}
pictured() {
    grep -qF "](pictures/gallery-$scene.png)" "$page" && test "$(wc -c < "$srcdir/docs/pictures/gallery-$scene.png")" -le 61440
}
runs() {
    limited "$DUITE_CLOTH" "$folder/$scene.yaml" --check-intersections --quiet --report report.json && grep intersections report.json &&
        test "$(value intersections)" = 0 && test "$(value intersections_shapes)" = 0
}
n=0
for file in "$folder"/*.yaml; do
    scene=$(basename "$file" .yaml)
    ok "$scene.yaml is the one in the page" printed
    test "$scene" != studio || continue
    n=$((n + 1))
    ok "$scene.yaml has a small picture" pictured
    ok "$scene.yaml runs" runs
done
ok "there are twenty" test $n = 20
