/* Ring k has 6 k vertices, so that neighbours along it are almost as far from each other as rings
 * are. Places are computed in the first quarter of the disc and mirrored: it is its own image in
 * both axes to the last bit. Sine and cosine are sums of powers, since those of a C library differ
 * in their last bits. */
#include "cloth/base/memory.h"
#include "cloth/mesh/mesh.h"

#include <stdlib.h>

static const double PI_3 = 1.04719755119659774615; /* pi / 3 */

/* The first vertex of a ring, of which the 0th is the centre. */
static uint32_t disc_start_of(uint32_t ring)
{
    return ring ? 1 + 3 * ring * (ring - 1) : 0;
}

/* cos(a) and sin(a) for 0 <= a <= pi / 4: the first term left out is below 1e-21. */
static void disc_turn(double a, double *cosine, double *sine)
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
        disc_turn(PI_3 * sixths, x, z);
    else
        disc_turn(PI_3 * rest, z, x);
}

/* The same of any j < 6 ring. */
static void disc_place(uint32_t ring, uint32_t j, double *x, double *z)
{
    const uint32_t half = 3 * ring, up = j > half ? 6 * ring - j : j;
    const uint32_t quarter = 2 * (uint64_t)up > half ? half - up : up;
    place_quarter(ring, quarter, x, z);
    *x = quarter == up ? *x : -*x;
    *z = up == j ? *z : -*z;
}

static void disc_place_vertices(double *x, double *uv, double radius, uint32_t rings)
{
    for (uint32_t ring = 0; ring <= rings; ring++) {
        const uint32_t n = ring ? 6 * ring : 1;
        const double r = radius * ring / rings;
        for (uint32_t j = 0; j < n; j++, x += 3, uv += 2) {
            double along = 0, across = 0;
            if (ring)
                disc_place(ring, j, &along, &across);
            x[0] = r * along;
            x[1] = 0;
            x[2] = r * across;
            uv[0] = x[0] + radius;
            uv[1] = x[2] + radius;
        }
    }
}

static uint32_t *disc_add(uint32_t *corner, uint32_t a, uint32_t b, uint32_t c)
{
    corner[0] = a;
    corner[1] = b;
    corner[2] = c;
    return corner + 3;
}

/* The triangles between a ring and the one inside it, wound so that normals are +y. */
static uint32_t *add_ring(uint32_t *corner, uint32_t ring)
{
    const uint32_t out = disc_start_of(ring), in = disc_start_of(ring - 1);
    const uint32_t n_out = 6 * ring, n_in = ring > 1 ? 6 * (ring - 1) : 1;
    for (uint32_t sixth = 0; sixth < 6; sixth++) {
        const uint32_t a = sixth * ring, b = sixth * (ring - 1);
        for (uint32_t j = 0; j < ring; j++) {
            const uint32_t inner = in + (b + j) % n_in, outer = out + (a + j + 1) % n_out;
            corner = disc_add(corner, inner, outer, out + a + j);
            if (j + 1 < ring)
                corner = disc_add(corner, inner, in + (b + j + 1) % n_in, outer);
        }
    }
    return corner;
}

int mesh_disc(struct mesh *mesh, double radius, uint32_t rings, struct cloth_error *error)
{
    *mesh = (struct mesh){0};
    if (rings < 1 || rings > MESH_DISC_RINGS || !(radius > 0 && radius < 1e300))
        return cloth_fail(error, CLOTH_E_INPUT,
                          "a disc has 1 to %d rings and a radius above 0, not %u and %g",
                          MESH_DISC_RINGS, rings, radius);
    const uint32_t n = disc_start_of(rings + 1), n_triangles = 6 * rings * rings;
    double *position = cloth_alloc(n, 3 * sizeof *position, error);
    double *uv = cloth_alloc(n, 2 * sizeof *uv, error);
    uint32_t *triangle = cloth_alloc(n_triangles, 3 * sizeof *triangle, error), *next = triangle;
    int code = CLOTH_E_MEMORY;
    if (position && uv && triangle) {
        disc_place_vertices(position, uv, radius, rings);
        for (uint32_t ring = 1; ring <= rings; ring++)
            next = add_ring(next, ring);
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
