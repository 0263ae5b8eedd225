/* A spring has one side where both ends lie in one block, and two where they do not. Sorting the
 * sides of a block by neighbour and rows gives every array of its table as a contiguous part. */
#include "cloth/flow/run/source.h"

#include "cloth/base/memory.h"
#include "cloth/base/order.h"

#include <stdlib.h>
#include <string.h>

/* One side of a spring, seen from the block that it is kept in. */
struct flow_side {
    uint32_t other;       /* the neighbour plus one, 0 for inner springs */
    uint32_t here, there; /* places; inner: the lower is here */
    uint32_t number;      /* of the spring: those that join the same rows keep their order */
    struct flow_spring spring;
};

/* The sides of the group: counted from the shapes, then put where their block's part goes on. */
struct gatherer {
    struct flow_source *source;
    uint32_t first, end; /* places of the group */
    uint32_t spring;
    uint32_t block; /* of the last spring's lower end: the next one's is often the same */
};

static void springs_sides_put_side(struct gatherer *gatherer, uint32_t block, uint32_t other,
                                   uint32_t here, uint32_t there, const struct flow_spring *s)
{
    struct flow_source *source = gatherer->source;
    source->side[source->start[block - source->from]++] =
        (struct flow_side){other, here, there, gatherer->spring, *s};
}

static void gather_spring(void *to, const struct flow_spring *s)
{
    struct gatherer *gatherer = to;
    const struct mesh_blocks *blocks = &gatherer->source->blocks;
    uint32_t p = blocks->place[s->a], q = blocks->place[s->b];
    gatherer->spring++;
    const bool own_p = p >= gatherer->first && p < gatherer->end;
    const bool own_q = q >= gatherer->first && q < gatherer->end;
    if (!own_p && !own_q)
        return;
    const uint32_t bp = flow_source_block(blocks, p, gatherer->block);
    const uint32_t bq = flow_source_block(blocks, q, bp);
    gatherer->block = bp;
    if (bp == bq) {
        springs_sides_put_side(gatherer, bp, 0, p < q ? p : q, p < q ? q : p, s);
        return;
    }
    if (own_p)
        springs_sides_put_side(gatherer, bp, bq + 1, p, q, s);
    if (own_q)
        springs_sides_put_side(gatherer, bq, bp + 1, q, p, s);
}

void flow_source_forget(struct flow_source *source)
{
    cloth_pool_free(&source->gathered);
    source->side = NULL;
}

int flow_source_gather(struct flow_source *source, uint32_t from, uint32_t to,
                       struct cloth_error *error)
{
    struct gatherer gatherer = {
        .source = source, .first = source->blocks.start[from], .end = source->blocks.start[to]};
    flow_source_forget(source);
    source->start =
        cloth_take(&source->gathered, (size_t)(to - from) + 1, sizeof *source->start, error);
    if (!source->start)
        return CLOTH_E_MEMORY;
    size_t n = 0;
    for (uint32_t b = from; b < to; b++) {
        source->start[b - from] = n;
        n += (size_t)source->shape[b].n_inner + source->shape[b].n_cut;
    }
    source->side = cloth_take(&source->gathered, n, sizeof *source->side, error);
    if (!source->side)
        return CLOTH_E_MEMORY;
    source->from = from;
    flow_springs_each(&source->springs, gather_spring, &gatherer);
    for (uint32_t i = to - from; i > 0; i--) /* each was moved on to the next one's */
        source->start[i] = source->start[i - 1];
    source->start[0] = 0;
    const int code = flow_source_collect(source, from, to, error);
    if (code)
        flow_source_forget(source);
    return code;
}

/* Fills the data of each vertex, and the rows that other blocks need. */
static void fill_rows(const struct flow_source *source, const struct flow_table *t,
                      const struct flow_layout *layout)
{
    struct flow_cloths at = {0};
    for (uint32_t i = 0; i < t->n; i++) {
        const uint32_t v = source->blocks.vertex[t->first + i], halo = source->halo[t->first + i];
        struct flow_particle p;
        flow_particle_at(&source->particles, source->model, &at, v, &p);
        layout->vertex[i] = v;
        layout->mass[i] = p.mass;
        layout->drag[i] = p.drag;
        layout->free[i] = p.free;
        layout->load[i] = p.load;
        layout->position[i] = p.position;
        layout->velocity[i] = p.velocity;
        if (halo != MESH_NO_PLACE)
            layout->halo[halo] = i;
    }
}

