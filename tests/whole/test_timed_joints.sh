#!/bin/sh
# Joints that begin and end while a run is on: the motion of two masses before, during and after, the same motion as by a joint that is
# always there, what is recorded again, steps that are halved, and the same bits on any ranks and threads.
. "${srcdir:-.}/tests/support/probes.sh"
. "$srcdir/tests/whole/joints.sh"

# ---- Two masses, 0.5 m farther apart than a joint of 40 N/m and 0.1 kg/s is long, which acts from 0.1 s to 0.2 s ----
timed='--set joints[0].begin=0.1 --set joints[0].end=0.2'
distance() { # its largest error over all rows, m
    rows 'function swing(t) { return exp(-r * t) * (cos(w * t) + r / w * sin(w * t)) }
        function rate(t) { return -exp(-r * t) * sin(w * t) * (w + r * r / w) }
        { t = c("time") - 0.1; k = 40; damping = 0.1; mu = 0.1 * 0.3 / 0.4; r = damping / (2 * mu); w = sqrt(k / mu - r * r)
        d = 0.5 + 0.5 * (t < 0 ? 1 : t < 0.1 ? swing(t) : swing(0.1) + rate(0.1) * (t - 0.1)) - (c("q.1.x") - c("p.0.x"))
        if (d < 0) d = -d; if (d > most) most = d } END { printf "%.3g\n", most }'
}
ok "free, joined and free again by rk4" swings rk4 1e-3 1e-8
ok "by velocity Verlet" swings verlet 1e-3 1e-4
ok "by symplectic Euler" swings symplectic_euler 1e-4 2e-3
ok "by implicit Euler" swings implicit_euler 1e-4 4e-3
ok "by BDF2, which begins again where the joint does" swings bdf2 1e-4 1e-4
ok "in one block" eval 'run two.yaml $timed --set integrator=rk4 --set grain=9 && below "distance" "$(distance)" 1e-8'

unjudged() { # 5 J come with the joint
    # shellcheck disable=SC2086 # a list of settings
    run two.yaml $timed --set integrator="$1" --report report.json && test "$(value steps_halved)" = 0 && test "$(value steps_retaken)" = 0 && test "$(value steps)" = 300
}
for integrator in implicit_euler bdf2; do
    ok "energy that comes with a joint is no step's fault, $integrator" unjudged $integrator
done

# The reaction of a pin at one end is m a of the other end in each row; the row at a change is of the step that ends there.
pulls() { # SETTING...
    # shellcheck disable=SC2086 # a list of settings
    run two.yaml $timed --set 'cloths[0].pins=[{vertices: [0]}]' --set 'probes[0].values=[reaction]' --set joints[0].damping=0 "$@" &&
        below "reaction against the spring's length, N" "$(rows '{ t = c("time"); acts = t > 0.1001 && t < 0.2001; d = c("q.1.x") - 0.5; r = c("p.0.rx") + (acts ? 40 * d : 0)
            if (r < 0) r = -r; if (r > most) most = r } END { printf "%.3g\n", most }')" 1e-9
}
for integrator in implicit_euler verlet rk4 symplectic_euler explicit_euler; do
    ok "the reaction of a pin is that of the step's joints, $integrator" pulls --set integrator=$integrator
done
ok "also where steps do not overlap" pulls --set 'cloths[1].pins=[{vertices: [0], motion: {times: [0, 1], translate: [[0, 0, 0], [1, 0, 0]]}}]'

wakes() { # a run that rests waits for joints that are to come
    # shellcheck disable=SC2086
    run two.yaml $timed --set 'time.rest={speed: 0.001, hold: 0.05}' --set integrator="$1" --report report.json && grep rest_seconds report.json && test "$(value steps)" = 300
}
ok "a run does not rest before a joint begins" wakes rk4

# ---- Two panels, joined along an edge, over several blocks ----
seen() { run panels.yaml "$@" --report report.json && last p.60.x p.60.y p.60.z q.4.x q.4.y q.4.z p.58.rx p.58.ry p.58.rz && value energy_kinetic && value energy_elastic; }
apart() { # the largest relative difference of two lists of numbers
    paste -d ' ' "$1" "$2" | awk '{ n = NF / 2; for (i = 1; i <= n; i++) { d = $i - $(n + i); d = d < 0 ? -d : d; s = $i < 0 ? -$i : $i; if (s > 0 && d / s > most) most = d / s } }
        END { printf "%.3g\n", most }'
}
as_always() { # MOST SETTING...
    most=$1
    shift
    for setting in "$@"; do set -- "$@" --set "$setting" && shift; done
    seen "$@" > always && seen "$@" --set 'joints[0].end=100' > timed && test -s timed && below "a timed joint against one that is always there: $*" "$(apart always timed)" "$most"
}
if quick; then kinds=ic0_coarse explicit=verlet; else kinds="none jacobi ic0 coarse ic0_coarse" explicit="explicit_euler symplectic_euler verlet rk4"; fi
for preconditioner in $kinds; do
    ok "a joint that ends after the run is as one that never does, $preconditioner" as_always 1e-8 solver.preconditioner=$preconditioner
