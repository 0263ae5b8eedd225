/* Vertices that triangles join have one root: the lowest of them. */
#include "cloth/intersections_parts.h"

#include "cloth/base/memory.h"
#include "cloth/base/sets.h"

#include <stdbool.h>
#include <stdlib.h>

static void join(uint32_t n_triangles, const uint32_t (*corner)[3], uint32_t *root, bool *used)
{
    for (uint32_t t = 0; t < n_triangles; t++)
        for (int c = 0; c < 3; c++) {
            cloth_sets_join(root, corner[t][c], corner[t][0]);
            used[corner[t][c]] = true;
        }
}

int intersections_parts(uint32_t n, uint32_t n_triangles, const uint32_t (*corner)[3],
                        uint32_t **part, uint32_t *n_parts, struct cloth_error *error)
{
    uint32_t *root = cloth_alloc(n, sizeof *root, error);
    bool *used = cloth_alloc(n, sizeof *used, error);
    *part = cloth_alloc(n, sizeof **part, error);
    *n_parts = 0;
    const int code = root && used && *part ? CLOTH_OK : CLOTH_E_MEMORY;
    if (!code) {
        cloth_sets_start(root, n);
        join(n_triangles, corner, root, used);
    }
    for (uint32_t v = 0; v < n && !code; v++)
        if (used[v] && root[v] == v)
            (*part)[(*n_parts)++] = v;
    free(root);
    free(used);
    return code;
}
