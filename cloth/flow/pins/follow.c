/* Pins that follow obstacles. A rigid obstacle takes its vertices along by its motion. One with
 * frames changes its shape: each vertex gets an anchor on it, whose number stands behind those of
 * motions. */
#include "cloth/flow/run/source.h"

#include "cloth/base/memory.h"

#include <stdlib.h>

static uint32_t followed_by(const struct flow_particles *p, const struct model *model, uint32_t v)
{
    return p->motion[v] ? model->motions[p->motion[v] - 1].follow : 0;
}

static bool has_frames(const struct model *model, uint32_t obstacle)
{
    const struct contact_body *body =
        contact_bodies_at(&model->bodies, model->obstacles[obstacle].body);
    return body && body->n_frames;
}

static void start_of(const struct flow_particles *p, const struct model *model, uint32_t cloth,
                     uint32_t first, uint32_t v, phys_vec *x)
{
    const double *at =
        p->start ? p->start[v] : model->cloths[cloth].mesh.position + 3 * (size_t)(v - first);
    *x = (phys_vec){at[0], at[1], at[2], 0};
}

/* Marks all vertices that follow an obstacle, and those welded to them. */
static int mark(struct flow_particles *p, const struct model *model, struct cloth_error *error)
{
    p->attached = cloth_alloc(p->n, sizeof *p->attached, error);
    if (!p->attached)
        return CLOTH_E_MEMORY;
    for (uint32_t v = 0; v < p->n; v++)
        p->attached[v] = followed_by(p, model, flow_root(&p->welds, v));
    return CLOTH_OK;
}

/* Adds the anchors of an obstacle, whose vertices are at `place`. */
static void add_anchors(struct flow_particles *p, const struct model *model, uint32_t obstacle,
                        const phys_vec *place)
{
    uint32_t first = 0;
    for (uint32_t c = 0; c < model->n_cloths; first += model->cloths[c++].mesh.n_vertices)
        for (uint32_t v = first; v < first + model->cloths[c].mesh.n_vertices; v++) {
            phys_vec x;
            if (p->attached[v] != obstacle + 1 || flow_root(&p->welds, v) != v)
                continue;
            start_of(p, model, c, first, v, &x);
            flow_anchor_find(model, obstacle, place, &x, p->anchor + p->n_anchors);
            p->motion[v] = model->n_motions + ++p->n_anchors;
        }
}

static int anchor_all(struct flow_particles *p, const struct model *model, uint32_t obstacle,
                      struct cloth_error *error)
{
    const struct contact_body *body =
        contact_bodies_at(&model->bodies, model->obstacles[obstacle].body);
    uint32_t n = 0;
    for (uint32_t v = 0; v < p->n; v++)
        n += p->attached[v] == obstacle + 1;
    if (!n || !has_frames(model, obstacle))
        return CLOTH_OK;
    struct flow_anchor *grown = realloc(p->anchor, ((size_t)p->n_anchors + n) * sizeof *grown);
    p->anchor = grown ? grown : p->anchor;
    phys_vec *place = aligned_alloc(sizeof *place, body->n_vertices * sizeof *place);
    if (grown && place) {
        flow_anchor_places(model, obstacle, place);
        add_anchors(p, model, obstacle, place);
    } else {
        cloth_fail(error, CLOTH_E_MEMORY, "out of memory for pins that follow a body");
    }
    free(place);
    return grown && place ? CLOTH_OK : CLOTH_E_MEMORY;
}

int flow_follow_make(struct flow_particles *p, const struct model *model, struct cloth_error *error)
{
    int code = model_follows(model) ? mark(p, model, error) : CLOTH_OK;
    for (uint32_t i = 0; i < model->n_obstacles && p->attached && !code; i++)
        code = anchor_all(p, model, i, error);
    return code;
}