done
ok "with springs, a guess and a pin at the joint" as_always 1e-8 materials.m.model=springs materials.m.damping.stiffness=0.01 solver.guess=previous 'cloths[0].pins[1]={vertices: [58]}'
ok "by BDF2" as_always 1e-8 integrator=bdf2
ok "by Newton steps with the whole slope" as_always 1e-6 newton.steps=4 solver.jacobian=full
ok "with a floor" as_always 1e-8 'obstacles=[{plane: {point: [0, -0.11, 0], normal: [0, 1, 0]}}]'
for integrator in $explicit; do
    ok "by $integrator" as_always 1e-8 integrator=$integrator time.h=2e-5 time.end=0.02
done

# Preconditioners know of ties: else stiff ones take several times the iterations.
iterations() { value cg_iterations_mean; }
preconditioned() { # PRECONDITIONER
    set -- --set solver.preconditioner="$1" --set solver.stop.relative=1e-6 --set 'joints[0].stiffness=50000' --set grain=12
    run panels.yaml "$@" --report report.json && always=$(iterations) && run panels.yaml "$@" --set 'joints[0].end=100' --report report.json && timed=$(iterations) &&
        echo "# $2 $always iterations a step, $timed where the joints are timed" >&3 && awk -v a="$always" -v b="$timed" 'BEGIN { exit !(a > 10 && b <= 1.3 * a) }'
}
for preconditioner in ${kinds#none }; do
    ok "stiff timed joints take the iterations of others, $preconditioner" preconditioned $preconditioner
done

as_patched() { as_always 1e-8 solver.patches=4 grain=64 'cloths[0].mesh.grid={width: 0.7, height: 0.7, nx: 8, ny: 20}' solver.preconditioner="$1" time.end=0.02; }
ok "with patches, coarse" as_patched coarse
ok "with patches, ic0_coarse" as_patched ic0_coarse
free_panels() { # two free panels that joints join: momentum as by joints that are always there
    run panels.yaml --set 'cloths[0].pins=[]' --set 'probes=[]' --set 'joints[0].end=0.05' --set solver.stop.relative=1e-3 --report report.json && below "momentum lost, kg m/s" "$(value momentum_lost)" 1e-13
}
ok "free panels that are joined keep their momentum to rounding" free_panels

momentum_kept() { # of joints with held ends, what the solve lost is the residual, no more
    run panels.yaml --set 'cloths[0].pins[0].vertices=[0,7,58]' --set 'joints[0].end=0.05' --report report.json && below "momentum lost, kg m/s" "$(value momentum_lost)" 1e-10
}
ok "momentum that pins take is not lost" momentum_kept

recorded() { # TIMES SETTING...
    times=$1
    shift
    run panels.yaml --report report.json "$@" && echo "recorded $(value graphs_recorded) times" && test "$(value graphs_recorded)" = "$times"
}
ok "the solve is recorded once where joints last" recorded 1
ok "also where they are there from the start" recorded 1 --set 'joints[0].end=100'
ok "again where joints begin, and where they end" recorded 3 --set 'joints[0].begin=0.02' --set 'joints[0].end=0.05'
again='{from: {cloth: front, vertices: [56, 57, 58, 59, 60, 61, 62, 63]}, to: {cloth: back, vertices: [0, 1, 2, 3, 4, 5, 6, 7]}, stiffness: 20, begin: 0.05, end: 0.08}'
ok "not where others come between the same blocks" recorded 3 --set 'joints[0].begin=0.02' --set 'joints[0].end=0.05' --set "joints[1]=$again"

# ---- The same bits ----
# RANKS,THREADS of the first case, and of those after it.
if quick; then runs=3,2 fewer=2,1; else runs="3,2 1,2 2,1" fewer=$runs; fi
alike() { # SETTING...
    for setting in "$@"; do set -- "$@" --set "$setting" && shift; done
    run panels.yaml "$@" --report report.json || return 1
    for run in $runs; do
        ranks "${run%,*}" "$DUITE_CLOTH" panels.yaml --threads "${run#*,}" --quiet --report many.json --set 'probes=[]' "$@" || return 1
        test "$(value state_hash)" = "$(value state_hash many.json)" || { echo "another hash on $run"; return 1; }
    done
}
ok "on any ranks and threads" alike 'joints[0].begin=0.02' 'joints[0].end=0.05' "joints[1]=$again"
runs=$fewer
halves() { alike 'joints[0].begin=0.0205' 'joints[0].stiffness=5000' time.h=0.004 time.stretch_growth=0.02 && echo "$(value steps_halved) steps halved" && test "$(value steps_halved)" -gt 0; }
in_full "where steps are halved" halves
rows16=$(awk 'BEGIN { for (i = 0; i < 256; i++) printf "%s%d", i ? ", " : "", i }')
ok "more joints of two blocks than a class has room for" alike grain=200 'cloths[0].mesh.grid={width: 0.7, height: 0.7, nx: 16, ny: 16}' \
    'cloths[1].mesh.grid={width: 0.7, height: 0.7, nx: 16, ny: 16}' "joints[0]={from: {cloth: front, vertices: [$rows16]}, to: {cloth: back, vertices: [$rows16]}, stiffness: 5, begin: 0.02, end: 0.05}" \
    'cloths[0].pins=[{vertices: [0, 7]}]' 'joints[1]={from: {cloth: front, vertices: [1, 2]}, to: {cloth: back, vertices: [9, 9]}, stiffness: 5, begin: 0.01}' solver.stop.relative=1e-6
