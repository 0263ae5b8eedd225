/* Parts of objects: tasks write them in the object's bytes, and the object is whole again. Run
 * under mpirun. */
#include "tests/negative/misuse.h"
#include "tests/support/ranks.h"

#include <stdatomic.h>
#include <stdint.h>
#include <string.h>

enum { WIDTH = 3000, SMALL = 100, ROUNDS = 5 };

static duite *rt;
static _Atomic(void *) seen[2]; /* where the last body of MARK found its object: of fewer, of all */

/* Each value is one more. */
KERNEL(MARK, "mark", .access = {DUITE_RW})
{
    const size_t n = duite_count(call, 0);

    for (size_t i = 0; i < n; i++)
        duite_out(call, 0, int32_t)[i] += 1;
    atomic_store(&seen[n == WIDTH], call->param[0].data);
    return 0;
}

KERNEL(NUMBER, "number", .access = {DUITE_W})
{
    for (size_t i = 0; i < duite_count(call, 0); i++)
        duite_out(call, 0, int32_t)[i] = (int32_t)i;
    return 0;
}

/* Halves the object until it is small; every second one is joined by the runtime. */
KERNEL(HALVE, "halve", .access = {DUITE_RWP})
{
    const size_t n = duite_count(call, 0), counts[] = {n / 2, n - n / 2};
    const duite_object object = call->param[0].object;
    duite_object half[2];

    if (n <= SMALL)
        return duite_fork(call->rt, &MARK, NULL, 1, &object);
    duite_split(call->rt, object, 2, counts, half);
    duite_fork(call->rt, &HALVE, NULL, 1, &half[0]);
    duite_fork(call->rt, &HALVE, NULL, 1, &half[1]);
    return n % 2 ? duite_join(call->rt, object) : 0;
}

/* A body splits what it made, and may not split what it holds by w; the result is 0 if all is
 * right.
 */
KERNEL(INSIDE, "inside", .access = {DUITE_W}, .side_effects = 1)
{
    const size_t counts[] = {1, 2};
    duite_object own, part[2], again[2];
    int32_t got[3] = {-1, -1, -1};
    int code = duite_new(call->rt, DUITE_I32, 3, &own);

    code |= duite_split(call->rt, own, 2, counts, part);
    code |= duite_fork(call->rt, &MARK, NULL, 1, &part[1]) | duite_join(call->rt, own);
    code |= duite_get(call->rt, own, got);
    int wrong = code || got[0] || got[1] != 1 || got[2] != 1;
    wrong |= duite_split(call->rt, call->param[0].object, 2, counts, again) != DUITE_E_RIGHT;
    wrong |= duite_wait(call->rt) != DUITE_E_RIGHT;
    wrong |= duite_join(call->rt, own) != DUITE_E_OBJECT || duite_wait(call->rt) != DUITE_E_OBJECT;
    duite_out(call, 0, int32_t)[0] = wrong;
    return 0;
}

static const duite_kernel *const KERNELS[] = {&SET,    &COPY,  &ADD,    &FAIL, &MARK,
                                              &NUMBER, &HALVE, &INSIDE, NULL};

static int is_row(const int32_t *values, int32_t first, size_t n)
{
    int right = 1;

    for (size_t i = 0; i < n; i++)
        right = right && values[i] == first + (int32_t)i;
    return right;
}

static duite_object numbered(void)
{
    const duite_object object = misuse_new(rt, WIDTH);

    duite_fork(rt, &NUMBER, NULL, 1, &object);
    return object;
}

/* Each part is written by tasks of its own, all in one place. */
static void in_place(int check)
{
    static const size_t COUNTS[] = {1000, 1, 1999};
    const duite_object object = numbered();
    duite_object part[3];
    int32_t got[WIDTH];
    int code = duite_split(rt, object, 3, COUNTS, part);

    for (int i = 0; i < 2 * ROUNDS; i++)
        code |= duite_fork(rt, &MARK, NULL, 1, &part[i % 2 ? 0 : 2]);
    code |= duite_fork(rt, &MARK, NULL, 1, &part[1]) | duite_get(rt, part[1], got);
    int right = got[0] == 1001;
    const char *last = atomic_load(&seen[0]);
    code |= duite_join(rt, object) | duite_fork(rt, &MARK, NULL, 1, &object);
    code |= duite_get(rt, object, got);
    right = right && is_row(got, ROUNDS + 1, 1000) && got[1000] == 1002 &&
            is_row(got + 1001, 1002 + ROUNDS, 1999);
    tap_case(!code && right, "parts are written apart, and then the whole");
    const char *whole = atomic_load(&seen[1]);
    const int here = duite_home(rt, object) == rank;
    tap_case(check || !here || (last >= whole && last < whole + WIDTH * sizeof(int32_t)),
             "in the bytes of the whole");
    duite_free(rt, object);
    duite_wait(rt);
}

