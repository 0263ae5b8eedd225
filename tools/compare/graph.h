#ifndef DUITE_TOOLS_COMPARE_GRAPH_H
#define DUITE_TOOLS_COMPARE_GRAPH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A graph of tasks to be scheduled without an application: task i works for cost[i] seconds, writes
 * an object of its own of bytes[i], and reads those of the tasks in its row, all before it. */
struct compare_graph {
    size_t n, n_reads;
    double *cost;
    uint32_t *bytes;
    size_t *start; /* n + 1 */
    uint32_t *from;
    uint32_t *place; /* <= i, or COMPARE_NO_PLACE: tasks of one place stay on one rank */
    size_t capacity, reads_capacity;
};

#define COMPARE_NO_PLACE UINT32_MAX

/* The most that a task reads. */
size_t compare_graph_most_reads(const struct compare_graph *graph);

/* Fills an empty graph of one of these kinds with about n tasks that cost `cost` seconds on average
 * and write `bytes` each:
 *   stencil    as many rows as tasks in each, or rows of WIDTH tasks (stencil:WIDTH, and the three
 *              below); each task reads its three neighbours of the row before
 *   nearest    likewise, its five
 *   fft        likewise, itself and those at a distance of 1, 2, 4, ..., the next in each row
 *   spread     likewise, five all over the row, and others in the next
 *   tree       a reduction by twos
 *   cholesky   of tiles: potrf, trsm, syrk, gemm, of 1/3, 1, 1 and 2 units of work
 *   random     each task reads up to three random ones among the last few rows
 *   irregular  likewise up to five, and costs are spread over two decades
 *   chain      one long chain beside short tasks: a graph made for `priority`
 * 1, said on stderr, without memory or for another kind. */
int compare_graph_make(struct compare_graph *graph, const char *kind, size_t n, double cost,
                       uint32_t bytes, uint64_t seed);
#define COMPARE_GRAPH_KINDS                                                                        \
    "stencil, nearest, fft, spread, tree, cholesky, random, irregular, chain"

/* A name on a command line is a file's if it has a . or / in it, else a kind's. NULL if it can be
 * used, else the reason, written to text. */
bool compare_graph_is_file(const char *what);
const char *compare_graph_wrong(const char *what, char *text, size_t size);

/* Files: a line "duite-graph 1", then one a task: cost, bytes, number of reads, the tasks read,
 * from 0; at its end maybe @ and its place, numbered from 0 as they come; # begins a comment. 1,
 * said on stderr with the line, if it cannot be read or written. */
int compare_graph_read(struct compare_graph *graph, const char *file);
int compare_graph_write(const struct compare_graph *graph, const char *file);

void compare_graph_free(struct compare_graph *graph);

#endif
