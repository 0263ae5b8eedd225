/* Springs come sorted by (a, b); between the same vertices stretch comes before bend. A grid's do
 * so by themselves. */
#include "cloth/mesh/lattice.h"

#include "cloth/base/memory.h"
#include "cloth/mesh/detail/sides.h"

#include <math.h>
#include <stdlib.h>

/* Makes springs. They are shown to `visit` unless it is NULL, else counted, and stored if so
 * wanted.
 */
struct builder {
    const struct mesh *mesh;
    const struct mesh_moduli *moduli;
    struct cloth_error *error;
    void (*visit)(void *to, const struct mesh_spring *spring);
    void *to;
    uint32_t n;
    bool stores;
    struct cloth_list springs;
};

static int take_spring(struct builder *builder, const struct mesh_spring *spring)
{
    if (builder->visit) {
        builder->visit(builder->to, spring);
        return CLOTH_OK;
    }
    if (builder->n++ == UINT32_MAX)
        return cloth_fail(builder->error, CLOTH_E_INPUT,
                          "the mesh has more than %u springs; use a coarser one", UINT32_MAX);
    return builder->stores
               ? cloth_list_put(&builder->springs, spring, sizeof *spring, builder->error)
               : CLOTH_OK;
}

static int add_spring(struct builder *builder, uint32_t a, uint32_t b, enum mesh_spring_kind kind,
                      double stiffness, double length)
{
    if (!(length > 0) || !isfinite(length))
        return cloth_fail(builder->error, CLOTH_E_INPUT,
                          "vertices %u and %u (counted from 1) are %g m apart; vertices that a "
                          "spring joins need a finite distance above 0",
                          a + 1, b + 1, length);
    if (stiffness == 0)
        return CLOTH_OK;
    if (!isfinite(stiffness))
        return cloth_fail(builder->error, CLOTH_E_INPUT,
                          "the spring between vertices %u and %u (counted from 1) has a stiffness "
                          "of %g N/m; it must be finite",
                          a + 1, b + 1, stiffness);
    const struct mesh_spring spring = {a < b ? a : b, a < b ? b : a, stiffness, length, kind};
    return take_spring(builder, &spring);
}

/* The moduli of a spring between two vertices. */
static const struct mesh_moduli *moduli_of(const struct builder *builder, uint32_t a, uint32_t b)
{
    const struct mesh_regions *regions = builder->moduli->regions;
    const int region = regions ? mesh_region(regions->mask, 2, (const uint32_t[]){a, b}) : -1;
    return region < 0 ? builder->moduli : regions->moduli + region;
}

/* Modulus of a grid's spring. */
static double modulus_along(const struct mesh_moduli *moduli, enum mesh_spring_kind kind, int weft)
{
    if (kind == MESH_STRETCH)
        return weft ? moduli->stretch + moduli->weft_excess : moduli->stretch;
    return kind == MESH_BEND ? moduli->bend : moduli->shear;
}

/* The springs of a grid's vertex (i, j) to later vertices, nearest number first. */
static int add_grid_vertex(struct builder *builder, uint32_t i, uint32_t j)
{
    uint32_t nx = builder->mesh->grid_nx, ny = builder->mesh->grid_ny, a = j * nx + i;
    double along = j == 0 || j == ny - 1 ? 0.5 : 1; /* half where the row is the border */
    double across = i == 0 || i == nx - 1 ? 0.5 : 1;
    const int both = builder->moduli->both_diagonals;
    const struct mesh *mesh = builder->mesh;
    const struct {
        int exists;
        uint32_t b;
        enum mesh_spring_kind kind;
        int weft;
        double part; /* of the modulus */
    } springs[] = {
        {i + 1 < nx, a + 1, MESH_STRETCH, 0, along},
        {i + 2 < nx, a + 2, MESH_BEND, 0, along},
        {i > 0 && j + 1 < ny && (both || mesh_cell_turned(mesh, i - 1, j)), a + nx - 1, MESH_SHEAR,
         0, 1},
        {j + 1 < ny, a + nx, MESH_STRETCH, 1, across},
        {i + 1 < nx && j + 1 < ny && (both || !mesh_cell_turned(mesh, i, j)), a + nx + 1,
         MESH_SHEAR, 0, 1},
        {j + 2 < ny, a + 2 * nx, MESH_BEND, 1, across},
    };
    for (size_t s = 0; s < sizeof springs / sizeof *springs; s++) {
        if (!springs[s].exists)
            continue;
        const uint32_t b = springs[s].b;
        const double k = springs[s].part *
                         modulus_along(moduli_of(builder, a, b), springs[s].kind, springs[s].weft);
        const double length = mesh_distance(mesh->position, a, b);
        int code = k == 0 ? CLOTH_OK : add_spring(builder, a, b, springs[s].kind, k, length);
        if (code)
            return code;
    }
    return CLOTH_OK;
}

