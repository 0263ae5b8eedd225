#ifndef CLOTH_MESH_LATTICE_H
#define CLOTH_MESH_LATTICE_H

#include "cloth/mesh/mesh.h"

/* The springs of a mesh, after the design's rules (docs/design.md):
 * grids: stretch along rows and columns, half of k on border edges; shear along both
 * diagonals of each cell or the one that cuts it; bend over two vertices along rows and columns,
 * half of k along the border; k is the modulus, N/m. other meshes: every edge of a triangle is
 * stretch with k = modulus
 * * area of its triangles / length^2; the vertices opposite an inner edge are joined by bend with k
 * = modulus * area of the two triangles / length^2; shear has none. lone edges that are no
 * triangle's: stretch with k = ea / length. Rest lengths are the distances in the mesh as
 * positioned. Springs with k = 0 are left out. Sorted by (a, b), a < b; two springs may join the
 * same vertices, stretch before bend then. */
enum mesh_spring_kind { MESH_STRETCH, MESH_SHEAR, MESH_BEND };

struct mesh_spring {
    uint32_t a, b;
    double stiffness; /* N/m */
    double length;    /* at rest, m */
    enum mesh_spring_kind kind;
};

struct mesh_moduli {
    double stretch, shear, bend; /* N/m */
    int both_diagonals;          /* grids only */
    double weft_excess; /* N/m: of stretch along v, more than along u; between them by the square of
                           the cosine */
    const struct mesh_regions *regions; /* that have other moduli; NULL: none */
    double ea;                          /* N, of lone edges: force / strain */
};

/* What joins vertices that are all in a region has the moduli of that; which diagonals there are
 * those of the mesh say. */
struct mesh_regions {
    const uint64_t *mask;             /* as mesh_region wants it */
    const struct mesh_moduli *moduli; /* by region */
};

/* To be gone through in order, as often as wanted. The springs of a grid are made as they are
 * visited, those of other meshes are stored. Mesh and regions must outlive it. */
struct mesh_lattice {
    const struct mesh *mesh;
    struct mesh_moduli moduli;
    uint32_t n;
    struct mesh_spring *spring; /* n; NULL: a grid */
};

/* Errors: CLOTH_E_INPUT for weft_excess without uv, a spring whose length is zero or whose length
 * or stiffness is not finite (names its vertices), CLOTH_E_MEMORY. Local. */
int mesh_lattice_build(struct mesh_lattice *lattice, const struct mesh *mesh,
                       const struct mesh_moduli *moduli, struct cloth_error *error);
/* Calls visit(to, spring) for each spring. Local. */
void mesh_lattice_each(const struct mesh_lattice *lattice,
                       void (*visit)(void *to, const struct mesh_spring *spring), void *to);
void mesh_lattice_free(struct mesh_lattice *lattice);

#endif
