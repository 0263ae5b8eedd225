#!/bin/sh
# slope.yaml: by Coulomb's law the cloth with the larger coefficient stays where it is, the other one slides with g (sin a - m cos a), m the
# geometric mean of the two sides' coefficients, whichever side has which.
. "${srcdir:-.}/tests/support/probes.sh"

slope() { # KEY=VALUE...
    for set; do set -- "$@" --set "$set"; shift; done
    run "$srcdir/cloth/scenes/slope.yaml" --set 'cloths[0].mesh.grid={width: 0.3, height: 0.3, nx: 7, ny: 7}' \
        --set 'cloths[1].mesh.grid={width: 0.3, height: 0.3, nx: 7, ny: 7}' --set 'probes[0].vertices=[24]' --set 'probes[1].vertices=[24]' "$@"
}
along() { # NAME WHAT: how the probe's place, or velocity, changes down the slope in the last half of a second
    rows '$1 == 100 { x = c("'"$1.24.$2x"'"); y = c("'"$1.24.$2y"'") }
        END { printf "%.15g", (x - c("'"$1.24.$2x"'")) * 0.906307787036650 + (y - c("'"$1.24.$2y"'")) * 0.422618261740699 }'
}
law() { awk -v m="$1" 'BEGIN { printf "%.15g", 9.81 * (0.422618261740699 - m * 0.906307787036650) }'; }

law_holds() { # NAME, m of the smooth cloth, KEY=VALUE...
    name=$1 m=$2 expected=$(law "$2")
    shift 2
    slope "$@" || return 1
    below "the rough cloth moves, m" "$(along rough '' | sed 's/^-//')" 1e-6 &&
        near "the smooth cloth's acceleration, m/s2" "$(awk -v OFMT=%.17g -v v="$(along smooth v)" 'BEGIN { print 2 * v }')" "$expected" 0.01 &&
        row "two sheets of springs on a slope of 25 degrees, μ $name: one stays, m; one slides by μ = $m, acceleration" "0; g (sin α − μ cos α)" "$(digit "$(along rough '')"); $(digit "$(awk -v v="$(along smooth v)" -v a="$expected" 'BEGIN { print 2 * v / a - 1 }')")"
}
ok "one cloth holds, one slides" law_holds 'of `contact` and cloths' 0.3
ok "coefficients of the slope and of cloths mean the same" law_holds 'of the slope and cloths' 0.3 'obstacles[0].box.friction=0.18' 'materials.smooth.friction=0.5' 'materials.rough.friction=2'
ok "materials without one have that of contact" law_holds 'of `contact`' 0.2 contact.friction=0.08 \
    'materials.smooth={density: 0.2, stretch: 1000, shear: 300, bend: 1, damping: {stiffness: 0.004}}'
ok "docs/accuracy.md has these rows" table
