#!/bin/sh
# duite-compare on four programs that know nothing of its options: of duite, OpenMP, StarPU and MPI, 12 configurations each.
. "${srcdir:-.}/tests/support/tap.sh"
plan_later
bin=$PWD

cat > "$scratch/openmp.c" << 'END'
#include <omp.h>
#include <stdio.h>
int main(void)
{
    const double start = omp_get_wtime();
    unsigned sum = 0;
#pragma omp parallel for schedule(runtime) reduction(+ : sum)
    for (unsigned i = 0; i < 1000000; i++)
        sum += i * i % 7;
    printf("sum %u\nTime: %g s\n", sum, omp_get_wtime() - start);
    return 0;
}
END
cat > "$scratch/starpu.c" << 'END'
#include <starpu.h>
#include <stdio.h>
#include <stdlib.h>
static void add(void *buffers[], void *arguments)
{
    (void)arguments;
    *(unsigned *)STARPU_VARIABLE_GET_PTR(buffers[0]) += 7;
}
static struct starpu_codelet codelet = {.cpu_funcs = {add}, .nbuffers = 1, .modes = {STARPU_RW}};
int main(int argc, char **argv)
{
    unsigned value[8] = {0}, sum = 0;
    starpu_data_handle_t handle[8];
    if (starpu_init(NULL))
        return 1;
    const double start = starpu_timing_now();
    for (int i = 0; i < 8; i++)
        starpu_variable_data_register(&handle[i], STARPU_MAIN_RAM, (uintptr_t)&value[i], sizeof *value);
    for (int i = 0; argc > 1 && i < atoi(argv[1]); i++)
        if (starpu_task_insert(&codelet, STARPU_RW, handle[i % 8], 0))
            return 1;
    for (int i = 0; i < 8; i++)
        starpu_data_unregister(handle[i]);
    for (int i = 0; i < 8; i++)
        sum += value[i];
    printf("sum %u\nTime: %g s\n", sum, 1e-6 * (starpu_timing_now() - start));
    starpu_shutdown();
    return 0;
}
END
cat > "$scratch/mpi.c" << 'END'
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
int main(int argc, char **argv)
{
    int rank, n;
    unsigned sum = 0, all = 0;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &n);
    const double start = MPI_Wtime();
    for (int i = rank; argc > 1 && i < atoi(argv[1]); i += n)
        sum += (unsigned)i % 7;
    MPI_Reduce(&sum, &all, 1, MPI_UNSIGNED, MPI_SUM, 0, MPI_COMM_WORLD);
    if (!rank)
        printf("sum %u\nTime: %g s\n", all, MPI_Wtime() - start);
    MPI_Finalize();
    return 0;
}
END

aligned() { awk '/^[|]/ { n[length($0)]++ } END { for (l in n) k++; exit k != 1 }' "$scratch/said"; }
compare() { # NAME OPTIONS... -- PROGRAM...: 12 configurations, each of which has a figure, a table in columns, and a page that stands alone
    name=$1
    shift
    status=0
    (cd "$scratch" && limited "$bin/duite-compare" --output "pages/$name" --rounds 1 "$@" > said 2>&1) || status=$?
    cat "$scratch/said" "$scratch/pages/$name/summary.csv"
    test $status = 0 && grep -q "^12 configurations, 1 rounds" "$scratch/said" && aligned && test "$(grep -c ',fine$' "$scratch/pages/$name/summary.csv")" = 12 &&
        test "$(grep -c '^<tr><td>' "$scratch/pages/$name/compare.html")" = 12 && grep -q '^<svg' "$scratch/pages/$name/compare.html" &&
        ! grep -q 'href=\|src=\|<script' "$scratch/pages/$name/compare.html"
}
time='Time: ([0-9.e-]+) s'
mkdir "$scratch/pages"
ok "duite" compare duite --scheduler fifo,steal,priority --mapping block,metis --threads 1,2 --figure key=wall_seconds --same key=tasks \
    -- "$bin/tests/examples/cholesky"
if ${CC:-cc} -O2 -fopenmp -o "$scratch/openmp" "$scratch/openmp.c" > "$scratch/output" 2>&1; then
    ok "OpenMP" compare openmp --threads 1,2,3 --vary OMP_SCHEDULE=static,dynamic,guided,auto --figure "$time" --same 'sum ([0-9]+)' -- ./openmp
else
    skip "OpenMP" "the compiler has no OpenMP"
fi
# shellcheck disable=SC2046 # options
if ${CC:-cc} -O2 -o "$scratch/starpu" "$scratch/starpu.c" $(${PKG_CONFIG:-pkg-config} --cflags --libs starpu-1.3) \
    > "$scratch/output" 2>&1; then
    export STARPU_HOME=$scratch STARPU_SILENT=1
    ok "StarPU" compare starpu --threads 1,2 --vary STARPU_SCHED=eager,lws,prio --vary TASKS=100,200 --figure "$time" --same 'sum ([0-9]+)' \
        -- ./starpu '{TASKS}'
else
    skip "StarPU" "libstarpu-dev is missing"
fi
# shellcheck disable=SC2086 # options
${CC:-cc} -O2 $MPI_CFLAGS -o "$scratch/mpi" "$scratch/mpi.c" $MPI_LIBS
ok "MPI" compare mpi --ranks 1,2,3 --vary SIZE=1000,2000,3000,4000 --figure "$time" --same 'sum ([0-9]+)' -- ./mpi '{SIZE}'
