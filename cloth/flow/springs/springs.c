/* Springs keep the order of their mesh, cloth after cloth, with the links of its elements after
 * them; then come joints. */
#include "cloth/flow/run/source.h"

#include "cloth/base/memory.h"

#include <string.h>

/* Finds the moduli of the regions of a cloth, for its lattice. */
static int find_regions(struct flow_springs *springs, uint32_t c, struct mesh_regions *regions,
                        struct cloth_error *error)
{
    const struct model_cloth *cloth = springs->model->cloths + c;
    struct mesh_moduli *moduli =
        cloth_take(&springs->memory, cloth->n_regions, sizeof *moduli, error);
    if (!moduli)
        return CLOTH_E_MEMORY;
    for (uint32_t i = 0; i < cloth->n_regions; i++)
        moduli[i] = model_moduli(springs->model->materials + cloth->region[i]);
    *regions = (struct mesh_regions){cloth->mask, moduli, cloth->grain_mask,
                                     (const double(*)[2])cloth->grain};
    return CLOTH_OK;
}

/* Edges beside triangles are in no lattice, which would refuse those without a length. */
static int springs_check_edges(const struct flow_springs *springs, uint32_t c,
                               struct cloth_error *error)
{
    const struct model_cloth *cloth = springs->model->cloths + c;
    const struct mesh_edges *edges = springs->elements->edges + c;
    const double *position = model_rest(cloth)->position;
    for (uint32_t e = 0; e < edges->n; e++) {
        const struct mesh_edge *edge = edges->edge + e;
        if (edge->opposite[0] == UINT32_MAX &&
            !memcmp(position + 3 * (size_t)edge->a, position + 3 * (size_t)edge->b,
                    3 * sizeof *position))
            return model_fail(cloth->mesh_place, error,
                              "cloth '%.60s': vertices %u and %u (counted from 1) are 0 m apart; "
                              "the edge that joins them needs a length",
                              cloth->name, edge->a + 1, edge->b + 1);
    }
    return CLOTH_OK;
}

static int springs_make_cloth(struct flow_springs *springs, uint32_t c, struct cloth_error *error)
{
    const struct model_cloth *cloth = springs->model->cloths + c;
    struct mesh_moduli moduli = model_moduli(model_material(springs->model, cloth, 0));
    struct cloth_error inner = {0};
    if (model_has_triangles(springs->model, cloth))
        return springs_check_edges(springs, c, error);
    const bool parts = cloth->mask || cloth->grain_mask;
    int code = parts ? find_regions(springs, c, springs->regions + c, error) : CLOTH_OK;
    if (code)
        return code;
    moduli.regions = parts ? springs->regions + c : NULL;
    code = mesh_lattice_build(springs->lattice + c, model_rest(cloth), &moduli, &inner);
    if (code == CLOTH_E_INPUT)
        model_fail(cloth->mesh_place, error, "cloth '%.60s': %s", cloth->name, inner.text);
    else if (code)
        cloth_fail(error, code, "%s", inner.text);
    return code;
}

int flow_springs_make(struct flow_springs *springs, const struct model *model,
                      const struct flow_welds *welds, const struct element_cloths *elements,
                      struct cloth_error *error)
{
    *springs = (struct flow_springs){.model = model, .welds = welds, .elements = elements};
    struct cloth_pool *memory = &springs->memory;
    springs->lattice = cloth_take(memory, model->n_cloths, sizeof *springs->lattice, error);
    springs->regions = cloth_take(memory, model->n_cloths, sizeof *springs->regions, error);
    int code = memory->lacks ? CLOTH_E_MEMORY : CLOTH_OK;
    for (uint32_t c = 0; c < model->n_cloths && !code; c++)
        code = springs_make_cloth(springs, c, error);
    if (code)
        flow_springs_free(springs);
    return code;
}

struct visitor {
    void (*visit)(void *to, const struct flow_spring *spring);
    void *to;
    uint32_t first;
    const struct model *model;
    const struct element_cloths *elements;
    uint32_t number; /* of the cloth */
    const struct model_cloth *cloth;
};

/* The material of a link between two vertices of the cloth's mesh. */
static const struct model_material *springs_material_of(const struct visitor *visitor, uint32_t a,
                                                        uint32_t b)
{
    return visitor->model->materials +
           model_material_of(visitor->cloth, 2, (const uint32_t[]){a, b});
}

/* NULL: none. */
static const struct model_correction *correction_of(const struct visitor *visitor, uint32_t a,
                                                    uint32_t b)
{
    const struct model_correction *correction = &springs_material_of(visitor, a, b)->correction;
    return visitor->model->correction_rounds && correction->rounds ? correction : NULL;
}

