/* Warnings about a model. Each kind has its place in flow->warning, and says one thing at
 * most, the first. */
#include "cloth/flow/integrators/integrator.h"
#include "cloth/flow/pins/sliders.h"
#include "cloth/flow/run/setup.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

static const double LEAST_EXTENT = 0.01, MAX_EXTENT = 10; /* m: of a garment */
static const double DEEP = 1e-6; /* m: a point on a surface is less deep in it */

void flow_warn_say(struct flow *flow, int kind, const char *place, const char *format, ...)
{
    char *text = flow->warning[kind];
    const size_t size = sizeof flow->warning[kind];
    va_list list;
    if (*text)
        return;
    const size_t n = place ? (size_t)snprintf(text, size, "%.200s: ", place) : 0;
    va_start(list, format);
    vsnprintf(text + n, size - n, format, list);
    va_end(list);
}

static void warn_of_unusual(struct flow *flow, int kind, const struct flow_unusual *unusual,
                            const char *what, const char *effect)
{
    if (unusual->n)
        flow_warn_say(flow, kind, unusual->place,
                      "%s that no face, edge or joint uses: %u, the first is vertex %u of cloth "
                      "'%.60s' (vertices count from 1); %s",
                      what, unusual->n, unusual->vertex + 1, unusual->cloth->name, effect);
}

static const char *name_of(const struct model_cloth *cloth)
{
    return cloth->name ? cloth->name : "";
}

/* Files are often in centimetres or millimetres. Chains, which no garment is, may have any length.
 */
static void warn_of_extent(struct flow *flow)
{
    const struct model *model = flow->model;
    for (uint32_t c = 0; c < model->n_cloths; c++) {
        const struct model_cloth *cloth = model->cloths + c;
        double low[3], high[3];
        const double extent = mesh_box(&cloth->mesh, low, high);
        if (cloth->mesh.n_triangles && !(extent >= LEAST_EXTENT && extent <= MAX_EXTENT))
            flow_warn_say(flow, FLOW_WARN_EXTENT, cloth->mesh_place,
                          "cloth '%.60s' is %g m long in its largest extent, %s than %g m: is its "
                          "mesh in metres? transform.units: cm reads centimetres",
                          name_of(cloth), extent, extent > MAX_EXTENT ? "more" : "less",
                          extent > MAX_EXTENT ? MAX_EXTENT : LEAST_EXTENT);
    }
}

/* The vertex of a cloth that starts deepest in a shape, of those that are free. first: the number
 * of the cloth's first vertex. Returns its gap, m; infinite: none is free. */
static double find_deepest(const struct flow *flow, const struct contact_shape *shape,
                           const struct model_cloth *cloth, uint32_t first, uint32_t *deepest)
{
    const struct flow_particles *particles = &flow->source.particles;
    struct contact_pose pose;
    double gap = INFINITY;
    contact_pose_over(shape, flow->model->keys, &flow->model->bodies, 0, 0, &pose);
    for (uint32_t i = 0; i < cloth->mesh.n_vertices; i++) {
        struct contact_hit hit;
        phys_vec x;
        if (!particles->used[first + i] || !particles->free[first + i])
            continue;
        flow_start_place(particles, cloth, first, i, &x);
        contact_closest(shape, &pose, 1, &x, &hit);
        if (hit.gap < gap) {
            gap = hit.gap;
            *deepest = i;
        }
    }
    return gap;
}

/* The first step puts it out at once, by the nearest way, which may be none that was meant. A start
 * of certified contact is refused, and this says where. */
static void warn_of_inside(struct flow *flow)
{
    const struct model *model = flow->model;
    for (uint32_t c = 0; c < model->n_cloths; c++)
        for (uint32_t i = 0; i < model->n_obstacles && !flow->warning[FLOW_WARN_INSIDE][0]; i++) {
            const struct model_cloth *cloth = model->cloths + c;
            uint32_t deepest = 0;
            if (!model_meets(model, c, model->n_cloths + i))
                continue;
            const double gap =
                find_deepest(flow, model->obstacles + i, cloth, model_first(model, c), &deepest);
            if (gap < -DEEP)
                flow_warn_say(flow, FLOW_WARN_INSIDE, cloth->place,
                              "cloth '%.60s' starts inside obstacles[%u], a %s: vertex %u is %g m "
                              "deep in it (vertices count from 1)%s",
                              name_of(cloth), i, contact_kinds[model->obstacles[i].kind]->name,
                              deepest + 1, -gap,
                              model_promise(model).apart
                                  ? ""
                                  : "; the first step puts it out by the nearest way");
        }
}

