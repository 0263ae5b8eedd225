#ifndef TESTS_CLOTH_FLOW_RANDOM_TIES_H
#define TESTS_CLOTH_FLOW_RANDOM_TIES_H

#include "cloth/flow/run/setup.h"
#include "cloth/flow/run/step.h"
#include "cloth/flow/solver/solve.h"
#include "tests/support/unit.h"

#include <stdlib.h>
#include <string.h>

/* Random ties of some blocks: their list, the records and tables that are made of it, and the dense
 * matrix that they are. For one test program: all stands in variables of the file. */

enum { BLOCKS = 6, ROWS = 40, TIES = 300, ALL = 3 * BLOCKS * ROWS };

static const uint32_t n_rows[BLOCKS] = {7, 40, 1, 12, 33, 20};
static struct flow_tie joints[3];
static struct flow_tie_corners ties[TIES];
static const struct flow_tie_corners *listed[TIES]; /* those, as a list takes them */
static struct flow_tie_list list;
static phys_vec values[3 + TIES], p[BLOCKS][ROWS];
static double diagonal[BLOCKS][ROWS], dense[ALL][ALL];

static struct flow_tie_record record[BLOCKS];
static struct flow_tie_link link[BLOCKS][BLOCKS];
static void *table[BLOCKS];

static inline double draw(void)
{
    return 2.0 * rand() / RAND_MAX - 1;
}

static inline uint32_t below(uint32_t n)
{
    return (uint32_t)rand() % n;
}

/* n corners, some without weight; where they may repeat, some twice. */
static bool repeats;
static inline struct flow_tie_corners draw_corners(uint32_t n)
{
    struct flow_tie_corners tie = {.n = n};
    for (uint32_t k = 0; k < n; k++) {
        tie.block[k] = below(BLOCKS - 1); /* the last one has none */
        tie.row[k] = below(n_rows[tie.block[k]]);
        for (uint32_t l = 0; l < k; l++)
            if (!repeats && tie.block[l] == tie.block[k] && tie.row[l] == tie.row[k]) {
                k--;
                break;
            }
    }
    for (uint32_t k = 0; k < n; k++) {
        tie.weight[k] = below(10) ? draw() : 0;
        tie.held |= (unsigned char)(below(5) ? 0 : 1 << k);
    }
    return tie;
}

static inline const struct flow_tie_corners *corners(uint32_t i)
{
    return i < 3 ? &joints[i].at : ties + (i - 3);
}

static inline bool is_listed(uint32_t i)
{
    return i >= 3 || flow_tie_acts(joints + i, list.tick);
}

static inline uint32_t place(uint32_t block, uint32_t row, int c)
{
    return 3 * (ROWS * block + row) + (uint32_t)c;
}

static inline void add_dense(uint32_t i)
{
    const struct flow_tie_corners *tie = corners(i);
    for (uint32_t k = 0; k < tie->n; k++)
        for (uint32_t l = 0; l < tie->n; l++)
            for (int c = 0; c < 3; c++)
                for (int d = 0; d < 3; d++)
                    dense[place(tie->block[k], tie->row[k], c)]
                         [place(tie->block[l], tie->row[l], d)] +=
                        tie->weight[k] * tie->weight[l] *
                        (values[i][c] * values[i][d] + (c == d ? values[i][3] : 0));
}

static inline void draw_all(unsigned seed)
{
    srand(seed);
    memset(dense, 0, sizeof dense);
    for (uint32_t i = 0; i < 3; i++)
        joints[i] = (struct flow_tie){.at = draw_corners(2), .begin = 10 * i, .end = 10 * i + 15};
    for (uint32_t i = 0; i < TIES; i++) {
        ties[i] = draw_corners(below(SOLVE_TIE_CORNERS + 1));
        listed[i] = ties + i;
    }
    list = (struct flow_tie_list){3, TIES, joints, 12, listed};
    for (uint32_t i = 0; i < 3 + TIES; i++) {
        values[i] = i % 3 ? (phys_vec){draw(), draw(), draw(), 1 + draw()} : (phys_vec){0};
        if (is_listed(i))
            add_dense(i);
    }
    for (uint32_t b = 0; b < BLOCKS; b++)
        for (uint32_t row = 0; row < n_rows[b]; row++) {
            p[b][row] = (phys_vec){draw(), draw(), draw(), 0};
            diagonal[b][row] = 2 + draw();
            for (int c = 0; c < 3; c++)
                dense[place(b, row, c)][place(b, row, c)] += diagonal[b][row];
        }
}

static inline void count_all(void)
{
    uint64_t *scratch = calloc(flow_ties_scratch(3 + TIES), sizeof *scratch);
    ck_assert_ptr_nonnull(scratch);
    for (uint32_t b = 0; b < BLOCKS; b++)
        ck_assert(flow_ties_count(&list, b, scratch, BLOCKS, record + b, link[b]));
    ck_assert(!flow_ties_count(&list, 1, scratch, 3, record + 1, link[1]));
    ck_assert(flow_ties_count(&list, 1, scratch, 4, record + 1, link[1]));
    free(scratch);
}

/* The rows that block b shows before those for `other`. */
static inline uint32_t shown_before(uint32_t b, uint32_t other)
{
    uint32_t rows = 0;
    for (uint32_t i = 0; i < record[b].n_links && link[b][i].block < other; i++)
        rows += link[b][i].rows;
    return rows;
}

static const uint32_t halo[] = {0};

/* Where `also` is a block, it is one of the others, too. */
static inline struct flow_ties_of table_of(uint32_t b, uint32_t also, uint32_t others[][2])
{
    struct flow_ties_of of = {.block = b,
                              .n_rows = n_rows[b],
                              .n_halo = 1,
                              .halo = halo,
                              .list = &list,
                              .room = {record[b].n_ties, record[b].n_shown, BLOCKS}};
    if (record[b].n_ghosts > of.room.rows)
        of.room.rows = record[b].n_ghosts;
    for (uint32_t other = 0; other < BLOCKS; other++) {
        bool has = other == also;
        for (uint32_t i = 0; i < record[b].n_links; i++)
            has = has || link[b][i].block == other;
        if (!has)
            continue;
        others[of.n_others][0] = other;
        others[of.n_others++][1] = shown_before(other, b);
    }
    of.others = (const uint32_t(*)[2])others;
    return of;
}

static inline void make_all(unsigned seed)
{
    draw_all(seed);
    count_all();
    for (uint32_t b = 0; b < BLOCKS; b++) {
        uint32_t others[BLOCKS][2];
        const struct flow_ties_of of = table_of(b, BLOCKS, others);
        const size_t bytes = flow_ties_bytes(of.n_rows, &of.room);
        table[b] = aligned_alloc(64, bytes);
        ck_assert_ptr_nonnull(table[b]);
        memset(table[b], 0xff, bytes);
        ck_assert(flow_ties_make(&of, table[b]));
    }
}

static inline void free_all(void)
{
    for (uint32_t b = 0; b < BLOCKS; b++)
        free(table[b]);
}

#endif
