# A mesh that is turned about an axis, as OBJ: what scenes of this folder read that no shape or grid is.
#     awk -v shape=tube -v n=360 -f turned.awk > tube.obj
# tube: radius 0.5 m, 2 m along x, in n divisions, and as many around it as make cells square, their diagonals by turns.
# cone: its tip at the origin, its base of radius 0.2 m at y = -1, n sides. bowl: half a hollow ball about the origin, open
# above, inside of radius 1 m, outside 1.1 m, n divisions around it.
function tube(    length_, around, i, j, a, b, c, d) {
    around = int(pi * n / 2)
    for (j = 0; j < around; j++)
        for (i = 0; i <= n; i++)
            printf "v %.9g %.9g %.9g\n", 2 * i / n - 1, 0.5 * sin(2 * pi * j / around), 0.5 * cos(2 * pi * j / around)
    for (j = 0; j < around; j++)
        for (i = 1; i <= n; i++) {
            a = j * (n + 1) + i
            b = a + 1
            d = (j + 1) % around * (n + 1) + i
            c = d + 1
            if (i % 2 == j % 2) printf "f %d %d %d\nf %d %d %d\n", a, b, c, a, c, d
            else printf "f %d %d %d\nf %d %d %d\n", a, b, d, b, c, d
        }
}
function cone(    j) {
    print "v 0 0 0\nv 0 -1 0"
    for (j = 0; j < n; j++)
        printf "v %.9g -1 %.9g\n", 0.2 * sin(2 * pi * j / n), 0.2 * cos(2 * pi * j / n)
    for (j = 0; j < n; j++)
        printf "f 1 %d %d\nf 2 %d %d\n", 3 + j, 3 + (j + 1) % n, 3 + (j + 1) % n, 3 + j
}
function ring(radius, angle,    j) {
    for (j = 0; j < n; j++)
        printf "v %.9g %.9g %.9g\n", radius * sin(angle) * sin(2 * pi * j / n), -radius * cos(angle), radius * sin(angle) * cos(2 * pi * j / n)
}
function bowl(    rings, i, j, a, b) {
    rings = int(n / 4)
    print "v 0 -1 0\nv 0 -1.1 0"
    for (i = 1; i <= rings; i++) ring(1, pi / 2 * i / rings)
    for (i = rings; i; i--) ring(1.1, pi / 2 * i / rings)
    for (j = 0; j < n; j++) {
        printf "f 1 %d %d\n", 3 + j, 3 + (j + 1) % n
        for (i = 0; i < 2 * rings - 1; i++) {
            a = 3 + i * n
            b = (j + 1) % n
            printf "f %d %d %d %d\n", a + j, a + n + j, a + n + b, a + b
        }
        printf "f 2 %d %d\n", a + n + b, a + n + j
    }
}
BEGIN {
    pi = atan2(0, -1)
    if (shape == "tube") tube()
    else if (shape == "cone") cone()
    else bowl()
}
