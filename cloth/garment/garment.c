/* The spacing that gives a wanted number of vertices is found by meshing: each try corrects it by
 * the last one's excess. */
#include "cloth/garment/garment.h"
#include "cloth/base/memory.h"
#include "cloth/garment/detail/flat.h"
#include "cloth/garment/detail/meshing.h"
#include "cloth/physics/curve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TRIES = 10, EARLY = 6 };
static const double CLOSE = 0.005; /* of the wanted number: near enough, */
static const double FAIR = 0.008;  /* and after the early tries */
static const uint32_t MOST = (uint32_t)1 << 27;

/* A lattice of triangles with edges h has 1.155 / h^2 vertices an area. A boundary of length P adds
 * about 0.365 P / h, since its vertices are nearer to each other. */
static const double INSIDE = 1.155, AROUND = 0.365;

static void measure_pattern(const struct garment_pattern *pattern, double *area, double *around)
{
    *area = *around = 0;
    for (uint32_t p = 0; p < pattern->n_panels; p++) {
        *area += fabs(garment_panel_area(&pattern->panel[p]));
        for (uint32_t e = 0; e < pattern->panel[p].n_edges; e++)
            *around += garment_edge_length(&pattern->panel[p], e);
    }
}

double garment_vertices(const struct garment_pattern *pattern, double edge)
{
    double area, around;
    measure_pattern(pattern, &area, &around);
    return INSIDE * area / (edge * edge) + AROUND * around / edge;
}

/* The spacing that gives about n vertices. */
static double first_spacing(const struct garment_pattern *pattern, double n)
{
    double area, around;
    measure_pattern(pattern, &area, &around);
    const double a = INSIDE * area, b = AROUND * around;
    return (b + sqrt(b * b + 4 * a * n)) / (2 * n);
}

/* The next spacing to try: between those that gave too few and too many, else by the last error. */
static double next_spacing(double spacing, double n, double wanted, double fine, double coarse)
{
    const double next = spacing * sqrt(n / wanted);
    return next > fine && next < coarse    ? next
           : coarse < INFINITY && fine > 0 ? 0.5 * (fine + coarse)
                                           : next;
}

static uint32_t count_vertices(const struct meshing *meshing)
{
    uint32_t n = 0;
    for (uint32_t p = 0; p < meshing->pattern->n_panels; p++)
        n += meshing->panel[p].plane.n;
    return n;
}

static void mesh_by_count(struct meshing *meshing, uint32_t wanted)
{
    double spacing = first_spacing(meshing->pattern, wanted), best = spacing, least = INFINITY;
    double fine = 0, coarse = INFINITY; /* spacings that gave too many and too few */
    const struct cloth_error *error = meshing->error;
    for (int k = 0; k < TRIES && least > (k < EARLY ? CLOSE : FAIR) && !error->code; k++) {
        meshing_mesh(meshing, spacing);
        const double n = count_vertices(meshing), off = fabs(n - wanted) / wanted;
        if (off < least) {
            least = off;
            best = spacing;
        }
        if (n > wanted)
            fine = spacing;
        else
            coarse = spacing;
        if (off > CLOSE)
            spacing = next_spacing(spacing, n, wanted, fine, coarse);
    }
    if (!error->code && meshing->spacing != best)
        meshing_mesh(meshing, best);
}

static int check_fineness(const struct garment_fineness *fineness,
                          const struct garment_pattern *pattern, struct cloth_error *error)
{
    if (fineness->vertices && (fineness->vertices < 3 || fineness->vertices > MOST))
        return cloth_fail(error, CLOTH_E_INPUT, "%u vertices cannot be had: 3 to %u",
                          fineness->vertices, MOST);
    if (!fineness->vertices && !(fineness->edge > 0 && isfinite(fineness->edge)))
        return cloth_fail(error, CLOTH_E_INPUT, "edges of %g m cannot be had", fineness->edge);
    const double about = fineness->vertices ? 0 : garment_vertices(pattern, fineness->edge);
    if (about > MOST)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "edges of %g m give about %.1g vertices; up to %u can be had",
                          fineness->edge, about, MOST);
    return CLOTH_OK;
}

static int make_room(struct garment *garment, const struct meshing *meshing,
                     struct cloth_error *error)
{
    const struct garment_pattern *pattern = meshing->pattern;
    uint64_t n = 0, n_triangles = 0;
    for (uint32_t p = 0; p < pattern->n_panels; p++) {
        n += meshing->panel[p].plane.n;
        n_triangles += meshing->panel[p].plane.n_triangles;
    }
    if (n > MOST)
        return cloth_fail(error, CLOTH_E_INPUT, "%ju vertices are too many: up to %u", (uintmax_t)n,
                          MOST);
    struct cloth_pool *memory = &garment->memory;
    garment->position = cloth_take(memory, n, sizeof *garment->position, error);
    garment->uv = cloth_take(memory, n, sizeof *garment->uv, error);
    garment->triangle = cloth_take(memory, n_triangles, sizeof *garment->triangle, error);
    garment->excused = cloth_take(memory, n_triangles, 1, error);
    garment->piece = cloth_take(memory, pattern->n_panels, sizeof *garment->piece, error);
    for (uint32_t p = 0; p < pattern->n_panels && garment->piece; p++)
        garment->piece[p].start = cloth_take(memory, (size_t)pattern->panel[p].n_edges + 1,
                                             sizeof *garment->piece->start, error);
    if (memory->lacks)
        return CLOTH_E_MEMORY;
    garment->n_vertices = (uint32_t)n;
    garment->n_triangles = (uint32_t)n_triangles;
    return CLOTH_OK;
}

