#!/bin/sh
# A cloth starts in a frame of an earlier run: where it was, at rest, with the lengths at rest of its mesh; and what is wrong with the folder.
. "${srcdir:-.}/tests/support/probes.sh"

cat > fall.yaml << 'END'
schema: 1
cloths:
  - {name: other, mesh: {grid: {width: 0.1, height: 0.1, nx: 3, ny: 3}}, transform: {translate: [1, 0.3, 0]}, material: m}
  - {name: sheet, mesh: {grid: {width: 0.3, height: 0.3, nx: 9, ny: 9}}, transform: {translate: [0, 0.01, 0]}, material: m, velocity: [0, -0.5, 0]}
materials: {m: {density: 0.2, stretch: 1000, shear: 300, bend: 1, damping: {mass: 1, stiffness: 0.004}}}
obstacles: [{box: {centre: [0, -0.05, 0], size: [0.2, 0.1, 0.2]}}]
time: {h: 0.005, end: 0.3, fps: 20}
probes: [{name: p, cloth: sheet, vertices: [0, 40], values: [position, velocity]}]
grain: 20
END
run fall.yaml --check-intersections && mv out first || exit 99
tail -n 1 first/probes.csv > ended
sed '/name: other/d; s/velocity: .*}/from: {frames: first}}/; s/cloth: sheet, //' fall.yaml > settled.yaml
begins() { # at the last frame, to a float, and at rest; and goes on
    run settled.yaml --check-intersections --report report.json && sed -n 2p out/probes.csv > began &&
        paste -d , ended began | awk -F, '{ n = NF / 2; for (i = 1; i <= n; i++) { print $i, $(n + i) } }' > pairs &&
        awk 'BEGIN { most = 0 } NR > 9 && (NR - 10) % 6 < 3 { d = $1 - $2; if (d < 0) d = -d; if (d > most) most = d; n++ }
            NR > 9 && (NR - 10) % 6 >= 3 { if ($2 != 0) bad = 1 } END { print n, most; exit bad || n != 6 || !(most < 1e-7) }' pairs && test "$(value contacts)" -gt 0
}
ok "in the last frame of a run" begins
another() { # frame 0 is the start; the cloth has another name there
    run settled.yaml --set 'cloths[0].from={frames: first, frame: 0, cloth: sheet}' --set 'cloths[0].name=another' --end 0.005 &&
        sed -n 2p out/probes.csv | cut -d, -f10-12 > found && sed -n 2p first/probes.csv | cut -d, -f10-12 > wanted && paste -d , wanted found &&
        paste -d , wanted found | awk -F, '{ for (i = 1; i <= 3; i++) { d = $i - $(i + 3); if (d * d > 1e-14) bad = 1 } } END { exit bad || !NR }'
}
ok "in another frame of a cloth of another name" another
cut() { # only that frame is read: where an earlier one is, the file may be cut off
    mkdir -p cut && cp first/cloth.obj cut && head -c $((32 + 12 * 90 * 3)) first/cloth.pc2 > cut/cloth.pc2 &&
        run settled.yaml --set 'cloths[0].from={frames: cut, frame: 2}' --end 0.005 && last p.40.y > found && run settled.yaml --set 'cloths[0].from.frame=2' --end 0.005 &&
        last p.40.y > wanted && cat wanted && cmp wanted found && ! run settled.yaml --set 'cloths[0].from={frames: cut, frame: 3}' > said 2>&1 && grep 'ends within frame 4' said
}
ok "in a frame of a file that is cut off behind it" cut
stretched() { # lengths at rest are those of the mesh
    run settled.yaml --report report.json --end 0.005 && rows 'NR == 2 { print c("elastic"); exit !(c("elastic") > 1e-9) }' && run fall.yaml --end 0.005 && rows 'NR == 2 { print c("elastic"); exit !(c("elastic") < 1e-12) }'
}
ok "lengths at rest are those of the mesh" stretched
ok "no such frame" refuses 'from.frame is 7, but first has the frames 0 to 6; one of them, or last, is expected' limited "$DUITE_CLOTH" settled.yaml --quiet --set 'cloths[0].from.frame=7'
ok "half a frame" refuses 'from.frame is 1.5, but first has the frames 0 to 6' limited "$DUITE_CLOTH" settled.yaml --quiet --set 'cloths[0].from.frame=1.5'
ok "no such cloth" refuses "from: first/cloth.obj has no cloth 'shirt'; from.cloth names another one" limited "$DUITE_CLOTH" settled.yaml --quiet --set 'cloths[0].name=shirt'
ok "another mesh" refuses "from: cloth 'other' has 9 vertices in first/cloth.obj, but 81 here; the same mesh is expected" limited "$DUITE_CLOTH" settled.yaml --quiet --set 'cloths[0].from.cloth=other'
ok "no folder" refuses '--set cloths[0].from.frames=nowhere: from: cannot read nowhere/cloth.obj: No such file or directory' limited "$DUITE_CLOTH" settled.yaml --quiet --set 'cloths[0].from.frames=nowhere'
ok "frames that are read are not replaced" refuses 'first/cloth.obj would be replaced, but this run reads it' limited "$DUITE_CLOTH" settled.yaml --quiet --output first
