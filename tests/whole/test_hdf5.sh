#!/bin/sh
# Scientific frames (output.hdf5): what they hold, against closed forms and what probes say; the same on ranks; what is refused; what a
# run that is killed, or has no room, leaves.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless "$DUITE_CLOTH"
grep -q '^#define HAVE_HDF5 1' config.h || { echo "1..0 # SKIP built without HDF5" && exit 77; }
command -v h5dump h5diff > /dev/null || { echo "1..0 # SKIP no h5dump and h5diff (hdf5-tools)" && exit 77; }
plan_later
cd "$scratch" || exit 99

frame() { printf '%s/hdf5/frame-%06d.vtkhdf' "$1" "$2"; } # FOLDER NUMBER
numbers() { # FILE DATASET: a number a line
    h5dump -y -w 1 -m %.17g -d "/VTKHDF/$2" "$1" | sed -n '/DATA {/,/}/{ s/[,[:space:]]*$//; s/^[[:space:]]*//; /[{}]/!p; }'
}
run() { limited "$DUITE_CLOTH" "$@" --quiet; }

cat > pull.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
cloths:
  - name: a
    mesh: {grid: {width: 0.6, height: 0.4, nx: 7, ny: 5}}
    material: m
    start: [{box: [[-9, -9, -9], [9, 9, 9]], scale: [1.1, 1, 1.05], velocity: [1, 2, 3]}]
materials: {m: {model: triangles, density: 0.2, stretch: [500, 200], shear: 100, poisson: 0.3}}
time: {h: 0.001, end: 0.08}
grain: 12
probes: [{cloth: a, vertices: [0, 17], values: [position, velocity]}]
output: {hdf5: {fields: [velocity, block, rank, strain, stress], precision: double}}
END
# Plane stress of warp 0.1, weft 0.05, and no shear.
closed_form() {
    run pull.yaml --output one || return 1
    numbers "$(frame one 0)" CellData/strain | awk '{ d = $1 - 0.1; bad += d * d > 1e-24 } END { exit bad || NR != 48 }' || return 1
    numbers "$(frame one 0)" CellData/stress | awk 'BEGIN { c = 1 / (1 - 0.3 * 0.3 * 200 / 500); want[1] = c * (500 * 0.1 + 60 * 0.05); want[2] = c * (60 * 0.1 + 200 * 0.05); want[0] = 0 }
        { d = $1 - want[NR % 3]; bad += d * d > 1e-18 } END { exit bad || NR != 144 }' || return 1
    numbers "$(frame one 0)" PointData/velocity | awk '{ bad += $1 != (NR - 1) % 3 + 1 } END { exit bad || NR != 105 }'
}
ok "strain and stress of a stretched sheet" closed_form
as_probes() { # the state's bits: 17 digits
    numbers "$(frame one 2)" Points > x && numbers "$(frame one 2)" PointData/velocity > v && tail -n 1 one/probes.csv | tr , '\n' | tail -n 12 > want
    { sed -n 1,3p x && sed -n 1,3p v && sed -n 52,54p x && sed -n 52,54p v; } | cmp - want
}
ok "positions and velocities are the state's, bit for bit" as_probes
on_ranks() {
    ranks 2 "$DUITE_CLOTH" pull.yaml --quiet --output two || return 1
    for k in 0 1 2; do
        for set in Points PointData/velocity PointData/block CellData/strain CellData/stress Connectivity; do
            h5diff -q "$(frame one $k)" "$(frame two $k)" "/VTKHDF/$set" || return 1
        done
    done
    test "$(numbers "$(frame two 1)" PointData/rank | sort -u | tr '\n' ' ')" = '0 1 '
}
ok "the same on two ranks, but for the rank" on_ranks
sparse() {
    run pull.yaml --output one --set output.hdf5.every=2 --set 'output.hdf5.fields=[strain]' --set output.hdf5.compression=6 || return 1
    test "$(ls one/hdf5 | tr '\n' ' ')" = 'frame-000000.vtkhdf frame-000002.vtkhdf ' || return 1
    test "$(grep -c '"time"' one/cloth.vtkhdf.series)" = 2 && test "$(grep -c '<Time' one/cloth.xmf)" = 2 && ! h5dump -d /VTKHDF/PointData/velocity "$(frame one 2)" > /dev/null 2>&1
}
ok "every second frame in place of an earlier run's, compressed, with one field" sparse
forgotten() { sed '/^output/d' pull.yaml > plain.yaml && run plain.yaml --output one && ! test -e one/hdf5 && ! test -e one/cloth.xmf; }
ok "a run without them leaves none of an earlier run" forgotten

