/* The loops of a scene's model. Springs, joints, masses and starts are those that a run of it would
 * have. */
#include "bench/vassilev/loops.h"

#include "cloth/flow/state/flow.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_COLOURS = 64 };

static int fail(const char *what)
{
    fprintf(stderr, "vassilev: %s\n", what);
    return 1;
}

/* Zeroed. */
static void *lines(size_t bytes)
{
    const size_t whole = (bytes / CONTACT_ALIGN + 1) * CONTACT_ALIGN;
    void *memory = aligned_alloc(CONTACT_ALIGN, whole);
    return memory ? memset(memory, 0, whole) : NULL;
}

void loops_free(struct loops *l)
{
    void *const all[] = {l->x,    l->v,      l->f,     l->load,   l->mass,         l->drag,
                         l->free, l->spring, l->joint, l->pixels, l->first,        l->at,
                         l->pull, l->order,  l->seam,  l->patch,  l->colour_first, l->by_colour};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        free(all[i]);
    *l = (struct loops){0};
}

/* ---- Vertices ---- */

static int take_vertices(struct loops *l, const struct flow *flow, const struct model *model)
{
    const size_t n = flow->n_vertices;
    l->n = flow->n_vertices;
    l->x = lines(n * sizeof *l->x);
    l->v = lines(n * sizeof *l->v);
    l->f = lines(n * sizeof *l->f);
    l->load = lines(n * sizeof *l->load);
    l->mass = calloc(n + 1, sizeof *l->mass);
    l->drag = calloc(n + 1, sizeof *l->drag);
    l->free = calloc(n + 1, sizeof *l->free);
    if (!l->x || !l->v || !l->f || !l->load || !l->mass || !l->drag || !l->free)
        return fail("no memory");
    for (uint32_t c = 0, first = 0; c < model->n_cloths; c++) {
        const struct model_cloth *cloth = model->cloths + c;
        for (uint32_t i = 0; i < cloth->mesh.n_vertices; i++) {
            struct flow_particle one;
            flow_particle_of(&flow->source.particles, model, cloth, first, first + i, &one);
            l->x[first + i] = one.position;
            l->v[first + i] = one.velocity;
            l->load[first + i] = one.load;
            l->mass[first + i] = one.mass;
            l->drag[first + i] = one.drag;
            l->free[first + i] = one.free;
        }
        first += cloth->mesh.n_vertices;
    }
    return 0;
}

/* ---- Springs and joints ---- */

struct taking {
    struct loops *l;
    uint64_t n, n_joints; /* of all; the last ones are joints */
    bool counts;
};

static void take_spring(void *to, const struct flow_spring *spring)
{
    struct taking *taking = to;
    struct loops *l = taking->l;
    const uint64_t i = taking->n++;
    if (taking->counts)
        return;
    if (i < l->n_springs)
        l->spring[i] = (struct loops_spring){
            {spring->a, spring->b}, spring->stiffness, spring->damping, spring->length};
    else
        l->joint[i - l->n_springs] =
            (struct loops_joint){spring->a,         {spring->b, spring->b}, 0,
                                 spring->stiffness, spring->damping,        spring->length};
}

/* Those that end on edges; at an end of its edge a joint has two vertices. */
static void take_edge_joints(struct loops *l, const struct flow_springs *springs)
{
    for (uint32_t i = 0; i < springs->n_timed; i++) {
        const struct flow_timed *of = springs->timed + i;
        const bool edge = of->n > 2;
        l->joint[springs->n_joints + i] =
            (struct loops_joint){.vertex = of->vertex[0],
                                 .end = {of->vertex[1], of->vertex[edge ? 2 : 1]},
                                 .share = edge ? -of->weight[2] : 0,
                                 .stiffness = of->spring.stiffness,
                                 .damping = of->spring.damping,
                                 .length = of->spring.length};
    }
}

static int take_springs(struct loops *l, const struct flow *flow)
{
    const struct flow_springs *springs = &flow->source.springs;
    struct taking taking = {.l = l, .counts = true};
    flow_springs_each(springs, take_spring, &taking);
    l->n_joints = springs->n_joints + springs->n_timed;
    l->n_springs = (uint32_t)taking.n - springs->n_joints;
    l->spring = calloc(l->n_springs + 1, sizeof *l->spring);
    l->joint = calloc(l->n_joints + 1, sizeof *l->joint);
    if (!l->spring || !l->joint)
        return fail("no memory");
    taking = (struct taking){.l = l};
    flow_springs_each(springs, take_spring, &taking);
    take_edge_joints(l, springs);
    return 0;
}

/* ---- For several threads ---- */

static int list_by_vertex(struct loops *l)
{
    l->first = calloc((size_t)l->n + 2, sizeof *l->first);
    l->at = calloc(2 * (size_t)l->n_springs + 1, sizeof *l->at);
    l->pull = lines(l->n_springs * sizeof *l->pull);
    if (!l->first || !l->at || !l->pull)
        return fail("no memory");
    for (uint32_t i = 0; i < l->n_springs; i++)
        for (int k = 0; k < 2; k++)
            l->first[l->spring[i].end[k] + 2]++;
    for (uint32_t i = 2; i < l->n + 2; i++)
        l->first[i] += l->first[i - 1];
    for (uint32_t i = 0; i < l->n_springs; i++)
        for (uint32_t k = 0; k < 2; k++)
            l->at[l->first[l->spring[i].end[k] + 1]++] = 2 * i + k;
    return 0;
}

