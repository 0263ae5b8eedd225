/* A panel is meshed again only when its divisions changed. The reasons for a change are found in
 * its mesh: a boundary that crosses itself between its vertices, or triangles that the inside could
 * not make good. Where this does not help, as in strips that are few triangles wide, all is meshed
 * by a somewhat finer spacing. */
#include "cloth/garment/detail/meshing.h"
#include "cloth/base/memory.h"
#include "cloth/garment/detail/flat.h"

#include <stdlib.h>

enum { TRIES = 8, FAIR_TRIES = 3, FINER_TRIES = 6 };
static const double FINER = 0.93; /* of the spacing before */

/* Which angles are worth a finer boundary: at first those that a slightly finer one may better,
 * then those alone that are bad. */
struct worth {
    double cosine, factor;
};
static const struct worth FAIR = {0.86602540, 1.15}, POOR = {MESHING_POOR, 2}; /* 30, 20 degrees */

/* Asks for shorter divisions of an edge. */
static void refine(struct meshing *meshing, uint32_t panel, uint32_t edge, double factor,
                   bool *again)
{
    meshing->edge[meshing->first[panel] + edge].finer *= factor;
    *again = true;
}

static uint32_t meshing_edge_of(const struct meshing_panel *of, uint32_t n_edges, uint32_t vertex)
{
    uint32_t e = 0;
    while (e + 1 < n_edges && of->start[e + 1] <= vertex)
        e++;
    return e;
}

bool meshing_is_ear(const struct delaunay *plane, uint32_t triangle)
{
    const uint32_t *beside = plane->triangle[triangle].beside;
    int n = 0;
    for (int i = 0; i < 3; i++)
        n += beside[i] == DELAUNAY_NONE;
    return n > 1;
}

/* True if a triangle is bad, and not excused. An ear below 20 degrees stays so. */
static bool is_worth(const struct meshing_panel *of, struct worth worth, uint32_t triangle)
{
    return delaunay_sharpness_of(&of->plane, triangle) > worth.cosine &&
           !flat_excused(&of->plane, of->sharp, triangle) &&
           !(worth.cosine == POOR.cosine && meshing_is_ear(&of->plane, triangle));
}

/* Edges of bad triangles; each is refined once. */
static void refine_poor(struct meshing *meshing, uint32_t panel, struct worth worth, bool *again)
{
    const struct meshing_panel *of = &meshing->panel[panel];
    const uint32_t n_edges = meshing->pattern->panel[panel].n_edges;
    unsigned char *poor = cloth_alloc(n_edges, 1, meshing->error);
    if (!poor)
        return;
    for (uint32_t t = 0; t < of->plane.n_triangles; t++) {
        if (!is_worth(of, worth, t))
            continue;
        for (int i = 0; i < 3; i++) {
            const uint32_t v = of->plane.triangle[t].vertex[i];
            if (v < of->start[n_edges])
                poor[meshing_edge_of(of, n_edges, v)] = 1;
        }
    }
    for (uint32_t e = 0; e < n_edges; e++)
        if (poor[e])
            refine(meshing, panel, e, worth.factor, again);
    free(poor);
}

static void mesh_panel(struct meshing *meshing, uint32_t panel, int try, bool *again)
{
    struct meshing_panel *of = &meshing->panel[panel];
    const char *name = meshing->pattern->panel[panel].name;
    const uint32_t n_edges = meshing->pattern->panel[panel].n_edges;
    struct cloth_error why = {0};
    uint32_t edge[2] = {0, 0}, crossing = DELAUNAY_NONE;
    bool meets = false;
    const bool last = try == TRIES - 1;
    delaunay_free(&of->plane);
    if (!meshing_outline(meshing, panel))
        return;
    const double(*place)[2] = (const double(*)[2])of->place;
    const struct meet_loop outline = {n_edges, of->start, place};
    const struct flat_loop loop = {of->start[n_edges], place, of->sharp};
    if (meet_find(&outline, 1e-8, &meets, edge, meshing->error))
        return;
    if (!meets && loop.n >= 3)
        of->meshed = !flat_make(&of->plane, &loop, meshing->spacing, &crossing, &why);
    if (crossing != DELAUNAY_NONE)
        edge[0] = edge[1] = meshing_edge_of(of, n_edges, crossing);
    if (why.code && crossing == DELAUNAY_NONE)
        cloth_fail(meshing->error, why.code, "panel '%s': %s", name, why.text);
    else if (of->meshed && !last)
        refine_poor(meshing, panel, try < FAIR_TRIES ? FAIR : POOR, again);
    else if (!of->meshed && last)
        cloth_fail(meshing->error, CLOTH_E_INPUT,
                   "panel '%s' cannot be meshed by edges of %g m: at edge %u its boundary comes "
                   "too near to itself",
                   name, meshing->spacing, edge[0]);
    else if (!of->meshed) {
        refine(meshing, panel, edge[0], 2, again);
        if (edge[1] != edge[0])
            refine(meshing, panel, edge[1], 2, again);
    }
}

/* Returns whether all tries were needed, so that there may be bad triangles. */
static bool mesh_at(struct meshing *meshing, double spacing)
{
    const uint32_t n_panels = meshing->pattern->n_panels;
    int k = 0;
    bool again = true;
    meshing->spacing = spacing;
    for (uint32_t e = 0; e < meshing->first[n_panels]; e++)
        meshing->edge[e].finer = 1;
    for (uint32_t p = 0; p < n_panels; p++)
        meshing->panel[p].meshed = false;
    for (; k < TRIES && again && !meshing->error->code; k++) {
        again = false;
        meshing_divide(meshing);
        for (uint32_t p = 0; p < n_panels && !meshing->error->code; p++)
            if (!meshing->panel[p].meshed)
                mesh_panel(meshing, p, k, &again);
    }
    return k == TRIES;
}

static bool is_poor(const struct meshing *meshing)
{
    for (uint32_t p = 0; p < meshing->pattern->n_panels; p++) {
        const struct meshing_panel *of = &meshing->panel[p];
        for (uint32_t t = 0; t < of->plane.n_triangles; t++)
            if (is_worth(of, POOR, t))
                return true;
    }
    return false;
}

void meshing_mesh(struct meshing *meshing, double spacing)
{
    struct cloth_error *error = meshing->error;
    double finer = spacing;
    bool last = mesh_at(meshing, finer);
    const struct cloth_error first = *error;
    for (int k = 0; k < FINER_TRIES &&
                    (error->code == CLOTH_E_INPUT || (!error->code && last && is_poor(meshing)));
         k++) {
        *error = (struct cloth_error){0};
        finer *= FINER;
        last = mesh_at(meshing, finer);
    }
    if (!first.code && (error->code || (last && is_poor(meshing)))) {
        *error = (struct cloth_error){0};
        mesh_at(meshing, spacing); /* nothing helps: as it was asked for */
    } else if (error->code == CLOTH_E_INPUT) {
        *error = first;
    }
}
