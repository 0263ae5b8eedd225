#!/bin/sh
# Pinched cloth pushes by the law of compression, P (d / g - 1) on its area, in steps of any length and however long it is pressed. It is
# named, friction holds it; opened, it flies no faster than the energy in it allows. Cloth that gives way is not pinched. And what passes
# many layers in a step takes no more memory than its vertices need.
. "${srcdir:-.}/tests/support/probes.sh"

# A sheet of 4 cm, shifted by OFFSET, on a box; another box comes down in 0.1 s. Vertices 0 and 4 are the ends of its border that stays
# between them.
pinch() { # NAME LEAST GAP OFFSET
    cat > "$1.yaml" << END
schema: 1
cloths: [{name: a, material: m, mesh: {grid: {width: 0.04, height: 0.04, nx: 5, ny: 5}}, transform: {translate: [$3, 0.0015, 0]}}]
materials: {m: {density: 0.2, stretch: 1000, shear: 300, bend: 1, damping: {stiffness: 0.004}}}
obstacles:
  - box: {name: low, centre: [-0.05, -0.05, 0], size: [0.2, 0.1, 0.2]}
  - box: {name: high, centre: [-0.05, 0.053, 0], size: [0.2, 0.1, 0.2], motion: {times: [0, 0.1], translate: [[0, 0, 0], [0, $(less "$2" 0.003), 0]]}}
contact: {mode: certified, thickness: 0.001, friction: 1}
time: {h: 0.004, end: 3, fps: 10}
probes:
  - {name: a, cloth: a, vertices: [0, 4], values: [position, velocity]}
  - {name: low, obstacle: low}
  - {name: high, obstacle: high}
END
}
law() { awk -v g="$1" 'BEGIN { printf "%.17g", 5000 * (0.002 / g - 1) * 0.0016 }'; } # LEAST GAP, shared by two contacts; N
after() { rows '!n && $2 >= '"$1"' { printf "%.17g", '"$2"'; n = 1 }'; } # SECONDS VALUE

pinch pinch 0.0015 0
presses() { # SCENE LEAST GAP, h
    run "$1.yaml" --report report.json --check-intersections --set time.h="$3" || return 1
    test "$(value intersections)" = 0 && near "force after 1 s, h = $3, N" "$(after 1 'c("low.cy")')" "$(law "$2")" 0.02 &&
        near "after 3 s, h = $3, N" "$(after 2.99 'c("low.cy")')" "$(after 1 'c("low.cy")')" 0.01
}
for h in 0.001 0.004 0.01; do ok "cloth of 1 mm in 0.75 mm, h = $h" presses pinch 0.0015 $h; done
named() {
    grep contact_pinch report.json
    test "$(value contact_pinches)" -ge 50 && grep -Eq '"contact_pinch": "vertices [0-9]+ of .a. and obstacles.[01]., a box, at 0[.][0-9]* s"' report.json
}
ok "the pinch is named" named
pinch tight 0.0005 0
for h in 0.001 0.004 0.01; do ok "cloth of 1 mm in 0.25 mm, h = $h" presses tight 0.0005 $h; done

opens() { # the most that its kinetic energy can be: that of the law over both gaps
    run pinch.yaml --report report.json --set time.end=2.3 \
        --set 'obstacles[1].box.motion={times: [0, 0.1, 2, 2.01], translate: [[0, 0, 0], [0, -0.0015, 0], [0, -0.0015, 0], [0, 0.01, 0]]}' || return 1
    below "speed when it is opened, of what the law allows" \
        "$(rows '$2 > 1.9 { for (i = 0; i < 5; i += 4) { v = c("a." i ".vy"); if (v > most) most = v } } END { print most / sqrt(4 * 5000 * 0.001 * (log(4 / 3) - 0.25) / 0.2) }')" 1 &&
        near "weight in the end, N" "$(rows 'END { printf "%.17g", c("low.cy") }')" "$(awk 'BEGIN { print 0.2 * 0.0016 * 9.81 }')" 0.01
}
ok "it is opened" opens

# A third of it hangs out.
pinch hangs 0.0015 0.045
creeps() { # SCENE OPTION...: how far its held border moves in 5 s
    run hangs.yaml --set time.end=6 "$@" || return 1
    test -n "$(after 1 'c("a.0.x")')" && below "held cloth moves in 5 s, m" "$(awk -v a="$(after 1 'c("a.0.x")')" -v b="$(rows 'END { printf "%.17g", c("a.0.x") }')" 'BEGIN { d = a - b; print d < 0 ? -d : d }')" 1e-6
}
ok "it does not creep" creeps
ok "it does not creep, h = 10 ms" creeps --set time.h=0.01

