#ifndef BENCH_PROBLEM_H
#define BENCH_PROBLEM_H

#include <stddef.h>
#include <stdint.h>

/* The tasks of all benches, one text for us, the sequential twins and the rivals: they compute
 * unsigned integers, so that a wrong order shows in the last bit. All bodies are called through
 * pointers. */

struct problem_cell {
    _Alignas(64) uint64_t value; /* a line of its own */
};

/* A ring of points: each step makes every point from itself and its two neighbours. */
typedef void problem_point(const uint64_t *left, const uint64_t *middle, const uint64_t *right,
                           uint64_t *out);
problem_point problem_combine, problem_nothing;

/* The value that point i starts with, not 0. */
uint64_t problem_start(uint64_t i);

/* The ring, step after step: field[s % 2] is read, the other one written. */
void problem_sweep(struct problem_cell *const field[2], size_t points, size_t steps,
                   problem_point *const volatile *body);

/* Two fields, the first with its start values; NULL without memory. Freed by free(field[0]). */
int problem_fields(struct problem_cell *field[2], size_t points);

/* A sum that tells whether the points are those of the sequential ring: 0 if they are. */
int problem_stencil_wrong(const struct problem_cell *got, size_t points, size_t steps);

/* A chain: one value, changed by n tasks in turn; what the i-th does repeats with a period. */
enum { PROBLEM_PERIOD = 64 };
typedef void problem_link(uint64_t *value, uint64_t i);
problem_link problem_next;
uint64_t problem_chain(uint64_t n, problem_link *const volatile *body);

/* Independent tasks: task i leaves its mark. */
typedef void problem_mark_body(uint64_t *mark, uint64_t i);
problem_mark_body problem_mark;
/* Returns nonzero if a mark is missing or made twice; clears them. */
int problem_marks_wrong(uint64_t *mark, uint64_t n);

/* Fibonacci numbers by the book: a call of n makes one of n - 1 and one of n - 2. */
int64_t problem_fib(unsigned n);
uint64_t problem_fib_calls(unsigned n);

/* An unbalanced tree: T1 of the benchmark UTS (Olivier et al., LCPC 2006), which is geometric with
 * 4 children a node on average, seed 19 and 10 levels below the root, with as many levels as asked
 * for. A node is a state of 20 bytes; each of its children has the SHA-1 of it and of its own place
 * among them. */
struct problem_node {
    uint32_t state[5];
    uint32_t depth;
};
struct problem_node problem_tree_root(void);
/* How many children it has in a tree of so many levels; the child at that place. */
uint32_t problem_tree_children(const struct problem_node *node, uint32_t levels);
struct problem_node problem_tree_child(const struct problem_node *node, uint32_t place);
/* Nodes of the tree below, this one among them. */
uint64_t problem_tree_nodes(const struct problem_node *node, uint32_t levels);

/* A line of points: what a point hands on. Its body checks that its inputs are of the same step. */
struct problem_message {
    uint64_t step, value;
};
/* left or right NULL at the ends. 0; 1 if the inputs are of different steps. */
typedef int problem_line_body(const struct problem_message *left,
                              const struct problem_message *middle,
                              const struct problem_message *right, struct problem_message *out);
problem_line_body problem_line_point;
/* The sequential line; `line` has 2 x points messages, the answer is in the half steps % 2. */
int problem_line(struct problem_message *line, size_t points, uint64_t steps);

#endif
