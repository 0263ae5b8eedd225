/* Blocks: each used vertex has one place, no block is empty, sizes are even, neighbours are near,
 * and nothing but the graph and the grain counts. */
#include "cloth/mesh/blocks.h"
#include "cloth/mesh/detail/graph.h"
#include "cloth/mesh/lattice.h"
#include "tests/cloth/mesh/tools.h"

#include <math.h>
#include <stdlib.h>

struct graph {
    uint32_t n_vertices;
    unsigned char *used;
    size_t n_pairs;
    uint32_t *pairs;
};

static struct graph graph_new(uint32_t n_vertices, size_t n_pairs)
{
    struct graph graph = {n_vertices, malloc(n_vertices + 1), n_pairs,
                          malloc((2 * n_pairs + 1) * sizeof(uint32_t))};
    memset(graph.used, 1, n_vertices + 1);
    return graph;
}

static void graph_free(struct graph *graph)
{
    free(graph->used);
    free(graph->pairs);
}

/* The springs of a grid, and `more` vertices that nothing joins. */
static struct graph sheet(uint32_t nx, uint32_t ny, uint32_t more)
{
    struct mesh mesh = grid(1, 1, nx, ny);
    struct mesh_moduli moduli = {1, 1, 1, 1, 0, NULL, 0};
    struct mesh_lattice lattice;
    ck_assert_int_eq(mesh_lattice_build(&lattice, &mesh, &moduli, NULL), CLOTH_OK);
    struct graph graph = graph_new(mesh.n_vertices + more, lattice.n);
    struct mesh_spring *spring = springs_of(&lattice);
    for (size_t s = 0; s < lattice.n; s++) {
        graph.pairs[2 * s] = spring[s].a;
        graph.pairs[2 * s + 1] = spring[s].b;
    }
    free(spring);
    mesh_lattice_free(&lattice);
    mesh_free(&mesh);
    return graph;
}

/* Cuts and checks what is promised of every cut. *smallest, *largest: vertices of a block. */
static struct mesh_blocks cut(const struct graph *graph, uint32_t grain, uint32_t *smallest,
                              uint32_t *largest)
{
    struct mesh_blocks blocks;
    UNIT_FINE(cut_list(&blocks, graph->n_vertices, graph->used, graph->n_pairs, graph->pairs, grain,
                       &error));
    uint32_t n = 0, without = 0;
    for (uint32_t v = 0; v < graph->n_vertices; v++)
        n += graph->used[v] != 0;
    ck_assert_uint_eq(blocks.n_vertices, graph->n_vertices);
    ck_assert_uint_eq(blocks.n_places, n);
    ck_assert_uint_eq(blocks.start[0], 0);
    ck_assert_uint_eq(blocks.start[blocks.n_blocks], n);
    *smallest = UINT32_MAX;
    *largest = 0;
    for (uint32_t b = 0; b < blocks.n_blocks; b++) {
        ck_assert_uint_lt(blocks.start[b], blocks.start[b + 1]);
        uint32_t size = blocks.start[b + 1] - blocks.start[b];
        *smallest = size < *smallest ? size : *smallest;
        *largest = size > *largest ? size : *largest;
    }
    for (uint32_t v = 0; v < graph->n_vertices; v++) {
        uint32_t place = blocks.place[v];
        without += place == MESH_NO_PLACE;
        ck_assert((place == MESH_NO_PLACE) == !graph->used[v]);
        ck_assert(place == MESH_NO_PLACE || (place < n && blocks.vertex[place] == v));
    }
    ck_assert_uint_eq(without, graph->n_vertices - n);
    return blocks;
}

static uint32_t block_of(const struct mesh_blocks *blocks, uint32_t vertex)
{
    uint32_t b = 0;
    while (blocks->start[b + 1] <= blocks->place[vertex])
        b++;
    return b;
}

static uint32_t n_cut(const struct mesh_blocks *blocks, const struct graph *graph)
{
    uint32_t n = 0;
    for (size_t i = 0; i < graph->n_pairs; i++)
        n += block_of(blocks, graph->pairs[2 * i]) != block_of(blocks, graph->pairs[2 * i + 1]);
    return n;
}

