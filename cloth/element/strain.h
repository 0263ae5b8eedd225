#ifndef CLOTH_ELEMENT_STRAIN_H
#define CLOTH_ELEMENT_STRAIN_H

#include "cloth/base/memory.h"
#include "cloth/model/model.h"
#include "cloth/physics/triangle.h"

/* The strain of every triangle of all cloths against its shape at rest, whatever resists it: the
 * cells of scientific frames. Cells are the triangles, cloth after cloth in the order of their
 * meshes, then in the same order the edges without triangles. Vertices are numbered cloth after
 * cloth, too. */
struct element_strains {
    uint32_t n_vertices, n_triangles, n_edges, n_materials;
    uint32_t (*corner)[4]; /* n_triangles: vertices, then the number of the material */
    phys_vec *gradient;    /* n_triangles, */
    double *area;          /* and as cloth/physics/triangle.h has them; 0: of no area at rest */
    uint32_t (*edge)[2];   /* n_edges: vertices */
    double *length;        /* n_edges: at rest, m */
    struct phys_membrane *membrane; /* of each material; of springs all 0 */
    bool *has_stress;               /* of each material: it is one of triangles */
    phys_vec *x;                    /* n_vertices: room */
    struct cloth_pool memory;
};

/* Room for what is counted, for shapes that come from elsewhere; membranes are all 0. In any case
 * element_strains_free follows. Error: CLOTH_E_MEMORY. Local. */
int element_strains_room(struct element_strains *strains, struct cloth_error *error);
/* Needs the meshes. In any case element_strains_free follows. Error: CLOTH_E_MEMORY, and as of
 * element_cloths_make. Local. */
int element_strains_make(struct element_strains *strains, const struct model *model,
                         struct cloth_error *error);
void element_strains_free(struct element_strains *strains);

/* strain: of each triangle its largest principal strain, of each edge length / length at rest - 1;
 * NaN where there is no size at rest. stress, unless NULL: of each triangle as
 * phys_triangles_strain has it, N/m; NaN where its material is springs, and of edges. position:
 * n_vertices x 3, m. One thread at a time. Local. */
void element_strains_find(const struct element_strains *strains, const double *position,
                          double *strain, double (*stress)[3]);

#endif
