#!/bin/sh
# Integrators as a user meets them: free fall of each by its own formula, read from probes; energies and Newton steps, and that little
# is gained.
. "${srcdir:-.}/tests/support/cloth.sh"
. "$srcdir/tests/support/table.sh"

exec 3>&1
build=$OLDPWD

run() { limited "$DUITE_CLOTH" "$@" --quiet; }

# ---- Rows of the tables that the unit tests print

printed() { # PROGRAM PATTERN: its rows that have the pattern; a case of it that fails is of its own test
    test -x "$build/$1" || { echo "$1 is not built" && return 1; }
    limited "$build/$1" > printed || true
    sed -n 's/e-0\([1-9]\)/e-\1/g; s/0e+00/0/; s/^# |/|/p' printed | grep "$2" > some || return
    sed 's/^/# /' some >&3
    cat some >> table
}
ok "orders of convergence of a weight" printed tests/cloth/flow/test_integrators '| order'
ok "and of a chain" printed tests/cloth/flow/test_newton '| order'

cat > fall.yaml << 'END'
schema: 1
cloths:
  - mesh: {grid: {width: 1, height: 1, nx: 6, ny: 6}}
    material: cotton
    velocity: [0.5, 2, 0]
materials: {cotton: {density: 0.2, stretch: 500, shear: 100, damping: {stiffness: 0.0001}}}
time: {h: 0.001, end: 0.5}
solver: {stop: {relative: 1.0e-13}}
grain: 9
probes: [{vertices: [7]}]
END

falls() { # INTEGRATOR, its FORM, by awk: what it falls more than g t^2 / 2, in g h^2, after n steps, ARGUMENT...
    name=$1 form=$2 more=$3
    shift 3
    rm -rf fall
    run fall.yaml --output fall --set integrator="$name" "$@" || return 1
    awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "probe1.7.y [m]") y = i; next }
        { n = NR - 2; h = 0.001; g = 9.81; t = n * h; more = '"$more"'
          wrong = $y - (2 * t - g * t * t / 2 - g * h * h * more); if (wrong < 0) wrong = -wrong; if (wrong > most) most = wrong }
        END { print NR - 1 " rows, off by " most " m"; print most > "off"; exit !(y && NR == 502 && most < 1e-10) }' fall/probes.csv &&
        row "free fall after n steps, \`$name\`, m" "$form" "$(digit "$(cat off)")"
}
ok "explicit_euler falls" falls explicit_euler 'g h² n (n − 1) / 2' '-n / 2' --set 'materials.cotton={density: 0.2, stretch: 1, damping: {stiffness: 0.01}}'
ok "symplectic_euler falls" falls symplectic_euler 'g h² n (n + 1) / 2' 'n / 2'
ok "verlet falls" falls verlet 'g (h n)² / 2' 0
ok "rk4 falls" falls rk4 'g (h n)² / 2' 0
ok "implicit_euler falls" falls implicit_euler 'g h² n (n + 1) / 2' 'n / 2'
ok "bdf2 falls" falls bdf2 'g h² (n² / 2 + 3/4 (1 − 3⁻ⁿ))' '0.75 * (1 - exp(-n * log(3)))'

ok "docs/accuracy.md has these rows" table

# ---- Energies: the sum of the columns of the probes against the report

wavers() {
    rm -rf fall
    run fall.yaml --output fall --report report.json --set integrator=verlet --set materials.cotton.damping.stiffness=0 \
        --set 'cloths[0].pins=[{vertices: [0]}]' --set energies=steps --set time.h=0.0005 || return 1
    grep energy report.json
    awk -F, -v low="$(value energy_lowest)" -v high="$(value energy_highest)" -v gained="$(value energy_gained)" \
        'function near(a, b) { return a - b < 1e-12 && b - a < 1e-12 }
        NR > 1 { sum = $6 + $7 + $8 + $9; if (NR == 2 || sum < least) least = sum; if (NR == 2 || sum > most) most = sum
                 if (sum - least > rise) rise = sum - least }
        END { print least, most, rise
              exit !(near(least, low) && near(most, high) && near(rise, gained) && rise > 0 && rise < 1e-3) }' fall/probes.csv
}
ok "energies of the report are those of the probes" wavers
ok "without energies: steps they are null" eval 'run fall.yaml --report report.json --end 0.002 && test "$(value energy_gained)" = null'

