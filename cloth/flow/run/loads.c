/* Loads add up vertex by vertex, with the weights. Loads that vary in time are kept one by one, in
 * the order of the scene. So each vertex has the same sums for any blocks. In a run they are those
 * at the time of the state whose forces are computed; the end of the step for implicit ones. */
#include "cloth/flow/run/source.h"
#include "cloth/flow/state/bodies.h"

#include "cloth/base/memory.h"
#include "cloth/base/order.h"

#include <math.h>
#include <stdlib.h>

/* ---- Set-up ---- */

/* A load and its addition to a vertex. */
struct loader {
    struct flow_particles *particles;
    uint32_t first; /* vertex of the cloth */
    const struct model_cloth *cloth;
    const char *place;
    uint32_t curve;
    phys_vec force; /* N */
    struct cloth_error *error;
    bool failed; /* there was no memory */
};

static const uint32_t NO_TRIANGLES[2] = {UINT32_MAX, UINT32_MAX};

static void add_varying(struct loader *loader, uint32_t vertex)
{
    struct cloth_list *list = &loader->particles->varying;
    struct flow_varying *to = cloth_list_add(list, sizeof *to, 1, loader->error);
    loader->failed = loader->failed || !to;
    if (!to)
        return;
    *to = (struct flow_varying){.at = vertex, .number = (uint32_t)list->n, .curve = loader->curve};
    for (int c = 0; c < 3; c++)
        to->force[c] = loader->force[c];
}

static void add_load(void *to, uint32_t vertex)
{
    struct loader *loader = to;
    struct flow_particles *p = loader->particles;
    const uint32_t v = loader->first + vertex;
    if (!p->used[v])
        flow_unusual_note(&p->loaded, loader->cloth, vertex, loader->place);
    if (loader->curve)
        add_varying(loader, v);
    else
        p->load[flow_root(&p->welds, v)] += loader->force;
}

static int load_edges(struct loader *loader, const struct model_load *load,
                      struct cloth_error *error)
{
    const struct mesh *mesh = model_rest(loader->cloth);
    struct mesh_edges edges = {0}; /* found where ends alone do not say the length */
    int code =
        mesh->placed_by_uv && mesh->triangle_uv ? mesh_edges_find(&edges, mesh, error) : CLOTH_OK;
    const phys_vec force = PHYS_VEC(load->force);
    for (uint32_t i = 0; i < load->n_edges && !code; i++) {
        const uint32_t *end = load->edges[i];
        for (int k = 0; k < 2 && !code; k++)
            if (end[k] >= mesh->n_vertices)
                code = flow_no_vertex(loader->cloth, "a load", end[k], loader->place, error);
        if (code)
            break;
        const struct mesh_edge *edge = mesh_edges_get(&edges, end[0], end[1]);
        const double length =
            mesh_length(mesh, edge ? edge->triangle : NO_TRIANGLES, end[0], end[1]);
        loader->force = 0.5 * length * force;
        add_load(loader, end[0]);
        add_load(loader, end[1]);
    }
    mesh_edges_free(&edges);
    return code;
}

int flow_loads_make(struct flow_particles *p, uint32_t first, const struct model_cloth *cloth,
                    struct cloth_error *error)
{
    int code = CLOTH_OK;
    for (uint32_t i = 0; i < cloth->n_loads && !code; i++) {
        const struct model_load *load = cloth->loads + i;
        struct loader loader = {.particles = p,
                                .first = first,
                                .cloth = cloth,
                                .place = load->pick.place,
                                .curve = load->curve,
                                .error = error};
        const struct flow_picking picking = {cloth, p->used + first, "a load", add_load, &loader};
        loader.force = PHYS_VEC(load->force);
        code = load->n_edges ? load_edges(&loader, load, error)
                             : flow_pick(&load->pick, &picking, error);
        if (!code && loader.failed)
            code = CLOTH_E_MEMORY;
    }
    return code;
}

static int compare_varying(const void *a, const void *b)
{
    return cloth_compare_numbers(a, b, 2);
}

void flow_varying_settle(struct flow_source *source)
{
    struct cloth_list *list = &source->particles.varying;
    struct flow_varying *all = list->items;
    size_t n = 0;
    for (size_t i = 0; i < list->n; i++) {
        struct flow_varying load = all[i];
        load.at = source->blocks.place[load.at];
        if (load.at != MESH_NO_PLACE)
            all[n++] = load;
    }
    list->n = n;
    if (n)
        qsort(all, n, sizeof *all, compare_varying);
}

uint32_t flow_varying_from(const struct flow_source *source, uint32_t place)
{
    const struct cloth_list *list = &source->particles.varying;
    return cloth_first_from(list->items, sizeof(struct flow_varying) / sizeof(uint32_t),
                            (uint32_t)list->n, place);
}

/* ---- In bodies ---- */

void flow_varying_add(const duite_call *call, const struct flow_table *t, double now, phys_vec *f)
{
    const struct model *model = flow_of(call)->model;
    uint32_t curve = 0; /* that the factor is of */
    double factor = 1;
    for (uint32_t i = 0; i < t->n_varying; i++) {
        if (curve != t->varying[i][1])
            factor = model_curve_at(model, t->varying[i][1], now);
        curve = t->varying[i][1];
        f[t->varying[i][0]] += factor * t->varying_force[i];
    }
}

double flow_varying_energy(const duite_call *call, const struct flow_table *t, double now,
                           const phys_vec *x)
{
    const struct model *model = flow_of(call)->model;
    double sum = 0;
    for (uint32_t i = 0; i < t->n_varying; i++)
        sum -= model_curve_at(model, t->varying[i][1], now) *
               phys_dot(t->varying_force + i, x + t->varying[i][0]);
    return sum;
}