/* As many as the grain asks for; from 16 on a multiple of four, where there is a vertex for each.
 */
UNIT_TEST(number_of_blocks)
{
    static const uint32_t wanted[][3] = {
        /* vertices, grain, blocks */
        {1, 1, 1},     {150, 10, 15}, {151, 10, 16}, {161, 10, 16},  {170, 10, 16},   {171, 10, 20},
        {190, 10, 20}, {201, 10, 20}, {211, 10, 24}, {17, 1, 16},    {18, 1, 18},     {19, 1, 19},
        {23, 1, 23},   {24, 1, 24},   {101, 50, 3},  {999, 1000, 1}, {22500, 250, 92}};
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
        UNIT_OWNED(graph_free) struct graph graph = graph_new(wanted[i][0], 0);
        uint32_t smallest, largest;
        UNIT_OWNED(mesh_blocks_free)
        struct mesh_blocks blocks = cut(&graph, wanted[i][1], &smallest, &largest);
        ck_assert_msg(blocks.n_blocks == wanted[i][2], "%u blocks of %u vertices by %u",
                      blocks.n_blocks, wanted[i][0], wanted[i][1]);
    }
}

UNIT_TEST(balance_of_the_sheet)
{
    const uint32_t grains[] = {1000, 500, 250};
    UNIT_OWNED(graph_free) struct graph graph = sheet(150, 150, 0);
    for (size_t i = 0; i < 3; i++) {
        uint32_t smallest, largest;
        UNIT_OWNED(mesh_blocks_free)
        struct mesh_blocks blocks = cut(&graph, grains[i], &smallest, &largest);
        double mean = 22500.0 / blocks.n_blocks;
        ck_assert_double_lt(largest, 1.02 * mean);
        ck_assert_double_gt(smallest, 0.98 * mean);
        /* compact: about 8 springs of a vertex row leave a square's side, here with half as much
         * again */
        double sides = 2 * 150 * sqrt(blocks.n_blocks);
        ck_assert_double_lt(n_cut(&blocks, &graph), 1.5 * 5 * sides);
    }
}

UNIT_TEST(near_numbers_are_near)
{
    uint32_t smallest, largest;
    UNIT_OWNED(graph_free) struct graph graph = sheet(64, 64, 0);
    UNIT_OWNED(mesh_blocks_free) struct mesh_blocks blocks = cut(&graph, 64, &smallest, &largest);
    uint32_t crossing = 0;
    for (size_t i = 0; i < graph.n_pairs; i++) /* between the two halves of the numbers */
        crossing += (blocks.place[graph.pairs[2 * i]] < 2048) !=
                    (blocks.place[graph.pairs[2 * i + 1]] < 2048);
    ck_assert_uint_lt(crossing, 64 * 5 * 3 / 2);
}

UNIT_TEST(every_grain)
{
    UNIT_OWNED(graph_free) struct graph graph = sheet(23, 17, 0);
    uint32_t smallest, largest;
    for (uint32_t grain = 1; grain < 450; grain = grain < 30 ? grain + 1 : grain * 5 / 4) {
        UNIT_OWNED(mesh_blocks_free)
        struct mesh_blocks blocks = cut(&graph, grain, &smallest, &largest);
        ck_assert(grain > 1 || largest == 1);
        ck_assert_uint_le(largest, 2 * grain + 2);
    }
    UNIT_OWNED(mesh_blocks_free)
    struct mesh_blocks blocks = cut(&graph, UINT32_MAX, &smallest, &largest);
    ck_assert_uint_eq(blocks.n_blocks, 1);
}