# ---- Energy that is gained: a cloth swings from two corners, undamped. Parts of what it can fall.

cat > swing.yaml << 'END'
schema: 1
cloths:
  - mesh: {grid: {width: 1, height: 1, nx: 6, ny: 6}}
    material: silk
    pins: [{vertices: [0, 5]}]
materials:
  silk: {density: 0.2, model: triangles, stretch: [300, 200], shear: 20, poisson: 0.2, bending: {rigidity: 1.0e-4}}
  net: {density: 0.2, stretch: 200, shear: 50}
time: {h: 0.02, end: 0.8, halving: off, stretch_growth: 0}
energies: steps
newton: {tolerance: 1.0e-8}
solver: {stop: {relative: 1.0e-11}}
END
ok "energy of a chain" printed tests/cloth/flow/test_newton '| a chain.*, h = '
gains() { # MOST, MATERIAL, H, SETTING...
    most=$1 material=$2 h=$3
    shift 3
    run swing.yaml --report report.json --set "cloths[0].material=$material" --set time.h="$h" "$@" || return 1
    awk -v what="$material, h = $h s, $*" -v most="$most" -v gained="$(value energy_gained)" -v lowest="$(value energy_lowest)" -v left="$(value newton_unconverged)" \
        'BEGIN { fall = 0.2 * 9.81 / 2; printf "# %s: gains %.1e of its fall, loses %.2f\n", what, gained / fall, -lowest / fall; exit !(gained ~ /^[0-9]/ && lowest < -fall / 1e3 && gained / fall <= most && !left) }' >&3 || return 1
    row "$material, h = $h s${*:+, \`$(echo "$*" | sed 's/--set //g; s/materials[^}]*}/5000 N\/m/; s/ cloths[^}]*}//; s/ time.halving=on//; s/ air={[^}]*}/ air: {}/')\`}" "$(digit "$(value energy_gained | awk '{ print $1 / 0.981 }')")" "$(value energy_lowest | awk '{ printf "%.2g", -$1 / 0.981 }')"
}
gains_more() { gains 1 "$@" && awk -v gained="$(value energy_gained)" 'BEGIN { exit !(gained > 0.02 * 0.981) }'; }
for material in silk net; do
    ok "$material gains nothing by implicit_euler, Newton converged" gains 1e-9 $material 0.02 --set newton.steps=60
    ok "$material gains little by one linear step" gains 0.01 $material 0.02
    ok "$material gains little by bdf2" gains 0.01 $material 0.004 --set integrator=bdf2
    for h in 0.02 0.04; do
        ok "$material gains little by bdf2, h = $h s" gains 0.01 $material $h --set integrator=bdf2
        ok "by implicit Euler where it gained" eval 'test "$(value steps_retaken)" -gt 0 && test "$(value steps_halved)" = 0'
    done
    ok "$material gains more where it may" gains_more $material 0.02 --set integrator=bdf2 --set time.energy_growth=0
    ok "$material gains more in a wind, which works on it" gains_more $material 0.02 --set integrator=bdf2 --set 'air={wind: [1e-9, 0, 0], normal: 0, tangent: 0}'
done
ok "a stiff net gains little by one linear step of 40 ms" gains 0.01 net 0.04 --set 'materials.net={density: 0.2, stretch: 5000, shear: 2500}' --set time.halving=on --set 'cloths[0].mesh.grid={width: 1, height: 1, nx: 9, ny: 9}'
ok "since steps that gain are halved" eval 'test "$(value steps_halved)" -gt 0 && test "$(value steps_retaken)" = 0'
ok "it gains more where it may" gains_more net 0.04 --set 'materials.net={density: 0.2, stretch: 5000, shear: 2500}' --set time.halving=on \
    --set 'cloths[0].mesh.grid={width: 1, height: 1, nx: 9, ny: 9}' --set time.energy_growth=0

