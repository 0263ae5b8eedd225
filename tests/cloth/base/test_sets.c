#include "cloth/base/sets.h"
#include "tests/support/unit.h"

enum { N = 64 };

/* Pairs (a, b) with a = b modulo 4, in an order without a pattern: then the sets are the four
 * classes of remainders, and their lowest numbers are 0 to 3. */
UNIT_TEST(roots_are_the_lowest_in_any_order)
{
    for (uint32_t step = 1; step < N; step += 2) { /* odd: it visits all pairs */
        uint32_t parent[N];
        cloth_sets_start(parent, N);
        for (uint32_t i = 0; i < N; i++) {
            const uint32_t a = i * step % N;
            cloth_sets_join(parent, a, (a + 4) % N);
        }
        for (uint32_t i = 0; i < N; i++) {
            ck_assert_uint_le(parent[i], i);
            ck_assert_uint_eq(cloth_sets_root(parent, i), i % 4);
        }
    }
}

/* A chain that is joined from its end on is as long as it may get. */
UNIT_TEST(what_is_not_joined_stays_apart)
{
    uint32_t parent[N];
    cloth_sets_start(parent, N);
    for (uint32_t i = N - 1; i > N / 2; i--)
        cloth_sets_join(parent, i, i - 1);
    for (uint32_t i = 0; i < N; i++)
        ck_assert_uint_eq(cloth_sets_root(parent, i), i < N / 2 ? i : N / 2);
}
