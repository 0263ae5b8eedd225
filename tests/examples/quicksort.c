/* Quicksort: how deep it goes depends on the values, so tasks fork tasks. No task waits: each sort
 * hands its right to write the result on to the task that joins the halves. It sorts a permutation
 * of 0 ... N - 1. */

#include <duite.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { N = 20000, SMALL = 500 };

static int sort(const duite_call *call);
static int sort_small(const duite_call *call);
static int split(const duite_call *call);
static int join(const duite_call *call);

static const duite_kernel SORT = {.name = "sort", .body = sort, .access = {DUITE_R, DUITE_WP}};
static const duite_kernel SORT_SMALL = {
    .name = "sort small", .body = sort_small, .access = {DUITE_R, DUITE_W}};
static const duite_kernel SPLIT = {
    .name = "split", .body = split, .access = {DUITE_R, DUITE_W, DUITE_W, DUITE_W}};
static const duite_kernel JOIN = {
    .name = "join", .body = join, .access = {DUITE_W}, .variadic = DUITE_R};

static int sort(const duite_call *call)
{
    const duite_object values = call->param[0].object, sorted = call->param[1].object;
    const size_t n = duite_count(call, 0);
    duite_object low, pivot, high, low_sorted, high_sorted;
    if (n <= SMALL)
        return DUITE_FORK(call->rt, &SORT_SMALL, NULL, values, sorted);
    duite_new(call->rt, DUITE_I32, 1, &pivot);
    duite_new_sized(call->rt, DUITE_I32, 0, n, &low);
    duite_new_sized(call->rt, DUITE_I32, 0, n, &high);
    duite_new_sized(call->rt, DUITE_I32, 0, n, &low_sorted);
    duite_new_sized(call->rt, DUITE_I32, 0, n, &high_sorted);
    DUITE_FORK(call->rt, &SPLIT, NULL, values, low, pivot, high);
    DUITE_FORK(call->rt, &SORT, NULL, low, low_sorted);
    DUITE_FORK(call->rt, &SORT, NULL, high, high_sorted);
    return DUITE_FORK(call->rt, &JOIN, NULL, sorted, low_sorted, pivot, high_sorted);
}

static int compare(const void *a, const void *b)
{
    const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

static int sort_small(const duite_call *call)
{
    const size_t n = duite_count(call, 0);
    int32_t *sorted = duite_out(call, 1, int32_t);
    memcpy(sorted, duite_in(call, 0, int32_t), n * sizeof *sorted);
    qsort(sorted, n, sizeof *sorted, compare);
    return duite_resize(call, 1, n);
}

static int split(const duite_call *call) /* values below the pivot, the pivot, the others */
{
    const int32_t *values = duite_in(call, 0, int32_t);
    const size_t n = duite_count(call, 0), middle = n / 2;
    int32_t *low = duite_out(call, 1, int32_t), *high = duite_out(call, 3, int32_t);
    size_t n_low = 0, n_high = 0;
    for (size_t i = 0; i < n; i++)
        if (i == middle)
            *duite_out(call, 2, int32_t) = values[i];
        else if (values[i] < values[middle])
            low[n_low++] = values[i];
        else
            high[n_high++] = values[i];
    return duite_resize(call, 1, n_low) || duite_resize(call, 3, n_high);
}

static int join(const duite_call *call) /* one after the other */
{
    size_t n = 0;
    for (size_t i = 1; i < call->n_params; i++)
        for (size_t k = 0; k < duite_count(call, i); k++)
            duite_out(call, 0, int32_t)[n++] = duite_in(call, i, int32_t)[k];
    return duite_resize(call, 0, n);
}

static int run(duite *rt)
{
    static int32_t x[N];
    duite_object values, sorted;
    for (int i = 0; i < N; i++)
        x[i] = (int)(i * 7919LL % N);
    duite_new(rt, DUITE_I32, N, &values);
    duite_new_sized(rt, DUITE_I32, 0, N, &sorted);
    duite_set(rt, values, x);
    DUITE_FORK(rt, &SORT, NULL, values, sorted);
    if (duite_get(rt, sorted, x))
        fprintf(stderr, "quicksort: %s\n", duite_message());
    duite_free(rt, values);
    duite_free(rt, sorted);
    for (int i = 0; i < N; i++)
        if (x[i] != i)
            return 1;
    return 0;
}

int main(int argc, char **argv)
{
    duite_options options = duite_options_default();
    duite *rt;
    options.kernels = (const duite_kernel *const[]){&SORT, &SORT_SMALL, &SPLIT, &JOIN, NULL};
    if (argc > 1)
        options.scheduler = duite_scheduler_find(argv[1]);
    if (duite_start(&rt, &options))
        return fprintf(stderr, "quicksort: %s\n", duite_message()), 1;
    int wrong = run(rt);
    if (duite_stop(&rt)) /* tells the errors that nobody asked for */
        return fprintf(stderr, "quicksort: %s\n", duite_message()), 1;
    return wrong;
}
