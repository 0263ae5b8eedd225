# What a welded garment is, of the files that its run left: awk -v density=KG_M2 -f garment.awk scene.json report.json cloth.obj places
# places has the last frame, three numbers a line. Prints: Euler number, loops of the boundary, edges of the boundary, those that its panels and
# seams predict, mass of the panels (kg), their weight's energy at those places (J, with 9.81 m/s2).
function find(i) { while (up[i] != i) i = up[i]; return i }
function edge(a, b) { uses[a < b ? a SUBSEP b : b SUBSEP a]++ }
function length3(x, y, z) { return sqrt(x * x + y * y + z * z) }
function area(a, b, c,   ux, uy, uz, wx, wy, wz) {
    ux = x[b] - x[a]; uy = y[b] - y[a]; uz = z[b] - z[a]
    wx = x[c] - x[a]; wy = y[c] - y[a]; wz = z[c] - z[a]
    return length3(uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx) / 2
}
BEGIN { n = m = faces = 0 }
FILENAME ~ /scene.json$/ && /"sewn"/ { gsub(/[^0-9]+/, " "); sewn = $0 }
FILENAME ~ /report.json$/ && match($0, /"pairs": [0-9]+/) { seam_edges += substr($0, RSTART + 9, RLENGTH - 9) - 1 }
FILENAME ~ /cloth.obj$/ && $1 == "v" { x[n] = $2; y[n] = $3; z[n] = $4; up[n] = n; n++ }
FILENAME ~ /cloth.obj$/ && $1 == "f" { for (k = 0; k < 3; k++) { split($(k + 2), of, "/"); corner[faces, k] = of[1] - 1 } faces++ }
FILENAME ~ /places$/ { height[m++] = $2 }
END {
    for (f = 0; f < faces; f++) {
        for (k = 0; k < 3; k++) edge(corner[f, k], corner[f, (k + 1) % 3])
        share = density * area(corner[f, 0], corner[f, 1], corner[f, 2]) / 3
        for (k = 0; k < 3; k++) { mass += share; energy += share * 9.81 * height[corner[f, k]] }
    }
    for (e in uses) if (uses[e] == 1) predicted++
    predicted -= 2 * seam_edges
    pairs = split(sewn, pair, " ")
    for (i = 1; i < pairs; i += 2) up[find(pair[i])] = find(pair[i + 1])
    delete uses
    for (f = 0; f < faces; f++) for (k = 0; k < 3; k++) edge(find(corner[f, k]), find(corner[f, (k + 1) % 3]))
    for (i = 0; i < n; i++) vertices += up[i] == i
    for (e in uses) { edges++; if (uses[e] == 1) border[e] }
    for (e in border) { boundary++; split(e, end, SUBSEP); at[end[1]]; at[end[2]]; up[find(end[1])] = find(end[2]) }
    for (i in at) loops += find(i) == i
    printf "%d %d %d %d %.9g %.9g\n", vertices - edges + faces, loops, boundary, predicted, mass, energy
}
