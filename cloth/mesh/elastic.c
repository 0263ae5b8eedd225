/* The compliances are written out, not inverted: so a lattice without diagonals, whose stiffness
 * is singular, has its moduli, too. */
#include "cloth/mesh/lattice.h"

#include <math.h>

static const struct mesh_elastic NONE = {NAN, NAN, NAN, NAN};

/* Moduli of cells of a (m, along the warp) by b (m, along the weft), springs in N/m. A lattice with
 * both diagonals is orthotropic: shear and stretch are not coupled. */
static struct mesh_elastic of_both(double warp, double weft, double diagonal, double a, double b)
{
    const double square = a * a + b * b;
    const double c11 = warp * (a / b) + 2 * diagonal * (a * a * a) / (b * square);
    const double c22 = weft * (b / a) + 2 * diagonal * (b * b * b) / (a * square);
    const double c12 = 2 * diagonal * (a * b) / square; /* also G: forces along springs */
    return (struct mesh_elastic){.warp = c22 > 0 ? c11 - c12 * c12 / c22 : c11,
                                 .weft = c11 > 0 ? c22 - c12 * c12 / c11 : c22,
                                 .shear = c12,
                                 .poisson = c11 > 0 && c22 > 0 ? c12 / c22 : NAN};
}

/* With one diagonal, pulling shears a sheet until its diagonals have no strain, and shearing pushes
 * it along its threads. */
static struct mesh_elastic of_one(double warp, double weft, double diagonal, double a, double b)
{
    const int stiff = warp > 0 && weft > 0 && diagonal > 0;
    const double flow = stiff ? a * a / warp + b * b / weft + (a * a + b * b) / diagonal : INFINITY;
    return (struct mesh_elastic){.warp = warp * (a / b),
                                 .weft = weft * (b / a),
                                 .shear = a * b / flow,
                                 .poisson = warp > 0 && weft > 0 ? 0 : NAN};
}

struct mesh_elastic mesh_elastic_of(const struct mesh *mesh, const struct mesh_moduli *moduli)
{
    if (!mesh->grid_nx)
        return NONE;
    /* A bend spring of k over two cells is as stiff as four stretch springs of k over one. */
    const double warp = moduli->stretch + 4 * moduli->bend, weft = warp + moduli->weft_excess;
    const double a = mesh_distance(mesh->position, 0, 1);
    const double b = mesh_distance(mesh->position, 0, mesh->grid_nx);
    if (moduli->both_diagonals)
        return of_both(warp, weft, moduli->shear, a, b);
    if (mesh->grid_cells == MESH_ALTERNATE) /* as many of each, and nothing couples any more */
        return of_both(warp, weft, moduli->shear / 2, a, b);
    if (mesh->grid_cells == MESH_MIRRORED && moduli->shear > 0)
        return NONE;
    return of_one(warp, weft, moduli->shear, a, b);
}