# Only a flap waves in it, so steps are halved where it lands alone: no contact presses harder the shorter they are.
pinch flap 0.0005 0.05
rests() {
    run flap.yaml --report report.json --set time.end=1.5 --set 'cloths[0].mesh={grid: {width: 0.08, height: 0.08, nx: 9, ny: 9}}' || return 1
    grep -E '"(steps|steps_halved|shortest_step)"' report.json
    test "$(value steps)" -lt 600
}
ok "it rests in steps that are seldom halved" rests
# A flap beside it changes no force.
even() { # h: the force after 1 s and in the end
    run flap.yaml --set time.end="${2:-2}" --set 'cloths[0].mesh={grid: {width: 0.08, height: 0.08, nx: 9, ny: 9}}' --set time.h="$1" || return 1
    near "force with a flap in the end, h = $1, N" "$(rows 'END { printf "%.17g", c("low.cy") }')" "${force:=$(after 1 'c("low.cy")')}" 0.02
}
for h in 0.001 0.004 0.01; do ok "a flap waves beside it, h = $h" even $h; done
if test "${DUITE_LONG:-}" = 1; then
    for h in 0.001 0.004 0.01; do ok "ten seconds beside a flap, h = $h" even $h 10; done
fi

# Pinned cloth is as solid as a box: one gap has what both leave, the law's 5 kPa at half of the thickness.
pinch held 0.0015 0
holds() { # h
    run held.yaml --report report.json --check-intersections --set 'cloths[0].pins=[{box: [[-1, -1, -1], [1, 1, 1]]}]' --set time.h="$1" \
        --set 'obstacles[1].box.motion={times: [0, 0.1], translate: [[0, 0, 0], [0, -0.001, 0]]}' || return 1
    test "$(value intersections)" = 0 && near "force of pinned cloth, h = $1, N" "$(rows 'END { printf "%.17g", c("high.cy") }')" -8 0.02 &&
        grep -E '"contact_pinch": "vertices [0-9]+ .pinned. of .a. and obstacles.1., a box' report.json
}
for h in 0.001 0.01; do ok "cloth that pins hold, h = $h" holds $h; done

# ---- Cloth that gives way

free() { # SCENE: it presses, and is never pinched
    run "$1.yaml" --report report.json --check-intersections || return 1
    grep -E '"(contact_pinch|contact_pinches|contacts|steps_halved)"' report.json
    test "$(value intersections)" = 0 && test "$(value contact_pinches)" = 0 && test "$(value contacts)" -gt 10
}
cat > belt.yaml << 'END'
schema: 1
gravity: [0, 0, 0]
cloths:
  - material: m
    mesh: {grid: {width: 0.3, height: 0.02, nx: 61, ny: 3}}
    transform: {translate: [0, 0.0512, 0]}
    loads:
      - {box: [[-0.16, 0, -1], [-0.14, 1, 1]], force: [0, -1, 0], curve: {keys: [[0, 0.01], [0.4, 1]]}}
      - {box: [[0.14, 0, -1], [0.16, 1, 1]], force: [0, -1, 0], curve: {keys: [[0, 0.01], [0.4, 1]]}}
materials: {m: {density: 0.5, stretch: 20000, bend: 0, damping: {stiffness: 0.003, mass: 20}}}
contact: {mode: certified, self: off, thickness: 0.001, friction: 0.3}
time: {h: 0.005, end: 0.8, stretch_growth: 0}
obstacles: [{cylinder: {centre: [0, 0, 0], axis: [0, 0, 1], radius: 0.05, length: 0.2}}, {plane: {point: [0, -1, 0], normal: [0, 1, 0]}}]
END
ok "a belt that is pulled tight around a cylinder" free belt
cat > curtain.yaml << 'END'
schema: 1
cloths:
  - {mesh: {grid: {width: 2, height: 2, nx: 33, ny: 33, cells: alternate}}, material: m, transform: {rotate: [0.7071067811865476, 0, 0, 0.7071067811865476]}, pins: [{box: [[-1, 0.999, -2], [1, 1.001, 2]]}]}
materials: {m: {density: 5, model: triangles, stretch: 1000, shear: 370, poisson: 0.35, bending: {rigidity: 0.000128}, friction: 0}}
obstacles: [{sphere: {centre: [-0.6, 0, 0], radius: 0.5, motion: {times: [0, 5], translate: [[0, 0, 0], [8, 0, 0]]}}}]
contact: {mode: certified, self: on, thickness: 0.001}
time: {h: 0.00833333333, end: 0.5, fps: 60}
END
ok "a curtain that a ball goes through" free curtain

