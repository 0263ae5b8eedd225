#!/bin/sh
# The garment scenes, coarse: T-shirt, jeans and both are sewn around the mannequin, welded and draped. No frame has an intersection; the
# garment has the Euler number and boundary of what it is, and the mass of its panels. One state_hash over ranks, threads and policies.
. "${srcdir:-.}/tests/support/cloth.sh"
. "$srcdir/tests/whole/dressing.sh"

# Jeans so coarse do not come to rest: a drape of 0.4 s. Only the T-shirt's goes on until rest.
scene dressing 900 3 && scene jeans 900 0.4 && scene layers 900 0.4 || exit 99
ok "the T-shirt is sewn, worn and rests" dressed dressing "end sewn rest"
ok "the jeans are sewn and worn" dressed jeans "end sewn end"
ok "the T-shirt is sewn over the jeans" dressed layers "end sewn end sewn end"

# An orientable surface of genus 0 with so many loops of boundary has the Euler number 2 - loops: one waist or hem, one neck, two legs or
# sleeves. Each seam takes its edges of both sides from the boundary. The weight's energy in the last frame, of single precision, is that
# of the panels' masses, at rest, a third of each triangle at each corner.
garment() { # NAME DENSITY LOOPS
    n=$(grep -c '^v ' "$1/cloth.obj") && tail -c $((12 * n)) "$1/cloth.pc2" | od -An -v -tf4 -w12 > "$1/places" || return 1
    awk -v density="$2" -f "$srcdir/tests/whole/garment.awk" "$1/scene.json" "$1/report.json" "$1/cloth.obj" "$1/places" > "$1/garment" || return 1
    cat "$1/garment" && echo "gravity: $(value energy_gravity "$1/report.json")"
    awk -v loops="$3" -v want="$(value energy_gravity "$1/report.json")" '
        { exit !($1 == 2 - loops && $2 == loops && $3 == $4 && $3 > 20 && ($6 / want - 1) ^ 2 < 1e-12) }' "$1/garment"
}
ok "the welded T-shirt is whole, with the mass of its panels" garment dressing 0.2 4
ok "the welded jeans too" garment jeans 0.3 3

# Sewing, welding and the begin of the drape.
scene dressing 500 0.1 || exit 99
ok "a hash of one rank" alike dressing 1
ok "the same of two ranks of two threads" alike dressing 2 --threads 2 --scheduler fifo --mapping cyclic --balance migrate
in_full "of three ranks" alike dressing 3 --scheduler steal --mapping cyclic
in_full "of two threads" alike dressing 1 --threads 2 --scheduler fifo --mapping cyclic
in_full "of two ranks" alike dressing 2 --scheduler steal --mapping metis --balance migrate
in_full "of three ranks of two threads" alike dressing 3 --threads 2 --scheduler fifo --mapping metis --balance migrate
