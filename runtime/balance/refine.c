/* Loads are seconds a worker; a move keeps them up to date. Each move lowers the sum of their
 * squares, so the moves come to an end. After Fiduccia & Mattheyses (DAC 1982), with balance first
 * and the cut second, since the first homes have a small cut already. */
#include "runtime/balance/refine.h"

#include "runtime/base/memory.h"

#include <stdlib.h>
#include <string.h>

#define GOAL    1.01  /* balanced enough: the largest load over the mean */
#define WORTH   0.002 /* of the mean: moves that relieve a rank by less are not made */
#define MAX_OPS 1e8   /* about so many pairs of a block and a rank are looked at */

struct parts {
    const duite_blocks *blocks;
    int *present, *home;
    double *load;    /* a rank */
    double *towards; /* a rank: bytes of one block's edges; zero in between */
    double even, periods, ops;
};

static double load_share(const duite_blocks *blocks, size_t block, int rank)
{
    return blocks->graph.weight[block] / blocks->workers[rank];
}

/* Returns the mean. */
static double load_add_up(const duite_blocks *blocks, const int *home, double *load)
{
    double sum = 0, workers = 0;
    for (int r = 0; r < blocks->n_ranks; r++) {
        load[r] = blocks->other[r] / blocks->workers[r];
        sum += blocks->other[r];
        workers += blocks->workers[r];
    }
    for (size_t i = 0; i < blocks->graph.n; i++) {
        load[home[i]] += load_share(blocks, i, home[i]);
        sum += blocks->graph.weight[i];
    }
    return sum / workers;
}

static int load_heaviest(const struct parts *parts)
{
    int max = 0;
    for (int r = 1; r < parts->blocks->n_ranks; r++)
        if (parts->load[r] > parts->load[max])
            max = r;
    return max;
}

bool balance_bill(const duite_blocks *blocks, const int *present, const int *home,
                  struct balance_bill *bill)
{
    const duite_object_graph *graph = &blocks->graph;
    double *load = base_alloc((size_t)blocks->n_ranks * sizeof *load), cut = 0, moved = 0;
    if (!load)
        return false;
    *bill = (struct balance_bill){.even = load_add_up(blocks, home, load)};
    for (int r = 0; r < blocks->n_ranks; r++)
        bill->max = load[r] > bill->max ? load[r] : bill->max;
    for (size_t i = 0; i < graph->n; i++) {
        moved += home[i] != present[i] ? (double)blocks->bytes[i] : 0;
        for (size_t e = graph->start[i]; e < graph->start[i + 1]; e++)
            cut += home[i] != home[graph->neighbour[e]] ? graph->edge_weight[e] : 0;
    }
    bill->cut = cut * blocks->byte_seconds / blocks->n_ranks; /* each edge is there twice */
    bill->move = moved * blocks->byte_seconds;
    base_free(load);
    return true;
}

/* The fall of the larger of two ranks' loads if the block moves from one to the other. */
static double move_relief(const struct parts *parts, size_t block, int from, int to)
{
    double left = parts->load[from] - load_share(parts->blocks, block, from);
    double there = parts->load[to] + load_share(parts->blocks, block, to);
    return parts->load[from] - (left > there ? left : there);
}

/* True if a move saves more time than sending the block takes. */
static bool move_pays(const struct parts *parts, size_t block, double relief)
{
    bool moved = parts->home[block] != parts->present[block];
    double way = moved ? 0 : (double)parts->blocks->bytes[block] * parts->blocks->byte_seconds;
    return relief > WORTH * parts->even && relief * parts->periods > way;
}

struct move {
    size_t block;
    int to;
    double relief, gain; /* gain: bytes of cut */
};

static bool move_is_allowed(const struct parts *parts, size_t block, int from)
{
    return parts->home[block] == from && !parts->blocks->fixed[block] &&
           parts->blocks->graph.weight[block] > 0;
}

/* The largest relief that one move brings to a rank. */
static double move_best_relief(struct parts *parts, int from)
{
    double best = 0;
    for (size_t i = 0; i < parts->blocks->graph.n; i++) {
        if (!move_is_allowed(parts, i, from))
            continue;
        for (int to = 0; to < parts->blocks->n_ranks; to++) {
            double brings = to == from ? 0 : move_relief(parts, i, from, to);
            if (brings > best && move_pays(parts, i, brings))
                best = brings;
        }
    }
    return best;
}

/* Fills `towards` for a block, or clears it. */
static void move_add_edges(struct parts *parts, size_t block, bool clear)
{
    const duite_object_graph *graph = &parts->blocks->graph;
    for (size_t e = graph->start[block]; e < graph->start[block + 1]; e++) {
        double *towards = &parts->towards[parts->home[graph->neighbour[e]]];
        *towards = clear ? 0 : *towards + graph->edge_weight[e];
    }
}

/* Finds the move with the least cut whose relief is at least `least`; of equals the one with more
 * relief, then the first. */