# ---- Layers

# Four sheets between the boxes of above have half of their thicknesses. Each is pinched, from box to box; a box is in the first name.
pinch pile 0.0025 0
press() { # OPTION...
    run pile.yaml --report report.json --check-intersections --set obstacles[1].box.centre="[-0.05, 0.057, 0]" \
        --set 'obstacles[1].box.motion={times: [0, 0.2], translate: [[0, 0, 0], [0, -0.0045, 0]]}' --set time.end=1.2 "$@" || return 1
    grep contact_pinch report.json
    test "$(value intersections)" = 0 && grep -Eq '"contact_pinch": "vertices [0-9]+ of .[a-d]. and obstacles.[01]., a box, at 0[.][0-9]* s"' report.json
}
awk '/^cloths/ { for (i = 0; i < 4; i++) printf "%s{name: %c, material: m, mesh: {grid: {width: 0.04, height: 0.04, nx: %d, ny: %d}}, transform: {translate: [0, %g, 0]}}%s", i ? ", " : "cloths: [", 97 + i, 5 + i % 2, 5 + i % 2, 0.0015 * (i + 1), i < 3 ? "" : "]\n"; next } { print }' pile.yaml > piled && mv piled pile.yaml
ok "four sheets between two boxes" press
# It goes on from a checkpoint on two ranks, and reports what it would have on one without it.
goes_on() {
    set -- pile.yaml --quiet --set obstacles[1].box.centre="[-0.05, 0.057, 0]" --set 'obstacles[1].box.motion={times: [0, 0.2], translate: [[0, 0, 0], [0, -0.0045, 0]]}' --set grain=40
    limited "$DUITE_CLOTH" "$@" --end 0.6 --report whole.json && rm -rf part && ranks 2 "$DUITE_CLOTH" "$@" --end 0.4 --output part --checkpoint 100 &&
        ranks 2 "$DUITE_CLOTH" "$@" --end 0.6 --restart part --report report.json || return 1
    for key in state_hash contact_pinches contact_pinch steps; do
        echo "$key: $(value $key), $(value $key whole.json)"
        test "$(value $key)" = "$(value $key whole.json)" || return 1
    done
    test "$(value blocks)" -gt 2 && test "$(value contact_pinches)" -gt 0
}
in_full "it goes on from a checkpoint, on two ranks" goes_on

# Eight sheets at 100 m/s, which pass each other in the first step: in it 15 pairs fail a vertex.
layers() {
    for i in 0 1 2 3; do
        printf '  - {name: up%s, mesh: {grid: {width: 0.1, height: 0.1, nx: 7, ny: 7}}, material: m, velocity: [0, 100, 0], transform: {translate: [0, -0.1%s, 0]}}\n' $i $i
        printf '  - {name: down%s, mesh: {grid: {width: 0.1, height: 0.1, nx: 6, ny: 6}}, material: m, velocity: [0, -100, 0], transform: {translate: [0.05, 0.1%s, 0.03], rotate: [0.966, 0, 0.05, 0.259]}}\n' $i $i
    done
}
cat > pass.yaml << END
schema: 1
gravity: [0, 0, 0]
cloths:
$(layers)
materials: {m: {density: 0.2, stretch: 1000, shear: 300, bend: 1, damping: {viscous: 2.0e-6, stiffness: 0.004}}}
contact: {mode: certified, thickness: 0.001, friction: 0.3}
time: {h: 0.005, end: 0.005, stretch_growth: 0}
END
passes() { # MEGABYTES SCENE OPTION...: the contacts of all pairs of that step would take more
    most=${1}000000
    shift
    run "$@" --report report.json || return 1
    grep -E 'steps_halved|peak_memory' report.json
    test "$(value steps_halved_contact)" -gt 0 && { test -n "$SANITIZER" || test "$(value peak_memory_bytes)" -lt "$most"; }
}
pile() { # five sheets that press each other: a vertex fails with several of them
    for i in 0 1 2 3 4; do set -- "$@" --set "cloths[$i].mesh.grid.nx=30" --set "cloths[$i].mesh.grid.ny=30"; done
    passes 280 "$srcdir/cloth/scenes/stack.yaml" --end 0.18 "$@"
}
ok "what passes many layers in a step" passes 80 pass.yaml
ok "a sheet that passes half of another" passes 80 "$srcdir/bench/contact/peers/cross.yaml" --end 0.005
ok "a pile that presses itself" pile