/* Values that do not lie there, contributions, turns, and parts of parts. */
static void from_elsewhere(void)
{
    static const size_t COUNTS[] = {5, 5, 2990}, HALVES[] = {2, 3};
    const duite_object object = numbered();
    duite_object part[3], half[2];
    const int32_t five[] = {50, 51, 52, 53, 54}, seven = 7;
    int32_t got[WIDTH];
    void *data;
    int code = duite_split(rt, object, 3, COUNTS, part);

    code |= duite_set(rt, part[0], five) | duite_split(rt, part[1], 2, HALVES, half);
    code |= duite_fork_at(rt, ranks - 1, &SET, &seven, 1, &half[0]);
    code |= duite_fork(rt, &ADD, NULL, 1, &half[1]) | duite_join(rt, part[1]);
    code |= duite_acquire(rt, part[2], DUITE_RW, &data);
    if (data)
        *(int32_t *)data = -1;
    code |= duite_release(rt, part[2]) | duite_join(rt, object) | duite_get(rt, object, got);
    tap_case(!code && is_row(got, 50, 5) && got[5] == 7 && got[6] == 7 && got[7] == 8 &&
                 got[8] == 8 && got[10] == -1 && is_row(got + 11, 11, WIDTH - 11),
             "values from elsewhere come to the whole");
    duite_free(rt, object);
    duite_wait(rt);
}

/* A part that failed poisons the whole; a whole that failed its parts, until they are overwritten.
 */
static void fails(void)
{
    static const size_t COUNTS[] = {1000, 2000};
    const duite_object object = numbered();
    duite_object part[2];
    const int32_t code = 17;
    int32_t got[WIDTH];

    duite_split(rt, object, 2, COUNTS, part);
    duite_fork(rt, &FAIL, &code, 1, &part[0]);
    duite_fork(rt, &MARK, NULL, 1, &part[1]);
    int right = duite_get(rt, part[0], got) == code && !duite_get(rt, part[1], got);
    right = !duite_join(rt, object) && right && duite_get(rt, object, got) == code;
    tap_case(duite_wait(rt) == code && right, "a part's failure is the whole's");
    right = !duite_split(rt, object, 2, COUNTS, part) && duite_get(rt, part[1], got) == code;
    for (int i = 0; i < 2; i++)
        duite_fork(rt, &NUMBER, NULL, 1, &part[i]);
    right = !duite_join(rt, object) && !duite_get(rt, object, got) && right;
    tap_case(!duite_wait(rt) && right && is_row(got, 0, 1000) && is_row(got + 1000, 0, 2000),
             "and the parts', which heal");
    duite_free(rt, object);
    duite_wait(rt);
}

static void in_bodies(void)
{
    const duite_object object = numbered(), told = misuse_new(rt, 1);
    int32_t got[WIDTH], wrong = -1;
    int code = duite_fork(rt, &HALVE, NULL, 1, &object) | duite_fork(rt, &MARK, NULL, 1, &object);

    code |= duite_get(rt, object, got);
    tap_case(!code && is_row(got, 2, WIDTH), "bodies split what they hold");
    code = duite_fork(rt, &INSIDE, NULL, 1, &told) | duite_get(rt, told, &wrong);
    tap_case(!code && !wrong, "and what they made, no more");
    duite_free(rt, object);
    duite_free(rt, told);
    duite_wait(rt);
}

static void adopted(int check)
{
    static const size_t COUNTS[] = {1500, 1500};
    static int32_t values[WIDTH];
    duite_object object, part[2];

    memset(values, 0, sizeof values);
    int code = duite_adopt(rt, ranks - 1, DUITE_I32, WIDTH, values, NULL, NULL, &object);
    code |= duite_split(rt, object, 2, COUNTS, part) | duite_fork(rt, &MARK, NULL, 1, &part[1]);
    code |= duite_wait(rt);
    const void *data = atomic_load(&seen[0]);
    const int right = check || rank < ranks - 1 || data == values + 1500;
    code |= duite_join(rt, object) | duite_free(rt, object) | duite_wait(rt);
    tap_case(!code && right && !values[1499] && values[1500] == (rank == ranks - 1),
             "the program's memory has parts");
}