/* Maya's rotation x, y, z: the vector turns about x first. Only the first two columns are needed,
 * since panels are flat. */
static void panel_axes(const double degrees[3], double axis[2][3])
{
    double c[3], s[3];
    for (int k = 0; k < 3; k++)
        phys_turn(degrees[k], &c[k], &s[k]);
    axis[0][0] = c[2] * c[1];
    axis[0][1] = s[2] * c[1];
    axis[0][2] = -s[1];
    axis[1][0] = c[2] * s[1] * s[0] - s[2] * c[0];
    axis[1][1] = s[2] * s[1] * s[0] + c[2] * c[0];
    axis[1][2] = c[1] * s[0];
}

static void put_piece(struct garment *garment, struct meshing *meshing, uint32_t p, uint32_t first,
                      uint32_t first_triangle)
{
    const struct garment_panel *panel = &meshing->pattern->panel[p];
    struct meshing_panel *of = &meshing->panel[p];
    const uint32_t n = of->plane.n, n_triangles = of->plane.n_triangles;
    double axis[2][3];
    panel_axes(panel->rotate, axis);
    for (uint32_t v = 0; v < n; v++) {
        const double *uv = of->plane.place[v], x = of->clockwise ? -uv[0] : uv[0];
        garment->uv[first + v][0] = panel->warp_up ? uv[1] : uv[0];
        garment->uv[first + v][1] = panel->warp_up ? -uv[0] : uv[1];
        for (int k = 0; k < 3; k++)
            garment->position[first + v][k] =
                (x * axis[0][k] + uv[1] * axis[1][k]) + panel->translate[k];
    }
    for (uint32_t t = 0; t < n_triangles; t++) {
        for (int i = 0; i < 3; i++)
            garment->triangle[first_triangle + t][i] = first + of->plane.triangle[t].vertex[i];
        garment->excused[first_triangle + t] = flat_excused(&of->plane, of->sharp, t);
    }
    uint32_t *start = garment->piece[p].start;
    memcpy(start, of->start, ((size_t)panel->n_edges + 1) * sizeof *start);
    garment->piece[p] = (struct garment_piece){first, n, first_triangle, n_triangles, start};
}

static int put_pieces(struct garment *garment, struct meshing *meshing, struct cloth_error *error)
{
    int code = make_room(garment, meshing, error);
    uint32_t first = 0, first_triangle = 0;
    if (code)
        return code;
    garment->edge = meshing->spacing;
    garment->n_pieces = meshing->pattern->n_panels;
    for (uint32_t p = 0; p < garment->n_pieces; p++) {
        put_piece(garment, meshing, p, first, first_triangle);
        first += garment->piece[p].n_vertices;
        first_triangle += garment->piece[p].n_triangles;
    }
    code = seams_make(garment, meshing->pattern, error);
    return code ? code : corners_open(garment, meshing, error);
}

int garment_make(struct garment *garment, const struct garment_pattern *pattern,
                 const struct garment_fineness *fineness, struct cloth_error *error)
{
    struct cloth_error own = {0};
    struct meshing meshing = {0};
    *garment = (struct garment){0};
    if (!check_fineness(fineness, pattern, &own))
        meshing_make(&meshing, pattern, &own);
    if (!own.code && fineness->vertices)
        mesh_by_count(&meshing, fineness->vertices);
    else if (!own.code)
        meshing_mesh(&meshing, fineness->edge);
    if (!own.code)
        put_pieces(garment, &meshing, &own);
    meshing_free(&meshing);
    return own.code ? cloth_fail(error, own.code, "%s", own.text) : CLOTH_OK;
}

void garment_free(struct garment *garment)
{
    cloth_pool_free(&garment->memory);
    *garment = (struct garment){0};
}

double garment_least_angle(const struct garment *garment, uint32_t *below)
{
    static const double cosine_30 = 0.86602540378443864676;
    double most = 0.5;
    *below = 0;
    for (uint32_t t = 0; t < garment->n_triangles; t++) {
        const uint32_t *v = garment->triangle[t];
        if (garment->excused[t])
            continue;
        const double cosine =
            delaunay_sharpness(garment->uv[v[0]], garment->uv[v[1]], garment->uv[v[2]]);
        *below += cosine > cosine_30;
        most = fmax(most, fmin(cosine, 1));
    }
    return acos(most) * (180 / 3.14159265358979323846);
}
