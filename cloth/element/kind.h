#ifndef CLOTH_ELEMENT_KIND_H
#define CLOTH_ELEMENT_KIND_H

#include "cloth/model/model.h"
#include "cloth/physics/element.h"

#include <stdbool.h>

/* Descriptors of elements: everything that the rest of the cloth knows of a force that joins
 * vertices, springs aside. Each kind has one descriptor, in a file of its own (bending has two).
 * All other code walks the table of kinds and asks; none names a kind. To add a force: one file in
 * cloth/physics, one descriptor here, its name in ELEMENT_ALL, its keys in the scene. */

/* The part of a cloth's mesh that each element of a kind is made of. Corners in this order. */
enum element_part {
    ELEMENT_TRIANGLES, /* of each triangle: its corners */
    ELEMENT_FACES,     /* the same, and the fourth corner of its cell where the cloth has cells */
    ELEMENT_HINGES,    /* of each edge between two triangles: its ends, the vertices opposite */
    ELEMENT_EDGES,     /* of each edge: its ends; where the cloth has cells, without diagonals */
    ELEMENT_PARTS
};

enum {
    ELEMENT_CORNERS = 4, /* an element has at most, */
    ELEMENT_PAIRS = 6    /* and so many pairs of them */
};

/* A cloth, to limit steps. */
struct element_sheet {
    const struct model *model;
    const struct model_cloth *cloth;
    double density; /* kg/m^2: its smallest mass of an area */
    double edge;    /* m: the mean distance of its vertices */
};

/* A shape at rest against that of the mesh: factors of lengths along warp and weft, of areas, and
 * of the square of the length of an element's edge, or of a spring. */
struct element_scale {
    double warp, weft, area, square;
};

struct element;
struct element_cloths;

/* A descriptor. Functions are local and pure, except for their sums and outputs; those on lists are
 * of cloth/physics, as that says (struct phys_elements). A list of a block has all elements that
 * have a corner there, in the order of the mesh. A part that a kind lacks is NULL or 0;
 * tests/cloth/element/test_kinds.c says which go together. */
struct element_kind {
    const char *name; /* in the plural, as sentences have it */
    enum element_part part;
    uint32_t corners; /* at most */
    uint32_t pairs;   /* of corners, that the matrix has: all, (0, 1), (0, 2), (1, 2), (0, 3), ..;
                         0: the matrix does not know these forces */

    /* A list: how many vectors (0 or 1) and numbers an element has, how many bytes a material. */
    uint32_t vectors, numbers;
    size_t material_bytes;

    /* ---- On rank 0, when a run is set up ---- */

    /* True if a cloth has such elements; then all its parts are elements. Reads its materials and
     * the model, not its mesh. */
    bool (*has)(const struct model *model, const struct model_cloth *cloth);
    /* Optional: CLOTH_E_INPUT, with the place, for parts of a cloth that can be no such elements.
     */
    int (*check)(const struct element_cloths *cloths, uint32_t cloth, struct cloth_error *error);
    /* For kinds with vectors or numbers: writes those of entry e of a list, whose corners are
     * there. Corners that it lacks are PHYS_NO_CORNER until it uses them. */
    void (*pack)(const struct element_cloths *cloths, const struct element *element,
                 const struct phys_elements *list, uint32_t e);
    /* For kinds with a shape at rest: changes the vectors and numbers of entry e from those that
     * pack wrote. Moduli and rigidities are then those of the changed shape. */
    void (*resize)(const struct phys_elements *list, uint32_t e, const struct element_scale *scale);
    /* For kinds with material_bytes: writes the elements' data of a material of any kind. */
    void (*material)(const struct model_material *material, void *to);
    /* For kinds without pairs: writes why steps of the model are too long for their force on a
     * cloth, or the empty string. */
    void (*warn)(const struct element_sheet *sheet, char *text, size_t size);

    /* ---- On the lists of blocks, in a step ---- */

    phys_force *force;
    /* All below are of kinds with pairs; system and torque are optional, and kinds with a system
     * have no stiffness. */
    phys_matrix *matrix;
    phys_system *system;
    phys_stiffness *stiffness;
    phys_energy *energy;
    phys_torque *torque;
    phys_matrix *stiffest; /* optional: of elements at their stiffest, where that is not at the
                            * start: for the longest step */
};

/* All kinds, in the order in which their forces are added and their entries assembled. */
#define ELEMENT_ALL(KIND)                                                                          \
    KIND(triangles) KIND(hinges) KIND(quadratic) KIND(air) KIND(strain_limit) KIND(pressure)

#define ELEMENT_COUNT(name) +1
enum { ELEMENT_KINDS = 0 ELEMENT_ALL(ELEMENT_COUNT) };
#undef ELEMENT_COUNT

#define ELEMENT_DECLARE(name) extern const struct element_kind element_##name;
ELEMENT_ALL(ELEMENT_DECLARE)
#undef ELEMENT_DECLARE

extern const struct element_kind *const element_kinds[ELEMENT_KINDS];

/* The parts of a cloth that are elements, as bits 1 << part. The first kind of them that the matrix
 * knows; NULL: none, so that a matrix of springs can hold the cloth. */
unsigned element_parts(const struct model *model, const struct model_cloth *cloth);
const struct element_kind *element_in_matrix(const struct model *model,
                                             const struct model_cloth *cloth);

/* Fills list->material of a kind, n_materials times its material_bytes. */
void element_materials(const struct element_kind *kind, const struct model *model, void *to);

#endif