/* Stiffness as the lattice of a mesh of that size has it: that of a grid's springs stays. A lone
 * edge has no weft: its stiffness goes with its length, so that EA stays. */
static struct element_size size_of(const struct visitor *visitor, uint32_t a, uint32_t b)
{
    if (!visitor->model->sizes)
        return (struct element_size){.along = 1};
    const uint32_t end[2] = {a, b};
    const struct mesh_edge *edge = mesh_edges_get(visitor->elements->edges + visitor->number, a, b);
    const uint32_t triangle = edge ? edge->triangle[0] : UINT32_MAX;
    struct element_size size =
        element_size_of(visitor->elements, visitor->number, 2, end, triangle);
    if (edge && edge->opposite[0] == UINT32_MAX)
        size = (struct element_size){{size.curve[0], 0}, 1, false};
    size.keeps = model_rest(visitor->cloth)->grid_nx;
    return size;
}

/* damping: s, times the stiffness. stretch: it counts as such a spring. */
static void visit_spring(const struct visitor *visitor, uint32_t a, uint32_t b, double stiffness,
                         double damping, double length, bool stretch)
{
    const struct flow_spring spring = {.a = visitor->first + (a < b ? a : b),
                                       .b = visitor->first + (a < b ? b : a),
                                       .stiffness = stiffness,
                                       .damping = damping * stiffness,
                                       .length = length,
                                       .stretch = stretch,
                                       .correction = stretch ? correction_of(visitor, a, b) : NULL,
                                       .size = size_of(visitor, a, b)};
    visitor->visit(visitor->to, &spring);
}

static void springs_pass_on(void *context, const struct mesh_spring *s)
{
    const struct visitor *visitor = context;
    const struct model_material *material = springs_material_of(visitor, s->a, s->b);
    visit_spring(visitor, s->a, s->b, s->stiffness,
                 s->kind == MESH_BEND ? model_damping_bending(material)
                                      : material->damping_stiffness,
                 s->length, s->kind == MESH_STRETCH);
}

static const uint32_t NO_TRIANGLES[2] = {UINT32_MAX, UINT32_MAX};

/* A link without stiffness, or with ea (N) the spring of an edge without triangles. triangle: those
 * at it. */
static void link_pair(const struct visitor *visitor, const struct mesh *mesh,
                      const uint32_t triangle[2], uint32_t a, uint32_t b, double ea,
                      unsigned char stretch)
{
    const double length = mesh_length(mesh, triangle, a, b);
    const double stiffness = length > 0 ? ea / length : 0;
    const double damping =
        stiffness > 0 ? springs_material_of(visitor, a, b)->damping_stiffness : 0;
    visit_spring(visitor, a, b, stiffness, damping, length, stretch && length > 0);
}

/* Links the diagonals of cells, whose corners share the force of the air. */
static void link_cells(const struct visitor *visitor, const struct mesh *mesh)
{
    const uint32_t nx = mesh->grid_nx;
    for (uint32_t j = 0; j + 1 < mesh->grid_ny; j++)
        for (uint32_t i = 0; i + 1 < nx; i++) {
            const uint32_t v = j * nx + i;
            if (mesh_cell_turned(mesh, i, j))
                link_pair(visitor, mesh, NO_TRIANGLES, v, v + nx + 1, 0, 0);
            else
                link_pair(visitor, mesh, NO_TRIANGLES, v + 1, v + nx, 0, 0);
        }
}

/* True if a cloth of springs may lack springs between corners of its triangles: a spring of 0 N/m
 * is none. */
static bool lacks_springs(const struct model *model, const struct model_cloth *cloth)
{
    bool lacks = false;
    for (uint32_t i = 0; i <= cloth->n_regions; i++) {
        const struct mesh_moduli moduli = model_moduli(i ? model->materials + cloth->region[i - 1]
                                                         : model_material(model, cloth, 0));
        const bool shears = moduli.shear != 0 || !model_rest(cloth)->grid_nx;
        lacks = lacks || moduli.stretch == 0 || moduli.stretch + moduli.weft_excess == 0 || !shears;
    }
    return lacks;
}

/* Between all corners of each triangle, for contact (contact/skin_tables.c). */
static void link_triangles(const struct visitor *visitor, const struct mesh *mesh)
{
    for (uint32_t t = 0; t < mesh->n_triangles; t++) {
        uint32_t corner[3];
        mesh_corners(mesh, t, corner);
        for (int k = 0; k < 3; k++)
            link_pair(visitor, mesh, NO_TRIANGLES, corner[k], corner[(k + 1) % 3], 0, 0);
    }
}

/* Visits the links that a cloth's elements make, and its edges without triangles, which are springs
 * in any cloth. */
