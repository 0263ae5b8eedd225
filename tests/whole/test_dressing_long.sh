#!/bin/sh
# The garment scenes whole, on the mannequin and, where its file is there, on a body of another source: sewn, at rest, no frame with an
# intersection. One state_hash of each over ranks, threads, schedulers, mappings and balancers, coarser and with a drape of 0.1 s.
. "${srcdir:-.}/tests/support/cloth.sh"
. "$srcdir/tests/whole/dressing.sh"

body=$srcdir/../shared/data/body/female_generic.obj
one="end sewn rest" two="end sewn end sewn rest"
rests() { # NAME WANTED
    scene "$1" 5000 3 && dressed "$1" "$2"
}
ok "the T-shirt on the mannequin" rests dressing "$one"
ok "the jeans on the mannequin" rests jeans "$one"
ok "the T-shirt over the jeans on the mannequin" rests layers "$two"
# Garments of a walker do not rest; the drape before the walk rests.
walks() { scene layers 6000 3 && scene walk 6000 3 walk && dressed walk "$two end"; }
ok "both on the mannequin as it walks" walks

# The body is 1.605 m tall, in decimetres, with the origin 0.819 m above its feet, and stands 6 cm before the middle of the garments.
other() { # NAME: NAME.yaml with the other body, and measures that fit it
    sed -i.mannequin "s|body: {mannequin: {}|body: {obj: \"$body\", scale: 0.1, translate: [0, 0.819, 0]|
        s|garment: trousers|garment: trousers, measures: {height: 1.605, waist: 0.72, hip: 0.94}|
        s|measures: {arm: 0.34|measures: {height: 1.605, chest: 0.88, shoulders: 0.37, neck: 0.40, armhole: 0.22|
        s|^    material: |    transform: {translate: [0, 0, 0.06]}\\
    material: |" "$1.yaml"
}
other_rests() { # NAME WANTED
    scene "$1" 5000 3 && other "$1" && dressed "$1" "$2"
}
other_ok() { # NAME COMMAND...
    if test -f "$body"; then ok "$@"; else skip "$1" "no $body"; fi
}
other_ok "the T-shirt on the other body" other_rests dressing "$one"
other_ok "the jeans on the other body" other_rests jeans "$one"
other_ok "the T-shirt over the jeans on the other body" other_rests layers "$two"

alike_all() { # SCENE OPTION...
    all_of=$1
    shift
    rm -f "$all_of.hash"
    alike "$all_of" 1 "$@" &&
        alike "$all_of" 1 --threads 2 --scheduler fifo --mapping cyclic "$@" &&
        alike "$all_of" 2 --scheduler locality --mapping taskgraph --balance delegate "$@" &&
        alike "$all_of" 2 --threads 2 --scheduler steal --mapping metis --balance migrate "$@" &&
        alike "$all_of" 3 --scheduler priority --mapping list --balance migrate "$@" &&
        alike "$all_of" 3 --threads 2 --scheduler fifo --mapping cyclic --balance delegate "$@"
}
mannequin_alike() { scene "$1" 900 0.1 && alike_all "$1"; }
other_alike() { scene "$1" 900 0.1 && other "$1" && alike_all "$1"; }
for name in dressing jeans layers; do
    ok "one hash of $name.yaml" mannequin_alike $name
    other_ok "one hash of $name.yaml on the other body" other_alike $name
done
walk_alike() { # a drape of 0.1 s; the walk begins after 0.2 s
    scene layers 900 0.1 && scene walk 900 0.3 walk && alike_all walk
}
ok "one hash of walk.yaml" walk_alike
shirt_alike() { scene shirt 700 0 && alike_all shirt --set 'phases[1].set.time.end=0.01'; }
ok "one hash of shirt.yaml" shirt_alike
