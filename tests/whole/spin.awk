# Of the probes of two sheets of 8 g each, 7 and 8 vertices wide, positions, velocities and forces of contact: prints what contact changed
# of their spin about the origin, over the sum of m |x| |v| at the start; what the motion did; the bound that friction has. -v friction,
# thickness (m). The bound: friction pulls at both ends of a gap of 1.3 thickness at most, with 2 friction times the load of a step's begin.
function mass(name, i, n) { n = name == "a" ? 7 : 8; return 0.008 / (n - 1) ^ 2 * (i % n % (n - 1) ? 1 : 0.5) * (int(i / n) % (n - 1) ? 1 : 0.5) }
function get(vertex, what, to, c) { for (c = 1; c <= 3; c++) to[c] = $at[vertex "." what axis[c]] }
function cross(a, b, scale, to, c) { for (c = 1; c <= 3; c++) to[c] += scale * (a[c % 3 + 1] * b[(c + 1) % 3 + 1] - a[(c + 1) % 3 + 1] * b[c % 3 + 1]) }
function size(a) { return sqrt(a[1] * a[1] + a[2] * a[2] + a[3] * a[3]) }
BEGIN { FS = ","; split("x y z", axis, " ") }
NR == 1 {
    for (i = 1; i <= NF; i++) { split($i, column, " "); at[column[1]] = i; n = split(column[1], word, "."); if (n == 3 && word[3] == "x") of[word[1] "." word[2]] = mass(word[1], word[2]) }
    next
}
{
    split("0 0 0", spin, " ")
    split("0 0 0", force, " ")
    for (k in of) {
        get(k, "", x); get(k, "v", v); get(k, "c", f)
        cross(x, v, of[k], spin)
        if (NR == 2) all += of[k] * size(x) * size(v)
        else {
            for (c = 1; c <= 3; c++) from[c] = before[k, c]
            cross(from, f, $2 - time, turned)
            if (k ~ /^a/) for (c = 1; c <= 3; c++) force[c] += f[c]
        }
        for (c = 1; c <= 3; c++) before[k, c] = x[c]
    }
    if (NR == 2) for (c = 1; c <= 3; c++) first[c] = spin[c]
    for (c = 1; c <= 3; c++) change[c] = spin[c] - first[c]
    load += ($2 - time) * size(force)
    if (size(turned) > by_contact) by_contact = size(turned)
    if (size(change) > by_motion) by_motion = size(change)
    time = $2
}
END { printf "%.6g %.6g %.6g\n", by_contact / all, by_motion / all, 2 * friction * 1.3 * thickness * load / all }
