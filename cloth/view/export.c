/* The state of a folder at a frame, as the writers of files take it. */
#include "cloth/view/export.h"

#include "cloth/base/memory.h"
#include "cloth/view/view.h"

#include <stdlib.h>

int view_export_open(struct view_export *from, struct output_cache *cache,
                     struct cloth_error *error)
{
    *from = (struct view_export){.cache = cache};
    from->obstacles = cloth_alloc(1, sizeof *from->obstacles, error);
    from->position = cloth_alloc(cache->mesh.n_vertices, 3 * sizeof *from->position, error);
    if (!from->obstacles || !from->position)
        return CLOTH_E_MEMORY;
    return view_obstacles_make(from->obstacles, cache->n_obstacles, cache->obstacles, cache->keys,
                               &cache->bodies, error);
}

int view_export_at(struct view_export *from, uint64_t frame, struct cloth_error *error)
{
    int code = output_cache_frame(from->cache, frame, from->position, error);
    code = code ? code : output_cache_pose(from->cache, frame, error);
    if (!code)
        view_obstacles_at(from->obstacles, from->cache->time[frame]);
    return code;
}

void view_export_close(struct view_export *from)
{
    if (from->obstacles)
        view_obstacles_free(from->obstacles);
    free(from->obstacles);
    free(from->position);
}
