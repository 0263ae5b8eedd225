/* Shapes at rest are those that count in the frame that was asked for last. */
#include "cloth/view/colours.h"

#include "cloth/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int view_values_open(struct view_values *values, struct output_cache *cache, const char *folder,
                     struct cloth_error *error)
{
    const size_t n = cache->mesh.n_vertices;
    *values = (struct view_values){.cache = cache, .folder = folder, .since = UINT64_MAX};
    values->weight = cloth_alloc(n, sizeof *values->weight, error);
    values->number = cloth_alloc(n, sizeof *values->number, error);
    values->force = cloth_alloc(3 * n, sizeof *values->force, error);
    return error->code;
}

static int view_values_open_colours(struct view_values *values, struct cloth_error *error)
{
    if (values->colours)
        return CLOTH_OK;
    const int code = output_colours_load(&values->colours, values->folder,
                                         values->cache->mesh.n_vertices, error);
    if (code) {
        output_colours_unload(values->colours);
        values->colours = NULL;
    }
    return code;
}

static int view_values_find_parts(const struct view_values *values, enum view_colour by,
                                  uint64_t frame, double *value, struct cloth_error *error)
{
    const int code = by == VIEW_COLOUR_BLOCK
                         ? output_colours_blocks(values->colours, frame, values->number, error)
                         : output_colours_ranks(values->colours, frame, values->number, error);
    for (size_t v = 0; v < values->cache->mesh.n_vertices && !code; v++)
        value[v] = values->number[v] < 0 ? (double)NAN : values->number[v];
    return code;
}

/* A run that goes on, or was killed, has the forces of its last frames not yet, or never. */
static int view_values_find_forces(const struct view_values *values, uint64_t frame, double *value,
                                   struct cloth_error *error)
{
    const uint32_t n = values->cache->mesh.n_vertices;
    uint64_t n_frames = 0;
    const int code = output_forces_read(values->folder, n, frame, values->force, &n_frames, error);
    const bool there = frame < n_frames;
    for (size_t v = 0; v < n && !code; v++) {
        const double *f = values->force + 3 * v;
        value[v] = there ? sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]) : (double)NAN;
    }
    return code;
}

/* ---- Strain and stress ---- */

/* Takes the shapes at rest of the frame. */
static int make_strains(struct view_values *values, uint64_t frame, struct cloth_error *error)
{
    const uint64_t since = output_colours_rest_since(values->colours, frame);
    if (since == values->since && since != UINT64_MAX)
        return CLOTH_OK;
    element_strains_free(&values->strains);
    free(values->cell);
    free(values->stress);
    values->cell = NULL;
    values->stress = NULL;
    values->since = UINT64_MAX;
    int code = output_colours_rest_at(values->colours, frame, &values->strains, error);
    const size_t n = (size_t)values->strains.n_triangles + values->strains.n_edges;
    if (!code) {
        values->cell = cloth_alloc(n, sizeof *values->cell, error);
        values->stress = cloth_alloc(n, sizeof *values->stress, error);
        code = values->cell && values->stress ? CLOTH_OK : CLOTH_E_MEMORY;
    }
    values->since = code ? UINT64_MAX : since;
    return code;
}

/* The larger eigenvalue. */
static double principal(const double stress[3])
{
    const double half = 0.5 * (stress[0] - stress[1]);
    return 0.5 * (stress[0] + stress[1]) + sqrt(half * half + stress[2] * stress[2]);
}

static void view_values_add(struct view_values *values, double *value, const uint32_t *corner,
                            int corners, double cell, double weight)
{
    for (int i = 0; i < corners && !isnan(cell); i++) {
        value[corner[i]] += weight * cell;
        values->weight[corner[i]] += weight;
    }
}

/* Averages cells to vertices. Edges count for vertices without triangles. */
static void view_values_gather(struct view_values *values, double *value)
{
    const struct element_strains *strains = &values->strains;
    const size_t n = strains->n_vertices;
    memset(value, 0, n * sizeof *value);
    memset(values->weight, 0, n * sizeof *values->weight);
    for (size_t t = 0; t < strains->n_triangles; t++)
        view_values_add(values, value, strains->corner[t], 3, values->cell[t], strains->area[t]);
    for (size_t v = 0; v < n; v++)
        values->number[v] = values->weight[v] > 0;
    for (size_t e = 0; e < strains->n_edges; e++)
        for (int i = 0; i < 2; i++)
            if (!values->number[strains->edge[e][i]])
                view_values_add(values, value, strains->edge[e] + i, 1,
                                values->cell[strains->n_triangles + e], strains->length[e]);
    for (size_t v = 0; v < n; v++)
        value[v] = values->weight[v] > 0 ? value[v] / values->weight[v] : (double)NAN;
}

static bool has_stress(const struct element_strains *strains)
{
    for (size_t t = 0; t < strains->n_triangles; t++)
        if (strains->has_stress[strains->corner[t][3]])
            return true;
    return false;
}

static int find_strains(struct view_values *values, bool stress, uint64_t frame,
                        const double *position, double *value, struct cloth_error *error)
{
    const int code = make_strains(values, frame, error);
    if (code)
        return code;
    if (stress && !has_stress(&values->strains))
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%s: nothing has a stress, since all cloths are of springs; a material "
                          "with model: triangles has one, and strain is known of both",
                          values->folder);
    element_strains_find(&values->strains, position, values->cell, values->stress);
    const size_t n = (size_t)values->strains.n_triangles + values->strains.n_edges;
    for (size_t i = 0; i < n && stress; i++)
        values->cell[i] = principal(values->stress[i]);
    view_values_gather(values, value);
    return CLOTH_OK;
}

/* ---- All of them ---- */

int view_values_at(struct view_values *values, enum view_colour by, uint64_t frame,
                   const double *position, double *value, struct cloth_error *error)
{
    if (values->cache->held)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "a run that goes on shows its cloth's own colours: it sends positions "
                          "alone; other colours are of a folder of frames");
    if (by == VIEW_COLOUR_CONTACT)
        return view_values_find_forces(values, frame, value, error);
    const int code = view_values_open_colours(values, error);
    if (code)
        return code;
    return view_colour_is_of_parts(by)
               ? view_values_find_parts(values, by, frame, value, error)
               : find_strains(values, by == VIEW_COLOUR_STRESS, frame, position, value, error);
}

int view_values_frames(struct view_values *values, enum view_colour by, uint64_t *n_frames,
                       struct cloth_error *error)
{
    *n_frames = values->cache->n_frames;
    return by == VIEW_COLOUR_CONTACT
               ? output_forces_read(values->folder, values->cache->mesh.n_vertices, 0, NULL,
                                    n_frames, error)
               : CLOTH_OK;
}

void view_values_close(struct view_values *values)
{
    output_colours_unload(values->colours);
    element_strains_free(&values->strains);
    free(values->cell);
    free(values->stress);
    free(values->weight);
    free(values->number);
    free(values->force);
}