/* Each spring has the first colour that no spring before it has at its ends. */
static int colour(struct loops *l)
{
    uint64_t *used = calloc((size_t)l->n + 1, sizeof *used);
    unsigned char *own = calloc((size_t)l->n_springs + 1, 1);
    uint32_t at[MOST_COLOURS + 2] = {0};
    int code = used && own ? 0 : fail("no memory");
    for (uint32_t i = 0; i < l->n_springs && !code; i++) {
        const uint32_t *end = l->spring[i].end;
        const uint64_t taken = used[end[0]] | used[end[1]];
        unsigned k = 0;
        while (k < MOST_COLOURS && taken >> k & 1)
            k++;
        if (k == MOST_COLOURS) {
            code = fail("too many springs at a vertex");
            break;
        }
        own[i] = (unsigned char)k;
        used[end[0]] |= UINT64_C(1) << k;
        used[end[1]] |= UINT64_C(1) << k;
        at[k + 1]++;
        l->n_colours = k + 1 > l->n_colours ? k + 1 : l->n_colours;
    }
    l->colour_first = calloc(MOST_COLOURS + 1, sizeof *l->colour_first);
    l->by_colour = calloc((size_t)l->n_springs + 1, sizeof *l->by_colour);
    if (!code && (!l->colour_first || !l->by_colour))
        code = fail("no memory");
    for (unsigned k = 0; k < MOST_COLOURS && !code; k++)
        l->colour_first[k + 1] = at[k + 1] += at[k];
    for (uint32_t i = 0; i < l->n_springs && !code; i++)
        l->by_colour[at[own[i]]++] = i;
    free(used);
    free(own);
    return code;
}

/* ---- Pieces ---- */

static uint32_t find_root(uint32_t *root, uint32_t i)
{
    while (root[i] != i)
        i = root[i] = root[root[i]];
    return i;
}

static void unite(uint32_t *root, uint32_t a, uint32_t b)
{
    a = find_root(root, a);
    b = find_root(root, b);
    root[a > b ? a : b] = a < b ? a : b;
}

/* Numbers the pieces in the order of their lowest vertices, and lists these piece by piece. */
static int list_pieces(struct loops *l, uint32_t *root)
{
    uint32_t *number = calloc((size_t)l->n + 1, sizeof *number);
    uint32_t *piece = calloc((size_t)l->n + 2, sizeof *piece);
    int code = number && piece ? 0 : 1;
    for (uint32_t i = 0; i < l->n && !code; i++) {
        const uint32_t r = find_root(root, i);
        if (r == i)
            number[i] = l->n_pieces++;
        piece[number[r] + 2]++;
    }
    for (uint32_t k = 2; k < l->n_pieces + 2 && !code; k++)
        piece[k] += piece[k - 1];
    for (uint32_t i = 0; i < l->n && !code; i++)
        l->order[piece[number[find_root(root, i)] + 1]++] = i;
    code = code || loops_cut(l, piece);
    free(number);
    free(piece);
    return code;
}

static int take_pieces(struct loops *l)
{
    uint32_t *root = calloc((size_t)l->n + 1, sizeof *root);
    l->order = calloc((size_t)l->n + 1, sizeof *l->order);
    l->seam = calloc((size_t)l->n + 1, sizeof *l->seam);
    int code = root && l->order && l->seam ? 0 : 1;
    for (uint32_t i = 0; i < l->n && !code; i++)
        root[i] = l->seam[i] = i;
    for (uint32_t i = 0; i < l->n_springs && !code; i++)
        unite(root, l->spring[i].end[0], l->spring[i].end[1]);
    for (uint32_t i = 0; i < l->n_joints && !code; i++)
        for (int k = 0; k < 2; k++)
            unite(l->seam, l->joint[i].vertex, l->joint[i].end[k]);
    for (uint32_t i = 0; i < l->n && !code; i++)
        l->seam[i] = find_root(l->seam, i);
    code = code || list_pieces(l, root);
    free(root);
    return code ? fail("no memory") : 0;
}

/* ---- The body ---- */

static int take_body(struct loops *l, const struct model *model)
{
    for (uint32_t i = 0; i < model->n_obstacles; i++) {
        const struct contact_shape *shape = model->obstacles + i;
        if (l->maps || !shape->body || !shape->view.width || shape->n)
            return fail("one obstacle, a body that is met by image and stands still, or none");
        l->maps = true;
        l->image = (struct contact_image){.body = contact_bodies_at(&model->bodies, shape->body),
                                          .view = shape->view};
        contact_view_cut(&l->image.view, 1);
        l->pixels = lines(contact_strip_bytes(l->image.body, &l->image.view, 0));
        if (!l->pixels)
            return fail("no memory");
        contact_strip_draw(l->image.body, &l->image.view, 0, l->pixels);
        l->image.strip[0] = l->pixels;
    }
    return 0;
}

/* ---- All ---- */

static int check(const struct model *model)
{
    for (uint32_t c = 0; c < model->n_cloths; c++)
        if (element_parts(model, model->cloths + c))
            return fail("cloths of springs alone");
    for (uint32_t i = 0; i < model->n_joints; i++)
        if (model_is_timed(model->joints + i))
            return fail("joints that are there all the time");
    return model->n_welds || model->n_motions || model->n_sliders || model->n_curves
               ? fail("no welds, and nothing that is moved or varies")
               : 0;
}

int loops_take(struct loops *l, const struct model *model)
{
    struct cloth_error error = {0};
    struct flow *flow = NULL;
    int code = check(model);
    if (!code && flow_prepare(&flow, model, 1, &error))
        code = fail(error.text);
    l->h = model->h;
    l->thickness = model->contact.thickness;
    code = code || take_vertices(l, flow, model) || take_springs(l, flow);
    if (!code)
        l->stiffness = 0.1 * flow_source_mass(&flow->source) / (l->h * l->h);
    code = code || list_by_vertex(l) || colour(l) || take_pieces(l) || take_body(l, model);
    flow_free(flow);
    return code;
}
