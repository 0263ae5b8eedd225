/* The numbers are of the frame found last, in the quantity that colours it now. */
#include "cloth/view/colours.h"

#include "cloth/base/memory.h"
#include "cloth/base/order.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SAMPLE = 20000 };

int view_colours_open(struct view_colours *colours, struct output_cache *cache, const char *folder,
                      const struct view_colouring *first, struct cloth_error *error)
{
    const size_t n = cache->mesh.n_vertices;
    colours->has_scale[first->by] = first->has_scale;
    colours->scale[first->by] = first->scale;
    colours->value = cloth_alloc(n, sizeof *colours->value, error);
    colours->position = cloth_alloc(3 * n, sizeof *colours->position, error);
    colours->number = cloth_alloc(n, sizeof *colours->number, error);
    colours->part = cloth_alloc(n, sizeof *colours->part, error);
    const int code = view_values_open(&colours->values, cache, folder, error);
    return code ? code : view_colours_pick(colours, first->by, error);
}

/* ---- Scales ---- */

static void view_colours_find_range(const double *value, size_t n, double *low, double *high)
{
    *low = *high = (double)NAN;
    for (size_t v = 0; v < n; v++) {
        *low = fmin(*low, value[v]); /* a NaN beside a number counts as none */
        *high = fmax(*high, value[v]);
    }
}

/* The number that one in twenty of those above 0 exceeds, so that a few vertices at a pin do not
 * leave one colour for all others. Many vertices are sampled evenly. Sorts `value`. NaN: none is
 * above 0. */
static double find_high(double *value, size_t n)
{
    const size_t stride = n / SAMPLE + 1;
    size_t found = 0;
    for (size_t v = 0; v < n; v += stride)
        if (value[v] > 0)
            value[found++] = value[v];
    qsort(value, found, sizeof *value, cloth_by_double);
    return found ? value[found - 1 - found / 20] : (double)NAN;
}

/* Finds the scale over the frames that have numbers. */
static int find_scale(struct view_colours *colours, enum view_colour by, struct cloth_error *error)
{
    struct output_cache *cache = colours->values.cache;
    double max = 0;
    uint64_t n_frames = 0;
    int code = view_values_frames(&colours->values, by, &n_frames, error);
    n_frames = n_frames < cache->n_frames ? n_frames : cache->n_frames;
    for (uint64_t i = 0; i < view_looks(n_frames) && !code; i++) {
        const uint64_t frame = view_look(n_frames, i);
        code = output_cache_frame(cache, frame, colours->position, error);
        if (!code)
            code = view_values_at(&colours->values, by, frame, colours->position, colours->value,
                                  error);
        if (!code)
            max = fmax(max, find_high(colours->value, cache->mesh.n_vertices));
    }
    colours->has_scale[by] = !code;
    colours->scale[by] = view_scale_up_to(max);
    return code;
}

int view_colours_pick(struct view_colours *colours, enum view_colour by, struct cloth_error *error)
{
    int code = CLOTH_OK;
    if (view_colour_has_scale(by) && !colours->has_scale[by])
        code = find_scale(colours, by, error);
    if (!code)
        colours->legend = (struct view_legend){.by = by, .scale = colours->scale[by]};
    return code;
}

/* ---- Frames ---- */

static int find_hues(struct view_colours *colours, struct cloth_error *error)
{
    const struct mesh *mesh = &colours->values.cache->mesh;
    int32_t last = 0;
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        colours->part[v] = isnan(colours->value[v]) ? -1 : (int32_t)colours->value[v];
        last = colours->part[v] > last ? colours->part[v] : last;
    }
    const uint32_t n = (uint32_t)last + 1;
    free(colours->hue);
    free(colours->near);
    colours->hue = cloth_alloc(n, sizeof *colours->hue, error);
    colours->near = cloth_alloc(n, sizeof *colours->near, error);
    if (!colours->hue || !colours->near)
        return CLOTH_E_MEMORY;
    view_hues_spread(mesh->n_triangles, mesh->triangle, colours->part, n, colours->hue,
                     colours->near);
    colours->legend.n_parts = n;
    colours->legend.hue = colours->hue;
    for (size_t v = 0; v < mesh->n_vertices; v++)
        colours->number[v] = colours->part[v] < 0 ? -1 : colours->hue[colours->part[v]];
    return CLOTH_OK;
}

int view_colours_frame(struct view_colours *colours, uint64_t frame, const double *position,
                       struct cloth_error *error)
{
    const enum view_colour by = colours->legend.by;
    const size_t n = colours->values.cache->mesh.n_vertices;
    if (by == VIEW_COLOUR_CLOTH)
        return CLOTH_OK;
    const int code = view_values_at(&colours->values, by, frame, position, colours->value, error);
    if (code)
        return code;
    view_colours_find_range(colours->value, n, &colours->low, &colours->high);
    if (view_colour_is_of_parts(by))
        return find_hues(colours, error);
    for (size_t v = 0; v < n; v++)
        colours->number[v] =
            isnan(colours->value[v])
                ? -1
                : (float)view_scale_part(&colours->legend.scale, colours->value[v]);
    return CLOTH_OK;
}

void view_colours_paint(const struct view_colours *colours, struct view_scene *scene)
{
    const enum view_colour by = colours->legend.by;
    if (by == VIEW_COLOUR_CLOTH)
        view_scene_paint(scene, VIEW_PAINT_CLOTH, 0, NULL, NULL);
    else if (view_colour_is_of_parts(by))
        view_scene_paint(scene, VIEW_PAINT_PARTS, VIEW_HUES, view_hue, colours->number);
    else
        view_scene_paint(scene, VIEW_PAINT_SCALE, VIEW_MAP, view_map, colours->number);
}

void view_colours_say(const struct view_colours *colours)
{
    const struct view_legend *legend = &colours->legend;
    const char *title = view_colour_title[legend->by];
    if (view_colour_is_of_parts(legend->by))
        printf("colours: %s, 0 to %u\n", title, legend->n_parts - 1);
    else if (view_colour_has_scale(legend->by) && isnan(colours->low))
        printf("colours: %s, from %g to %g; this frame has none\n", title, legend->scale.min,
               legend->scale.max);
    else if (view_colour_has_scale(legend->by))
        printf("colours: %s, from %g to %g; this frame has %.4g to %.4g\n", title,
               legend->scale.min, legend->scale.max, colours->low, colours->high);
}

void view_colours_close(struct view_colours *colours)
{
    view_values_close(&colours->values);
    free(colours->value);
    free(colours->position);
    free(colours->number);
    free(colours->part);
    free(colours->hue);
    free(colours->near);
}
