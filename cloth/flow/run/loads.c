/* Loads add up vertex by vertex, with the weights. Loads that vary in time are kept one by one, in
 * the order of the scene. So each vertex has the same sums for any blocks. In a run they are those
 * at the time of the state whose forces are computed; the end of the step for implicit ones. */
#include "cloth/flow/run/source.h"
#include "cloth/flow/state/bodies.h"

#include "cloth/base/memory.h"
#include "cloth/base/order.h"

#include <stdlib.h>

/* ---- Set-up ---- */

static const uint32_t NO_TRIANGLES[2] = {UINT32_MAX, UINT32_MAX};

/* Adds a force, N, to a vertex of all cloths. */
static int add_load(struct flow_particles *p, const struct flow_picking *picking,
                    const struct model_load *load, uint32_t vertex, const phys_vec *force,
                    struct cloth_error *error)
{
    struct cloth_list *list = &p->varying;
    if (!p->used[vertex])
        flow_unusual_note(&p->loaded, picking->cloth, vertex - picking->first, load->pick.place);
    if (!load->curve) {
        p->load[flow_root(&p->welds, vertex)] += *force;
        return CLOTH_OK;
    }
    const struct flow_varying varying = {.at = vertex,
                                         .number = (uint32_t)list->n,
                                         .curve = load->curve,
                                         .force = {(*force)[0], (*force)[1], (*force)[2]}};
    return cloth_list_put(list, &varying, sizeof varying, error);
}

static int load_edges(struct flow_particles *p, const struct flow_picking *picking,
                      const struct model_load *load, struct cloth_error *error)
{
    const struct mesh *mesh = model_rest(picking->cloth);
    struct mesh_edges edges = {0}; /* found where ends alone do not say the length */
    int code =
        mesh->placed_by_uv && mesh->triangle_uv ? mesh_edges_find(&edges, mesh, error) : CLOTH_OK;
    for (uint32_t i = 0; i < load->n_edges && !code; i++) {
        const uint32_t *end = load->edges[i];
        for (int k = 0; k < 2 && !code; k++)
            if (end[k] >= mesh->n_vertices)
                code = flow_no_vertex(picking->cloth, "a load", end[k], load->pick.place, error);
        if (code)
            break;
        const struct mesh_edge *edge = mesh_edges_get(&edges, end[0], end[1]);
        const double length =
            mesh_length(mesh, edge ? edge->triangle : NO_TRIANGLES, end[0], end[1]);
        const phys_vec force = 0.5 * length * PHYS_VEC(load->force);
        for (int k = 0; k < 2 && !code; k++)
            code = add_load(p, picking, load, picking->first + end[k], &force, error);
    }
    mesh_edges_free(&edges);
    return code;
}

int flow_loads_make(struct flow_particles *p, uint32_t first, const struct model_cloth *cloth,
                    struct cloth_error *error)
{
    struct flow_picking picking = {cloth, first, p->used, "a load", {0}};
    int code = CLOTH_OK;
    for (uint32_t i = 0; i < cloth->n_loads && !code; i++, picking.list.n = 0) {
        const struct model_load *load = cloth->loads + i;
        const phys_vec force = PHYS_VEC(load->force);
        code = load->n_edges ? load_edges(p, &picking, load, error)
                             : flow_pick(&load->pick, &picking, error);
        const uint32_t *vertex = picking.list.items;
        for (size_t k = 0; k < picking.list.n && !code; k++)
            code = add_load(p, &picking, load, vertex[k], &force, error);
    }
    free(picking.list.items);
    return code;
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
