# A scene of about n vertices for bench/experiments vassilev: a front and a back, each 0.56 x 0.66 m, that hang before and behind the
# figure. Joints pull them together at the shoulders, where the back has more divisions and its vertices end on edges of the front,
# and, below the arms, at the sides.
#     awk -v n=5000 -f panels.awk
function column(name, side, first, last, nx,    j, list) { # the vertices of a side's rows: 0 the left one, 1 the right one
    for (j = first; j <= last; j++)
        list = list (j > first ? ", " : "") j * nx + side * (nx - 1)
    return "{cloth: " name ", vertices: [" list "]}"
}
function shoulder(from, to,    i, at, k, vertices, edges, share) { # of the back's top row
    for (i = from; i <= to; i++) {
        at = i * (nx - 1) / (more - 1)
        k = int(at)
        if (k == nx - 1) k--
        vertices = vertices (i > from ? ", " : "") i
        edges = edges (i > from ? ", " : "") "[" k ", " k + 1 "]"
        share = share (i > from ? ", " : "") sprintf("%.9g", at - k)
    }
    joint("{cloth: back, vertices: [" vertices "]}", "{cloth: front, edges: [" edges "], at: [" share "]}")
}
function panel(name, columns, z) {
    printf "  - name: %s\n    mesh: {grid: {width: 0.56, height: 0.66, nx: %d, ny: %d, cells: same}}\n", name, columns, ny
    printf "    transform: {rotate: [1, 1, 0, 0], translate: [0, 1.17, %.6g]}\n    material: cloth\n", z
}
function joint(from, to) {
    printf "  - {from: %s, to: %s, stiffness: %.4g, damping: %.4g, length: 0}\n", from, to, 40 / ny, 0.2 / ny
}
BEGIN {
    ny = int(sqrt(n / 2.2 * 0.66 / 0.56) + 0.5)
    nx = int(n / 2.2 / ny + 0.5)
    more = int(1.2 * nx + 0.5)
    below = int(0.35 * ny)              # the row at the armpits
    neck = int(0.34 * more)             # vertices of a shoulder
    print "schema: 1\nname: panels\n\ncloths:"
    panel("front", nx, 0.15)
    panel("back", more, -0.15)
    print "\nmaterials:"
    print "  cloth: {density: 0.2, stretch: 40, shear: 20, bend: 2, damping: {viscous: 0.0000002, mass: 10, stiffness: 0.0001}}"
    print "\njoints:"
    shoulder(0, neck - 1)
    shoulder(more - neck, more - 1)
    joint(column("front", 0, below, ny - 1, nx), column("back", 0, below, ny - 1, more))
    joint(column("front", 1, below, ny - 1, nx), column("back", 1, below, ny - 1, more))
    print "\nobstacles:\n  - body: {mannequin: {}, meet: image}"
    print "\ntime: {h: 0.0001, end: 0.1, fps: 25, halving: off, stretch_growth: 0}"
    print "integrator: symplectic_euler"
}
