/* The explorer itself, on programs whose outcomes are known: every outcome that C allows to stores
 * that lag behind is reached, none that it forbids, and each class of orders is run once. */
#include "tests/model/atomics.h"

#include <stdio.h>
#include <string.h>

static struct {
    _Atomic int x, y, z, turn, a_in, b_in;
    pthread_mutex_t mutex;
    pthread_cond_t condition;
    int r[4], count;
    bool ready;
} its;

static unsigned outcomes; /* of all executions: bits numbered by 2 r[0] + r[1] */

static void clear(void)
{
    memset(&its, 0, sizeof its);
}

static void note(void)
{
    outcomes |= 1u << (2 * its.r[0] + its.r[1]);
}

/* ---- Store buffering: 00 without fences ---- */

static void sb_a(void)
{
    atomic_store_explicit(&its.x, 1, memory_order_release);
    atomic_thread_fence(memory_order_seq_cst);
    its.r[0] = atomic_load_explicit(&its.y, memory_order_relaxed);
}

static void sb_b(void)
{
    atomic_store_explicit(&its.y, 1, memory_order_release);
    atomic_thread_fence(memory_order_seq_cst);
    its.r[1] = atomic_load_explicit(&its.x, memory_order_relaxed);
}

static void sb_end(void)
{
    note();
    explore_check(its.r[0] || its.r[1]);
}

/* ---- Message passing: 10 without release ---- */

static void mp_a(void)
{
    atomic_store_explicit(&its.x, 1, memory_order_relaxed);
    atomic_store_explicit(&its.y, 1, memory_order_release);
}

static void mp_b(void)
{
    its.r[0] = atomic_load_explicit(&its.y, memory_order_acquire);
    its.r[1] = atomic_load_explicit(&its.x, memory_order_relaxed);
}

static void mp_end(void)
{
    note();
    explore_check(!its.r[0] || its.r[1]);
}

/* ---- A mutex, a condition ---- */

static void add(void)
{
    pthread_mutex_lock(&its.mutex);
    int now = atomic_load_explicit(&its.z, memory_order_relaxed);
    atomic_store_explicit(&its.z, now + 1, memory_order_relaxed);
    pthread_mutex_unlock(&its.mutex);
}

static void add_end(void)
{
    explore_check(its.z == 3);
}

static void give(void)
{
    pthread_mutex_lock(&its.mutex);
    its.ready = true;
    pthread_cond_signal(&its.condition);
    pthread_mutex_unlock(&its.mutex);
}

static void take(void)
{
    pthread_mutex_lock(&its.mutex);
    while (!its.ready)
        pthread_cond_wait(&its.condition, &its.mutex);
    pthread_mutex_unlock(&its.mutex);
}

/* ---- Peterson's lock: needs a release and a fence ---- */

static void section(_Atomic int *own, _Atomic int *other, int number)
{
    atomic_store_explicit(own, 1, memory_order_relaxed);
    atomic_store_explicit(&its.turn, number, memory_order_release);
    atomic_thread_fence(memory_order_seq_cst);
    if (atomic_load_explicit(other, memory_order_acquire) &&
        atomic_load_explicit(&its.turn, memory_order_acquire) == number)
        return; /* would wait */
    explore_check(its.count++ == 0);
    atomic_fetch_add(&its.z, 1);
    its.count--;
    atomic_store_explicit(own, 0, memory_order_release);
}

static void peterson_a(void)
{
    section(&its.a_in, &its.b_in, 1);
}

static void peterson_b(void)
{
    section(&its.b_in, &its.a_in, 2);
}

/* ---- Three threads that have nothing to do with one another, and three that write one place ----
 */

static void own_x(void)
{
    atomic_fetch_add(&its.x, 1);
    atomic_fetch_add(&its.x, 1);
}

static void own_y(void)
{
    atomic_fetch_add(&its.y, 1);
    atomic_fetch_add(&its.y, 1);
}

static void write_z(void)
{
    atomic_fetch_add(&its.z, 1);
}

/* ---- Random programs: the reduction loses no outcome ---- */

enum { OPERATIONS = 3, PLACES = 2 };

struct operation {
    unsigned kind, place;
};

static struct operation program[3][OPERATIONS];
static _Atomic int place[PLACES];
static int seen[3][OPERATIONS];
static uint64_t random_state, reached[4096]; /* a set, by open addressing; 0: free */
static unsigned n_reached;

static unsigned draw(unsigned below)
{
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return (unsigned)(random_state >> 33) % below;
}

static int operate(struct operation operation, int value)
{
    _Atomic int *object = &place[operation.place];
    int expected = 0;
    switch (operation.kind) {
    case 0:
        return atomic_load_explicit(object, memory_order_acquire);
    case 1:
        atomic_store_explicit(object, value, memory_order_relaxed);
        return 0;
    case 2:
        atomic_store_explicit(object, value, memory_order_release);
        return 0;
    case 3:
        atomic_thread_fence(memory_order_seq_cst);
        return 0;
    case 4:
        return atomic_compare_exchange_strong_explicit(object, &expected, value,
                                                       memory_order_relaxed, memory_order_relaxed);
    default:
        return atomic_fetch_add(object, 10);
    }
}

