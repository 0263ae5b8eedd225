#ifndef CLOTH_MESH_LATTICE_H
#define CLOTH_MESH_LATTICE_H

#include "cloth/mesh/mesh.h"

/* The springs of a mesh, after the rules of docs/physics.md. The modulus is in N/m.
 *
 * Grids: k is the modulus. Stretch springs lie along rows and columns. Shear springs lie along both
 * diagonals of each cell, or along the one that cuts it. Bend springs skip a vertex along rows and
 * columns. Stretch and bend springs along the border have half of k.
 *
 * Other meshes: every edge of a triangle is a stretch spring with k = modulus * area of its
 * triangles / length^2. A bend spring joins the vertices opposite an inner edge, with k = modulus *
 * area of the two triangles / length^2. There are no shear springs.
 *
 * Lone edges that are no triangle's: stretch springs with k = ea / length.
 *
 * Rest lengths are the distances in the mesh as positioned. Springs with k = 0 are left out.
 * Springs are sorted by (a, b), a < b; two springs may join the same vertices, then stretch comes
 * before bend. */
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

/* A spring whose ends are in a region has the moduli of that region. The moduli of the mesh say
 * which diagonals there are. Except in grids, a grain turns the warp of springs whose ends are in
 * it. */
struct mesh_regions {
    const uint64_t *mask;             /* as mesh_region wants it; NULL: none */
    const struct mesh_moduli *moduli; /* by region */
    const uint64_t *grain_mask;       /* the same of grains, and by grain */
    const double (*grain)[2];         /* cosine and sine of the angle from u towards v */
};

/* The springs of a mesh, which mesh_lattice_each visits in order, as often as wanted. Those of a
 * grid are made as they are visited, those of other meshes are stored. Mesh and regions must
 * outlive it. */
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

/* A membrane's moduli for small strains, along its threads, with free sides: of a strip under
 * tension, and of a sheet that tangential loads shear. */
struct mesh_elastic {
    double warp, weft; /* Young's moduli E1, E2, N/m */
    double shear;      /* G, N/m */
    double poisson;    /* nu12: how much a pull along the warp narrows the weft; NaN: not defined */
};

/* Moduli of the springs that mesh_lattice_build gives a grid's inner vertices. Every vertex is a
 * centre of inversion: a uniform strain moves vertices and cell corners alike. So the sum over a
 * cell's springs is exact: C = sum of k l^2 t t t t / area, t the direction of a spring (Born &
 * Huang 1954). Without bend springs a sheet of any size with free edges has these moduli. With
 * MESH_ALTERNATE cells it has them except in a layer about a cell wide at its edges.
 * docs/physics.md has the closed forms. All are NaN without a grid, and for mirrored cells with one
 * diagonal spring each. The quarters of such a sheet shear against each other when pulled, so it is
 * not uniform. Pure. */
struct mesh_elastic mesh_elastic_of(const struct mesh *mesh, const struct mesh_moduli *moduli);

#endif