UNIT_TEST(same_every_time)
{
    UNIT_OWNED(graph_free) struct graph graph = sheet(40, 40, 0);
    const uint32_t grains[] = {1, 7, 100, 1600};
    for (size_t g = 0; g < 4; g++) {
        uint32_t smallest, largest;
        UNIT_OWNED(mesh_blocks_free)
        struct mesh_blocks first = cut(&graph, grains[g], &smallest, &largest);
        srand(12345 + (unsigned)g); /* METIS draws from the same numbers */
        (void)rand();
        UNIT_OWNED(mesh_blocks_free)
        struct mesh_blocks again = cut(&graph, grains[g], &smallest, &largest);
        ck_assert(first.hash == again.hash);
        mesh_blocks_free(&again);
        /* the order of pairs, their direction and repeats do not matter, nor loops */
        UNIT_OWNED(graph_free) struct graph other = graph_new(1600, 2 * graph.n_pairs + 1);
        for (size_t i = 0; i < graph.n_pairs; i++) {
            const uint32_t *pair = graph.pairs + 2 * (graph.n_pairs - 1 - i);
            uint32_t *to = other.pairs + 4 * i;
            to[0] = to[3] = pair[1];
            to[1] = to[2] = pair[0];
        }
        other.pairs[4 * graph.n_pairs] = other.pairs[4 * graph.n_pairs + 1] = 5;
        again = cut(&other, grains[g], &smallest, &largest);
        ck_assert(first.hash == again.hash);
    }
}

UNIT_TEST(halves_of_a_chain)
{
    UNIT_OWNED(graph_free) struct graph graph = graph_new(100, 99);
    for (uint32_t i = 0; i < 99; i++) { /* 37 and 100 share no factor: a chain in a wild order */
        graph.pairs[2 * i] = i * 37 % 100;
        graph.pairs[2 * i + 1] = (i + 1) * 37 % 100;
    }
    uint32_t smallest, largest;
    UNIT_OWNED(mesh_blocks_free) struct mesh_blocks blocks = cut(&graph, 50, &smallest, &largest);
    ck_assert_uint_eq(smallest, 50);
    ck_assert_uint_eq(n_cut(&blocks, &graph), 1); /* both halves in one piece */
    mesh_blocks_free(&blocks);
    blocks = cut(&graph, 100, &smallest, &largest); /* in one block, the order finds the chain */
    for (uint32_t i = 0; i < 99; i++)
        ck_assert_int_eq(
            abs((int)blocks.place[graph.pairs[2 * i]] - (int)blocks.place[graph.pairs[2 * i + 1]]),
            1);
}

/* Reverse Cuthill-McKee of a 3 x 30 grid with diagonals and bends knows to walk along it: no pair
 * is farther apart than three levels of three. Two components follow each other by their lowest
 * vertex, each turned round by itself. */
UNIT_TEST(order_inside_a_block)
{
    struct graph graph = sheet(30, 3, 0);
    uint32_t smallest, largest;
    UNIT_OWNED(mesh_blocks_free) struct mesh_blocks blocks = cut(&graph, 90, &smallest, &largest);
    for (size_t i = 0; i < graph.n_pairs; i++)
        ck_assert_int_lt(
            abs((int)blocks.place[graph.pairs[2 * i]] - (int)blocks.place[graph.pairs[2 * i + 1]]),
            12);
    mesh_blocks_free(&blocks);
    graph_free(&graph);

    struct graph two = graph_new(7, 4); /* 1 - 4 - 6 and 0 - 5 - 3, 2 alone */
    const uint32_t pairs[] = {4, 1, 4, 6, 5, 0, 3, 5};
    memcpy(two.pairs, pairs, sizeof pairs);
    blocks = cut(&two, 7, &smallest, &largest);
    /* from 0 the far end is 3; the walk from there is no longer, so it stays, and is turned round
     */
    const uint32_t expected[] = {0, 5, 3, 1, 4, 6, 2};
    ck_assert_mem_eq(blocks.vertex, expected, sizeof expected);
    /* XXH64 of 1, 0, 7, 0, 5, 3, 1, 4, 6, 2, by another program */
    ck_assert(blocks.hash == 0xe99b11f3fa1e0339);
    mesh_blocks_free(&blocks);
    graph_free(&two);

    struct graph tree =
        graph_new(6, 5); /* the walk from 4 meets 2, then 5 before 3, which has more neighbours */
    const uint32_t branches[] = {0, 3, 3, 1, 3, 2, 2, 4, 2, 5}, turned[] = {1, 0, 3, 5, 2, 4};
    memcpy(tree.pairs, branches, sizeof branches);
    blocks = cut(&tree, 6, &smallest, &largest);
    ck_assert_mem_eq(blocks.vertex, turned, sizeof turned);
    graph_free(&tree);
}

