#!/bin/sh
# The drape test with the fabrics that every scene knows: each comes to rest, through nothing, and two meshes differ by at most two
# points. The coefficients are those that docs/physics.md quotes, to a point and a half: a cloth has several shapes at rest.
. "${srcdir:-.}/tests/support/cloth.sh"
exec 3>&1

drape() { # FABRIC RINGS: leaves its coefficient in $found
    limited "$DUITE_CLOTH" "$srcdir/cloth/scenes/drape.yaml" --set materials.fabric.like="$1" --set "cloths[0].mesh.disc.rings=$2" --quiet \
        --check-intersections --report report.json || return 1
    found=$(value drape_coefficient_percent)
    printf '# %-12s %2s rings: %6.2f %%, at rest after %s s\n' "$1" "$2" "$found" "$(value rest_seconds)" >&3
    test "$(value rest_seconds)" != null && test "$(value intersections)" = 0
}
drapes() { # FABRIC QUOTED QUOTED: by 32 and by 40 rings
    drape "$1" 32 || return 1
    coarse=$found
    drape "$1" 40 || return 1
    awk -v a="$coarse" -v b="$found" -v quoted_a="$2" -v quoted_b="$3" '
        function near(x, y, d) { return x - y <= d && y - x <= d }
        BEGIN { exit !(near(a, b, 2) && near(a, quoted_a, 1.5) && near(b, quoted_b, 1.5)) }'
}
# Lines of the table: | `FABRIC` | c | FIRST, SECOND % | ...
while read -r fabric first second; do
    ok "$fabric" drapes "$fabric" "$first" "$second"
done <<END
$(sed -n '/^### Drape/,/^## /s/^| `\([a-z_]*\)` | [0-9.]* cm | \([0-9.]*\), \([0-9.]*\) % .*/\1 \2 \3/p' "$srcdir/docs/physics.md")
END
ok "docs/physics.md has four fabrics" test "$tap_cases" = 4
