#ifndef CLOTH_APP_CHECK_DRAPE_H
#define CLOTH_APP_CHECK_DRAPE_H

#include "cloth/model/model.h"

/* The drape coefficient of a cloth that hangs over a disc (ISO 9073-9, BS 5058). It is the area
 * that the border shades in light along the disc's axis, over the area of the flat border. 100 %:
 * the border stands out stiffly. 0 %: it hangs straight down. Local functions, on one rank. */
struct drape;

struct drape_found {
    double coefficient; /* % */
    double shadow;      /* m^2, of the whole cloth */
};

/* While the model has its meshes; *drape is NULL where it has no drape test. Error:
 * CLOTH_E_MEMORY. */
int drape_of(struct drape **drape, const struct model *model, struct cloth_error *error);

/* Takes a frame, in the place of the one before. position: as of flow_output.frame. */
void drape_frame(struct drape *drape, const double *position);

/* The positions of the last frame, as numbers to be taken and put back. */
size_t drape_numbers(const struct drape *drape);
void drape_get(const struct drape *drape, double *numbers);
void drape_set(struct drape *drape, const double *numbers);

/* The coefficient of the last frame; there was one. Error: CLOTH_E_MEMORY. */
int drape_find(const struct drape *drape, struct drape_found *found, struct cloth_error *error);

/* *drape becomes NULL; nothing is done if it is. */
void drape_close(struct drape **drape);

#endif