static int add_grid(struct builder *builder)
{
    int code = CLOTH_OK;
    for (uint32_t j = 0; j < builder->mesh->grid_ny && !code; j++)
        for (uint32_t i = 0; i < builder->mesh->grid_nx && !code; i++)
            code = add_grid_vertex(builder, i, j);
    return code;
}

/* Turns components along u and v into those along warp and weft. */
static void turn_to_grain(const struct mesh_regions *regions, const struct mesh_edge *edge,
                          double *u, double *v)
{
    const uint32_t end[2] = {edge->a, edge->b};
    const int region = regions ? mesh_region(regions->grain_mask, 2, end) : -1;
    if (region < 0)
        return;
    const double c = regions->grain[region][0], s = regions->grain[region][1], along = *u;
    *u = c * along + s * *v;
    *v = c * *v - s * along;
}

/* How much of a modulus along an edge is that of the weft, as the uv of one of its triangles says.
 */
static double weft_share(const struct builder *builder, const struct mesh_edge *edge,
                         uint32_t triangle)
{
    const struct mesh *mesh = builder->mesh;
    double a[2], b[2];
    mesh_uv(mesh, mesh_uv_number(mesh, triangle, edge->a), a);
    mesh_uv(mesh, mesh_uv_number(mesh, triangle, edge->b), b);
    double along = b[0] - a[0], across = b[1] - a[1];
    turn_to_grain(builder->moduli->regions, edge, &along, &across);
    const double u = along * along, v = across * across;
    return u + v > 0 ? v / (u + v) : 0;
}

/* The modulus along an edge: the mean over its triangles. */
static int modulus_of(const struct builder *builder, const struct mesh_edge *edge, double *modulus)
{
    const struct mesh_moduli *moduli = moduli_of(builder, edge->a, edge->b);
    const uint32_t *triangle = edge->triangle;
    double uv[2];
    *modulus = moduli->stretch;
    if (moduli->weft_excess == 0)
        return CLOTH_OK;
    if (!mesh_uv(builder->mesh, edge->a, uv))
        return cloth_fail(builder->error, CLOTH_E_INPUT,
                          "moduli of springs along warp and weft differ, which needs a mesh with "
                          "uv; a grid, an OBJ file with vt, or one modulus is expected");
    double share = weft_share(builder, edge, triangle[0]);
    if (triangle[1] != UINT32_MAX)
        share = (share + weft_share(builder, edge, triangle[1])) / 2;
    *modulus += moduli->weft_excess * share;
    return CLOTH_OK;
}

/* Adds the spring of a triangle's side. */
static int add_side(struct builder *builder, const struct mesh_edge *edge)
{
    double modulus;
    const int code = modulus_of(builder, edge, &modulus);
    if (code)
        return code;
    const double length = mesh_length(builder->mesh, edge->triangle, edge->a, edge->b);
    return add_spring(builder, edge->a, edge->b, MESH_STRETCH,
                      modulus * (edge->area / length / length), length);
}

static int add_lone_edge(struct builder *builder, const struct mesh_edge *edge)
{
    const double length = mesh_distance(builder->mesh->position, edge->a, edge->b);
    const double ea = moduli_of(builder, edge->a, edge->b)->ea;
    return add_spring(builder, edge->a, edge->b, MESH_STRETCH, length > 0 ? ea / length : 0,
                      length);
}

