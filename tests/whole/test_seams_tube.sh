#!/bin/sh
# Two rectangles, one before and one behind a cylinder that is a little thicker than they are wide, are sewn to a tube around it. Without friction
# the tube is stretched evenly: by e = 2 pi R / girth - 1 where its vertices are at the radius R, so that its tension is T = E e and its pressure T / R.
. "${srcdir:-.}/tests/support/probes.sh"

rectangle='"vertices": [[-0.1512, -0.02], [0.1512, -0.02], [0.1512, 0.02], [-0.1512, 0.02]], "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]'
stitch() { printf '[{"panel": "front", "edge": %s}, {"panel": "back", "edge": %s}]' "$1" "$2"; }
cat > tube.json << END
{"pattern": {"panels": {
  "front": {$rectangle, "translation": [0, 0, 0.11], "rotation": [0, 0, 0]},
  "back": {$rectangle, "translation": [0, 0, -0.11], "rotation": [0, 180, 0]}},
  "stitches": [$(stitch 1 3), $(stitch 3 1)]},
 "properties": {"curvature_coords": "relative", "units_in_meter": 1}}
END
cat > tube.yaml << END
schema: 1
gravity: [0, 0, 0]
cloths:
  - {name: tube, mesh: {pattern: {file: tube.json, edge: 0.01}}, material: m, seams: {state: pulled, stiffness: 2000, damping: 100}}
materials: {m: {model: triangles, density: 0.2, stretch: 1000, shear: 500, damping: {stiffness: 0.01, mass: 5}}}
obstacles: [{cylinder: {centre: [0, 0, 0], axis: [0, 1, 0], radius: 0.1, length: 0.4}}]
contact: {mode: certified, thickness: 0.001}
probes: [{name: all, box: [[-1, -1, -1], [1, 1, 1]], values: [position, contact]}]
time: {h: 0.01, end: 0.5}
phases:
  - {name: sew, set: {time.sewn: {distance: 0.0005}}}
  - {name: rest, set: {'cloths[0].seams.state': welded, time.sewn: null}}
END
sewn() { run tube.yaml --check-intersections --report report.json && grep '"ended": "sewn"' report.json && test "$(value intersections)" = 0; }
ok "sewn to a tube around a cylinder, certified" sewn

# The last row: the mean radius, and the forces of contact: those on the front half sum up to 2 T H, their sizes to the pressure.
# Both names of a welded vertex are at one place; it counts once.
awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) { split($i, w, " "); at[i] = w[1] } next }
    { for (i = 1; i <= NF; i++) last[at[i]] = $i }
    END { girth = 4 * 0.1512; height = 0.04; pi = atan2(0, -1)
        for (name in last) { if (name !~ /^all\..*\.x$/) continue
            v = substr(name, 1, length(name) - 1); place = last[v "x"] " " last[v "y"] " " last[v "z"]
            if (place in seen) continue
            seen[place] = 1; n++; x = last[v "x"]; z = last[v "z"]; r = sqrt(x * x + z * z); radii += r
            across = (last[v "cx"] * x + last[v "cz"] * z) / r; press += across
            if (z > 0) front += last[v "cz"] }
        R = radii / n; T = 1000 * (2 * pi * R / girth - 1)
        print n, R, front / (2 * height), T, press / (2 * pi * R * height), T / R }' out/probes.csv > tube.txt
read -r vertices radius tension wanted pressure pressed < tube.txt
merged() { echo "$vertices of $(value vertices)"; test "$vertices" = $(($(value vertices) - 10)) && test "$(value vertices)" -gt 300; } # 2 seams of 5 vertices
ok "its two seams are one row of vertices each" merged
around() { echo "$radius"; awk -v r="$radius" 'BEGIN { exit !(r > 0.1 && r < 0.1012) }'; }
ok "it lies on the cylinder" around
# Chords of 62 edges are 0.05 % shorter than the circle, a hundredth of the strain.
ok "it has the tension of the closed form" near "tension, N/m" "$tension" "$wanted" 0.02
ok "and its pressure" near "pressure, Pa" "$pressure" "$pressed" 0.02