/* The n rows of a block that have a number, and these. */
static void fill_numbered(const struct flow_source *source, const struct flow_table *t,
                          const uint32_t *number, uint32_t n, uint32_t (*to)[2])
{
    for (uint32_t i = 0, k = 0; k < n; i++) {
        const uint32_t here = number[source->blocks.vertex[t->first + i]];
        if (!here)
            continue;
        to[k][0] = i;
        to[k++][1] = here;
    }
}

static void fill_watched(const struct flow_source *source, const struct flow_table *t,
                         const struct flow_layout *layout)
{
    const struct flow_watched *watched = &source->watched;
    const uint32_t from = cloth_first_from(watched->place, 1, watched->n, t->first);
    for (uint32_t i = 0; i < t->n_watched; i++)
        layout->watched[i] = watched->place[from + i] - t->first;
}

static void fill_varying(const struct flow_source *source, const struct flow_table *t,
                         const struct flow_layout *layout)
{
    const struct cloth_list *list = &source->particles.varying;
    if (!t->n_varying)
        return;
    const struct flow_varying *all = list->items;
    const struct flow_varying *load = all + flow_placed_from(list, sizeof *all, t->first);
    for (uint32_t i = 0; i < t->n_varying; i++, load++) {
        layout->varying[i][0] = load->at - t->first;
        layout->varying[i][1] = load->curve;
        layout->varying_force[i] = PHYS_VEC(load->force);
    }
}

static void fill_soft(const struct flow_source *source, const struct flow_table *t,
                      const struct flow_layout *layout)
{
    const struct cloth_list *list = &source->particles.soft;
    if (!t->n_soft)
        return;
    const struct flow_soft *all = list->items;
    const struct flow_soft *pin = all + flow_placed_from(list, sizeof *all, t->first);
    for (uint32_t i = 0; i < t->n_soft; i++, pin++) {
        layout->soft[i][0] = pin->at - t->first;
        layout->soft[i][1] = pin->motion;
        layout->soft_curve[i] = pin->curve;
        layout->soft_stiffness[i] = pin->stiffness;
        layout->soft_damping[i] = pin->damping;
    }
}

/* True if side i is the first of its entry. */
static bool opens(const struct flow_table *t, const struct flow_side *side, uint32_t i)
{
    if (t->format == SOLVE_SPRINGS || i == 0)
        return true;
    const struct flow_side *before = side + i - 1;
    return side[i].other != before->other || side[i].here != before->here ||
           side[i].there != before->there;
}

/* The inner entries come first, in order: rows of the matrix. Returns how many they are. */
static uint32_t fill_inner(const struct flow_table *t, const struct flow_side *side,
                           const struct flow_layout *layout)
{
    uint32_t i = 0, entries = 0;
    for (uint32_t a = 0; a < t->n; a++) {
        layout->row[a] = entries;
        for (; i < t->n_inner && side[i].here - t->first == a; i++)
            if (opens(t, side, i))
                layout->column[entries++] = side[i].there - t->first;
    }
    layout->row[t->n] = entries;
    return entries;
}

/* The cut springs and entries follow, neighbour after neighbour. */
static void fill_cut(const struct flow_source *source, const struct flow_table *t,
                     const struct flow_side *side, const struct flow_layout *layout)
{
    uint32_t neighbours = 0, entries = 0;
    for (uint32_t i = 0; i < t->n_cut; i++) {
        if (i == 0 || side[i].other != side[i - 1].other) {
            layout->cut[neighbours] = i;
            layout->cut_entry[neighbours++] = entries;
        }
        if (!opens(t, side, i))
            continue;
        layout->ghost_end[entries][0] = side[i].here - t->first;
        layout->ghost_end[entries++][1] =
            flow_table_ghost(t, neighbours - 1, source->halo[side[i].there]);
    }
    layout->cut[neighbours] = t->n_cut;
    layout->cut_entry[neighbours] = entries;
}

