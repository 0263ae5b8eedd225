/* Renaming: what a w does while the old version is still read, how much memory that takes, and that
 * readers keep what they read. */
#include "tests/negative/misuse.h"
#include "tests/support/unit.h"

#include <stdatomic.h>
#include <stdint.h>
#include <time.h>

enum { ROUNDS = 10, MOST = 40 };
static const size_t PACKET = 2 * 64; /* of a few bytes: its header, and a line of them */

static atomic_int written, read_over;

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Tells how much was written before it is over, having waited for that for a while. */
static int watch(const duite_call *call)
{
    const double until = seconds() + *(const double *)call->args;

    while (!atomic_load(&written) && seconds() < until)
        ;
    duite_out(call, 0, int32_t)[0] = 10 * duite_in(call, 1, int32_t)[0] + atomic_load(&written);
    atomic_store(&read_over, 1);
    return 0;
}

static int overwrite(const duite_call *call)
{
    const int32_t value = *(const int32_t *)call->args;

    for (size_t i = 0; i < duite_count(call, 0); i++)
        duite_out(call, 0, int32_t)[i] = value;
    atomic_store(&written, 1 + atomic_load(&read_over));
    return 0;
}

/* Overwrites with `value` elements that are each `value`. */
static int resize(const duite_call *call)
{
    const int32_t value = *(const int32_t *)call->args;
    const int code = duite_resize(call, 0, (size_t)value);

    return code ? code : overwrite(call);
}

static int total(const duite_call *call)
{
    int32_t sum = 0;

    for (size_t i = 0; i < duite_count(call, 1); i++)
        sum += duite_in(call, 1, int32_t)[i];
    duite_out(call, 0, int32_t)[0] += sum;
    return 0;
}

static const duite_kernel WATCH = {.name = "watch",
                                   .body = watch,
                                   .access = {DUITE_W, DUITE_R},
                                   .args_size = sizeof(double),
                                   .side_effects = 1};
static const duite_kernel OVERWRITE = {
    .name = "overwrite", .body = overwrite, .access = {DUITE_W}, .args_size = sizeof(int32_t)};
static const duite_kernel RESIZE = {
    .name = "resize", .body = resize, .access = {DUITE_W}, .args_size = sizeof(int32_t)};
static const duite_kernel TOTAL = {.name = "total", .body = total, .access = {DUITE_RW, DUITE_R}};

static duite *start(size_t rename_bytes, unsigned threads, int check)
{
    static const duite_kernel *const KERNELS[] = {&WATCH, &OVERWRITE, &RESIZE, &TOTAL, NULL};
    duite_options options = misuse_options(MPI_COMM_WORLD);
    duite *rt = NULL;

    misuse_mpi();
    options.kernels = KERNELS;
    options.threads = threads;
    options.rename_bytes = rename_bytes;
    options.check = check;
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_OK);
    return rt;
}

static int get(duite *rt, duite_object object)
{
    int32_t value[MOST] = {-1};

    ck_assert_int_eq(duite_get(rt, object, value), DUITE_OK);
    return value[0];
}

static uint64_t renamed(duite *rt)
{
    duite_counters counters;

    ck_assert_int_eq(duite_count_all(rt, &counters), DUITE_OK);
    return counters.renamed;
}

/* A task reads 7 and waits for the task that overwrites it with 8; what the reader tells. */
static int read_and_overwrite(size_t rename_bytes, double patience, uint64_t expected)
{
    duite *rt = start(rename_bytes, 2, 0);
    const duite_object object = misuse_new(rt, 1), told = misuse_new(rt, 1);
    const int32_t seven = 7, eight = 8;

    ck_assert_int_eq(DUITE_FORK(rt, &OVERWRITE, &seven, object), DUITE_OK);
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
    atomic_store(&written, 0);
    atomic_store(&read_over, 0);
    ck_assert_int_eq(DUITE_FORK(rt, &WATCH, &patience, told, object), DUITE_OK);
    ck_assert_int_eq(DUITE_FORK(rt, &OVERWRITE, &eight, object), DUITE_OK);
    ck_assert_int_eq(get(rt, object), 8);
    const int answer = get(rt, told);

    ck_assert_uint_eq(renamed(rt), expected);
    duite_free(rt, object);
    duite_free(rt, told);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
    return answer;
}

START_TEST(a_w_does_not_wait_for_readers)
{
    ck_assert_int_eq(read_and_overwrite(PACKET, 60, 1), 71);
}
END_TEST

START_TEST(a_w_waits_at_the_limit)
{
    ck_assert_int_eq(read_and_overwrite(0, 0.1, 0), 70);
    ck_assert_int_eq(atomic_load(&written), 2);
    ck_assert_int_eq(read_and_overwrite(PACKET - 1, 0.1, 0), 70);
    ck_assert_int_eq(atomic_load(&written), 2);
}
END_TEST

/* One thread: nothing runs before the wait. */
START_TEST(memory_is_bounded_and_comes_back)
{
    for (size_t limit = 0; limit <= 5; limit++) {
        duite *rt = start(limit * PACKET, 1, 0);
        const duite_object object = misuse_new(rt, 1), sum = misuse_new(rt, 1);
        int expected = 0;

        for (int32_t batch = 1; batch <= 3; batch++) {
            for (int32_t i = 0; i < ROUNDS; i++) {
                ck_assert_int_eq(DUITE_FORK(rt, &TOTAL, NULL, sum, object), DUITE_OK);
                ck_assert_int_eq(DUITE_FORK(rt, &OVERWRITE, &i, object), DUITE_OK);
                expected += i;
            }
            ck_assert_int_eq(DUITE_FORK(rt, &TOTAL, NULL, sum, object), DUITE_OK);
            expected += batch < 3 ? ROUNDS - 1 : 0;
            ck_assert_uint_eq(renamed(rt), (uint64_t)batch * limit);
            ck_assert_int_eq(duite_wait(rt), DUITE_OK);
        }
        ck_assert_int_eq(get(rt, sum), expected);
        duite_free(rt, object);
        duite_free(rt, sum);
        ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
    }
}
END_TEST

/* Readers find the size and the elements of their version, checked or not. */
static void run_sized(int check)
{
    duite *rt = start(SIZE_MAX, 3, check);
    const duite_object sum = misuse_new(rt, 1);
    duite_object object;
    int32_t expected = 0;

    ck_assert_int_eq(duite_new_sized(rt, DUITE_I32, 0, MOST, &object), DUITE_OK);
    for (int32_t i = 1; i <= MOST; i++) {
        const int32_t size = 1 + i * 7 % MOST;

        ck_assert_int_eq(DUITE_FORK(rt, &RESIZE, &size, object), DUITE_OK);
        ck_assert_int_eq(DUITE_FORK(rt, &TOTAL, NULL, sum, object), DUITE_OK);
        expected += size * size;
    }
    ck_assert_int_eq(get(rt, sum), expected);
    ck_assert_int_eq(get(rt, object), 1 + MOST * 7 % MOST);
    duite_free(rt, object);
    duite_free(rt, sum);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}

START_TEST(sizes_are_those_of_the_version)
{
    run_sized(0);
    run_sized(1);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("renaming");
    TCase *renaming = tcase_create("renaming");

    tcase_add_test(renaming, a_w_does_not_wait_for_readers);
    tcase_add_test(renaming, a_w_waits_at_the_limit);
    tcase_add_test(renaming, memory_is_bounded_and_comes_back);
    tcase_add_test(renaming, sizes_are_those_of_the_version);
    suite_add_tcase(suite, renaming);
    return unit_run(suite);
}
