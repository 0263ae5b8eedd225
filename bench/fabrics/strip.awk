# A strip of cloth as an OBJ file, in the plane y = 0: `long` along x (m), width along z, nx and ny cells, cut alike if `same` is 1; its warp lies at `grain` degrees to x.
# awk -v long=0.1 -v width=0.05 -v nx=20 -v ny=10 -v grain=45 -f strip.awk
BEGIN {
    turn = grain * atan2(0, -1) / 180
    for (j = 0; j <= ny; j++)
        for (i = 0; i <= nx; i++) {
            x = long * (i / nx - 0.5)
            z = width * (j / ny - 0.5)
            printf "v %.9g 0 %.9g\n", x, z
            printf "vt %.9g %.9g\n", x * cos(turn) + z * sin(turn), z * cos(turn) - x * sin(turn)
        }
    for (j = 0; j < ny; j++)
        for (i = 0; i < nx; i++) {
            a = j * (nx + 1) + i + 1
            c = a + nx + 1
            if ((i + j) % 2 && !same)
                printf "f %d/%d %d/%d %d/%d\nf %d/%d %d/%d %d/%d\n", a, a, c, c, c + 1, c + 1, a, a, c + 1, c + 1, a + 1, a + 1
            else
                printf "f %d/%d %d/%d %d/%d\nf %d/%d %d/%d %d/%d\n", a, a, c, c, a + 1, a + 1, a + 1, a + 1, c, c, c + 1, c + 1
        }
}
