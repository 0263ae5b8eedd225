#!/bin/sh
# Prints the table of README.md against rivals, all of it from one run on this machine (a quarter of an hour). Options go to
# duite-bench, as --repeats 4; --list names the cases that are run, and fails where one is missing.
#
#     bench/readme.sh [OPTION...]
set -eu
here=$(cd "$(dirname "$0")" && pwd)
bench=${BENCH:-$here/duite-bench}

rows() { # bench|metric|rival|what is measured
    cat << 'ROWS'
tasks|stencil_dynamic_ns_per_task_vs_libomp|libomp (OpenMP tasks)|a task of a stencil, forked anew
tasks|stencil_replay_ns_per_task_vs_libomp||the same graph, recorded and replayed
tasks|independent_dynamic_ns_per_task_vs_libomp||independent tasks
tasks|stencil_dynamic_ns_per_task_vs_starpu|StarPU|a task of a stencil, forked anew
tasks|stencil_replay_ns_per_task_vs_starpu||the same graph, recorded and replayed
ranks|cg_r2_vs_twin|MPI by hand|conjugate gradients on two ranks
ranks|stencil_step_vs_twin||a step of two empty tasks on two ranks: messages alone
cg|spring_150_vs_petsc|PETSc|an iteration of conjugate gradients, 22,500 vertices
cg|spring_400_vs_petsc||the same, 160,000 vertices
cg|solve_vs_petsc_icc||the whole solve of a cloth's step, each with its own preconditioner (PETSc: ICC)
contact|sphere_vs_blender|Blender|a frame of a sheet that falls onto a ball, where no triangles may intersect
ROWS
}

cases() { # BENCH: the options that run the cases of its rows
    rows | sed -n "s/^$1|\([^|]*\)|.*/\1/p" > "$scratch/wanted"
    "$bench" "$1" --list > "$scratch/list"
    awk 'NR == FNR { wanted[$1] = 1; next } /^[a-z]/ { now = $1; sub(":", "", now) }
         $1 in wanted { delete wanted[$1]; if (!seen[now]++) print "--only=" now }
         END { for (metric in wanted) { print "no case measures " metric > "/dev/stderr"; missing = 1 } exit missing }' \
        "$scratch/wanted" "$scratch/list"
}

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
for name in $(rows | cut -d '|' -f 1 | uniq); do
    only=$(cases "$name")
    if test "${1-}" = --list; then
        echo "$name:" "$only"
    else
        # shellcheck disable=SC2086 # an option a word
        "$bench" "$name" $only "$@" | tee -a "$scratch/said" >&2
    fi
done
test "${1-}" != --list || exit 0
echo "| rival | measured on two cores | duite's time / theirs | quartiles |"
echo "|---|---|---:|---|"
rows | while IFS='|' read -r _ metric rival what; do
    sed -n "s/^$metric: \([^ ]*\) x \[\([^]]*\)\].*/\1 | \2/; t row
            s/^$metric: \(.*\)/- | \1/; T
            :row
            s/.*/|${rival:+ $rival} | $what | & |/p" "$scratch/said"
done
echo
sed -n 's/^\(date\|duite\|host_processor\|host_cores\|compiler\): .*/&/p' "$scratch/said" | sort -u
