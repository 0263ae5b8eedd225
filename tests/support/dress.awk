# A dress as others make them, as an OBJ file: in centimetres, lying anyhow, in triangles of all shapes, its vertices in a wild
# order. A tube with two armholes:
#     awk -v around=80 -v rows=60 -f tests/support/dress.awk > dress.obj
# What armholes leave of a tube's cells are two triangles each; for a tube with two holes edges = vertices + triangles + 2.

# From 0 to 1, the same in every awk: Lehmer's generator, whose products a double holds.
function toss() { seed = seed * 16807 % 2147483647; return seed / 2147483647 }

function hole(i, j) { # Whether a cell is in an armhole: a quarter and three quarters round, below the shoulders.
    return j >= 0.72 * rows && j < 0.88 * rows && (i - int(0.2 * around)) % int(0.5 * around) < int(0.1 * around) && i >= int(0.2 * around)
}

function vertex(i, j,    a, r, x, y, z) {
    a = 6.283185307179586 * (i + 0.6 * (toss() - 0.5)) / around
    y = 110 * (j + (j > 0 && j < rows ? 0.6 * (toss() - 0.5) : 0)) / rows
    r = 16 + 24 * (1 - y / 110) ^ 2
    x = r * cos(a); z = 0.7 * r * sin(a)
    at[i, j] = sprintf("v %.9g %.9g %.9g", 0.8 * x - 0.6 * y + 7, 0.6 * x + 0.8 * y - 31, z + 90)
}

function corner(i, j) { used[i % around, j] = 1; return i % around SUBSEP j }

BEGIN {
    seed = 1
    for (j = 0; j <= rows; j++) for (i = 0; i < around; i++) vertex(i, j)
    for (j = 0; j < rows; j++)
        for (i = 0; i < around; i++) {
            if (hole(i, j)) continue
            a = corner(i, j); b = corner(i + 1, j); c = corner(i, j + 1); d = corner(i + 1, j + 1)
            if (toss() < 0.5) { face[n++] = a " " b " " d; face[n++] = a " " d " " c }
            else { face[n++] = a " " b " " c; face[n++] = b " " d " " c }
        }
    all = around * (rows + 1)
    stride = int(0.618 * all)
    while (all % stride == 0 || gcd(all, stride) > 1) stride++
    for (k = 0; k < all; k++) { # Every vertex once, far from the one before it.
        v = k * stride % all
        j = int(v / around); i = v % around
        if ((i, j) in used) { print at[i, j]; number[i SUBSEP j] = ++m }
    }
    for (k = 0; k < n; k++) { split(face[k], f, " "); print "f", number[f[1]], number[f[2]], number[f[3]] }
}

function gcd(a, b,    c) { while (b) { c = a % b; a = b; b = c } return a }
