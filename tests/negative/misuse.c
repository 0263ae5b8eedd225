/* The kernels do so little that what a test sees is the runtime's doing. */

#include "tests/negative/misuse.h"

#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

KERNEL_SHARED(SET, "set", .access = {DUITE_W}, .args_size = sizeof(int32_t))
{
    for (size_t i = 0; i < duite_count(call, 0); i++)
        duite_out(call, 0, int32_t)[i] = *(const int32_t *)call->args;
    return 0;
}

KERNEL_SHARED(COPY, "copy", .access = {DUITE_R, DUITE_W})
{
    duite_out(call, 1, int32_t)[0] = duite_in(call, 0, int32_t)[0] + 1;
    return 0;
}

KERNEL_SHARED(ADD, "add", .access = {DUITE_CW})
{
    duite_out(call, 0, int32_t)[0] += 1;
    return 0;
}

KERNEL_SHARED(FAIL, "fail", .access = {DUITE_RW}, .args_size = sizeof(int32_t))
{
    const int32_t code = *(const int32_t *)call->args;

    duite_out(call, 0, int32_t)[0] = -1;
    return duite_fail(call, code, "sentence %d of a body", code);
}

KERNEL_SHARED(EMPTY, "empty")
{
    (void)call;
    return 0;
}

const duite_kernel MANY = {
    .name = "many", .body = EMPTY_body, .access = {DUITE_R}, .variadic = DUITE_R};
const duite_kernel EVERYWHERE = {
    .name = "everywhere", .body = COPY_body, .access = {DUITE_R, DUITE_W}, .replicated = 1};
const duite_kernel UNLISTED = {.name = "unlisted", .body = EMPTY_body, .access = {DUITE_RW}};

double misuse_megabytes(void)
{
    const struct mallinfo2 info = mallinfo2();

    return 1e-6 * (double)(info.uordblks + info.hblkhd);
}

int rank, ranks;

static void finalise(void)
{
    MPI_Finalize();
}

void misuse_mpi_at(int level)
{
    int is, given;

    MPI_Initialized(&is);
    if (!is) {
        MPI_Init_thread(NULL, NULL, level, &given);
        atexit(finalise);
    }
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
}

void misuse_mpi(void)
{
    misuse_mpi_at(MPI_THREAD_MULTIPLE);
}

duite_options misuse_options(MPI_Comm comm)
{
    static const duite_kernel *const LIST[] = {&SET,  &COPY,  &ADD,        &FAIL,
                                               &MANY, &EMPTY, &EVERYWHERE, NULL};
    duite_options options = duite_options_default();

    options.comm = comm;
    options.kernels = LIST;
    options.threads = 2;
    options.bind = 0;
    return options;
}

duite *misuse_start_with(const duite_options *options)
{
    duite *rt = NULL;

    misuse_mpi();
    if (duite_start(&rt, options))
        fprintf(stderr, "# start: %s\n", duite_message());
    return rt;
}

duite *misuse_start(MPI_Comm comm, unsigned threads)
{
    duite_options options = misuse_options(comm);

    options.threads = threads;
    return misuse_start_with(&options);
}

duite_object misuse_new(duite *rt, size_t count)
{
    duite_object object = DUITE_NO_OBJECT;

    duite_new(rt, DUITE_I32, count, &object);
    return object;
}

static int n_cases, n_wrong;

const char *misuse_first_ranks(int n)
{
    static char text[60];

    snprintf(text, sizeof text, n > 2 ? "ranks 0-%d" : n > 1 ? "ranks 0 and %d" : "rank %d", n - 1);
    return text;
}

static char kept[1024];

void misuse_keep_message(void)
{
    snprintf(kept, sizeof kept, "%s", duite_message());
}

int misuse_all_told(const char *text)
{
    char first[sizeof kept];

    memcpy(first, kept, sizeof first);
    MPI_Bcast(first, sizeof first, MPI_CHAR, 0, MPI_COMM_WORLD);
    const int right = !strcmp(first, kept) && strstr(kept, text);

    if (!right)
        fprintf(stderr, "# '%s' is not '%s' of rank 0, or lacks '%s'\n", kept, first, text);
    return right;
}

void tap_case(int right, const char *name)
{
    int all;

    MPI_Allreduce(&right, &all, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    n_cases++;
    n_wrong += !all;
    if (!right)
        fprintf(stderr, "# rank %d: wrong: %s (last message: %s)\n", rank, name, duite_message());
    if (rank == 0)
        printf("%sok %d - %s\n", all ? "" : "not ", n_cases, name);
    fflush(stdout);
}

int tap_done(void)
{
    if (rank == 0)
        printf("1..%d\n", n_cases);
    return n_wrong != 0;
}
