#ifndef CLOTH_MESH_ELASTIC_H
#define CLOTH_MESH_ELASTIC_H

#include "cloth/mesh/lattice.h"

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