ok "docs/accuracy.md has these rows of energy" table "of energy"

# ---- A stiff cloth that starts from rest: a gain is small if it is small against what its weight will set free.

cat > stiff.yaml << 'END'
schema: 1
cloths:
  - mesh: {grid: {width: 1, height: 1, nx: 20, ny: 20}}
    material: tarp
    pins: [{vertices: [0]}]
materials: {tarp: {density: 0.2, stretch: 1.0e+6, shear: 1.0e+6}}
time: {h: 0.01, end: 0.44, stretch_growth: 0}
energies: steps
END
stiff() { # LEAST HALVED, MOST HALVED, SETTING...
    least=$1 most=$2
    shift 2
    run stiff.yaml --report report.json "$@" || return 1
    grep -E 'steps|energy_' report.json
    halved=$(value steps_halved)
    test "$halved" -ge "$least" && test "$halved" -le "$most" && test "$(value steps_halved_energy)" = "$halved" &&
        test "$(value steps)" -le 100 && awk -v gained="$(value energy_gained)" 'BEGIN { exit !(gained <= 0.01 * 0.2 * 9.81 / 2) }'
}
ok "a stiff sheet that falls from a corner gains less than 1 % of its fall: no step is halved" stiff 0 0
ok "from two corners it gains 11 %, and steps stay short for a while when one was halved" stiff 1 8 --set 'cloths[0].pins=[{vertices: [0, 19]}]'
without_quiet() { "$DUITE_CLOTH" stiff.yaml --set 'cloths[0].pins=[{vertices: [0, 19]}]' > said; grep shorter said; }
ok "the summary says what steps were halved for" eval "without_quiet | grep -c 'halved $(value steps_halved) times: $(value steps_halved) for energy gained (time.energy_growth)\$'"
cat > still.yaml << END
schema: 1
gravity: [0, 0, 0]
cloths: [{name: a, material: m, mesh: {grid: {width: 1, height: 1, nx: 40, ny: 40}}, transform: {translate: [0.3, 0.1, 0.7], rotate: [0.9, 0.3, 0.2, 0.1]}}]
materials: {m: {density: 0.2, stretch: 1000, shear: 300, bend: 1, damping: {stiffness: 0.004}}}
time: {h: 0.01, end: 0.2}
END
still() {
    run still.yaml --report report.json && grep -E '"steps' report.json && test "$(value steps)" = 20
}
ok "rounding of a sheet at rest without forces is no gain" still

# ---- Newton steps

newton() {
    run fall.yaml --report report.json --set 'cloths[0].pins=[{vertices: [0]}]' --set time.h=0.02 \
        --set 'newton={steps: 40, tolerance: 1e-6}' || return 1
    grep -E 'newton|steps' report.json
    test "$(value newton_steps)" -gt "$((2 * $(value steps)))" && test "$(value newton_unconverged)" = 0
}
ok "Newton steps are counted" newton

# One block, whose factors all need a shift: its bending pushes as well as pulls, and nothing resists shear.
shifted() { # KEY SETTING...: as many as the report has under the key
    key=$1
    shift
    run fall.yaml --report report.json --grain 256 --set 'cloths[0].pins=[{vertices: [0]}]' --set time.h=0.02 \
        --set 'cloths[0].mesh.grid={width: 1, height: 1, nx: 16, ny: 16}' \
        --set time.end=0.1 --set 'materials.cotton={density: 0.2, stretch: 500, shear: 0, model: triangles, poisson: 0.3, bending: {model: quadratic, rigidity: 0.01}}' "$@" || return 1
    grep -E 'shifted|steps' report.json
    test "$(value factors_shifted)" -gt 0 && test "$(value factors_shifted)" = "$(value "$key")"
}
ok "shifts of factors are counted" shifted steps
ok "... in each Newton step" shifted newton_steps --set 'newton={steps: 4, tolerance: 1e-6}'
