#!/bin/sh
# The drape test with the fabrics that every scene knows: each comes to rest, through nothing, with the coefficient of docs/fabrics.md
# to two points: a cloth has several shapes at rest. Two finer meshes of some differ by at most three, as
# each finds folds of its own.
. "${srcdir:-.}/tests/support/cloth.sh"
exec 3>&1

drape() { # FABRIC RINGS: leaves its coefficient in $found
    limited "$DUITE_CLOTH" "$srcdir/cloth/scenes/drape.yaml" --set materials.fabric.like="$1" --set "cloths[0].mesh.disc.rings=$2" --quiet \
        --check-intersections --report report.json || return 1
    found=$(value drape_coefficient_percent)
    printf '# %-12s %2s rings: %6.2f %%, at rest after %s s\n' "$1" "$2" "$found" "$(value rest_seconds)" >&3
    test "$(value rest_seconds)" != null && test "$(value intersections)" = 0
}
differ() { awk -v a="$1" -v b="$2" -v by="$3" 'BEGIN { exit !(a - b <= by && b - a <= by) }'; }
quoted() { # FABRIC COEFFICIENT: by the rings of bench/experiments fabrics
    rings=20
    case $1 in silk | faille) rings=32 ;; esac
    drape "$1" $rings && differ "$found" "$2" 2
}
finer() { # FABRIC
    drape "$1" 32 || return 1
    coarse=$found
    drape "$1" 40 && differ "$coarse" "$found" 3
}
# Lines of the table: | `FABRIC` | warp | weft | bias | G | c | DRAPE | ...
while read -r fabric coefficient; do
    ok "$fabric" quoted "$fabric" "$coefficient"
done <<END
$(awk -F ' *[|] *' '/^[|] `/ && NF == 11 { gsub(/`/, "", $2); print $2, $8 }' "$srcdir/docs/fabrics.md")
END
ok "docs/fabrics.md has fourteen fabrics" test "$tap_cases" = 14
for fabric in polycotton denim silk; do
    ok "$fabric on finer meshes" finer $fabric
done
