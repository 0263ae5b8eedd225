/* Patterns, as DXF unless they begin as JSON: the file, then its panels as a coarse mesh. */
#include "cloth/garment/garment.h"
#include "cloth/scene/pattern.h"
#include "tests/fuzz/fuzz.h"

#include <math.h>

enum { ACROSS = 8 }; /* edges, in the largest panel */

static double larger(double largest, const double from[2], const double to[2])
{
    return fmax(largest, hypot(to[0] - from[0], to[1] - from[1]));
}

/* Where a panel's corners and curves lead to, from its first corner, m: curves may go far away. */
static double reach_of(const struct garment_panel *panel, double largest)
{
    for (uint32_t i = 1; i < panel->n_corners; i++)
        largest = larger(largest, panel->corner[0], panel->corner[i]);
    for (uint32_t i = 0; i < panel->n_edges; i++) {
        const struct garment_edge *edge = panel->edge + i;
        const uint32_t n = edge->curve == GARMENT_CUBIC ? 2 : edge->curve == GARMENT_QUADRATIC;
        for (uint32_t k = 0; k < n; k++)
            largest = larger(largest, panel->corner[0], edge->control[k]);
        if (edge->curve == GARMENT_CIRCLE)
            largest = fmax(largest, edge->radius);
        for (uint32_t k = 0; k < edge->n_points; k++)
            largest = larger(largest, panel->corner[0], edge->point[k]);
    }
    return largest;
}

static double fineness_of(const struct garment_pattern *pattern)
{
    double largest = 1e-6;
    for (uint32_t p = 0; p < pattern->n_panels; p++)
        largest = reach_of(pattern->panel + p, largest);
    return largest / ACROSS;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct cloth_error error = {0};
    struct garment_pattern pattern = {0};
    struct garment garment = {0};
    const bool dxf = size > 0 && *data != '{'; /* no JSON begins otherwise */
    const char *path = fuzz_file(dxf ? "panels.dxf" : "panels.json", data, size);
    const struct garment_choice choice = {.notches = dxf};
    if (!scene_read_pattern(&pattern, path, &choice, &error)) {
        const struct garment_fineness fineness = {.edge = fineness_of(&pattern)};
        garment_make(&garment, &pattern, &fineness, &error);
    }
    garment_free(&garment);
    garment_pattern_free(&pattern);
    return 0;
}