/* Warns of the first cloth that has such edges. */
static void warn_of_windings(struct flow *flow, const struct model_cloth *cloth,
                             const struct mesh_edges *edges)
{
    const struct mesh_edge *first = NULL;
    uint32_t n = 0;
    for (uint32_t e = edges->n; e-- > 0;)
        if (edges->edge[e].against) {
            first = edges->edge + e;
            n++;
        }
    if (first)
        flow_warn_say(flow, FLOW_WARN_WINDING, cloth->mesh_place,
                      "cloth '%.60s' has %u edges whose two triangles are wound against each "
                      "other, the first is between vertices %u and %u (counted from 1): which side "
                      "is its outside differs there; turn the faces of one side round",
                      name_of(cloth), n, first->a + 1, first->b + 1);
}

/* The distance of two ends of an edge that follow obstacles at a time, m. */
static double length_at(const struct flow *flow, uint32_t first, const struct model_cloth *cloth,
                        const struct mesh_edge *edge, double time)
{
    const struct flow_particles *p = &flow->source.particles;
    const uint32_t end[2] = {edge->a, edge->b};
    struct flow_pins pins = {.model = flow->model, .anchor = p->anchor, .time = time};
    phys_vec x[2], start;
    for (int k = 0; k < 2; k++) {
        flow_start_place(p, cloth, first, end[k], &start);
        flow_pins_place(&pins, p->motion[flow_root(&p->welds, first + end[k])], &start, x + k);
    }
    const phys_vec way = x[1] - x[0];
    return sqrt(phys_dot(&way, &way));
}

/* The most that an edge of one cloth gets longer than at the start, or at rest; and when. */
struct stretched {
    double by, time;
    const struct mesh_edge *edge;
};

static void find_stretched(const struct flow *flow, const struct model_cloth *cloth, uint32_t first,
                           const struct mesh_edges *edges, struct stretched *most)
{
    enum { TIMES = 50 };
    const uint32_t *attached = flow->source.particles.attached + first;
    const double *position = model_rest(cloth)->position;
    for (uint32_t e = 0; e < edges->n; e++) {
        const struct mesh_edge *edge = edges->edge + e;
        if (!attached[edge->a] || !attached[edge->b])
            continue;
        const phys_vec way =
            PHYS_VEC(position + 3 * (size_t)edge->b) - PHYS_VEC(position + 3 * (size_t)edge->a);
        const double rest = sqrt(phys_dot(&way, &way));
        const double length = fmax(rest, length_at(flow, first, cloth, edge, 0));
        for (int i = 1; i <= TIMES; i++) {
            const double time = flow->model->end * i / TIMES;
            const double by = length_at(flow, first, cloth, edge, time) / length - 1;
            if (by > most->by)
                *most = (struct stretched){by, time, edge};
        }
    }
}

/* first: the number of the cloth's first vertex. */
static void warn_of_follow(struct flow *flow, const struct model_cloth *cloth, uint32_t first,
                           const struct mesh_edges *edges)
{
    struct stretched most = {.by = 0.2}; /* a body's skin stretches by so much at its joints */
    find_stretched(flow, cloth, first, edges, &most);
    if (most.edge)
        flow_warn_say(flow, FLOW_WARN_FOLLOW, cloth->place,
                      "pins that follow obstacles stretch cloth '%.60s' by %.0f %% at %.3g s: the "
                      "edge between vertices %u and %u (counted from 1); pin fewer of its vertices",
                      name_of(cloth), 100 * most.by, most.time, most.edge->a + 1, most.edge->b + 1);
}

/* Grids are wound in one direction. Cloths without elements have no edges of their own. */
static void run_warn_of_edges(struct flow *flow)
{
    const struct model *model = flow->model;
    const bool attached = flow->source.particles.attached != NULL;
    for (uint32_t c = 0; c < model->n_cloths; c++) {
        const struct model_cloth *cloth = model->cloths + c;
        const struct mesh_edges *edges = flow->source.elements.edges + c;
        struct mesh_edges found = {0};
        struct cloth_error ignored = {0}; /* without edges there are no warnings */
        if (!attached && cloth->mesh.grid_nx)
            continue;
        if (!edges->n && !mesh_edges_find(&found, &cloth->mesh, &ignored))
            edges = &found;
        warn_of_windings(flow, cloth, edges);
        if (attached)
            warn_of_follow(flow, cloth, model_first(model, c), edges);
        mesh_edges_free(&found);
    }
}

int flow_warn(struct flow *flow, struct cloth_error *error)
{
    const struct flow_particles *particles = &flow->source.particles;
    run_warn_of_edges(flow);
    warn_of_unusual(flow, FLOW_WARN_UNUSED, &particles->unused, "vertices",
                    "they are kept and stay where they are");
    warn_of_unusual(flow, FLOW_WARN_PINNED, &particles->pinned, "pinned vertices",
                    "they stay where they are without a pin");
    warn_of_unusual(flow, FLOW_WARN_LOADED, &particles->loaded, "loads on vertices",
                    "they move nothing");
    warn_of_extent(flow);
    warn_of_inside(flow);
    return flow_warn_of_steps(flow, error);
}
