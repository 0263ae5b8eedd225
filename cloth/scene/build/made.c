/* Parts are few: as many as a scene has garments and figures. */
#include "cloth/scene/build/made.h"
#include "cloth/scene/build/build.h"

#include "cloth/base/memory.h"

#include <stdlib.h>
#include <string.h>

static struct scene_made_part *add_part(struct scene_made *made, const void *key, size_t size,
                                        struct cloth_error *error)
{
    struct scene_made_part **all = scene_build_grow(made->part, made->n, 1, sizeof *all, error);
    if (!all)
        return NULL;
    made->part = all;
    struct scene_made_part *part = all[made->n] = cloth_alloc(1, sizeof *part, error);
    if (!part)
        return NULL;
    made->n++;
    part->size = size;
    part->key = cloth_alloc(size, 1, error);
    if (!part->key)
        return NULL;
    memcpy(part->key, key, size);
    return part;
}

struct scene_made_part *scene_made_part(struct scene_made *made, const void *key, size_t size,
                                        struct cloth_error *error)
{
    for (size_t i = 0; i < made->n; i++)
        if (made->part[i]->size == size && !memcmp(made->part[i]->key, key, size))
            return made->part[i];
    return add_part(made, key, size, error);
}

void scene_made_free(struct scene_made *made)
{
    for (size_t i = 0; i < made->n; i++) {
        struct scene_made_part *part = made->part[i];
        garment_free(&part->garment);
        garment_pattern_free(&part->pattern);
        mesh_free(&part->mesh);
        mannequin_rig_free(&part->rig);
        free(part->key);
        free(part);
    }
    free(made->part);
    *made = (struct scene_made){0};
}
