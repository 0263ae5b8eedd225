/* The containers of runtime/base: the heap gives its entries back in order whatever the order in
 * which they came, sets of ranks keep each rank apart, a stack gives back all that was pushed.
 * (tests/model explores the stack in all orders of its threads, within the queue of tasks.) */
#include "runtime/base/heap.h"
#include "runtime/base/rank_set.h"
#include "runtime/base/stack.h"
#include "tests/support/unit.h"

#include <duite_policy.h>

enum { N = 500, RANKS = 150, WORDS = 3 };

struct entry {
    int key;
    char unused[9]; /* entries of a size that is no power of two */
};

/* By the key's value in *table. */
static bool entry_before(const void *a, const void *b, const void *table)
{
    const int *value = table;
    return value[((const struct entry *)a)->key] < value[((const struct entry *)b)->key];
}

UNIT_LOOP(heap_sorts, 0, 4)
{
    static struct entry heap[N];
    static int value[N];
    uint64_t state = (uint64_t)_i + 1;
    size_t n = 0;
    int out = 0, last = -1;
    for (int i = 0; i < N; i++)
        value[i] = i;
    for (int i = N; i-- > 1;) { /* a random order */
        int k = (int)(duite_random(&state) % (uint64_t)(i + 1)), keep = value[i];
        value[i] = value[k];
        value[k] = keep;
    }
    for (int i = 0; i < N; i++) {
        struct entry entry = {.key = i};
        base_heap_push(heap, n++, &entry, sizeof entry, entry_before, value);
    }
    for (; n; out++) {
        struct entry first;
        base_heap_pop(heap, n--, &first, sizeof first, entry_before, value);
        ck_assert_int_eq(value[first.key], last + 1);
        last = value[first.key];
    }
    ck_assert_int_eq(out, N);
}

/* Pushes between pops: what comes out is the smallest of what is in. */
UNIT_LOOP(heap_mixed, 0, 4)
{
    static struct entry heap[N];
    static int value[N];
    bool in[N] = {false};
    uint64_t state = (uint64_t)_i + 1;
    size_t n = 0;
    for (int i = 0; i < N; i++)
        value[i] = (i * 7919) % N; /* N is no multiple of that prime: all differ */
    for (int i = 0; i < N; i++) {
        struct entry entry = {.key = i}, first;
        base_heap_push(heap, n++, &entry, sizeof entry, entry_before, value);
        in[value[i]] = true;
        while (n && duite_random(&state) % 2) {
            base_heap_pop(heap, n--, &first, sizeof first, entry_before, value);
            int smallest = 0;
            while (!in[smallest])
                smallest++;
            ck_assert_int_eq(value[first.key], smallest);
            in[smallest] = false;
        }
    }
}

UNIT_TEST(ranks_apart)
{
    uint64_t a[WORDS] = {0}, b[WORDS] = {0};
    ck_assert_uint_eq(base_ranks_words(RANKS), WORDS);
    ck_assert_uint_eq(base_ranks_words(64), 1);
    ck_assert_uint_eq(base_ranks_words(65), 2);
    for (int rank = 0; rank < RANKS; rank += 7)
        base_ranks_add(a, rank);
    for (int rank = 0; rank < RANKS; rank++)
        ck_assert(base_ranks_has(a, rank) == (rank % 7 == 0));
    ck_assert(base_ranks_is_empty(b, WORDS) && !base_ranks_is_empty(a, WORDS));
    ck_assert(base_ranks_within(b, a, WORDS) && !base_ranks_within(a, b, WORDS));
    ck_assert(base_ranks_join(b, a, WORDS) && !base_ranks_join(b, a, WORDS));
    ck_assert(base_ranks_within(a, b, WORDS));
    base_ranks_remove(b, 147);
    ck_assert(!base_ranks_has(b, 147) && base_ranks_has(b, 140));
    ck_assert(!base_ranks_within(a, b, WORDS) && base_ranks_within(b, a, WORDS));
    base_ranks_clear(b, WORDS);
    ck_assert(base_ranks_is_empty(b, WORDS));
}

struct node {
    struct node *next;
};

UNIT_TEST(stack_returns_all)
{
    static struct node nodes[N];
    _Atomic(struct node *) stack = NULL;
    ck_assert(BASE_STACK_IS_EMPTY(&stack));
    for (int i = 0; i < N; i++)
        BASE_STACK_PUSH(&stack, &nodes[i], memory_order_release);
    ck_assert(!BASE_STACK_IS_EMPTY(&stack));
    struct node *list = BASE_STACK_TAKE(&stack);
    ck_assert(BASE_STACK_IS_EMPTY(&stack));
    ck_assert_ptr_eq(list, &nodes[N - 1]);
    BASE_LIST_REVERSE(list);
    for (int i = 0; i < N; i++, list = list->next)
        ck_assert_ptr_eq(list, &nodes[i]);
    ck_assert_ptr_null(list);
}
