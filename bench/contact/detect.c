/* Detection of near pairs in a sheet of 34,969 vertices in 36 blocks: skins as a run has them are
 * made for a step and met with themselves and each other; each pair that comes is measured.
 * Threads take blocks, then pairs of blocks, one after the other. */
#include "bench/contact/contact.h"
#include "bench/contact/shapes.h"

#include "cloth/contact/body.h"
#include "cloth/contact/certificate.h"
#include "cloth/flow/contact/skin.h"
#include "cloth/flow/state/flow.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

enum { GRAIN = 1000, MOST_THREADS = 64 };
static const double THICKNESS = 1e-3; /* m */

struct block {
    void *table, *boxes;
    struct contact_skin skin;
    phys_vec *x; /* points, then where they come to */
};

struct sheet {
    struct model model;
    struct model_material material;
    struct model_cloth cloth;
    struct flow *flow;
    uint32_t n, (*pair)[2], n_pairs;
    struct block *block;
    atomic_uint next, next_pair;
    atomic_ulong near, visited;
};

/* ---- A sheet made ready ---- */

static void free_sheet(struct sheet *sheet)
{
    for (uint32_t b = 0; sheet->block && b < sheet->n; b++) {
        free(sheet->block[b].table);
        free(sheet->block[b].boxes);
        free(sheet->block[b].x);
    }
    free(sheet->block);
    free(sheet->pair);
    flow_free(sheet->flow);
    mesh_free(&sheet->cloth.mesh);
}

static size_t whole_lines(size_t bytes)
{
    return (bytes / CONTACT_ALIGN + 1) * CONTACT_ALIGN;
}

static int make_block(struct sheet *sheet, uint32_t b, unsigned side, shapes_place *place)
{
    struct block *block = sheet->block + b;
    const struct flow_source *source = &sheet->flow->source;
    const struct contact_skin counts = flow_skin_counts(source->shape + b);
    struct cloth_error error = {0};
    uint64_t seed = b + 1;
    block->table = aligned_alloc(CONTACT_ALIGN, whole_lines(flow_skin_bytes(source->shape + b)));
    block->boxes = aligned_alloc(CONTACT_ALIGN, whole_lines(contact_boxes_bytes(&counts)));
    block->x = aligned_alloc(CONTACT_ALIGN, whole_lines(2 * counts.n_points * sizeof(phys_vec)));
    if (!block->table || !block->boxes || !block->x)
        return serve_no_memory();
    if (flow_source_skin(source, b, block->table, &error))
        return serve_fail("%s", error.text);
    block->skin = contact_skin_open(block->table);
    for (uint32_t i = 0; i < counts.n_points; i++) {
        const uint32_t vertex = source->blocks.vertex[block->skin.id[i]];
        phys_vec *x = block->x + i, *y = x + counts.n_points;
        place(vertex % side / (side - 1.0), vertex / side / (side - 1.0), x);
        shapes_move(&seed, x, y);
    }
    return 0;
}

/* The flow of a flat sheet of springs, cut into blocks. */
static int make_flow(struct sheet *sheet, unsigned side)
{
    sheet->material =
        (struct model_material){.name = "cloth", .density = 0.2, .stretch = 50, .shear = 25};
    sheet->cloth = (struct model_cloth){.name = "sheet"};
    sheet->model =
        (struct model){.name = "sheet",
                       .n_materials = 1,
                       .n_cloths = 1,
                       .materials = &sheet->material,
                       .cloths = &sheet->cloth,
                       .h = 0.001,
                       .end = 0.001,
                       .fps = 1,
                       .integrator = MODEL_IMPLICIT_EULER,
                       .tolerance = 1e-3,
                       .max_iterations = 1,
                       .grain = GRAIN,
                       .contact = {.mode = MODEL_CONTACT_CERTIFIED, .thickness = THICKNESS}};
    struct cloth_error error = {0};
    int code = mesh_grid(&sheet->cloth.mesh, 1, 1, side, side, MESH_SAME, &error);
    if (!code)
        code = flow_prepare(&sheet->flow, &sheet->model, 1, &error);
    if (code)
        serve_fail("%s", error.text);
    return code;
}

static int make_sheet(struct sheet *sheet, unsigned side, const char *name)
{
    shapes_place *place = shapes_find(name);
    int code = place ? make_flow(sheet, side) : serve_fail("no shape '%s'", name);
    if (code)
        return code;
    sheet->n = sheet->flow->source.blocks.n_blocks;
    sheet->block = calloc(sheet->n, sizeof *sheet->block);
    sheet->pair = calloc((size_t)sheet->n * (sheet->n + 1) / 2, sizeof *sheet->pair);
    if (!sheet->block || !sheet->pair)
        return serve_no_memory();
    for (uint32_t b = 0; b < sheet->n && !code; b++)
        code = make_block(sheet, b, side, place);
    return code;
}

/* ---- A step ---- */

static void refit(struct block *block)
{
    const uint32_t n = block->skin.n_points;
    phys_vec way = {0};
    for (uint32_t i = 0; i < n; i++)
        way += block->x[n + i] - block->x[i];
    way /= n;
    contact_refit(&block->skin, block->x, block->x + n, &way, block->boxes);
}

struct meeting {
    const struct block *block[2];
    uint64_t near, visited;
};

