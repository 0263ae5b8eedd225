/* Tables depend on the model and the cut alone. A spring has one side where both ends lie in one
 * block, and two where they do not: sorting the sides by block, neighbour and rows gives every
 * array of the blocks as a contiguous part. */
#include "cloth/flow/tables/tables.h"

#include <stdlib.h>

/* One side of a spring, seen from block `block`. */
struct side {
    uint32_t block, other; /* other: the neighbour plus one, 0 for inner springs */
    uint32_t here, there;  /* places; inner: the lower is here */
    uint32_t spring;
};

static int compare_u32(uint32_t a, uint32_t b)
{
    return (a > b) - (a < b);
}

static int compare_sides(const void *va, const void *vb)
{
    const struct side *a = va, *b = vb;
    int order = compare_u32(a->block, b->block);
    if (!order)
        order = compare_u32(a->other, b->other);
    if (!order)
        order = compare_u32(a->here, b->here);
    if (!order)
        order = compare_u32(a->there, b->there);
    return order ? order : compare_u32(a->spring, b->spring);
}

static uint32_t block_of(const struct mesh_blocks *blocks, uint32_t place)
{
    uint32_t low = 0, high = blocks->n_blocks;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (blocks->start[middle] <= place)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* The sides of all springs, sorted; *n of them. NULL without memory. */
static struct side *find_sides(const struct flow_springs *springs, const struct mesh_blocks *blocks,
                               size_t *n)
{
    struct side *side = malloc((2 * springs->n + 1) * sizeof *side);
    if (!side)
        return NULL;
    *n = 0;
    for (size_t i = 0; i < springs->n; i++) {
        uint32_t p = blocks->place[springs->spring[i].a], q = blocks->place[springs->spring[i].b];
        if (p > q) {
            const uint32_t swap = p;
            p = q;
            q = swap;
        }
        const uint32_t bp = block_of(blocks, p), bq = block_of(blocks, q);
        side[(*n)++] = (struct side){bp, bp == bq ? 0 : bq + 1, p, q, (uint32_t)i};
        if (bp != bq)
            side[(*n)++] = (struct side){bq, bp + 1, q, p, (uint32_t)i};
    }
    qsort(side, *n, sizeof *side, compare_sides);
    return side;
}

static int allocate(struct flow_tables *t, const struct mesh_blocks *blocks, size_t n_sides,
                    struct cloth_error *error)
{
    const size_t places = (size_t)blocks->n_places + 1, sides = n_sides + 1;
    t->n_blocks = blocks->n_blocks;
    t->block = calloc((size_t)blocks->n_blocks + 1, sizeof *t->block);
    t->mass = calloc(places, sizeof *t->mass);
    t->drag = calloc(places, sizeof *t->drag);
    t->free = calloc(places, sizeof *t->free);
    t->diagonal = calloc(places, sizeof *t->diagonal);
    t->load = aligned_alloc(sizeof *t->load, places * sizeof *t->load);
    t->position = aligned_alloc(sizeof *t->load, places * sizeof *t->load);
    t->velocity = aligned_alloc(sizeof *t->load, places * sizeof *t->load);
    t->end = calloc(sides, sizeof *t->end);
    t->held = calloc(sides, sizeof *t->held);
    t->row = calloc(places + blocks->n_blocks, sizeof *t->row);
    t->column = calloc(sides, sizeof *t->column);
    t->rim = calloc(places, sizeof *t->rim);
    t->slot = calloc(sides, sizeof *t->slot);
    t->cut = calloc(sides + blocks->n_blocks, sizeof *t->cut);
    t->stiffness = calloc(sides, sizeof *t->stiffness);
    t->damping = calloc(sides, sizeof *t->damping);
    t->length = calloc(sides, sizeof *t->length);
    t->stretch = calloc(sides, 1);
    if (!t->block || !t->mass || !t->drag || !t->free || !t->diagonal || !t->load || !t->position ||
        !t->velocity || !t->end || !t->held || !t->row || !t->column || !t->rim || !t->slot ||
        !t->cut || !t->stiffness || !t->damping || !t->length || !t->stretch)
        return cloth_fail(error, CLOTH_E_MEMORY, "out of memory for the tables of %u vertices",
                          blocks->n_places);
    return CLOTH_OK;
}

/* What belongs to a vertex, by place. */
static void place_particles(struct flow_tables *t, const struct flow_particles *p,
                            const struct mesh_blocks *blocks, double h)
{
    for (uint32_t i = 0; i < blocks->n_places; i++) {
        const uint32_t v = blocks->vertex[i];
        t->mass[i] = p->mass[v];
        t->drag[i] = p->drag[v];
        t->free[i] = p->free[v];
        t->diagonal[i] = p->mass[v] + h * p->drag[v];
        t->load[i] = p->load[v];
        t->position[i] = p->position[v];
        t->velocity[i] = p->velocity[v];
    }
}

static void point_into_places(struct flow_tables *t, struct flow_table *b)
{
    b->mass = t->mass + b->first;
    b->drag = t->drag + b->first;
    b->free = t->free + b->first;
    b->load = t->load + b->first;
    b->position = t->position + b->first;
    b->velocity = t->velocity + b->first;
}

/* Numbers the rows that other blocks need: marks them in `rim_of` (by place), fills the blocks'
 * rims. */
static void number_rims(struct flow_tables *t, const struct side *side, size_t n_sides,
                        uint32_t *rim_of)
{
    for (size_t i = 0; i < n_sides; i++)
        if (side[i].other)
            rim_of[side[i].here] = 1;
    uint32_t *rim = t->rim;
    for (uint32_t b = 0; b < t->n_blocks; b++) {
        struct flow_table *table = t->block + b;
        table->rim = rim;
        for (uint32_t i = 0; i < table->n; i++) {
            if (!rim_of[table->first + i])
                continue;
            rim_of[table->first + i] = table->n_rim;
            rim[table->n_rim++] = i;
        }
        rim += table->n_rim;
    }
}

/* The inner springs of a block are in order: rows of its matrix. Returns the first side that is not
 * one of them. */
static size_t inner_sides(struct flow_table *b, uint32_t *row, uint32_t *column,
                          const struct side *side, size_t from, size_t to)
{
    size_t i = from;
    for (uint32_t a = 0; a < b->n; a++) {
        row[a] = (uint32_t)(i - from);
        while (i < to && !side[i].other && side[i].here - b->first == a) {
            column[i - from] = side[i].there - b->first;
            i++;
        }
    }
    row[b->n] = (uint32_t)(i - from);
    b->n_inner = (uint32_t)(i - from);
    return i;
}

/* The cut springs of a block, neighbour after neighbour. */
static void cut_sides(struct flow_table *b, uint32_t *slot, uint32_t *cut, const struct side *side,
                      size_t from, size_t to)
{
    for (size_t i = from; i < to; i++) {
        if (i > from && side[i].other == side[i - 1].other)
            continue;
        cut[b->n_slots] = (uint32_t)(i - from);
        slot[b->n_slots++] = side[i].other - 1;
    }
    cut[b->n_slots] = (uint32_t)(to - from);
    b->n_cut = (uint32_t)(to - from);
}

/* Values of the sides from .. to - 1, which are those of block b. */
static void fill_sides(struct flow_tables *t, struct flow_table *b,
                       const struct flow_springs *springs, const struct side *side, size_t from,
                       size_t to, const uint32_t *rim_of)
{
    b->held.at = (const uint32_t(*)[2])(t->held + from);
    for (size_t i = from; i < to; i++) {
        const struct flow_spring *s = springs->spring + side[i].spring;
        const uint32_t here = side[i].here - b->first;
        const uint32_t there = side[i].other ? rim_of[side[i].there] : side[i].there - b->first;
        t->end[i][0] = here;
        t->end[i][1] = there;
        t->stiffness[i] = s->stiffness;
        t->damping[i] = s->damping;
        t->length[i] = s->length;
        t->stretch[i] = s->stretch;
        if (t->free[side[i].here] == t->free[side[i].there])
            continue;
        if (side[i].other && t->free[side[i].here] == 0)
            continue; /* the free row is the neighbour's */
        t->held[from + b->held.n][0] = t->free[side[i].here] != 0 ? here : there;
        t->held[from + b->held.n++][1] = (uint32_t)(i - from);
    }
    b->end = (const uint32_t(*)[2])(t->end + from);
    b->stiffness = t->stiffness + from;
    b->damping = t->damping + from;
    b->length = t->length + from;
    b->stretch = t->stretch + from;
}

static void fill_blocks(struct flow_tables *t, const struct flow_springs *springs,
                        const struct side *side, size_t n_sides, const uint32_t *rim_of)
{
    uint32_t *row = t->row, *slot = t->slot, *cut = t->cut;
    size_t from = 0;
    for (uint32_t b = 0; b < t->n_blocks; b++) {
        struct flow_table *table = t->block + b;
        size_t to = from;
        while (to < n_sides && side[to].block == b)
            to++;
        const size_t inner = inner_sides(table, row, t->column + from, side, from, to);
        cut_sides(table, slot, cut, side, inner, to);
        fill_sides(t, table, springs, side, from, to, rim_of);
        point_into_places(t, table);
        table->slot = slot;
        table->cut = cut;
        table->matrix = (struct solve_block){table->n, t->diagonal + table->first, table->free, row,
                                             t->column + from};
        row += table->n + 1;
        slot += table->n_slots;
        cut += table->n_slots + 1;
        from = to;
    }
}

int flow_tables_make(struct flow_tables *tables, const struct flow_particles *particles,
                     const struct flow_springs *springs, const struct mesh_blocks *blocks, double h,
                     struct cloth_error *error)
{
    *tables = (struct flow_tables){0};
    size_t n_sides = 0;
    struct side *side = find_sides(springs, blocks, &n_sides);
    uint32_t *rim_of = calloc((size_t)blocks->n_places + 1, sizeof *rim_of);
    int code = CLOTH_OK;
    if (!side || !rim_of)
        code = cloth_fail(error, CLOTH_E_MEMORY, "out of memory for the sides of %zu springs",
                          springs->n);
    else
        code = allocate(tables, blocks, n_sides, error);
    if (!code) {
        for (uint32_t b = 0; b < blocks->n_blocks; b++) {
            tables->block[b].first = blocks->start[b];
            tables->block[b].n = blocks->start[b + 1] - blocks->start[b];
        }
        place_particles(tables, particles, blocks, h);
        number_rims(tables, side, n_sides, rim_of);
        fill_blocks(tables, springs, side, n_sides, rim_of);
        code = flow_copies_make(tables, error);
    }
    free(side);
    free(rim_of);
    if (code)
        flow_tables_free(tables);
    return code;
}

void flow_tables_free(struct flow_tables *t)
{
    free(t->block);
    free(t->mass);
    free(t->drag);
    free(t->free);
    free(t->diagonal);
    free(t->load);
    free(t->position);
    free(t->velocity);
    free(t->end);
    free(t->held);
    free(t->row);
    free(t->column);
    free(t->rim);
    free(t->slot);
    free(t->cut);
    free(t->copies);
    free(t->copy);
    free(t->copy_end);
    free(t->stiffness);
    free(t->damping);
    free(t->length);
    free(t->stretch);
    *t = (struct flow_tables){0};
}
