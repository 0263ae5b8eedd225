/* Bodies and answers alone: the callers, ours and rivals, bring the tasks. */
#include "bench/problem.h"

#include <stdlib.h>
#include <string.h>

uint64_t problem_start(uint64_t i)
{
    return (i + 1) * 0x9e3779b97f4a7c15U;
}

void problem_combine(const uint64_t *left, const uint64_t *middle, const uint64_t *right,
                     uint64_t *out)
{
    uint64_t x = *middle * 0xbf58476d1ce4e5b9U + 3 * *left + 5 * *right + 1;
    *out = x ^ (x >> 29);
}

void problem_nothing(const uint64_t *left, const uint64_t *middle, const uint64_t *right,
                     uint64_t *out)
{
    (void)left;
    (void)middle;
    (void)right;
    (void)out;
}

void problem_sweep(struct problem_cell *const field[2], size_t points, size_t steps,
                   problem_point *const volatile *body)
{
    for (size_t s = 0; s < steps; s++) {
        const struct problem_cell *old = field[s % 2];
        struct problem_cell *new = field[1 - s % 2];
        for (size_t i = 0; i < points; i++)
            (*body)(&old[i ? i - 1 : points - 1].value, &old[i].value,
                    &old[i + 1 < points ? i + 1 : 0].value, &new[i].value);
    }
}

int problem_fields(struct problem_cell *field[2], size_t points)
{
    field[0] = aligned_alloc(64, 2 * points * sizeof *field[0]);
    if (!field[0])
        return 1;
    memset(field[0], 0, 2 * points * sizeof *field[0]);
    field[1] = field[0] + points;
    for (size_t i = 0; i < points; i++)
        field[0][i].value = problem_start(i);
    return 0;
}

int problem_stencil_wrong(const struct problem_cell *got, size_t points, size_t steps)
{
    static problem_point *const volatile body = problem_combine;
    struct problem_cell *field[2];
    if (problem_fields(field, points))
        return 1;
    problem_sweep(field, points, steps, &body);
    int wrong = 0;
    for (size_t i = 0; i < points; i++)
        wrong |= got[i].value != field[steps % 2][i].value;
    free(field[0]);
    return wrong;
}

void problem_next(uint64_t *value, uint64_t i)
{
    *value = (*value ^ i % PROBLEM_PERIOD) * 0x94d049bb133111ebU + 1;
}

uint64_t problem_chain(uint64_t n, problem_link *const volatile *body)
{
    uint64_t value = 0;
    for (uint64_t i = 0; i < n; i++)
        (*body)(&value, i);
    return value;
}

void problem_mark(uint64_t *mark, uint64_t i)
{
    mark[i] += i + 1;
}

int problem_marks_wrong(uint64_t *mark, uint64_t n)
{
    int wrong = 0;
    for (uint64_t i = 0; i < n; i++) {
        wrong |= mark[i] != i + 1;
        mark[i] = 0;
    }
    return wrong;
}

static int64_t (*volatile fib)(unsigned n) = problem_fib;

int64_t problem_fib(unsigned n)
{
    return n < 2 ? n : fib(n - 1) + fib(n - 2);
}

uint64_t problem_fib_calls(unsigned n)
{
    uint64_t calls = 1, before = 1; /* of n = 1 and of n = 0 */
    for (unsigned i = 1; i < n; i++) {
        uint64_t next = 1 + calls + before;
        before = calls;
        calls = next;
    }
    return calls;
}

/* ---- The unbalanced tree ---- */

static inline uint32_t rotated(uint32_t x, unsigned by)
{
    return x << by | x >> (32 - by);
}

/* SHA-1 (FIPS 180-4) of a message of at most 13 words. */
static void sha1(const uint32_t *message, size_t words, uint32_t digest[5])
{
    static const uint32_t add[] = {0x5a827999, 0x6ed9eba1, 0x8f1bbcdc, 0xca62c1d6};
    uint32_t w[80] = {0}, h[5] = {0x67452301, 0xefcdab89, 0x98badcfe, 0x10325476, 0xc3d2e1f0};
    uint32_t a = h[0], b = h[1], c = h[2], d = h[3], e = h[4];
    memcpy(w, message, words * sizeof *w);
    w[words] = 0x80000000;
    w[15] = (uint32_t)(32 * words);
    for (size_t t = 16; t < 80; t++)
        w[t] = rotated(w[t - 3] ^ w[t - 8] ^ w[t - 14] ^ w[t - 16], 1);
    for (size_t t = 0; t < 80; t++) {
        const uint32_t choice = (b & c) | (~b & d), parity = b ^ c ^ d;
        const uint32_t majority = (b & c) | (b & d) | (c & d);
        const uint32_t f = t < 20 ? choice : t >= 40 && t < 60 ? majority : parity;
        const uint32_t next = rotated(a, 5) + f + e + w[t] + add[t / 20];
        e = d, d = c, c = rotated(b, 30), b = a, a = next;
    }
    const uint32_t end[5] = {a, b, c, d, e};
    for (size_t i = 0; i < 5; i++)
        digest[i] = h[i] + end[i];
}

struct problem_node problem_tree_root(void)
{
    enum { SEED = 19 };
    const uint32_t message[5] = {0, 0, 0, 0, SEED};
    struct problem_node root = {.depth = 0};
    sha1(message, 5, root.state);
    return root;
}

/* floor(log(1 - u) / log(1 - p)), where u in [0, 1) is random and 1 / p = 1 + the 4 children. */
uint32_t problem_tree_children(const struct problem_node *node, uint32_t levels)
{
    const double q = 1 - 1.0 / 5, rest = 1 - (node->state[4] & 0x7fffffff) / 2147483648.0;
    uint32_t n = 0;
    if (node->depth >= levels)
        return 0;
    for (double power = q; power >= rest; power *= q)
        n++;
    return n;
}

struct problem_node problem_tree_child(const struct problem_node *node, uint32_t place)
{
    uint32_t message[6];
    struct problem_node child = {.depth = node->depth + 1};
    memcpy(message, node->state, sizeof node->state);
    message[5] = place;
    sha1(message, 6, child.state);
    return child;
}

uint64_t problem_tree_nodes(const struct problem_node *node, uint32_t levels)
{
    uint64_t nodes = 1;
    const uint32_t n = problem_tree_children(node, levels);
    for (uint32_t i = 0; i < n; i++) {
        const struct problem_node child = problem_tree_child(node, i);
        nodes += problem_tree_nodes(&child, levels);
    }
    return nodes;
}

int problem_line_point(const struct problem_message *left, const struct problem_message *middle,
                       const struct problem_message *right, struct problem_message *out)
{
    const uint64_t edge = 0;
    if ((left && left->step != middle->step) || (right && right->step != middle->step))
        return 1;
    out->step = middle->step + 1;
    problem_combine(left ? &left->value : &edge, &middle->value, right ? &right->value : &edge,
                    &out->value);
    return 0;
}

int problem_line(struct problem_message *line, size_t points, uint64_t steps)
{
    static problem_line_body *const volatile body = problem_line_point;
    int wrong = 0;
    for (size_t i = 0; i < points; i++)
        line[i] = (struct problem_message){0, problem_start(i)};
    for (uint64_t s = 0; s < steps; s++) {
        const struct problem_message *old = line + s % 2 * points;
        struct problem_message *new = line + (1 - s % 2) * points;
        for (size_t i = 0; i < points; i++)
            wrong |=
                body(i ? &old[i - 1] : NULL, &old[i], i + 1 < points ? &old[i + 1] : NULL, &new[i]);
    }
    return wrong;
}