cat > lie.yaml << 'END'
schema: 1
cloths: [{name: a, material: m, mass_per_vertex: 0.001, mesh: {grid: {width: 0.3, height: 0.3, nx: 8, ny: 8}}, transform: {translate: [0, 0.0021, 0]}}]
materials: {m: {stretch: 200, shear: 60, bend: 1, damping: {stiffness: 0.004}}}
obstacles: [{plane: {point: [0, 0, 0], normal: [0, 1, 0]}}]
contact: {mode: certified, self: on, thickness: 0.002, friction: 0.4, force: on}
time: {h: 0.005, end: 0.2}
solver: {stop: {mass_norm: 1e-10}}
output: {hdf5: {fields: [contact_force], precision: double}}
END
carried() { # 64 g
    run lie.yaml --output lie && numbers "$(frame lie 5)" PointData/contact_force | awk 'NR % 3 == 2 { sum += $1 } END { d = sum - 0.62784; print "#", sum; exit d * d > 1e-8 || NR != 192 }'
}
ok "the force of contact of a sheet at rest is its weight" carried

foreign() { mkdir mine && echo mine > mine/cloth.xmf && refuses 'cloth.xmf is in the way' run pull.yaml --output mine && test "$(cat mine/cloth.xmf)" = mine; }
ok "an index that is not ours stays" foreign
aside() { run pull.yaml 2> said && grep -qF 'output.hdf5, whose frames are written into the folder of --output; there is none' said; }
ok "no folder for them" aside

in_the_way() { mkdir -p way/hdf5/frame-000001.vtkhdf && refuses 'cannot replace way/hdf5/frame-000001.vtkhdf: Is a directory' run pull.yaml --output way; }
ok "a folder where a frame goes" in_the_way

killed() { # every frame that has its name, and every one that the index names, is whole; the next run leaves nothing of it
    "$DUITE_CLOTH" pull.yaml --output cut --quiet --end 600 --set time.fps=1000 &
    pid=$!
    until test -e "$(frame cut 20)" || ! kill -0 $pid; do sleep 0.05; done
    kill -KILL $pid && ! wait $pid 2> /dev/null
    n=0
    for file in cut/hdf5/frame-*.vtkhdf; do h5dump -d /VTKHDF/CellData/stress "$file" > /dev/null || return 1; n=$((n + 1)); done
    series=$(grep -c '"time"' cut/cloth.vtkhdf.series) && xmf=$(grep -c '<Time' cut/cloth.xmf)
    echo "# $n frames; $series and $xmf in the indexes, which end with '$(tail -n 1 cut/cloth.vtkhdf.series)' and '$(tail -n 1 cut/cloth.xmf)'"
    for named in "$series" "$xmf"; do test "$n" -ge 20 && test "$named" -ge $((n - 1)) && test "$named" -le "$n" || return 1; done
    test "$(tail -n 1 cut/cloth.vtkhdf.series)" = '}' && test "$(tail -n 1 cut/cloth.xmf)" = '</Xdmf>' || return 1
    run pull.yaml --output cut && ! ls cut/hdf5 | grep -v '^frame-00000[0-2].vtkhdf$'
}
ok "a run that is killed leaves whole frames" killed
