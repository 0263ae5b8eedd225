/* Rows have nx and nx - 1 vertices by turns; those of shorter rows stand in the middle between
 * those of longer ones. So every triangle is equilateral, and the sheet is its own mirror image. */
#include "cloth/mesh/detail/equilateral.h"
#include "cloth/base/memory.h"

#include <math.h>
#include <stdlib.h>

double mesh_row_distance(double width, uint32_t nx)
{
    return width / (nx - 1.0) * sqrt(0.75);
}

/* The first vertex of a row. */
static uint32_t equilateral_start_of(uint32_t j, uint32_t nx)
{
    return j * nx - j / 2;
}

/* Place of the i-th of n points on a line, `step` metres apart and centred on 0: x(n - 1 - i) =
 * -x(i) to the last bit. */
static double equilateral_centred(double step, uint32_t i, uint32_t n)
{
    return step * (2.0 * i - (n - 1.0)) / 2;
}

static void equilateral_place_vertices(double *x, double *uv, double width, uint32_t nx,
                                       uint32_t ny)
{
    const double rise = mesh_row_distance(width, nx);
    for (uint32_t j = 0; j < ny; j++) {
        const uint32_t n = nx - j % 2;
        for (uint32_t i = 0; i < n; i++, x += 3, uv += 2) {
            x[0] = equilateral_centred(width / (nx - 1.0), i, n);
            x[1] = 0;
            x[2] = equilateral_centred(rise, j, ny);
            uv[0] = x[0] + width / 2;
            uv[1] = rise * j;
        }
    }
}

static uint32_t *equilateral_add(uint32_t *corner, uint32_t a, uint32_t b, uint32_t c)
{
    corner[0] = a;
    corner[1] = b;
    corner[2] = c;
    return corner + 3;
}

/* The triangles between rows j and j + 1, wound so that normals are +y. */
static uint32_t *add_strip(uint32_t *corner, uint32_t j, uint32_t nx)
{
    const uint32_t low = equilateral_start_of(j, nx), high = equilateral_start_of(j + 1, nx);
    for (uint32_t i = 0; i + 1 < nx; i++) {
        if (j % 2 == 0) {
            corner = equilateral_add(corner, low + i, high + i, low + i + 1);
            if (i + 2 < nx)
                corner = equilateral_add(corner, high + i, high + i + 1, low + i + 1);
        } else {
            corner = equilateral_add(corner, low + i, high + i, high + i + 1);
            if (i + 2 < nx)
                corner = equilateral_add(corner, low + i, high + i + 1, low + i + 1);
        }
    }
    return corner;
}

int mesh_equilateral(struct mesh *mesh, double width, uint32_t nx, uint32_t ny,
                     struct cloth_error *error)
{
    const uint32_t n = equilateral_start_of(ny, nx), n_triangles = (ny - 1) * (2 * nx - 3);
    double *position = cloth_alloc(n, 3 * sizeof *position, error);
    double *uv = cloth_alloc(n, 2 * sizeof *uv, error);
    uint32_t *triangle = cloth_alloc(n_triangles, 3 * sizeof *triangle, error), *next = triangle;
    int code = CLOTH_E_MEMORY;
    if (position && uv && triangle) {
        equilateral_place_vertices(position, uv, width, nx, ny);
        for (uint32_t j = 0; j + 1 < ny; j++)
            next = add_strip(next, j, nx);
        code = mesh_inline(mesh, n, position, 0, NULL, n_triangles, triangle, error);
    }
    free(position);
    free(triangle);
    if (code)
        free(uv);
    else
        mesh->uv = uv;
    return code;
}
