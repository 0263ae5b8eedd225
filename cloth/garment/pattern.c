/* Frees patterns. */
#include "cloth/garment/pattern.h"

#include <stdlib.h>

void garment_pattern_free(struct garment_pattern *pattern)
{
    for (uint32_t p = 0; pattern->panel && p < pattern->n_panels; p++) {
        free(pattern->panel[p].name);
        free(pattern->panel[p].corner);
        free(pattern->panel[p].edge);
    }
    free(pattern->panel);
    free(pattern->stitch);
    *pattern = (struct garment_pattern){0};
}