/* The first thread does three operations, the second two, the third one. */
static void run_program(int thread)
{
    for (int i = 0; i < OPERATIONS - thread; i++)
        seen[thread][i] = operate(program[thread][i], 1 + thread * OPERATIONS + i);
}

static void run_0(void)
{
    run_program(0);
}

static void run_1(void)
{
    run_program(1);
}

static void run_2(void)
{
    run_program(2);
}

static void random_start(void)
{
    memset(place, 0, sizeof place);
    memset(seen, 0, sizeof seen);
}

static void random_end(void)
{
    uint64_t hash = 1469598103934665603u;
    for (int i = 0; i < 3 * OPERATIONS; i++)
        hash = (hash ^ (uint64_t)seen[i / OPERATIONS][i % OPERATIONS]) * 1099511628211u;
    for (int i = 0; i < PLACES; i++)
        hash = (hash ^ (uint64_t)place[i]) * 1099511628211u;
    unsigned at = (unsigned)hash % 4096;
    while (reached[at] && reached[at] != hash)
        at = (at + 1) % 4096;
    n_reached += !reached[at];
    reached[at] = hash;
}

/* How many outcomes the program has. */
static unsigned count_outcomes(const struct explore_case *random, bool every)
{
    struct explore_case small = *random;
    small.every = every;
    explore_run(&small);
    return n_reached;
}

static void random_programs(unsigned programs)
{
    const struct explore_case random = {
        .start = random_start, .thread = {run_0, run_1, run_2}, .end = random_end};
    bool fine = true;
    unsigned max = 0;
    for (unsigned i = 0; i < programs && fine; i++) {
        random_state = i;
        for (int j = 0; j < 3 * OPERATIONS; j++)
            program[j / OPERATIONS][j % OPERATIONS] = (struct operation){draw(6), draw(PLACES)};
        memset(reached, 0, sizeof reached);
        n_reached = 0;
        unsigned reduced = count_outcomes(&random, false);
        fine = count_outcomes(&random, true) == reduced;
        max = reduced > max ? reduced : max;
        if (!fine)
            printf("# program %u: %u outcomes, %u without reduction\n", i, reduced, n_reached);
    }
    printf("# %u random programs of up to %u outcomes\n", programs, max);
    explore_line(fine, "random programs", "the reduction loses no outcome");
}

static const struct explore_case buffering = {
    .name = "store buffering", .start = clear, .thread = {sb_a, sb_b}, .end = sb_end};
static const struct explore_case passing = {
    .name = "message passing", .start = clear, .thread = {mp_a, mp_b}, .end = mp_end};
static const struct explore_case mutex = {
    .name = "mutex", .start = clear, .thread = {add, add, add}, .end = add_end};
static const struct explore_case condition = {
    .name = "condition", .start = clear, .thread = {take, give}};
static const struct explore_case peterson = {
    .name = "Peterson's lock", .start = clear, .thread = {peterson_a, peterson_b}};
static const struct explore_case apart = {
    .name = "nothing in common", .start = clear, .thread = {own_x, own_y}};
static const struct explore_case together = {
    .name = "three writers", .start = clear, .thread = {write_z, write_z, write_z}};

static void has_outcomes(const struct explore_case *small, unsigned expected)
{
    outcomes = 0;
    explore_run(small);
    printf("# outcomes %x\n", outcomes);
    explore_line(outcomes == expected, small->name, "has exactly the outcomes it may have");
}

int main(int argc, char **argv)
{
    explore_begin(argc, argv);
    explore_passes(&buffering);
    has_outcomes(&buffering, 1u << 1 | 1u << 2 | 1u << 3);
    explore_finds(&buffering, (struct explore_plant){"sb_a", "fence", EXPLORE_DROP});
    explore_finds(&buffering, (struct explore_plant){"sb_b", "fence", EXPLORE_DROP});
    explore_passes(&passing);
    has_outcomes(&passing, 1u << 0 | 1u << 1 | 1u << 3);
    explore_finds(&passing, (struct explore_plant){"mp_a", "&its.y", EXPLORE_RELAX});
    explore_passes(&mutex);
    explore_finds(&mutex, (struct explore_plant){"add", "lock", EXPLORE_DROP});
    explore_passes(&condition);
    explore_finds(&condition, (struct explore_plant){"give", "condition", EXPLORE_DROP});
    explore_finds(&condition, (struct explore_plant){"take", "lock", EXPLORE_DROP});
    explore_passes(&peterson);
    explore_finds(&peterson, (struct explore_plant){"section", "fence", EXPLORE_DROP});
    explore_finds(&peterson, (struct explore_plant){"section", "&its.turn", EXPLORE_RELAX});
    explore_passes(&apart);
    explore_passes(&together);
    random_programs(explore_deep() ? 1000 : 25);
    return explore_end();
}
