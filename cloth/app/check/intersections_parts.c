/* Union-find over the corners of triangles. */
#include "cloth/app/check/intersections_parts.h"

#include "cloth/base/memory.h"
#include "cloth/base/sets.h"

#include <stdbool.h>
#include <stdlib.h>

static void join(uint32_t n_triangles, const uint32_t (*corner)[3], uint32_t *part, bool *used)
{
    for (uint32_t t = 0; t < n_triangles; t++)
        for (int c = 0; c < 3; c++) {
            cloth_sets_join(part, corner[t][c], corner[t][0]);
            used[corner[t][c]] = true;
        }
}

int intersections_parts(uint32_t n, uint32_t n_triangles, const uint32_t (*corner)[3],
                        uint32_t **part, struct cloth_error *error)
{
    bool *used = cloth_alloc(n, sizeof *used, error);
    *part = cloth_alloc(n, sizeof **part, error);
    const int code = used && *part ? CLOTH_OK : CLOTH_E_MEMORY;
    if (!code) {
        cloth_sets_start(*part, n);
        join(n_triangles, corner, *part, used);
    }
    for (uint32_t v = 0; v < n && !code; v++)
        (*part)[v] = used[v] ? cloth_sets_root(*part, v) : INTERSECTIONS_NO_PART;
    free(used);
    return code;
}
