# An OBJ file of a torso: ellipses from the hips to the neck by the girths of the project's figure, y up, m. A closed mesh.
#     awk -f torso.awk
function ring(y, x, z,    i) {
    for (i = 0; i < around; i++)
        printf "v %.9g %.9g %.9g\n", x * sin(turn * i / around), y, z * cos(turn * i / around)
    n++
}
BEGIN {
    turn = 2 * atan2(0, -1)
    around = 96
    ring(0.80, 0.16, 0.11)
    ring(0.90, 0.18, 0.135)
    ring(1.08, 0.15, 0.115)
    ring(1.28, 0.18, 0.13)
    ring(1.38, 0.20, 0.11)
    ring(1.44, 0.19, 0.08)
    ring(1.47, 0.08, 0.06)
    ring(1.56, 0.06, 0.06)
    print "v 0 0.80 0\nv 0 1.56 0"
    for (k = 0; k < n - 1; k++)
        for (i = 0; i < around; i++) {
            a = k * around + i + 1
            b = k * around + (i + 1) % around + 1
            printf "f %d %d %d\nf %d %d %d\n", a, b, b + around, a, b + around, a + around
        }
    last = (n - 1) * around
    for (i = 0; i < around; i++) {
        j = (i + 1) % around
        printf "f %d %d %d\nf %d %d %d\n", j + 1, i + 1, n * around + 1, last + i + 1, last + j + 1, n * around + 2
    }
}
