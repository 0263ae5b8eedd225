#ifndef CLOTH_FLOW_SETUP_ELEMENTS_H
#define CLOTH_FLOW_SETUP_ELEMENTS_H

#include "cloth/flow/state/tables.h"
#include "cloth/model/model.h"

/* Elements of all cloths (cloth/physics/element.h): triangles, then the edges that bend, then
 * triangles once more as sails (with the fourth corner of their cell, where there are cells), cloth
 * after cloth in the order of their meshes. Each kind is numbered for itself. */
struct flow_element {
    uint32_t cloth, number;      /* of its cloth's triangles or edges */
    uint32_t corner[4], corners; /* vertices of all cloths; how many */
    enum flow_kind kind;
};

struct flow_elements {
    const struct model *model;
    struct mesh_edges *edges; /* a cloth; none where it has no elements */
    double (*axis)[2][3];     /* a cloth: directions of warp and weft where its mesh has no uv */
};

/* Whether a cloth has elements besides springs. */
int flow_has_triangles(const struct model *model, const struct model_cloth *cloth);
int flow_has_bending(const struct model *model, const struct model_cloth *cloth);
/* Whether mass and air are dealt out by the cells of its grid, not by triangles: of springs, which
 * know no triangles. */
int flow_has_cells(const struct model *model, const struct model_cloth *cloth);

/* Finds the edges, and what is wrong with rest shapes. Errors: CLOTH_E_INPUT for triangles without
 * area and what does not suit its material, with the place; CLOTH_E_MEMORY. Local. */
int flow_elements_make(struct flow_elements *elements, const struct model *model,
                       struct cloth_error *error);
void flow_elements_each(const struct flow_elements *elements,
                        void (*visit)(void *to, const struct flow_element *element), void *to);
void flow_elements_free(struct flow_elements *elements);

/* What the tables say of an element. Of one that flow_elements_make found nothing wrong with. */
struct flow_rest_of {
    uint32_t material;                       /* of triangles, and of the edges that bend */
    double gradient[4], area;                /* triangles */
    double stiffness, damping, s, weight[4]; /* bending: N m, N m s; sqrt(N/m) */
};
void flow_element_rest(const struct flow_elements *elements, const struct flow_element *element,
                       struct flow_rest_of *rest);

#endif