static bool move_choose(struct parts *parts, int from, double least, struct move *best)
{
    bool found = false;
    for (size_t i = 0; i < parts->blocks->graph.n; i++) {
        if (!move_is_allowed(parts, i, from))
            continue;
        move_add_edges(parts, i, false);
        for (int to = 0; to < parts->blocks->n_ranks; to++) {
            struct move move = {i, to, to == from ? 0 : move_relief(parts, i, from, to),
                                parts->towards[to] - parts->towards[from]};
            bool better = !found || move.gain > best->gain ||
                          (move.gain == best->gain && move.relief > best->relief);
            if (move.relief < least || !better || !move_pays(parts, i, move.relief))
                continue;
            *best = move;
            found = true;
        }
        move_add_edges(parts, i, true);
    }
    return found;
}

static void moves_make(struct parts *parts)
{
    const duite_blocks *blocks = parts->blocks;
    double pass = 2.0 * ((double)blocks->graph.n * (1 + 0.5 * blocks->n_ranks));
    while (parts->ops < MAX_OPS) {
        struct move move;
        int from = load_heaviest(parts);
        double best = parts->load[from] > GOAL * parts->even ? move_best_relief(parts, from) : 0;
        parts->ops += pass;
        if (best <= 0 || !move_choose(parts, from, best / 2, &move))
            return;
        parts->home[move.block] = move.to;
        parts->load[from] -= load_share(blocks, move.block, from);
        parts->load[move.to] += load_share(blocks, move.block, move.to);
    }
}

bool balance_refine(const duite_blocks *blocks, double periods, int *home)
{
    size_t n = blocks->graph.n, ranks = (size_t)blocks->n_ranks;
    struct parts parts = {.blocks = blocks, .home = home, .periods = periods};
    const struct base_array arrays[] = {BASE_ARRAY(parts.present, n),
                                        BASE_ARRAY(parts.load, ranks),
                                        BASE_ZEROS(parts.towards, ranks),
                                        {0}};
    void *memory = base_arrays(arrays);
    if (memory) {
        memcpy(parts.present, home, n * sizeof *home);
        parts.even = load_add_up(blocks, home, parts.load);
        moves_make(&parts);
    }
    base_free(memory);
    return memory;
}

/* ---- Anew ---- */

/* The bytes of a part that live on a rank. */
struct overlap {
    double bytes;
    int part, rank;
};

static int overlap_compare(const void *a, const void *b)
{
    const struct overlap *x = a, *y = b;
    if (x->bytes != y->bytes)
        return x->bytes > y->bytes ? -1 : 1;
    if (x->part != y->part)
        return x->part < y->part ? -1 : 1;
    return x->rank < y->rank ? -1 : x->rank > y->rank;
}

/* Gives each part the name of a rank, in the order of the bytes that they share. */
static void parts_name(struct overlap *overlap, int n_ranks, int *rank_of)
{
    size_t n = (size_t)n_ranks, pairs = n * n;
    qsort(overlap, pairs, sizeof *overlap, overlap_compare);
    for (size_t i = 0; i < 2 * n; i++)
        rank_of[i] = -1; /* from n on: by rank, the part that has its name */
    for (size_t i = 0; i < pairs; i++) {
        int part = overlap[i].part, rank = overlap[i].rank;
        if (rank_of[part] >= 0 || rank_of[n + (size_t)rank] >= 0)
            continue;
        rank_of[part] = rank;
        rank_of[n + (size_t)rank] = part;
    }
}

static bool parts_rename(const duite_blocks *blocks, const int *home, int *part)
{
    size_t n = (size_t)blocks->n_ranks;
    struct overlap *overlap = base_alloc(n * n * sizeof *overlap);
    int *rank_of = base_alloc(2 * n * sizeof *rank_of);
    bool fine = overlap && rank_of;
    for (size_t i = 0; i < n * n && fine; i++)
        overlap[i] = (struct overlap){0, (int)(i / n), (int)(i % n)};
    for (size_t i = 0; i < blocks->graph.n && fine; i++)
        overlap[(size_t)part[i] * n + (size_t)home[i]].bytes += 1 + (double)blocks->bytes[i];
    if (fine) {
        parts_name(overlap, blocks->n_ranks, rank_of);
        for (size_t i = 0; i < blocks->graph.n; i++)
            part[i] = blocks->fixed[i] ? home[i] : rank_of[part[i]];
    }
    base_free(overlap);
    base_free(rank_of);
    return fine;
}

bool balance_anew(const duite_blocks *blocks, double periods, int *home)
{
    size_t n = blocks->graph.n;
    int *part = base_alloc(n * sizeof *part + 1);
    bool fine = part && !blocks->mapping->map(&blocks->graph, blocks->n_ranks, blocks->seed, part);
    for (size_t i = 0; i < n && fine; i++)
        fine = part[i] >= 0 && part[i] < blocks->n_ranks;
    fine = fine && parts_rename(blocks, home, part) && balance_refine(blocks, periods, part);
    if (fine)
        memcpy(home, part, n * sizeof *home);
    base_free(part);
    return fine;
}
