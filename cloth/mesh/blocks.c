/* Nodes are the used vertices by rising number; parts hold nodes, blocks are the parts in order.
 * Every step has one outcome, so that a scene has the same blocks wherever it is cut. */
#include "cloth/mesh/blocks.h"

#include "cloth/base/memory.h"
#include "cloth/mesh/detail/graph.h"

#include <endian.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

struct cutter {
    struct cloth_error *error;
    struct mesh_blocks *blocks; /* until set_places: place[] is the node of a vertex */
    struct mesh_graph graph;
    struct mesh_order order;
    uint32_t *part;  /* of each node */
    uint32_t *nodes; /* part after part: those of part p are nodes[start[p] ..] */
    struct cloth_pool memory;
};

/* Many blocks are a multiple of four, so that two or four workers have as many each: the others
 * would wait for one block more. */
static uint32_t count_blocks(uint32_t n, uint32_t grain)
{
    const uint32_t blocks = n / grain + (n % grain ? 1 : 0);
    const uint64_t even = ((uint64_t)blocks + 2) / 4 * 4;
    return blocks < MESH_MANY_BLOCKS || even > n ? blocks : (uint32_t)even;
}

static int number_nodes(struct cutter *cutter, uint32_t n_vertices, const unsigned char *used,
                        uint32_t grain)
{
    struct mesh_blocks *blocks = cutter->blocks;
    blocks->n_vertices = n_vertices;
    for (uint32_t v = 0; v < n_vertices; v++)
        blocks->n_places += used[v] ? 1 : 0;
    uint32_t n = blocks->n_places;
    blocks->n_blocks = count_blocks(n, grain);
    blocks->start = cloth_alloc((size_t)blocks->n_blocks + 2, sizeof(uint32_t), cutter->error);
    blocks->vertex = cloth_alloc(n, sizeof(uint32_t), cutter->error);
    blocks->place = cloth_alloc(n_vertices, sizeof(uint32_t), cutter->error);
    cutter->part = cloth_take(&cutter->memory, n, sizeof(uint32_t), cutter->error);
    cutter->nodes = cloth_take(&cutter->memory, n, sizeof(uint32_t), cutter->error);
    if (!blocks->start || !blocks->vertex || !blocks->place || cutter->memory.lacks)
        return CLOTH_E_MEMORY;
    for (uint32_t v = 0, node = 0; v < n_vertices; v++) {
        blocks->place[v] = used[v] ? node : MESH_NO_PLACE;
        node += used[v] ? 1 : 0;
    }
    return CLOTH_OK;
}

/* Brings the nodes of each part together, by rising number, from start[] on. True if every part has
 * a node. */
static bool blocks_group(struct cutter *cutter)
{
    struct mesh_blocks *blocks = cutter->blocks;
    uint32_t *start = blocks->start, n = blocks->n_places;
    bool full = true;
    memset(start, 0, ((size_t)blocks->n_blocks + 2) * sizeof *start);
    for (uint32_t node = 0; node < n; node++)
        start[cutter->part[node] + 2]++;
    for (uint32_t b = 0; b < blocks->n_blocks; b++) {
        full = full && start[b + 2] > 0;
        start[b + 2] += start[b + 1];
    }
    for (uint32_t node = 0; node < n; node++) /* from where part b begins to where it ends */
        cutter->nodes[start[cutter->part[node] + 1]++] = node;
    return full;
}

static void order_parts(struct cutter *cutter)
{
    const uint32_t *start = cutter->blocks->start;
    for (uint32_t b = 0; b < cutter->blocks->n_blocks; b++)
        mesh_order_part(&cutter->order, cutter->part, start[b + 1] - start[b],
                        cutter->nodes + start[b]);
}

/* METIS may leave parts empty: they go, and the largest others are split along their order, so that
 * blocks with near numbers stay near in space. */
static int fill_empty(struct cutter *cutter)
{
    struct mesh_blocks *blocks = cutter->blocks;
    const uint32_t n = blocks->n_blocks;
    uint32_t *size = cloth_take(&cutter->memory, n, sizeof *size, cutter->error);
    uint32_t *pieces = cloth_take(&cutter->memory, n, sizeof *pieces, cutter->error);
    if (cutter->memory.lacks)
        return CLOTH_E_MEMORY;
    order_parts(cutter);
    for (uint32_t b = 0; b < n; b++)
        size[b] = blocks->start[b + 1] - blocks->start[b];
    mesh_pieces(n, size, pieces);
    for (uint32_t b = 0, before = 0; b < n; before += pieces[b++])
        for (uint32_t i = 0; i < size[b]; i++)
            cutter->part[cutter->nodes[blocks->start[b] + i]] =
                before + (uint32_t)((uint64_t)i * pieces[b] / size[b]);
    blocks_group(cutter);
    return CLOTH_OK;
}

static void set_places(struct cutter *cutter)
{
    struct mesh_blocks *blocks = cutter->blocks;
    uint32_t *vertex = cutter->part; /* of a node: parts are not needed any more */
    for (uint32_t v = 0; v < blocks->n_vertices; v++)
        if (blocks->place[v] != MESH_NO_PLACE)
            vertex[blocks->place[v]] = v;
    for (uint32_t i = 0; i < blocks->n_places; i++) {
        blocks->vertex[i] = vertex[cutter->nodes[i]];
        blocks->place[blocks->vertex[i]] = i;
    }
}

static int set_hash(struct cutter *cutter)
{
    struct mesh_blocks *blocks = cutter->blocks;
    const size_t n_starts = (size_t)blocks->n_blocks + 1, n = 1 + n_starts + blocks->n_places;
    uint32_t *number = cloth_take(&cutter->memory, n, sizeof *number, cutter->error);
    if (!number)
        return CLOTH_E_MEMORY;
    number[0] = blocks->n_blocks;
    memcpy(number + 1, blocks->start, n_starts * sizeof *number);
    memcpy(number + 1 + n_starts, blocks->vertex, blocks->n_places * sizeof *number);
    for (size_t i = 0; i < n; i++)
        number[i] = htole32(number[i]);
    blocks->hash = XXH64(number, n * sizeof *number, 0);
    return CLOTH_OK;
}

int mesh_blocks_cut(struct mesh_blocks *blocks, uint32_t n_vertices, const unsigned char *used,
                    const struct mesh_pairs *pairs, uint32_t grain, struct cloth_error *error)
{
    struct cutter cutter = {.error = error, .blocks = blocks};
    *blocks = (struct mesh_blocks){0};
    if (grain == 0)
        return cloth_fail(error, CLOTH_E_INPUT, "a grain of 0 vertices; it must be at least 1");
    int code = number_nodes(&cutter, n_vertices, used, grain);
    code = code ? code
                : mesh_graph_build(&cutter.graph, blocks->n_places, n_vertices, blocks->place,
                                   pairs, error);
    code = code ? code : mesh_order_make(&cutter.order, &cutter.graph, error);
    code = code ? code : mesh_partition(cutter.part, &cutter.graph, blocks->n_blocks, error);
    if (!code && !blocks_group(&cutter))
        code = fill_empty(&cutter);
    if (!code) {
        order_parts(&cutter);
        set_places(&cutter);
        code = set_hash(&cutter);
    }
    if (code)
        mesh_blocks_free(blocks);
    cloth_pool_free(&cutter.order.memory);
    mesh_graph_free(&cutter.graph);
    cloth_pool_free(&cutter.memory);
    return code;
}

void mesh_blocks_free(struct mesh_blocks *blocks)
{
    free(blocks->start);
    free(blocks->vertex);
    free(blocks->place);
    *blocks = (struct mesh_blocks){0};
}
