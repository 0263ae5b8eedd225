/* Flat sheets. Places of grids and of rows of triangles are x(n - 1 - i) = -x(i) to the last bit,
 * and those of a disc are computed in its first quarter and mirrored: each is its own mirror image.
 *
 * Rows of equilateral triangles have nx and nx - 1 vertices by turns; those of shorter rows stand
 * in the middle between those of longer ones. Ring k of a disc has 6 k vertices, so that neighbours
 * along it are almost as far from each other as rings are. */
#include "cloth/base/memory.h"
#include "cloth/mesh/detail/finish.h"

#include <math.h>
#include <stdlib.h>

static const double PI_3 = 1.04719755119659774615; /* pi / 3 */

/* A sheet that stores its triangles, while it is made. */
struct sheet {
    uint32_t n, n_triangles; /* that were added */
    double *position, *uv;
    uint32_t *triangle;
};

static bool sheet_begin(struct sheet *sheet, uint32_t n, uint32_t n_triangles,
                        struct cloth_error *error)
{
    *sheet = (struct sheet){
        .position = cloth_alloc(n, 3 * sizeof *sheet->position, error),
        .uv = cloth_alloc(n, 2 * sizeof *sheet->uv, error),
        .triangle = cloth_alloc(n_triangles, 3 * sizeof *sheet->triangle, error),
    };
    return sheet->position && sheet->uv && sheet->triangle;
}

static void sheet_add_vertex(struct sheet *sheet, double x, double z, double u, double v)
{
    double *position = sheet->position + 3 * (size_t)sheet->n;
    double *uv = sheet->uv + 2 * (size_t)sheet->n++;
    position[0] = x;
    position[2] = z;
    uv[0] = u;
    uv[1] = v;
}

static void sheet_add_triangle(struct sheet *sheet, uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t *corner = sheet->triangle + 3 * (size_t)sheet->n_triangles++;
    corner[0] = a;
    corner[1] = b;
    corner[2] = c;
}

/* Makes a mesh of it. made: whether it could begin. */
static int sheet_end(struct sheet *sheet, bool made, struct mesh *mesh, struct cloth_error *error)
{
    const int code = made ? mesh_inline(mesh, sheet->n, sheet->position, 0, NULL,
                                        sheet->n_triangles, sheet->triangle, error)
                          : CLOTH_E_MEMORY;
    if (!code)
        mesh->uv = sheet->uv;
    else
        free(sheet->uv);
    free(sheet->position);
    free(sheet->triangle);
    return code;
}

/* ---- Rows of equilateral triangles ---- */

double mesh_row_distance(double width, uint32_t nx)
{
    return width / (nx - 1.0) * sqrt(0.75);
}

/* The first vertex of a row. */
static uint32_t row_start(uint32_t j, uint32_t nx)
{
    return j * nx - j / 2;
}

/* Place of the i-th of n points on a line, `step` metres apart and centred on 0. */
static double row_place(double step, uint32_t i, uint32_t n)
{
    return step * (2.0 * i - (n - 1.0)) / 2;
}

/* The triangles between rows j and j + 1, wound so that normals are +y. */
static void add_strip(struct sheet *sheet, uint32_t j, uint32_t nx)
{
    const uint32_t low = row_start(j, nx), high = row_start(j + 1, nx);
    for (uint32_t i = 0; i + 1 < nx; i++) {
        const bool inner = i + 2 < nx;
        sheet_add_triangle(sheet, low + i, high + i, j % 2 ? high + i + 1 : low + i + 1);
        if (inner)
            sheet_add_triangle(sheet, j % 2 ? low + i : high + i, high + i + 1, low + i + 1);
    }
}

static int sheet_make_rows(struct mesh *mesh, double width, uint32_t nx, uint32_t ny,
                           struct cloth_error *error)
{
    const double step = width / (nx - 1.0), rise = mesh_row_distance(width, nx);
    struct sheet sheet;
    const bool made = sheet_begin(&sheet, row_start(ny, nx), (ny - 1) * (2 * nx - 3), error);
    for (uint32_t j = 0; made && j < ny; j++)
        for (uint32_t i = 0; i < nx - j % 2; i++) {
            const double x = row_place(step, i, nx - j % 2);
            sheet_add_vertex(&sheet, x, row_place(rise, j, ny), x + width / 2, rise * j);
        }
    for (uint32_t j = 0; made && j + 1 < ny; j++)
        add_strip(&sheet, j, nx);
    return sheet_end(&sheet, made, mesh, error);
}

/* ---- Grids ---- */

static int grid_check_size(double width, double height, uint32_t nx, uint32_t ny,
                           struct cloth_error *error)
{
    if (!isfinite(width) || !isfinite(height) || width <= 0 || height <= 0)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "a grid of %g m by %g m cannot be made; both must be positive", width,
                          height);
    if (nx < 2 || ny < 2)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "a grid of %u x %u vertices has no cell; both numbers must be at least 2",
                          nx, ny);
    if ((uint64_t)nx * ny > MESH_MAX / 6)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "a grid of %u x %u vertices is too large; at most %u vertices", nx, ny,
                          MESH_MAX / 6);
    return CLOTH_OK;
}

