/* Patterns: the file, then its panels as a coarse mesh. */
#include "cloth/garment/garment.h"
#include "cloth/scene/pattern.h"
#include "tests/fuzz/fuzz.h"

#include <math.h>

enum { ACROSS = 8 }; /* edges, in the largest panel */

static double fineness_of(const struct garment_pattern *pattern)
{
    double largest = 1e-6;
    for (uint32_t p = 0; p < pattern->n_panels; p++) {
        const struct garment_panel *panel = pattern->panel + p;
        for (uint32_t i = 1; i < panel->n_corners; i++)
            largest = fmax(largest, hypot(panel->corner[i][0] - panel->corner[0][0],
                                          panel->corner[i][1] - panel->corner[0][1]));
    }
    return largest / ACROSS;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct cloth_error error = {0};
    struct garment_pattern pattern = {0};
    struct garment garment = {0};
    if (!scene_read_pattern(&pattern, fuzz_file("panels.json", data, size), &error)) {
        const struct garment_fineness fineness = {.edge = fineness_of(&pattern)};
        garment_make(&garment, &pattern, &fineness, &error);
    }
    garment_free(&garment);
    garment_pattern_free(&pattern);
    return 0;
}