/* Adds the spring between the opposite vertices. */
static int add_bend(struct builder *builder, const struct mesh_edge *edge, double modulus)
{
    const uint32_t corner[4] = {edge->a, edge->b, edge->opposite[0], edge->opposite[1]};
    double x[12];
    mesh_hinge(builder->mesh, edge->triangle, corner, x);
    const double length = mesh_distance(x, 2, 3);
    return add_spring(builder, corner[2], corner[3], MESH_BEND,
                      modulus * (edge->area / length / length), length);
}

/* All stretch springs, then all bend springs, each in edge order. */
static int add_edges(struct builder *builder, const struct mesh_edges *edges)
{
    int code = CLOTH_OK;
    for (uint32_t e = 0; e < edges->n && !code; e++)
        code = edges->edge[e].opposite[0] == UINT32_MAX ? add_lone_edge(builder, &edges->edge[e])
                                                        : add_side(builder, &edges->edge[e]);
    for (uint32_t e = 0; e < edges->n && !code; e++) {
        const struct mesh_edge *edge = &edges->edge[e];
        uint32_t a = edge->opposite[0], b = edge->opposite[1];
        const double modulus = b == UINT32_MAX || a == b ? 0 : moduli_of(builder, a, b)->bend;
        if (modulus != 0)
            code = add_bend(builder, edge, modulus);
    }
    return code;
}

static int sort_springs(struct mesh_lattice *lattice, const struct builder *builder)
{
    const struct mesh_spring *spring = builder->springs.items;
    const size_t n = builder->springs.n;
    uint32_t *pair = cloth_alloc(n, 2 * sizeof *pair, builder->error);
    uint32_t *order = cloth_alloc(n, sizeof *order, builder->error);
    lattice->spring = cloth_alloc(n, sizeof *lattice->spring, builder->error);
    int code = pair && order && lattice->spring ? CLOTH_OK : CLOTH_E_MEMORY;
    for (size_t s = 0; s < n && !code; s++) {
        pair[2 * s] = spring[s].a;
        pair[2 * s + 1] = spring[s].b;
    }
    if (!code)
        code = mesh_sort_pairs(order, n, pair, builder->mesh->n_vertices, builder->error);
    for (size_t s = 0; s < n && !code; s++)
        lattice->spring[s] = spring[order[s]];
    free(pair);
    free(order);
    return code;
}

static int build_from_edges(struct mesh_lattice *lattice, struct builder *builder)
{
    struct mesh_edges edges = {0};
    builder->stores = true;
    int code = mesh_edges_find(&edges, builder->mesh, builder->error);
    if (!code)
        code = add_edges(builder, &edges);
    mesh_edges_free(&edges);
    if (!code)
        code = sort_springs(lattice, builder);
    free(builder->springs.items);
    return code;
}

int mesh_lattice_build(struct mesh_lattice *lattice, const struct mesh *mesh,
                       const struct mesh_moduli *moduli, struct cloth_error *error)
{
    struct builder builder = {.mesh = mesh, .moduli = moduli, .error = error};
    *lattice = (struct mesh_lattice){.mesh = mesh, .moduli = *moduli};
    const int code = mesh->grid_nx ? add_grid(&builder) : build_from_edges(lattice, &builder);
    lattice->n = builder.n;
    if (code)
        mesh_lattice_free(lattice);
    return code;
}

void mesh_lattice_each(const struct mesh_lattice *lattice,
                       void (*visit)(void *to, const struct mesh_spring *spring), void *to)
{
    struct builder builder = {
        .mesh = lattice->mesh, .moduli = &lattice->moduli, .visit = visit, .to = to};
    if (lattice->mesh && lattice->mesh->grid_nx)
        add_grid(&builder); /* built once without a failure */
    for (uint32_t s = 0; lattice->spring && s < lattice->n; s++)
        visit(to, lattice->spring + s);
}

void mesh_lattice_free(struct mesh_lattice *lattice)
{
    free(lattice->spring);
    *lattice = (struct mesh_lattice){0};
}