/* Place of the i-th of n points that divide a length centred on 0. */
static double grid_place(double length, uint32_t i, uint32_t n)
{
    return length * (2.0 * i - (n - 1.0)) / (2.0 * (n - 1.0));
}

int mesh_grid(struct mesh *mesh, double width, double height, uint32_t nx, uint32_t ny,
              enum mesh_cells cells, struct cloth_error *error)
{
    *mesh = (struct mesh){0};
    const bool rows = cells == MESH_EQUILATERAL;
    const int code = grid_check_size(width, rows ? width : height, nx, ny, error);
    if (code || rows)
        return code ? code : sheet_make_rows(mesh, width, nx, ny, error);
    double *x = cloth_alloc((size_t)nx * ny, 3 * sizeof *x, error);
    if (!x)
        return CLOTH_E_MEMORY;
    *mesh = (struct mesh){.n_vertices = nx * ny,
                          .position = x,
                          .n_faces = 2 * (nx - 1) * (ny - 1),
                          .n_triangles = 2 * (nx - 1) * (ny - 1),
                          .grid_nx = nx,
                          .grid_ny = ny,
                          .grid_width = width,
                          .grid_height = height,
                          .grid_cells = cells};
    for (uint32_t j = 0; j < ny; j++)
        for (uint32_t i = 0; i < nx; i++, x += 3) {
            x[0] = grid_place(width, i, nx);
            x[2] = grid_place(height, j, ny);
        }
    return CLOTH_OK;
}

/* ---- Discs ---- */

/* The first vertex of a ring, of which the 0th is the centre. */
static uint32_t ring_start(uint32_t ring)
{
    return ring ? 1 + 3 * ring * (ring - 1) : 0;
}

/* cos(a) and sin(a) for 0 <= a <= pi / 4: the first term left out is below 1e-21. Those of a C
 * library differ in their last bits. */
static void ring_turn(double a, double *cosine, double *sine)
{
    double c = 1, s = 1;
    for (int k = 18; k > 0; k -= 2) {
        c = 1 - a * a / (k * (k - 1)) * c;
        s = 1 - a * a / (k * (k + 1)) * s;
    }
    *cosine = c;
    *sine = a * s;
}

/* Place of the j-th vertex of a ring on a circle of radius 1; 2 j <= 3 ring: in the first quarter,
 * from x to z. */
static void place_quarter(uint32_t ring, uint32_t j, double *x, double *z)
{
    const double sixths = (double)j / ring, rest = (3.0 * ring - 2.0 * j) / (2.0 * ring);
    if (4 * (uint64_t)j <= 3 * (uint64_t)ring)
        ring_turn(PI_3 * sixths, x, z);
    else
        ring_turn(PI_3 * rest, z, x);
}

/* The same of any j < 6 ring. */
static void ring_place(uint32_t ring, uint32_t j, double *x, double *z)
{
    const uint32_t half = 3 * ring, up = j > half ? 6 * ring - j : j;
    const uint32_t quarter = 2 * (uint64_t)up > half ? half - up : up;
    place_quarter(ring, quarter, x, z);
    *x = quarter == up ? *x : -*x;
    *z = up == j ? *z : -*z;
}

static void add_ring(struct sheet *sheet, double radius, uint32_t ring, uint32_t rings)
{
    const double r = radius * ring / rings;
    for (uint32_t j = 0; j < (ring ? 6 * ring : 1); j++) {
        double x = 0, z = 0;
        if (ring)
            ring_place(ring, j, &x, &z);
        sheet_add_vertex(sheet, r * x, r * z, r * x + radius, r * z + radius);
    }
}

/* The triangles between a ring and the one inside it, wound so that normals are +y. */
static void fill_ring(struct sheet *sheet, uint32_t ring)
{
    const uint32_t out = ring_start(ring), in = ring_start(ring - 1);
    const uint32_t n_out = 6 * ring, n_in = ring > 1 ? 6 * (ring - 1) : 1;
    for (uint32_t sixth = 0; sixth < 6; sixth++) {
        const uint32_t a = sixth * ring, b = sixth * (ring - 1);
        for (uint32_t j = 0; j < ring; j++) {
            const uint32_t inner = in + (b + j) % n_in, outer = out + (a + j + 1) % n_out;
            sheet_add_triangle(sheet, inner, outer, out + a + j);
            if (j + 1 < ring)
                sheet_add_triangle(sheet, inner, in + (b + j + 1) % n_in, outer);
        }
    }
}

int mesh_disc(struct mesh *mesh, double radius, uint32_t rings, struct cloth_error *error)
{
    *mesh = (struct mesh){0};
    if (rings < 1 || rings > MESH_DISC_RINGS || !(radius > 0 && radius < 1e300))
        return cloth_fail(error, CLOTH_E_INPUT,
                          "a disc has 1 to %d rings and a radius above 0, not %u and %g",
                          MESH_DISC_RINGS, rings, radius);
    struct sheet sheet;
    const bool made = sheet_begin(&sheet, ring_start(rings + 1), 6 * rings * rings, error);
    for (uint32_t ring = 0; made && ring <= rings; ring++)
        add_ring(&sheet, radius, ring, rings);
    for (uint32_t ring = 1; made && ring <= rings; ring++)
        fill_ring(&sheet, ring);
    return sheet_end(&sheet, made, mesh, error);
}
