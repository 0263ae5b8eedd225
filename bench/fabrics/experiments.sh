# Sourced by bench/experiments: the tests of a textile laboratory on the fabrics that every scene knows. A fabric's row and curves stay in the
# folder fabrics, so that a command that was interrupted goes on. It has run, value, last_frame, $scratch, $scenes, $here and $quick.
# shellcheck shell=sh disable=SC2154,SC2086

GF_PER_CM=0.980665 # N/m

# A strip of LENGTH (along x) and WIDTH (m) in nx x ny cells, its warp at GRAIN degrees to x.
strip() { # LENGTH WIDTH NX NY GRAIN
    awk -v long="$1" -v width="$2" -v nx="$3" -v ny="$4" -v grain="$5" -f "$here/fabrics/strip.awk" > "$scratch/strip.obj"
}
# The fabric between two jaws, one of which goes by X and Z in a second: times and forces on it are in $scratch/out/probes.csv.
jaws() { # FABRIC LENGTH X Z
    jaw=$(awk -v long="$2" 'BEGIN { print 0.499 * long }')
    cat > "$scratch/jaws.yaml" << END
schema: 1
gravity: [0, 0, 0]
cloths:
  - name: strip
    mesh: {file: strip.obj}
    material: fabric
    pins:
      - box: [[-1, -1, -1], [-$jaw, 1, 1]]
      - {box: [[$jaw, -1, -1], [1, 1, 1]], motion: {times: [0, 1], translate: [[0, 0, 0], [$3, 0, $4]]}}
materials: {fabric: {like: $1, damping: {}}}
probes: [{name: jaw, box: [[$jaw, -1, -1], [1, 1, 1]], values: [total]}]
time: {h: $step, end: 1}
newton: {steps: 20}
END
    laboratory jaws --output "$scratch/out"
}
laboratory() { # SCENE OPTIONS...: of $scratch; what it writes is only of it
    rm -rf "$scratch/out"
    (scenes=$scratch && run 1 1 "$@") || exit 1
}
# Pairs of strain (%) and force (gf/cm) of what is WIDTH wide, from 0 to LENGTH times 20 %.
curve() { # LENGTH WIDTH
    awk -F, -v long="$1" -v width="$2" -v unit=$GF_PER_CM -v way=0.02 '
        NR == 1 { for (i = 1; i <= NF; i++) { if ($i ~ /^"?time/) time = i; if ($i ~ /^"?jaw.*rx/) force = i } next }
        { f = $force / width / unit; printf "%.6g %.6g\n", 100 * way * $time / long, f < 0 ? -f : f }' "$scratch/out/probes.csv"
}
strain_at() { # FILE LOAD: the strain (%) of the curve at LOAD gf/cm; "-" if it ends before
    awk -v load="$2" '$2 >= load && !done { printf "%.2f", NR == 1 ? $1 : x + ($1 - x) * (load - y) / ($2 - y); done = 1 } { x = $1; y = $2 }
        END { if (!done) printf "-" }' "$1"
}
pulls() { # FABRIC: extension along warp, weft and bias, of 10 x 5 cm as FAST has it; shear of 5 x 20 cm, as KES has it
    for grain in 0 90 45; do
        strip 0.1 0.05 $cells $((cells / 2)) $grain
        jaws "$1" 0.1 0.02 0
        curve 0.1 0.05 > "$sheet/$1.$grain"
    done
    strip 0.05 0.2 $((cells / 2)) $((cells * 2)) 0
    jaws "$1" 0.05 0 0.005
    awk -F, -v unit=$GF_PER_CM 'NR == 1 { for (i = 1; i <= NF; i++) { if ($i ~ /^"?time/) time = i; if ($i ~ /^"?jaw.*rz/) force = i } next }
        { degrees = atan2(0.005 * $time, 0.05) * 45 / atan2(1, 1); f = $force / 0.2 / unit; f = f < 0 ? -f : f }
        degrees <= 0.6 { low = degrees; low_f = f }
        degrees <= 2.5 { high = degrees; high_f = f }
        END { printf "%.3f\n", (high_f - low_f) / (high - low) }' "$scratch/out/probes.csv" > "$sheet/$1.shear"
}
# The bending length, cm. ASTM D1388 pushes a strip out until its tip lies 41.5 degrees below the clamp, where c = l / 2; at other angles a it goes as
# Peirce's (cos(a / 2) / tan a)^(1/3). A second run has the length that the first one finds. Cells are short across the strip, or it would twist.
bending_length() { # FABRIC GRAIN
    length=0.05
    for _ in 1 2; do
        strip "$(awk -v l=$length 'BEGIN { print l * 21 / 20.5 }')" "$(awk -v l=$length 'BEGIN { print l / 10.25 }')" 21 8 "$2"
        cat > "$scratch/cantilever.yaml" << END
schema: 1
cloths:
  - name: strip
    mesh: {file: strip.obj}
    transform: {translate: [$(awk -v l=$length 'BEGIN { print l * (0.5 * 21 - 0.5) / 20.5 }'), 0, 0]}
    material: fabric
    pins: [{box: [[-1, -1, -1], [$(awk -v l=$length 'BEGIN { print l * 0.6 / 20.5 }'), 1, 1]]}]
materials: {fabric: {like: $1, damping: {mass: 20}}}
probes: [{name: tip, nearest: [1, 0, 0], values: [position]}]
time: {h: 0.01, end: 10, rest: {speed: 0.0005}}
newton: {steps: 20}
END
        laboratory cantilever --output "$scratch/out"
        length=$(awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) { if ($i ~ /^"?tip.*x/) x = i; if ($i ~ /^"?tip.*y/) y = i } next } { along = $x; down = -$y }
            function peirce(a) { return exp(log(cos(a / 2) * cos(a) / sin(a)) / 3) }
            END { printf "%.6f", '$length' * peirce(atan2(down, along)) / peirce(41.5 * atan2(1, 1) / 45) }' "$scratch/out/probes.csv")
    done
    awk -v l="$length" 'BEGIN { printf "%.2f", 50 * l }'
}
# The drape coefficient, %, and the nodes along the border: how often it comes nearer to the axis and goes away again by 2 mm. Light fabrics that hardly
# stretch fold so narrowly that triangles of 20 rings lock: these have more.
drape() { # FABRIC
    case $1 in
        silk | faille) rings=$fine ;;
        *) rings=$coarse ;;
    esac
    laboratory drape --output "$scratch/out" --set materials.fabric.like="$1" --set "cloths[0].mesh.disc.rings=$rings"
    last_frame "$scratch/out/cloth.pc2" $((3 * rings * (rings + 1) + 1)) | tail -n $((6 * rings)) > "$sheet/$1.border"
    awk '{ r[NR] = sqrt($1 * $1 + $3 * $3) }
        END {
            high = low = r[1]; up = 0
            for (k = 1; k <= 2 * NR; k++) { # twice around: the second time counts
                v = r[(k - 1) % NR + 1]
                if (v > high) high = v
                if (v < low) low = v
                if (up >= 0 && v < high - 0.002) { nodes += up > 0 && k > NR; up = -1; low = v }
                else if (up <= 0 && v > low + 0.002) { up = 1; high = v }
            }
            print nodes + 0 }' "$sheet/$1.border" > "$sheet/$1.nodes"
    value drape_coefficient_percent | awk '{ printf "%.1f", $1 }'
}
# Cusick 1965 fitted 35.6 c - 3.61 c^2 - 2.59 A + 0.0461 A^2 + 17.0 to the coefficients of 130 fabrics, c the bending length (cm) and A the angle at which
# the sheared fabric buckles, which is on no sheet here: the band is that of all A.
band() { # FABRIC C
    case $1 in
        poplin) echo "82.9 measured" ;; # Matsudaira, Masuda, Wada & Yokura 2015
        faille) echo "28.3 measured" ;;
        *) awk -v c="$2" 'BEGIN { high = 17 + 35.6 * c - 3.61 * c * c; printf "%.0f to %.0f", high - 2.59 * 2.59 / 4 / 0.0461, high }' ;;
    esac
}
fabric_row() { # FABRIC
    test -f "$sheet/$1.shear" || pulls "$1"
    for way in warp:0 weft:90; do
        test -f "$sheet/$1.${way%:*}" || { bending_length "$1" "${way#*:}" > "$scratch/c" && mv "$scratch/c" "$sheet/$1.${way%:*}"; }
    done
    test -f "$sheet/$1.drape" || { drape "$1" > "$scratch/c" && mv "$scratch/c" "$sheet/$1.drape"; }
    warp=$(cat "$sheet/$1.warp") weft=$(cat "$sheet/$1.weft")
    {
        printf '| `%s` |' "$1"
        for grain in 0 90; do printf ' %s, %s, %s |' "$(strain_at "$sheet/$1.$grain" 5)" "$(strain_at "$sheet/$1.$grain" 20)" "$(strain_at "$sheet/$1.$grain" 100)"; done
        printf ' %s | %s | %s, %s | %s | %s | %s |\n' "$(strain_at "$sheet/$1.45" 5)" "$(cat "$sheet/$1.shear")" "$warp" "$weft" "$(cat "$sheet/$1.drape")" \
            "$(cat "$sheet/$1.nodes")" "$(band "$1" "$(awk -v a="$warp" -v b="$weft" 'BEGIN { print (a + b) / 2 }')")"
    } > "$sheet/$1.part"
    awk -v name="$1" -v stem="$sheet/$1" -v row="$(cat "$sheet/$1.part")" -f "$here/fabrics/sheet.awk" > "$sheet/$1.svg"
    mv "$sheet/$1.part" "$sheet/$1.row"
}
fabrics() {
    all="poplin wool_suiting wool_plain cotton_denim denim polycotton tablecloth silk faille rib_knit interlock jersey sweatshirt swimwear"
    cells=10 coarse=20 fine=32 step=0.005 sheet=fabrics
    test $quick = no || { all="poplin wool_plain" cells=4 coarse=5 fine=5 step=0.1 sheet=$scratch/fabrics; }
    mkdir -p "$sheet"
    cp "$scenes/drape.yaml" "$scratch"
    echo "Strain (%) at 5, 20 and 100 gf/cm along warp, weft and, at 5, on the bias; shear stiffness (gf/cm degree); bending length of the cantilever (cm, warp,"
    echo "weft); drape coefficient (%) and nodes of the 30 cm specimen on 18 cm, by $coarse rings (silk, faille: $fine), beside the laboratory's. A sheet with curves and"
    echo "silhouette of each is fabrics/NAME.svg"
    echo
    echo "| fabric | warp | weft | bias | G | c | drape | nodes | of laboratories |"
    echo "|---|---|---|---:|---:|---|---:|---:|---|"
    for fabric in $all; do
        test -f "$sheet/$fabric.row" || fabric_row "$fabric"
        cat "$sheet/$fabric.row"
    done
}