static void refused(void)
{
    static const size_t FEW[] = {1, 1}, MANY_[] = {2, 2}, NONE[] = {0, 3}, WELL[] = {1, 2};
    const duite_object object = misuse_new(rt, 3);
    duite_object sized, part[2], half[2];
    int32_t got[3];

    duite_new_sized(rt, DUITE_I32, 3, 3, &sized);
    tap_case(duite_split(rt, object, 2, FEW, part) == DUITE_E_ARGUMENT &&
                 strstr(duite_message(), "the parts leave 1 of the object's 3 elements") &&
                 duite_wait(rt) == DUITE_E_ARGUMENT,
             "too few elements");
    tap_case(duite_split(rt, object, 2, MANY_, part) == DUITE_E_ARGUMENT &&
                 duite_wait(rt) == DUITE_E_ARGUMENT,
             "too many");
    tap_case(duite_split(rt, object, 2, NONE, part) == DUITE_E_ARGUMENT &&
                 duite_wait(rt) == DUITE_E_ARGUMENT,
             "none in a part");
    tap_case(duite_split(rt, object, 0, NONE, part) == DUITE_E_ARGUMENT &&
                 duite_wait(rt) == DUITE_E_ARGUMENT &&
                 duite_split(rt, object, 2, WELL, NULL) == DUITE_E_ARGUMENT &&
                 duite_wait(rt) == DUITE_E_ARGUMENT,
             "no parts");
    tap_case(duite_split(rt, sized, 2, WELL, part) == DUITE_E_SIZE &&
                 duite_wait(rt) == DUITE_E_SIZE,
             "an object that changes its size");
    tap_case(duite_join(rt, object) == DUITE_E_OBJECT && strstr(duite_message(), "is not split") &&
                 duite_wait(rt) == DUITE_E_OBJECT,
             "a join of what is whole");
    tap_case(!duite_split(rt, object, 2, WELL, part) &&
                 duite_get(rt, object, got) == DUITE_E_OBJECT &&
                 strstr(duite_message(), "only its parts may be named") &&
                 duite_fork(rt, &MARK, NULL, 1, &object) == DUITE_E_OBJECT &&
                 duite_wait(rt) == DUITE_E_OBJECT,
             "the whole while it is split");
    tap_case(duite_free(rt, part[0]) == DUITE_E_STATE && duite_wait(rt) == DUITE_E_STATE,
             "a part is not freed");
    tap_case(!duite_split(rt, part[1], 2, FEW, half) && duite_join(rt, object) == DUITE_E_OBJECT &&
                 duite_wait(rt) == DUITE_E_OBJECT && !duite_join(rt, part[1]) &&
                 !duite_join(rt, object) && !duite_get(rt, object, got) && !got[2],
             "parts of parts are joined first");
    tap_case(duite_fork(rt, &MARK, NULL, 1, &part[0]) == DUITE_E_OBJECT &&
                 duite_wait(rt) == DUITE_E_OBJECT,
             "and then they are gone");
    duite_free(rt, object);
    duite_free(rt, sized);
    duite_wait(rt);
}

RANKS_CASE(parts)
{
    static const size_t COUNTS[] = {1000, 2000}, HALVES[] = {1, 999};
    duite_object part[2];

    misuse_mpi();
    for (unsigned threads = 1; threads < 3; threads++)
        for (int check = 0; check < 2; check++) {
            duite_options options = misuse_options(MPI_COMM_WORLD);

            options.kernels = KERNELS;
            options.threads = threads;
            options.check = check;
            rt = misuse_start_with(&options);
            in_place(check);
            from_elsewhere();
            fails();
            in_bodies();
            adopted(check);
            refused();
            const duite_object object = numbered();
            const int code = duite_split(rt, object, 2, COUNTS, part) |
                             duite_split(rt, part[0], 2, HALVES, part);
            tap_case(!code && duite_stop(&rt) == DUITE_E_NOT_FREED, "parts that are left are told");
        }
    return tap_done();
}