static void each_link(const struct flow_springs *springs, uint32_t c, const struct visitor *visitor)
{
    const struct model *model = springs->model;
    const struct model_cloth *cloth = model->cloths + c;
    const struct mesh *mesh = model_rest(cloth);
    const struct mesh_edges *edges = springs->elements->edges + c;
    const bool triangles = model_has_triangles(model, cloth);
    const unsigned parts = element_parts(model, cloth);
    for (uint32_t e = 0; e < edges->n; e++) {
        const struct mesh_edge *edge = edges->edge + e;
        const bool lone = edge->opposite[0] == UINT32_MAX;
        if (triangles || !lone)
            link_pair(visitor, mesh, edge->triangle, edge->a, edge->b,
                      lone ? springs_material_of(visitor, edge->a, edge->b)->ea : 0, triangles);
        if (parts & 1u << ELEMENT_HINGES && element_is_hinge(edge))
            link_pair(visitor, mesh, NO_TRIANGLES, edge->opposite[0], edge->opposite[1], 0, 0);
    }
    if (parts & 1u << ELEMENT_FACES && model_has_cells(model, cloth))
        link_cells(visitor, mesh);
    if (model_seeks(model) && !triangles && lacks_springs(model, cloth))
        link_triangles(visitor, mesh);
}

static void each_of_cloths(const struct flow_springs *springs,
                           void (*visit)(void *to, const struct flow_spring *spring), void *to)
{
    const struct model *model = springs->model;
    struct visitor visitor = {
        .visit = visit, .to = to, .model = model, .elements = springs->elements};
    for (uint32_t c = 0; c < model->n_cloths; c++) {
        visitor.number = c;
        visitor.cloth = model->cloths + c;
        mesh_lattice_each(springs->lattice + c, springs_pass_on, &visitor);
        each_link(springs, c, &visitor);
        visitor.first += visitor.cloth->mesh.n_vertices;
    }
}

/* Goes through springs beside those that welds merged. */
struct merger {
    const struct flow_springs *springs;
    void (*visit)(void *to, const struct flow_spring *spring);
    void *to;
    uint64_t number; /* of the next spring */
    size_t next;     /* of the merged ones */
};

static void pass_merged(void *context, const struct flow_spring *s)
{
    struct merger *merger = context;
    const struct flow_springs *springs = merger->springs;
    const struct flow_merged *merged = springs->merged + merger->next;
    const uint64_t number = merger->number++;
    struct flow_spring sum = *s;
    if (merger->next < springs->n_merged && merged->number == number) {
        merger->next++;
        if (merged->gone)
            return;
        sum.stiffness = merged->stiffness;
        sum.damping = merged->damping;
    }
    merger->visit(merger->to, &sum);
}

/* Visits the links that hinges across seams make. */
static void each_seam(const struct flow_springs *springs,
                      void (*visit)(void *to, const struct flow_spring *spring), void *to)
{
    for (uint32_t s = 0; s < springs->elements->n_seams; s++) {
        const struct element_side *side = springs->elements->seam[s].side;
        const uint32_t a = side[0].first + side[0].corner[2];
        const uint32_t b = side[1].first + side[1].corner[2];
        const struct flow_spring link = {.a = a < b ? a : b, .b = a < b ? b : a, .length = 1};
        visit(to, &link);
    }
}

void flow_springs_each(const struct flow_springs *springs,
                       void (*visit)(void *to, const struct flow_spring *spring), void *to)
{
    struct merger merger = {.springs = springs, .visit = visit, .to = to};
    if (springs->n_merged)
        each_of_cloths(springs, pass_merged, &merger);
    else
        each_of_cloths(springs, visit, to);
    each_seam(springs, visit, to);
    for (uint32_t j = 0; j < springs->n_joints; j++)
        visit(to, springs->joint + j);
}

void flow_springs_free(struct flow_springs *springs)
{
    for (uint32_t c = 0; springs->lattice && c < springs->model->n_cloths; c++)
        mesh_lattice_free(springs->lattice + c);
    cloth_pool_free(&springs->memory);
    *springs = (struct flow_springs){0};
}

struct lengths {
    double sum;
    uint64_t n;
};

static void add_length(void *to, const struct flow_spring *spring)
{
    struct lengths *lengths = to;
    lengths->sum += spring->stretch ? spring->length : 0;
    lengths->n += spring->stretch;
}

double flow_source_inertia(const struct flow_source *source)
{
    const struct flow_particles *particles = &source->particles;
    struct lengths lengths = {0};
    double mass = 0;
    flow_springs_each(&source->springs, add_length, &lengths);
    for (uint32_t v = 0; v < particles->n; v++)
        mass += particles->used[v] && particles->free[v] ? particles->mass[v] : 0;
    const double mean = lengths.n ? lengths.sum / (double)lengths.n : 0;
    return mass * mean * mean;
}
