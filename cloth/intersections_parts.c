/* Vertices that triangles join have one root: the lowest of them. */
#include "cloth/intersections_parts.h"

#include "cloth/base/memory.h"

#include <stdbool.h>
#include <stdlib.h>

static uint32_t root_of(uint32_t *root, uint32_t v)
{
    while (root[v] != v)
        v = root[v] = root[root[v]];
    return v;
}

static void join(uint32_t n_triangles, const uint32_t (*corner)[3], uint32_t *root, bool *used)
{
    for (uint32_t t = 0; t < n_triangles; t++)
        for (int c = 0; c < 3; c++) {
            const uint32_t a = root_of(root, corner[t][c]), b = root_of(root, corner[t][0]);
            root[a < b ? b : a] = a < b ? a : b;
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
    for (uint32_t v = 0; v < n && !code; v++)
        root[v] = v;
    if (!code)
        join(n_triangles, corner, root, used);
    for (uint32_t v = 0; v < n && !code; v++)
        if (used[v] && root[v] == v)
            (*part)[(*n_parts)++] = v;
    free(root);
    free(used);
    return code;
}
