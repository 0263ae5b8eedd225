#ifndef CLOTH_SCENE_BUILD_MADE_H
#define CLOTH_SCENE_BUILD_MADE_H

#include "cloth/garment/garment.h"
#include "cloth/mannequin/pose.h"
#include "cloth/mesh/mesh.h"

/* Garments and figures of the scene that is read, each made once for all its phases. One is known
 * by its key: the settings that it follows from. All begins as zero. Local. */
struct scene_made_part {
    char *key;
    size_t size; /* bytes of the key */
    bool is_made;
    struct garment_pattern pattern;
    struct garment garment;
    struct mesh mesh;
    struct mannequin_rig rig;
};
struct scene_made {
    size_t n;
    struct scene_made_part **part;
};

/* The part of a key, to be made where is_made is false. NULL: CLOTH_E_MEMORY. */
struct scene_made_part *scene_made_part(struct scene_made *made, const void *key, size_t size,
                                        struct cloth_error *error);
void scene_made_free(struct scene_made *made);

#endif
