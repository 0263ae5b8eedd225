/* Each comparison names its own fault. */
#include "cloth/app/run/phases.h"

#include "cloth/contact/body.h"

#include <stdio.h>
#include <string.h>

struct comparison {
    const struct model *first, *model;
    const struct model_phase *phase;
    struct cloth_error *error;
};

static int phases_check_differs(const struct comparison *of, const char *what)
{
    return model_fail(of->phase->place, of->error,
                      "phase '%.60s' has %s than the first phase; frames, probes and their names "
                      "are the same in all phases",
                      of->phase->name, what);
}

static int check_cloths(const struct comparison *of)
{
    if (of->first->n_cloths != of->model->n_cloths)
        return phases_check_differs(of, "another number of cloths");
    for (uint32_t c = 0; c < of->first->n_cloths; c++) {
        const struct model_cloth *a = of->first->cloths + c, *b = of->model->cloths + c;
        char what[160];
        const bool renamed = strcmp(a->name, b->name) != 0;
        if (!renamed && a->mesh.n_vertices == b->mesh.n_vertices &&
            a->mesh.n_triangles == b->mesh.n_triangles)
            continue;
        snprintf(what, sizeof what,
                 renamed ? "another name of cloth '%.60s'"
                         : "other vertices or triangles of cloth '%.60s'",
                 a->name);
        return phases_check_differs(of, what);
    }
    return CLOTH_OK;
}

static bool same_pick(const struct model_pick *a, const struct model_pick *b)
{
    return a->kind == b->kind && a->n_vertices == b->n_vertices &&
           !memcmp(a->point, b->point, sizeof a->point) && !(a->radius < b->radius) &&
           !(a->radius > b->radius) && !memcmp(a->box, b->box, sizeof a->box) &&
           (!a->n_vertices ||
            !memcmp(a->vertices, b->vertices, a->n_vertices * sizeof *a->vertices));
}

static bool same_probe(const struct model_probe *a, const struct model_probe *b)
{
    return !strcmp(a->name, b->name) && a->cloth == b->cloth && a->position == b->position &&
           a->velocity == b->velocity && a->reaction == b->reaction && a->contact == b->contact &&
           a->total == b->total && a->contact_total == b->contact_total &&
           a->by_obstacle == b->by_obstacle && a->obstacle == b->obstacle &&
           same_pick(&a->pick, &b->pick);
}

static int check_probes(const struct comparison *of)
{
    bool same = of->first->n_probes == of->model->n_probes;
    for (uint32_t i = 0; same && i < of->first->n_probes; i++)
        same = same_probe(of->first->probes + i, of->model->probes + i);
    return same ? CLOTH_OK : phases_check_differs(of, "other probes");
}

static bool same_body(const struct contact_body *a, const struct contact_body *b)
{
    return a == b || (a && b && a->n_vertices == b->n_vertices && a->n_triangles == b->n_triangles);
}

/* Their motions may be others, but about the same point. */
static bool same_obstacle(const struct comparison *of, uint32_t i)
{
    const struct contact_shape *a = of->first->obstacles + i, *b = of->model->obstacles + i;
    return a->kind == b->kind && a->body == b->body &&
           same_body(contact_bodies_at(&of->first->bodies, a->body),
                     contact_bodies_at(&of->model->bodies, b->body)) &&
           !memcmp(a->value, b->value, sizeof a->value) &&
           (!a->n || !b->n || !memcmp(a->about, b->about, sizeof a->about));
}

static int check_obstacles(const struct comparison *of)
{
    bool same = of->first->n_obstacles == of->model->n_obstacles;
    for (uint32_t i = 0; same && i < of->first->n_obstacles; i++)
        same = same_obstacle(of, i);
    return same ? CLOTH_OK
                : phases_check_differs(of, "other obstacles, or motions about other points,");
}

static bool same_hdf5(const struct model_hdf5 *a, const struct model_hdf5 *b)
{
    return a->velocity == b->velocity && a->block == b->block && a->rank == b->rank &&
           a->contact_force == b->contact_force && a->strain == b->strain &&
           a->stress == b->stress && a->is_double == b->is_double && a->every == b->every &&
           a->level == b->level;
}

int phases_check(const struct model *first, const struct model *model, uint32_t phase,
                 struct cloth_error *error)
{
    const struct comparison of = {first, model, model->phases + phase, error};
    if (strcmp(first->name, model->name) != 0)
        return phases_check_differs(&of, "another name of the scene");
    if (first->fps < model->fps || first->fps > model->fps)
        return phases_check_differs(&of, "another time.fps");
    if (model_shows_contact(first) != model_shows_contact(model))
        return phases_check_differs(
            &of, "another contact.force, or contact that is not certified in both,");
    if (!same_hdf5(&first->hdf5, &model->hdf5))
        return phases_check_differs(&of, "another output.hdf5");
    int code = check_cloths(&of);
    if (!code)
        code = check_obstacles(&of);
    return code ? code : check_probes(&of);
}