static void fill_sides(const struct flow_source *source, const struct flow_table *t,
                       const struct flow_side *side, const struct flow_layout *layout)
{
    const uint32_t *vertex = source->blocks.vertex;
    uint32_t held = 0, entries = 0, pulled = 0;
    for (uint32_t i = 0; i < t->n_inner + t->n_cut; i++) {
        const bool first = opens(t, side, i);
        entries += first;
        if (t->format != SOLVE_SPRINGS)
            layout->at[i] = entries - 1;
        const uint32_t here = side[i].here - t->first;
        const uint32_t there =
            side[i].other ? source->halo[side[i].there] : side[i].there - t->first;
        const bool free_here = source->particles.free[vertex[side[i].here]];
        const bool free_there = source->particles.free[vertex[side[i].there]];
        layout->end[i][0] = here;
        layout->end[i][1] = there;
        layout->stiffness[i] = side[i].spring.stiffness;
        layout->damping[i] = side[i].spring.damping;
        layout->length[i] = side[i].spring.length;
        layout->stretch[i] = side[i].spring.stretch;
        if (t->n_sized)
            layout->sized[i] = (struct flow_sized){
                side[i].spring.size,
                {side[i].spring.stiffness, side[i].spring.damping, side[i].spring.length}};
        if (side[i].spring.seam) {
            layout->pulled[pulled][0] = i;
            layout->pulled[pulled++][1] = side[i].spring.seam;
        }
        if (!first || free_here == free_there || (side[i].other && !free_here))
            continue; /* neither end is held, or the free row is the neighbour's */
        layout->held_at[held][0] = free_here ? here : there;
        layout->held_at[held++][1] = entries - 1;
    }
    *layout->held_entries = held;
}

/* The limits of a block's edges. An edge between blocks makes the share of its correction that lets
 * all those of a vertex be made at once. */
static void fill_corrected(const struct flow_source *source, const struct flow_table *t,
                           const struct flow_side *side, const struct flow_layout *layout)
{
    struct solve_edge *inner = layout->corrected;
    struct flow_cut_edge *cut = layout->corrected_cut;
    uint32_t s = 0;
    for (uint32_t i = 0; i < t->n_inner + t->n_cut; i++) {
        const struct model_correction *correction = side[i].spring.correction;
        const double length = side[i].spring.length;
        s += i > t->n_inner && side[i].other != side[i - 1].other;
        if (!correction)
            continue;
        const struct solve_edge edge = {.end = {layout->end[i][0], layout->end[i][1]},
                                        .length = length,
                                        .most = (1 + correction->at) * length,
                                        .slack = correction->tolerance * length};
        if (!side[i].other) {
            *inner++ = edge;
            continue;
        }
        const uint32_t here = source->cut[side[i].here], there = source->cut[side[i].there];
        *cut = (struct flow_cut_edge){.edge = edge,
                                      .row = edge.end[0],
                                      .neighbour = s,
                                      .share = 1.0 / (here > there ? here : there)};
        cut++->edge.end[0] = source->halo[side[i].here];
    }
}

void flow_source_table(const struct flow_source *source, uint32_t block, void *memory)
{
    const struct flow_table *t = source->shape + block;
    struct flow_side *side = source->side + source->start[block - source->from];
    const struct flow_layout arrays = flow_table_layout(t, memory);
    memset(memory, 0, flow_table_bytes(t));
    qsort(side, (size_t)t->n_inner + t->n_cut, sizeof *side, cloth_by_four);
    fill_rows(source, t, &arrays);
    fill_watched(source, t, &arrays);
    fill_numbered(source, t, source->particles.motion, t->n_moved, arrays.moved);
    fill_numbered(source, t, source->particles.slider, t->n_sliding, arrays.sliding);
    fill_numbered(source, t, source->particles.piece, t->n_loose, arrays.loose);
    fill_varying(source, t, &arrays);
    fill_soft(source, t, &arrays);
    fill_inner(t, side, &arrays);
    fill_cut(source, t, side + t->n_inner, &arrays);
    fill_sides(source, t, side, &arrays);
    fill_corrected(source, t, side, &arrays);
    flow_source_members(source, block, &arrays);
}
