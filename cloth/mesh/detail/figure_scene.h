#ifndef CLOTH_MESH_DETAIL_FIGURE_SCENE_H
#define CLOTH_MESH_DETAIL_FIGURE_SCENE_H

#include "cloth/base/memory.h"
#include "cloth/mesh/detail/figure.h"

#include <assimp/scene.h>

/* A file as Assimp has read it, flattened: nodes in the order of a walk, each behind its parent;
 * parts are a node's meshes; vertices are those of the parts that are one. */

struct figure_node {
    const struct aiNode *of;
    uint32_t parent; /* its own number: it is the root */
};

struct figure_part {
    const struct aiMesh *mesh;
    uint32_t node;
    uint32_t first; /* the number, among all parts, of its first vertex */
};

struct figure {
    const char *path;   /* with the name of the node, */
    const char *wanted; /* which is this; NULL: all are wanted */
    const struct aiScene *scene;
    struct cloth_list node, part; /* struct figure_node, struct figure_part */
    uint32_t n_all;               /* vertices of all parts */
    uint32_t *vertex;             /* n_all: which vertex of the mesh each is */
    uint32_t *source;             /* n_vertices: the first of n_all that is this one, ascending */
    uint32_t n_vertices;
    struct cloth_error *error;
};

/* Errors: those of mesh_read_figure. figure_close in any case. */
int figure_open(struct figure *figure, const char *path, struct cloth_error *error);
void figure_close(struct figure *figure);

/* The number of the node of a name; UINT32_MAX: there is none. */
uint32_t figure_node_of(const struct figure *figure, const struct aiString *name);

/* Rows of a matrix that turns (x, y, z, 1). */
struct figure_matrix {
    double row[3][4];
};
struct figure_matrix figure_matrix_of(const struct aiMatrix4x4 *from);

/* ---- How vertices follow nodes (figure_skin.c) ---- */

/* Vertex v is the sum of weight times matrix times place over its influences, start[v] to
 * start[v + 1]. Matrices: those of the nodes of all parts, by part, then those of their bones.
 * Linear-blend skinning: Magnenat-Thalmann, Laperriere & Thalmann 1988. */
struct figure_influence {
    uint32_t matrix;
    double weight; /* of a vertex these are 1 together */
};
struct figure_skin {
    const struct figure *figure;
    const struct aiAnimation *clip;    /* NULL: nothing is animated */
    const struct aiNodeAnim **channel; /* of each node; NULL: it rests */
    uint32_t n_matrices;
    uint32_t *start; /* n_vertices + 1 */
    struct figure_influence *influence;
    uint32_t *bone_first;                 /* of each part: its first bone's matrix */
    uint32_t *bone_node;                  /* of each matrix: its node */
    struct figure_matrix *world, *matrix; /* of each node, of each matrix, now */
    double (*own)[3];                     /* n_all: in their meshes, moved by shapes, now */
};
/* Errors: CLOTH_E_INPUT for a bone without a node or a weight of no vertex; CLOTH_E_MEMORY. */
int figure_skin_make(struct figure_skin *skin, const struct figure *figure,
                     const struct aiAnimation *clip);
void figure_skin_free(struct figure_skin *skin);

/* Places all vertices at a time of the clip, s. x: n_vertices x 3. */
void figure_place(struct figure_skin *skin, double time, double *x);

/* ---- What a clip says at a time, in its ticks (figure_clip.c) ---- */

/* channel NULL: the node's own matrix. */
struct figure_matrix figure_local(const struct aiNode *node, const struct aiNodeAnim *channel,
                                  double ticks);
/* The weight of a shape of a part's mesh. */
double figure_shape_weight(const struct figure_skin *skin, const struct figure_part *part,
                           uint32_t shape, double ticks);
double figure_ticks(const struct aiAnimation *clip); /* of a second */

#endif
