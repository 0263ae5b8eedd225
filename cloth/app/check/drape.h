#ifndef CLOTH_APP_CHECK_DRAPE_H
#define CLOTH_APP_CHECK_DRAPE_H

#include "cloth/model/model.h"

/* The drape coefficient of a cloth that hangs over a disc (ISO 9073-9, BS 5058). It is the area
 * that the border shades in light along the disc's axis, over the area of the flat border. 100 %:
 * the border stands out stiffly. 0 %: it hangs straight down. Local functions, on one rank. */
struct drape {
    size_t n;         /* numbers: 3 a vertex of the cloth; 0: there is no drape test */
    double *position; /* n: in the last frame */
    uint32_t first;   /* vertex, among those of all cloths */
    struct mesh_shape shape;
    uint32_t (*corner)[3];
    double flat, disc; /* m^2: the cloth at rest, the disc that carries it */
    double axis[3];
};

struct drape_found {
    double coefficient; /* % */
    double shadow;      /* m^2, of the whole cloth */
};

/* While the model has its meshes. drape: zero before; to be freed in any case. Error:
 * CLOTH_E_MEMORY. */
int drape_of(struct drape *drape, const struct model *model, struct cloth_error *error);

/* Takes a frame, in the place of the one before. position: as of flow_output.frame. */
void drape_frame(const struct drape *drape, const double *position);

/* The coefficient of the last frame; there was one. Error: CLOTH_E_MEMORY. */
int drape_find(const struct drape *drape, struct drape_found *found, struct cloth_error *error);

void drape_free(struct drape *drape);

#endif
