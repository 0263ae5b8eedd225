# Sourced by bench/experiments: those of garments. It has run, value, median, $scratch, $scenes, $runs, $all_runs and $quick.
# shellcheck shell=sh disable=SC2154,SC2086

# ---- Vassilev ----

loops_ms() { # THREADS STEPS on|off SCENE KEY=VALUE...: medians of what vassilev run prints, in $scratch/loops
    : > "$scratch/rows"
    loops_threads=$1 loops_steps=$2 loops_self=$3
    shift 3
    for _ in $(seq $runs); do
        "$loops" run "$loops_threads" "$loops_steps" "$loops_self" 1.1 "$@" >> "$scratch/rows" 2> "$scratch/said" || { cat "$scratch/said" >&2 && exit 1; }
    done
    for column in 1 2 3 4 5 6 7 8 9 10 11 12 13; do cut -d ' ' -f $column "$scratch/rows" | median | tr '\n' ' '; done > "$scratch/loops"
}
ours_ms() { # THREADS on|off SCENE: median of milliseconds a step
    ours_threads=$1 ours_self=$2 ours_scene=$3
    set -- --set 'materials.cloth.velocity_correction={at: 0.1, rounds: 1}' --set "time.end=$(awk -v n="$steps" 'BEGIN { print n * 1e-4 }')"
    test "$ours_self" = off || set -- "$@" --set 'contact={mode: repulsion, self: off, thickness: 0.003}' --set 'obstacles[0].body.meet=bvh'
    : > "$scratch/rows"
    for _ in $(seq $runs); do
        run 1 "$ours_threads" "$ours_scene" "$@"
        value seconds_per_step | awk '{ print $1 * 1e3 }' >> "$scratch/rows"
    done
    median < "$scratch/rows"
}
vassilev_row() { # on|off STEPS SCENE KEY=VALUE...: milliseconds an iteration of both, on one thread and two
    row_self=$1 row_steps=$2 row_scene=$3
    shift 3
    options=
    test "$row_self" = off || options=contact.thickness=0.003
    for threads in 1 2; do
        loops_ms $threads "$row_steps" "$row_self" "$scenes/$row_scene.yaml" $options "$@"
        mv "$scratch/loops" "$scratch/loops.$threads"
        ours_ms $threads "$row_self" "$row_scene" > "$scratch/ours.$threads"
    done
    paste -d ' ' "$scratch/loops.1" "$scratch/loops.2" "$scratch/ours.1" "$scratch/ours.2" | awk '{
        printf "| %d | %d | %.4f | %.4f | %.2f | %.4f | %.4f | %.2f |\n", $1, $2, $5, $18, $5 / $18, $27, $28, $27 / $28 }'
}
vassilev_header() {
    echo
    echo "| vertices | springs | six loops, 1 thread | 2 threads | speed-up | ours, 1 thread | 2 threads | speed-up |"
    echo "|---:|---:|---:|---:|---:|---:|---:|---:|"
}
panels() { # VERTICES: the scene is $scratch/panels.yaml
    awk -v n="$1" -f "$here/vassilev/panels.awk" > "$scratch/panels.yaml"
}
loops_by_name() { # of $scratch/loops.1 and .2
    echo
    echo "| loop | 1 thread | 2 threads |"
    echo "|---|---:|---:|"
    paste -d ' ' "$scratch/loops.1" "$scratch/loops.2" | awk '{
        split("springs,external forces,joints of seams and cloth against cloth,velocities and collisions,springs that are too long,positions", name, ",")
        for (k = 1; k <= 6; k++) printf "| %s | %.4f | %.4f |\n", name[k], $(5 + k), $(18 + k)
        printf "\nMean of all iterations: %.0f vertices in the body, %.0f pairs of vertices that repel each other\n", $12, $13 }'
}
vassilev() {
    loops=$PWD/bench/vassilev/vassilev
    test -x "$loops" || { echo "experiments: no bench/vassilev/vassilev in this folder" >&2 && exit 1; }
    sizes="500 1000 2000 5000 10000 20000" steps=1000
    test $quick = no || { sizes="100 300" && steps=10; }
    scenes=$scratch # run looks for scenes there
    cp "$here/vassilev/jeans.yaml" "$scratch"
    test $quick = no || sed -i 's/vertices: 5000/vertices: 500/' "$scratch/jeans.yaml"
    panels 500
    far_panels=$("$loops" check 20 "$scratch/panels.yaml")
    far_jeans=$("$loops" check 20 "$scratch/jeans.yaml")
    echo "Milliseconds an explicit iteration of two panels that joints pull together around the figure; median of $all_runs of $steps iterations. After 20"
    echo "iterations without the figure no vertex of the six loops is farther than $far_panels m from where duite-cloth has it, of jeans"
    echo "$far_jeans m"
    for self in off on; do
        echo
        echo "Cloth against cloth $self"
        vassilev_header
        for n in $sizes; do
            panels "$n"
            vassilev_row $self $steps panels
        done
    done
    echo
    echo "The six loops at the last size, by loop"
    loops_by_name
    for self in off on; do
        echo
        echo "Jeans, panels that joints of their seams pull together, cloth against cloth $self"
        vassilev_header
        vassilev_row $self $steps jeans
    done
}

# ---- ParTueTex's shirt ----

# The last phase, which is the paper's: steps, seconds and iterations a step.
hung() { sed -n 's/.*"name": "hang", "steps": \([0-9]*\), "cg_iterations_mean": \([^,]*\), .*"wall_seconds": \([^,]*\),.*/\1 \3 \2/p' "$scratch/report"; }
shirt_row() { # RANKS THREADS OPTIONS...: mean of the runs; the first row's seconds are those that speed-ups are by
    shape="$1 $2"
    shift 2
    : > "$scratch/rows"
    for _ in $(seq $runs); do
        run $shape shirt --output "$scratch/frames" "$@"
        hung >> "$scratch/rows"
        value state_hash >> "$scratch/hashes"
    done
    test "$(sort -u "$scratch/hashes" | wc -l)" = 1 || { echo "experiments: the shirt has other states" >&2 && exit 1; }
    awk '{ seconds += $2 } END { print seconds / NR }' "$scratch/rows" > "$scratch/seconds"
    test -s "$scratch/alone" || cp "$scratch/seconds" "$scratch/alone"
    awk -v shape="$shape" -v alone="$(cat "$scratch/alone")" -v mean="$(cat "$scratch/seconds")" '{ steps = $1; iterations = $3 } END {
        split(shape, s); printf "| %s x %s | %.3f | %.5f | %.2f | %.0f |\n", s[1], s[2], mean, mean / steps, alone / mean, iterations }' "$scratch/rows"
}
partutex_shirt() {
    most=$(nproc)
    set --
    test $quick = no || set -- --set 'cloths[0].mesh.pattern.vertices=700' --grain 100 --set 'phases[1].set.time.end=0.003'
    : > "$scratch/hashes" && : > "$scratch/alone"
    run 1 1 shirt "$@" --set 'phases[1].set.time.end=0.001'
    echo "Figure 3: the shirt of $(value triangles) triangles, one welded surface; plain conjugate gradients to 1e-3, 25 frames a second"
    echo "gathered, mean of $all_runs of the phase that hangs"
    echo
    echo "| ranks x threads | seconds | seconds a step | speed-up | iterations a step (1115 there) |"
    echo "|---|---:|---:|---:|---:|"
    shirt_row 1 1 "$@"
    for n in $(seq 2 "$most"); do shirt_row "$n" 1 "$@"; done
    for n in $(seq 2 "$most"); do shirt_row 1 "$n" "$@"; done
}