UNIT_TEST(free_particles)
{
    UNIT_OWNED(graph_free) struct graph graph = graph_new(103, 0);
    uint32_t smallest, largest;
    UNIT_OWNED(mesh_blocks_free) struct mesh_blocks blocks = cut(&graph, 10, &smallest, &largest);
    ck_assert_uint_ge(smallest, 9);
    ck_assert_uint_le(largest, 10);
    for (uint32_t v = 0; v < 103; v++)
        ck_assert_uint_eq(blocks.vertex[v], v);
}

UNIT_TEST(isolated_vertices)
{
    const uint32_t more[] = {1, 50, 1000, 20000}, grains[] = {1, 3, 10, 100, 1000};
    for (size_t m = 0; m < 4; m++) {
        UNIT_OWNED(graph_free) struct graph graph = sheet(8, 8, more[m]);
        for (size_t g = 0; g < 5; g++) {
            uint32_t smallest, largest;
            UNIT_OWNED(mesh_blocks_free)
            struct mesh_blocks blocks = cut(&graph, grains[g], &smallest, &largest);
            ck_assert_uint_le(largest, 2 * grains[g] + 2);
        }
    }
}

UNIT_TEST(unused_vertices)
{
    UNIT_OWNED(graph_free) struct graph graph = sheet(10, 10, 30);
    uint32_t smallest, largest;
    memset(graph.used + 100, 0, 30);
    UNIT_OWNED(mesh_blocks_free) struct mesh_blocks blocks = cut(&graph, 25, &smallest, &largest);
    ck_assert_uint_eq(blocks.n_blocks, 4);
    mesh_blocks_free(&blocks);
    graph.n_pairs = 0;
    memset(graph.used, 0, 130);
    blocks = cut(&graph, 25, &smallest, &largest);
    ck_assert_uint_eq(blocks.n_blocks, 0);
    mesh_blocks_free(&blocks);
    graph.n_vertices = 0;
    blocks = cut(&graph, 1, &smallest, &largest);
    mesh_blocks_free(&blocks);
}

UNIT_TEST(wrong_input)
{
    UNIT_OWNED(graph_free) struct graph graph = sheet(3, 3, 0);
    struct mesh_blocks blocks;
    UNIT_REFUSED(cut_list(&blocks, 9, graph.used, graph.n_pairs, graph.pairs, 0, &error),
                 CLOTH_E_INPUT, "at least 1");
    graph.used[4] = 0;
    UNIT_REFUSED(cut_list(&blocks, 9, graph.used, graph.n_pairs, graph.pairs, 3, &error),
                 CLOTH_E_INPUT, "vertex 4");
    graph.used[4] = 1;
    ck_assert_int_eq(cut_list(&blocks, 8, graph.used, graph.n_pairs, graph.pairs, 3, NULL),
                     CLOTH_E_INPUT);
    ck_assert(!blocks.start && !blocks.vertex && !blocks.place);
}

UNIT_TEST(pieces_of_full_parts)
{
    const struct {
        uint32_t n, size[8], pieces[8];
    } cases[] = {
        {3, {4, 0, 2}, {2, 0, 1}},
        {4, {9, 0, 0, 1}, {3, 0, 0, 1}},
        {6, {3, 0, 0, 1, 2, 0}, {3, 0, 0, 1, 2, 0}},
        {6, {2, 0, 2, 0, 2, 2}, {2, 0, 2, 0, 1, 1}}, /* lower parts first */
        {2, {0, 2}, {0, 2}},
        {8, {30, 0, 0, 0, 0, 0, 0, 1}, {7, 0, 0, 0, 0, 0, 0, 1}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        uint32_t pieces[8];
        mesh_pieces(cases[i].n, cases[i].size, pieces);
        ck_assert_mem_eq(pieces, cases[i].pieces, cases[i].n * sizeof *pieces);
    }
}
