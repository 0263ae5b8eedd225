/* The check is complete before the first frame, except the places of vertices. */
#include "cloth/app/check/intersections_state.h"
#include "cloth/base/memory.h"
#include "cloth/base/sets.h"
#include "cloth/model/model.h"

#include <stdlib.h>
#include <string.h>

static int take_arrays(struct intersections *all, struct cloth_error *error)
{
    const struct contact_surface cloths = contact_soup_cloths(&all->soup),
                                 end = contact_soup_all(&all->soup);
    all->x = cloth_alloc(end.point, sizeof *all->x, error);
    all->seen = cloth_alloc(cloths.point, sizeof *all->seen, error);
    all->place = aligned_alloc(sizeof *all->place,
                               (end.point - cloths.point + (size_t)1) * sizeof *all->place);
    if (!all->place)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the vertices of bodies");
    all->checked = (struct verify_soup){.n_points = end.point,
                                        .n_triangles = end.triangle,
                                        .n_first = cloths.triangle,
                                        .x = (const double(*)[3])all->x,
                                        .corner = (const uint32_t(*)[3])all->soup.welded};
    return error->code;
}

/* Vertices that seams or welds join share one number. */
static int intersections_open_take_sewn(struct intersections *all, struct cloth_error *error)
{
    const uint32_t *joined = all->apart->joined, n = contact_soup_cloths(&all->soup).point;
    if (!joined)
        return CLOTH_OK;
    all->sewn = cloth_alloc(all->checked.n_points, sizeof *all->sewn, error);
    if (!all->sewn)
        return CLOTH_E_MEMORY;
    cloth_sets_start(all->sewn, all->checked.n_points);
    for (uint32_t v = 0; v < n; v++) {
        cloth_sets_join(all->sewn, v, joined[v]);
        cloth_sets_join(all->sewn, v, all->soup.same ? all->soup.same[v] : v);
    }
    for (uint32_t v = 0; v < n; v++)
        all->sewn[v] = cloth_sets_root(all->sewn, v);
    all->checked.joined = all->sewn;
    return CLOTH_OK;
}

static int take_names(struct intersections *all, const char *const *names,
                      struct cloth_error *error)
{
    all->name = names ? cloth_alloc(all->soup.n_cloths, sizeof *all->name, error) : NULL;
    for (uint32_t i = 0; i < all->soup.n_cloths && all->name; i++)
        if (!(all->name[i] = strdup(names[i])))
            return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the names of cloths");
    return error->code;
}

static int intersections_open_find_parts(struct intersections *all, struct cloth_error *error)
{
    const struct contact_surface cloths = contact_soup_cloths(&all->soup);
    bool *used = cloth_alloc(cloths.point, sizeof *used, error);
    all->part = cloth_alloc(cloths.point, sizeof *all->part, error);
    if (used && all->part)
        cloth_sets_start(all->part, cloths.point);
    for (uint32_t t = 0; t < cloths.triangle && used && all->part; t++)
        for (int k = 0; k < 3; k++) {
            const uint32_t *corner = all->soup.welded[t];
            cloth_sets_join(all->part, corner[k], corner[0]);
            used[corner[k]] = true;
        }
    for (uint32_t v = 0; v < cloths.point && used && all->part; v++)
        all->part[v] = used[v] ? cloth_sets_root(all->part, v) : INTERSECTIONS_NO_PART;
    free(used);
    return error->code;
}

int intersections_open(struct intersections **intersections,
                       const struct intersections_setup *setup, struct cloth_error *error)
{
    struct intersections *all = *intersections = cloth_alloc(1, sizeof *all, error);
    if (!all) {
        contact_soup_free(setup->soup);
        return CLOTH_E_MEMORY;
    }
    all->program = setup->program;
    all->obstacles = setup->obstacles;
    all->keys = setup->keys;
    all->bodies = setup->bodies;
    all->apart = setup->apart;
    all->self_off = setup->self_off;
    all->soup = *setup->soup;
    *setup->soup = (struct contact_soup){0};
    int code = take_names(all, setup->names, error);
    code = code ? code : take_arrays(all, error);
    code = code ? code : intersections_open_take_sewn(all, error);
    code = code ? code : intersections_open_find_parts(all, error);
    if (code)
        intersections_close(intersections);
    return code;
}

int intersections_of(struct intersections **intersections, const struct model *model,
                     const struct contact_apart *apart, const char *program, bool self_off,
                     struct cloth_error *error)
{
    struct contact_soup soup;
    const char **names = cloth_alloc(model->n_cloths, sizeof *names, error);
    for (uint32_t i = 0; i < model->n_cloths && names; i++)
        names[i] = model->cloths[i].name;
    const struct intersections_setup setup = {program,     &soup,          names, model->obstacles,
                                              model->keys, &model->bodies, apart, self_off};
    int code = model_soup(model, &soup, error);
    code = code || !names ? error->code : intersections_open(intersections, &setup, error);
    contact_soup_free(&soup);
    free(names);
    return code;
}

void intersections_close(struct intersections **intersections)
{
    struct intersections *all = *intersections;
    *intersections = NULL;
    if (!all)
        return;
    for (uint32_t i = 0; i < all->soup.n_cloths && all->name; i++)
        free(all->name[i]);
    free(all->name);
    contact_soup_free(&all->soup);
    free(all->part);
    free(all->seen);
    free(all->x);
    free(all->place);
    free(all->sewn);
    free(all->pairs.items);
    free(all->entered.items);
    free(all);
}