static void visit(void *to, uint32_t n, const struct contact_candidate *candidate)
{
    struct meeting *meeting = to;
    meeting->visited += n;
    for (uint32_t i = 0; i < n; i++) {
        uint32_t point[4];
        unsigned char side[4];
        phys_vec y[4];
        struct contact_nearest nearest;
        const enum contact_pair pair = contact_candidate_corners(
            &meeting->block[0]->skin, &meeting->block[1]->skin, candidate + i, point, side);
        for (int k = 0; k < 4; k++) {
            const struct block *block = meeting->block[side[k]];
            y[k] = block->x[block->skin.n_points + point[k]];
        }
        contact_nearest_of(pair, y, &nearest);
        meeting->near += nearest.gap < SHAPES_REACH;
    }
}

static void meet(struct sheet *sheet, const uint32_t pair[2])
{
    struct meeting meeting = {{sheet->block + pair[0], sheet->block + pair[1]}, 0, 0};
    struct contact_side side[2];
    for (int k = 0; k < 2; k++) {
        const struct block *block = meeting.block[k];
        side[k] = (struct contact_side){.skin = &block->skin,
                                        .boxes = block->boxes,
                                        .x = block->x,
                                        .y = block->x + block->skin.n_points};
    }
    side[0].parts = contact_enough(THICKNESS);
    side[0].ridges = true;
    contact_query(side, side + 1, SHAPES_REACH, visit, &meeting);
    atomic_fetch_add(&sheet->near, meeting.near);
    atomic_fetch_add(&sheet->visited, meeting.visited);
}

static void find_pairs(struct sheet *sheet)
{
    sheet->n_pairs = 0;
    for (uint32_t a = 0; a < sheet->n; a++)
        for (uint32_t b = a; b < sheet->n; b++) {
            double low[2][3], high[2][3];
            bool near = true;
            contact_boxes_root(sheet->block[a].boxes, low[0], high[0]);
            contact_boxes_root(sheet->block[b].boxes, low[1], high[1]);
            for (int c = 0; c < 3; c++)
                near = near && low[0][c] - high[1][c] < SHAPES_REACH &&
                       low[1][c] - high[0][c] < SHAPES_REACH;
            if (near)
                memcpy(sheet->pair[sheet->n_pairs++], (uint32_t[2]){a, b}, sizeof *sheet->pair);
        }
}

static void *work_refit(void *context)
{
    struct sheet *sheet = context;
    for (uint32_t b; (b = atomic_fetch_add(&sheet->next, 1)) < sheet->n;)
        refit(sheet->block + b);
    return NULL;
}

static void *work_meet(void *context)
{
    struct sheet *sheet = context;
    for (uint32_t i; (i = atomic_fetch_add(&sheet->next_pair, 1)) < sheet->n_pairs;)
        meet(sheet, sheet->pair[i]);
    return NULL;
}

int contact_on_threads(unsigned threads, void *(*work)(void *context), void *context)
{
    pthread_t thread[MOST_THREADS];
    unsigned n = 1;
    int code = threads > MOST_THREADS ? serve_fail("too many threads") : 0;
    for (; n < threads && !code; n++)
        if (pthread_create(thread + n, NULL, work, context))
            code = serve_fail("no thread");
    n -= code != 0;
    if (!code)
        work(context);
    for (unsigned i = 1; i < n; i++)
        pthread_join(thread[i], NULL);
    return code;
}

static int step(struct sheet *sheet, unsigned threads)
{
    atomic_store(&sheet->next, 0);
    atomic_store(&sheet->next_pair, 0);
    atomic_store(&sheet->near, 0);
    atomic_store(&sheet->visited, 0);
    const int code = contact_on_threads(threads, work_refit, sheet);
    if (code)
        return code;
    find_pairs(sheet);
    return contact_on_threads(threads, work_meet, sheet);
}

/* Seconds a vertex of the best step. Every step must find as much as the first. */
static int detect(void *context, struct serve_request *request, double *value)
{
    const unsigned threads = (unsigned)serve_number(request, "threads");
    const unsigned side = serve_number(request, "quick") ? SHAPES_QUICK_SIDE : SHAPES_SIDE;
    const uint64_t rounds = serve_number(request, "rounds");
    struct sheet sheet = {0};
    unsigned long near = 0;
    char name[40];
    (void)context;
    serve_word(request, "shape", name, sizeof name);
    int code = make_sheet(&sheet, side, name);
    *value = INFINITY;
    for (uint64_t i = 0; i <= rounds && !code; i++) {
        const double begin = serve_seconds();
        code = step(&sheet, i ? threads : 1);
        const double seconds = (serve_seconds() - begin) / ((double)side * side);
        *value = i && seconds < *value ? seconds : *value;
        if (i && !code && atomic_load(&sheet.near) != near)
            code = serve_fail("wrong answer: %lu pairs are near, %lu on one thread",
                              atomic_load(&sheet.near), near);
        near = atomic_load(&sheet.near);
    }
    if (!code && !strcmp(name, "six_layers") && near < (unsigned long)side * side)
        code = serve_fail("wrong answer: %lu pairs are near", near);
    free_sheet(&sheet);
    return code;
}

const struct serve_run contact_detect_runs[] = {{"detect", detect}, {0}};
