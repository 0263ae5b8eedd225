# Two cloths on two ranks, with frames of all kinds, and probes of all vertices: the state, in 17 digits. Sourced after
# tests/support/tap.sh, in a folder that becomes the test's own.
cd "$scratch" || exit 99
cat > two.yaml << 'END'
schema: 1
cloths:
  - name: left
    mesh: {grid: {width: 0.6, height: 0.4, nx: 13, ny: 9}}
    transform: {translate: [-0.4, 0.5, 0]}
    material: knit
    pins: [{vertices: [0]}]
  - name: right
    mesh: {grid: {width: 0.5, height: 0.4, nx: 11, ny: 9}}
    transform: {translate: [0.4, 0.5, 0]}
    material: knit
    pins: [{vertices: [0]}]
materials: {knit: {model: triangles, density: 0.2, stretch: [500, 200], shear: 100, poisson: 0.3}}
time: {h: 0.001, end: 0.12}
grain: 60
probes:
  - {cloth: left, name: left, box: [[-9, -9, -9], [9, 9, 9]], values: [position, velocity]}
  - {cloth: right, name: right, box: [[-9, -9, -9], [9, 9, 9]], values: [position, velocity]}
END
run_two() { ranks 2 "$DUITE_CLOTH" two.yaml --quiet --output two "$@"; }
run_one() { # a single cloth
    sed '/name: right/,/pins:/d; /cloth: right/d' two.yaml > one.yaml && ranks 2 "$DUITE_CLOTH" one.yaml --quiet --output one
}
