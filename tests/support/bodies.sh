# Sourced by tests whose scenes have bodies: OBJ files on standard output.
#     box_obj X0 Y0 Z0 X1 Y1 Z1        a box, from the low corner to the high one
#     slab_obj N                       one of 1.2 x 0.1 x 1.2 m whose top, at y = 0, has N x N quads
#     ring_obj FAR WIDE                a ring around the y axis, of 24 x 12 vertices FAR +- WIDE m from it, in quads

box_obj() {
    for box_z in "$3" "$6"; do
        for box_y in "$2" "$5"; do printf 'v %s %s %s\n' "$1" "$box_y" "$box_z" "$4" "$box_y" "$box_z"; done
    done
    printf 'f %s %s %s %s\n' 1 3 4 2 5 6 8 7 1 2 6 5 3 7 8 4 1 5 7 3 2 4 8 6
}

slab_obj() {
    awk -v n="$1" 'function top(i, j) { return i * (n + 1) + j + 1 }
        function quad(a, b, c, d) { print "f", a, b, c, d }
        BEGIN { low = (n + 1) * (n + 1)
            for (y = 0; y < 2; y++) for (i = 0; i <= n; i++) for (j = 0; j <= n; j++) print "v", 1.2 * i / n - 0.6, -0.1 * y, 1.2 * j / n - 0.6
            for (i = 0; i < n; i++) for (j = 0; j < n; j++) {
                quad(top(i, j), top(i, j + 1), top(i + 1, j + 1), top(i + 1, j))
                quad(low + top(i, j), low + top(i + 1, j), low + top(i + 1, j + 1), low + top(i, j + 1)) }
            for (i = 0; i < n; i++) {
                quad(top(i, 0), top(i + 1, 0), low + top(i + 1, 0), low + top(i, 0))
                quad(top(i + 1, n), top(i, n), low + top(i, n), low + top(i + 1, n))
                quad(top(0, i + 1), top(0, i), low + top(0, i), low + top(0, i + 1))
                quad(top(n, i), top(n, i + 1), low + top(n, i + 1), low + top(n, i)) } }'
}

ring_obj() {
    awk -v r="$1" -v wide="$2" 'BEGIN { t = atan2(0, -1) / 12
        for (i = 0; i < 24; i++) for (j = 0; j < 12; j++) {
            far = r + wide * cos(2 * t * j); printf "v %.9f %.9f %.9f\n", far * cos(t * i), wide * sin(2 * t * j), far * sin(t * i) }
        for (i = 0; i < 24; i++) for (j = 0; j < 12; j++) {
            k = (i + 1) % 24; l = (j + 1) % 12; print "f", 12 * i + j + 1, 12 * i + l + 1, 12 * k + l + 1, 12 * k + j + 1 } }'
}
