# Of a table of probes with the columns CLOTH.N.vx, CLOTH.total.cx and byK.cx: in each step 1 g times the change of all velocities over 5 ms,
# less weights, is the force of contact on a cloth, to `most` of its weight; that on all cloths is what the obstacles (byK) put on them.
function abs(x) { return x < 0 ? -x : x }
NR == 1 {
    n_cloths = split(cloths, cloth, " ")
    for (i = 1; i <= NF; i++) {
        column = $i
        sub(/ .*/, "", column)
        axis = substr(column, length(column))
        owner = column
        sub(/[.].*/, "", owner)
        if (column ~ /[.]v[xyz]$/)
            at[owner, axis, ++n[owner, axis]] = i
        else if (column ~ /[.]total[.]c[xyz]$/)
            total[owner, axis] = i
        else if (owner ~ /^by/)
            by[axis, ++n_by[axis]] = i
    }
    next
}
{
    for (a = 1; a <= 3; a++) {
        axis = substr("xyz", a, 1)
        inside = outside = 0
        for (k = 1; k <= n_cloths; k++) {
            c = cloth[k]
            for (i = sum = 0; i++ < n[c, axis];)
                sum += $(at[c, axis, i])
            weight = 9.81e-3 * n[c, axis]
            want = 1e-3 * (sum - before[c, axis]) / 5e-3 + (axis == "y" ? weight : 0)
            is = $(total[c, axis])
            if (NR > 2 && !(abs(want - is) < most * weight)) {
                print "# step", $1 ":", is, "N along", axis, "on", c ", where", want, "changes its momentum"
                bad = 1
            }
            if (NR > 2 && abs(want) > abs(largest[axis]))
                largest[axis] = want
            before[c, axis] = sum
            inside += is
        }
        for (i = 1; i <= n_by[axis]; i++)
            outside += $(by[axis, i])
        if (!(abs(inside - outside) < 1e-9 * weight)) {
            print "# step", $1 ":", inside, "N along", axis, "on all cloths,", outside, "by obstacles"
            bad = 1
        }
    }
}
END {
    printf "# %d steps; the largest forces on a cloth: %g %g %g N\n", NR - 2, largest["x"], largest["y"], largest["z"]
    exit bad || NR < 12 || !n_cloths || !(largest["y"] > 0.1)
}
