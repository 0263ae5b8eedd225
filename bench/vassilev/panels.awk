# A scene of about n vertices for bench/experiments vassilev: a front and a back, each 0.56 x 0.66 m, that hang before and behind a
# body. Joints pull them together at the shoulders and, below the arms, at the sides.
#     awk -v n=5000 -v body='{obj: figure.obj}' -v shoulder=1.44 -f panels.awk
# body: what the obstacle has but for its view; shoulder: the height of its shoulders, m.
function column(name, side, first, last, nx,    j, list) { # the vertices of a side's rows, "front" at 0, "back" at 1
    for (j = first; j <= last; j++)
        list = list (j > first ? ", " : "") j * nx + side * (nx - 1)
    return "{cloth: " name ", vertices: [" list "]}"
}
function top(name, from, to,    i, list) {
    for (i = from; i <= to; i++)
        list = list (i > from ? ", " : "") i
    return "{cloth: " name ", vertices: [" list "]}"
}
function panel(name, z) {
    printf "  - name: %s\n    mesh: {grid: {width: 0.56, height: 0.66, nx: %d, ny: %d, cells: same}}\n", name, nx, ny
    printf "    transform: {rotate: [1, 1, 0, 0], translate: [0, %.6g, %.6g]}\n    material: cloth\n", shoulder - 0.27, z
}
function joint(from, to) {
    printf "  - {from: %s, to: %s, stiffness: %.4g, damping: %.4g, length: 0}\n", from, to, 40 / ny, 0.2 / ny
}
BEGIN {
    ny = int(sqrt(n / 2 * 0.66 / 0.56) + 0.5)
    nx = int(n / 2 / ny + 0.5)
    below = int(0.35 * ny)              # the row at the armpits
    neck = int(0.34 * nx)               # vertices of a shoulder
    print "schema: 1\nname: panels\n\ncloths:"
    panel("front", 0.15)
    panel("back", -0.15)
    print "\nmaterials:"
    print "  cloth: {density: 0.2, stretch: 40, shear: 20, bend: 2, damping: {viscous: 0.0000002, mass: 10, stiffness: 0.0001}}"
    print "\njoints:"
    joint(top("front", 0, neck - 1), top("back", 0, neck - 1))
    joint(top("front", nx - neck, nx - 1), top("back", nx - neck, nx - 1))
    joint(column("front", 0, below, ny - 1, nx), column("back", 0, below, ny - 1, nx))
    joint(column("front", 1, below, ny - 1, nx), column("back", 1, below, ny - 1, nx))
    print "\nobstacles:\n  - body: " body
    print ""
    print "time: {h: 0.0001, end: 0.1, fps: 25, halving: off, stretch_growth: 0}"
    print "integrator: symplectic_euler"
}
