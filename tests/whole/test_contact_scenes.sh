#!/bin/sh
# The scenes whose contact is certified, coarse and short: cloth touches, and goes through nothing, by exact arithmetic in each frame.
# No vertex is cut in more than 20 steps in a row.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
plan_later
cd "$scratch" || exit 99

nothing_enters() { # SCENE KEY=VALUE...
    scene=$srcdir/cloth/scenes/$1.yaml
    shift
    for set; do set -- "$@" --set "$set"; shift; done
    limited "$DUITE_CLOTH" "$scene" "$@" --threads 2 --quiet --check-intersections --report report.json || return 1
    grep -E '"(contacts|contact_|intersections|steps)' report.json
    test "$(value intersections)" = 0 && test "$(value intersections_shapes)" = 0 && test "$(value contacts)" -gt 100 &&
        test "$(value contact_cut_run)" -le 20
}
ok "sphere.yaml" nothing_enters sphere 'cloths[0].mesh.grid={width: 1, height: 1, nx: 40, ny: 40}' time.end=0.5
ok "drape.yaml" nothing_enters drape cloths[0].mesh.disc.rings=14 time.end=0.3

# The same on one rank and two, of which the second knows no scene.
drape_on() { # RANKS: the line of the summary
    ranks "$1" "$DUITE_CLOTH" "$srcdir/cloth/scenes/drape.yaml" --set cloths[0].mesh.disc.rings=14 --end 0.08 --threads 1 --grain 300 \
        --report report.json | grep '^  drape '
}
drape_coefficient() {
    test "$(drape_on 1)" = "$(drape_on 2)" && drape_on 2 && grep drape_ report.json &&
        awk "BEGIN { c = $(value drape_coefficient_percent); exit !(c > 90 && c < 99) }"
}
ok "the drape coefficient of cloth that has begun to hang, on one rank and two" drape_coefficient

# The places where cloth over an edge is nearest to it jump along the edge: a cloth that follows them rocks for ever.
comes_to_rest() {
    limited "$DUITE_CLOTH" "$srcdir/cloth/scenes/drape.yaml" --set cloths[0].mesh.disc.rings=16 --end 2.5 --quiet --report report.json &&
        grep -E 'rest_seconds|drape_' report.json && test "$(value rest_seconds)" != null
}
ok "a cloth over an edge comes to rest" comes_to_rest
set --
for i in 0 1 2 3 4; do set -- "$@" "cloths[$i].mesh.grid={width: 0.5, height: 0.5, nx: 15, ny: 15}"; done
ok "stack.yaml" nothing_enters stack "$@" time.end=0.25
ok "twist.yaml" nothing_enters twist 'cloths[0].mesh.grid={width: 0.8, height: 0.25, nx: 41, ny: 14}' time.h=0.01
