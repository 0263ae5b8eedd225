#ifndef CLOTH_ELEMENT_CLOTHS_H
#define CLOTH_ELEMENT_CLOTHS_H

#include "cloth/element/kind.h"

/* Elements of all cloths: kind after kind (cloth/element/kind.h), in each kind cloth after cloth,
 * in the order of the meshes. Only the edges of meshes are stored: rest values are computed when a
 * list is made. */

/* An edge that welds make of two border edges, with the corners of each side. A hinge across it has
 * the first side's ends, then the vertices opposite. */
struct element_side {
    uint32_t cloth, first; /* its number; its first vertex, of all cloths */
    uint32_t corner[3];    /* of the cloth's mesh: ends, in the order of both, and opposite */
    uint32_t triangle;     /* that has these */
};
struct element_seam {
    struct element_side side[2];
    double tolerance; /* m: how far apart welds let the sides' ends start */
    bool flat;        /* it is sewn: flat at rest wherever the meshes are, */
    double rigidity;  /* and then N m, of its hinges; < 0: as the materials say */
};

struct element {
    uint32_t cloth, first;                     /* its number; its first vertex, of all cloths */
    uint32_t corner[ELEMENT_CORNERS], corners; /* of the cloth's mesh; how many */
    uint32_t triangle[2]; /* it is one, or those at its edge; UINT32_MAX: none (mesh_edge) */
    uint32_t kind;        /* of element_kinds */
    const struct element_seam *seam; /* NULL; else across this: the last corner is the other side's,
                                        so numbered that first + corner is its vertex */
};

struct element_fold;

struct element_cloths {
    const struct model *model;
    struct mesh_edges *edges; /* a cloth; none where it has no elements */
    double (*axis)[2][3];     /* a cloth: directions of warp and weft where its mesh has no uv; of
                                 cloths with elements, or if sizes change */
    uint32_t n_seams;
    struct element_seam *seam; /* of cloths with hinges; added when welds are known */
    uint32_t n_folds;
    struct element_fold *fold; /* edges of all cloths whose rest angle is given, by their ends */
};

/* Finds the edges and checks the rest shapes. Errors: CLOTH_E_INPUT for triangles without area and
 * parts that do not suit their material, with the place; CLOTH_E_MEMORY. Local. */
int element_cloths_make(struct element_cloths *cloths, const struct model *model,
                        struct cloth_error *error);
void element_cloths_free(struct element_cloths *cloths);
/* Checks the rest shapes across seams, as element_cloths_make does. Local. */
int element_seams_check(const struct element_cloths *cloths, struct cloth_error *error);

/* Finds the folds of all cloths, when edges are there. Errors: CLOTH_E_INPUT for cloths whose
 * bending knows no rest angle and an edge that is folded twice, with the place; CLOTH_E_MEMORY. The
 * check, when seams are there: CLOTH_E_INPUT for folds at borders without a seam. Local. */
int element_folds_make(struct element_cloths *cloths, struct cloth_error *error);
int element_folds_check(const struct element_cloths *cloths, struct cloth_error *error);

/* Shows every element of all cloths; of each kind, those across seams come last. */
void element_each(const struct element_cloths *cloths,
                  void (*visit)(void *to, const struct element *element), void *to);

/* The list of one element by itself, whose corners are the first rows. It points into itself.
 * material: of its kind, as element_materials fills it; not owned. */
struct element_one {
    struct phys_elements list;
    uint32_t corner[1][4];
    phys_vec vector;
    double number[PHYS_NUMBERS];
};
void element_alone(const struct element_cloths *cloths, const struct element *element,
                   void *material, struct element_one *one);

/* ---- For descriptors: vertices are of the cloth's mesh ---- */

/* The shape at rest of a cloth: vertices lie at mesh_place, m. */
const struct mesh *element_rest(const struct element_cloths *cloths, uint32_t cloth);

/* The length of an edge at rest, m. */
double element_rest_length(const struct element_cloths *cloths, const struct element *element);

/* Coordinates along warp and weft (phys_triangle_local) of a triangle's corners, in any order,
 * turned by its grain. */
void element_rest_local(const struct element_cloths *cloths, uint32_t cloth, uint32_t triangle,
                        const uint32_t corner[3], double local[6]);

/* The material, by number, of an element: that which its first n corners share. */
static inline uint32_t element_material(const struct element_cloths *cloths,
                                        const struct element *element, size_t n)
{
    return model_material_of(cloths->model->cloths + element->cloth, n, element->corner);
}

/* How lengths at rest change in time: curves of the model along warp and weft, from 1 (0: they
 * stay); the square of the cosine between the warp and an element's edge, or a spring. */
struct element_size {
    uint32_t curve[2];
    double along;
    bool keeps; /* its stiffness: a spring of a grid */
};
/* That of what has n corners, the first two of them the ends of its edge; triangle: one that the
 * edge is of, UINT32_MAX: unknown. */
struct element_size element_size_of(const struct element_cloths *cloths, uint32_t cloth, size_t n,
                                    const uint32_t *corner, uint32_t triangle);
/* The shape at a time, s; needs the model's curves alone. */
struct element_scale element_scale_at(const struct model *model, const struct element_size *size,
                                      double time);

/* True if a fold gives the rest angle of a hinge; *s: then its 2 sin(theta / 2). */
bool element_fold_rest(const struct element_cloths *cloths, const struct element *element,
                       double *s);

/* The material that says how a cloth bends, which is alike in all its regions; NULL: it does not.
 * Without a bending of its own a region has no rigidity. */
const struct model_material *element_bending_of(const struct model *model,
                                                const struct model_cloth *cloth);

/* True if both cloths bend, by the same model. */
bool element_bend_alike(const struct model *model, uint32_t a, uint32_t b);

static inline bool element_is_hinge(const struct mesh_edge *edge)
{
    return edge->opposite[1] != UINT32_MAX && edge->opposite[0] != edge->opposite[1];
}

#endif
