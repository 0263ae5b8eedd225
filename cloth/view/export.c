/* The state of a folder at a frame, as the writers of files take it. */
#include "cloth/view/export.h"

#include "cloth/base/bytes.h"
#include "cloth/base/memory.h"
#include "cloth/view/view.h"

#include <inttypes.h>
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

static uint32_t export_first_corner(const struct mesh *mesh, uint32_t f)
{
    uint32_t room[3];
    const uint32_t *corner;
    mesh_face(mesh, f, room, &corner);
    return *corner;
}

bool view_export_next(const struct output_cache *cache, struct view_export_cloth *cloth)
{
    const struct mesh *mesh = &cache->mesh;
    const bool several = cache->apart.end && cache->apart.n_cloths > 1;
    if (cloth->n == (cache->apart.end ? cache->apart.n_cloths : 1))
        return false;
    snprintf(cloth->name, sizeof cloth->name, "cloth");
    if (several)
        snprintf(cloth->name, sizeof cloth->name, "cloth_%" PRIu32, cloth->n);
    cloth->first = cloth->end;
    cloth->first_face = cloth->end_face;
    cloth->end = cache->apart.end ? cache->apart.end[cloth->n] : mesh->n_vertices;
    while (cloth->end_face < mesh->n_faces &&
           export_first_corner(mesh, cloth->end_face) < cloth->end)
        cloth->end_face++;
    cloth->n++;
    return true;
}

bool view_export_moves(const struct output_cache *cache)
{
    bool moves = false;
    for (uint32_t i = 0; i < cache->n_obstacles; i++)
        moves = moves || cache->obstacles[i].n;
    for (uint32_t i = 0; i < cache->n_bodies; i++)
        moves = moves || cache->posed[i];
    return moves;
}

void view_export_u32(FILE *file, uint32_t value)
{
    unsigned char bytes[4];
    cloth_put_u32(bytes, value);
    fwrite(bytes, sizeof bytes, 1, file);
}
