/* Checks run in the order in which one would look: ends, lengths, sizes, crossings, stitches. */
#include "cloth/base/memory.h"
#include "cloth/base/vector.h"
#include "cloth/garment/detail/curve.h"

#include <stdio.h>
#include <stdlib.h>

void garment_pattern_free(struct garment_pattern *pattern)
{
    for (uint32_t p = 0; pattern->panel && p < pattern->n_panels; p++) {
        free(pattern->panel[p].name);
        free(pattern->panel[p].corner);
        for (uint32_t e = 0; pattern->panel[p].edge && e < pattern->panel[p].n_edges; e++)
            free(pattern->panel[p].edge[e].point);
        free(pattern->panel[p].edge);
    }
    free(pattern->panel);
    free(pattern->stitch);
    *pattern = (struct garment_pattern){0};
}

static const double LEAST = 1e-3, MOST = 100; /* m: sizes of panels */
static const double SHORT = 1e-6;             /* m: shorter edges have no length */

static int check_loop(const struct garment_panel *panel, struct cloth_error *error)
{
    if (panel->n_edges < 2)
        return cloth_fail(error, CLOTH_E_INPUT, "panel '%s' has %u edges; a loop needs at least 2",
                          panel->name, panel->n_edges);
    unsigned char *met = cloth_alloc(panel->n_corners, 1, error);
    if (!met)
        return CLOTH_E_MEMORY;
    int code = CLOTH_OK;
    for (uint32_t e = 0; e < panel->n_edges && !code; e++) {
        const uint32_t next = (e + 1) % panel->n_edges;
        const uint32_t begin = panel->edge[e].end[0], end = panel->edge[e].end[1];
        if (end != panel->edge[next].end[0])
            code = cloth_fail(error, CLOTH_E_INPUT,
                              "panel '%s' is no closed loop: edge %u ends at vertex %u, edge %u "
                              "begins at vertex %u",
                              panel->name, e, end, next, panel->edge[next].end[0]);
        else if (met[begin])
            code = cloth_fail(error, CLOTH_E_INPUT,
                              "panel '%s' comes to vertex %u a second time with edge %u",
                              panel->name, begin, e);
        met[begin] = 1;
    }
    for (uint32_t c = 0; c < panel->n_corners && !code; c++)
        if (!met[c])
            code = cloth_fail(error, CLOTH_E_INPUT, "panel '%s' has vertex %u, but no edge there",
                              panel->name, c);
    free(met);
    return code;
}

static int check_edges(const struct garment_panel *panel, struct cloth_error *error)
{
    for (uint32_t e = 0; e < panel->n_edges; e++) {
        const struct garment_edge *edge = &panel->edge[e];
        const double chord =
            sqrt(cloth_square_2(panel->corner[edge->end[0]], panel->corner[edge->end[1]]));
        if (!(chord > SHORT))
            return cloth_fail(
                error, CLOTH_E_INPUT,
                "panel '%s': edge %u has no length: it ends %g m from where it begins", panel->name,
                e, chord);
        if (edge->curve == GARMENT_CIRCLE && !(edge->radius >= 0.4999999 * chord))
            return cloth_fail(error, CLOTH_E_INPUT,
                              "panel '%s': edge %u is an arc of radius %g m, but its ends are %g m "
                              "from each other; at least half of that is needed",
                              panel->name, e, edge->radius, chord);
    }
    return CLOTH_OK;
}

/* start, place: room for an outline, the places along all edges, as straight as they are between.
 */
static int check_outline(const struct garment_panel *panel, uint32_t *start, double (*place)[2],
                         struct cloth_error *error)
{
    const struct meet_loop loop = {panel->n_edges, start, (const double(*)[2])place};
    uint32_t n = 0, edge[2];
    double low[2], high[2];
    bool meets = false;
    for (uint32_t e = 0; e < panel->n_edges; e++) {
        struct curve curve;
        curve_make(&curve, panel, e);
        const int parts = curve.kind == GARMENT_STRAIGHT ? 1 : CURVE_PARTS;
        start[e] = n;
        for (int k = 0; k < parts; k++)
            curve_at(&curve, (double)k / parts, place[n++]);
    }
    start[panel->n_edges] = n;
    cloth_box(n, loop.place, low, high);
    const double size = fmax(high[0] - low[0], high[1] - low[1]);
    if (!(size >= LEAST && size <= MOST))
        return cloth_fail(error, CLOTH_E_INPUT,
                          "panel '%s' is %g m large; panels have %g to %g m: is units_in_meter "
                          "right?",
                          panel->name, size, LEAST, MOST);
    int code = meet_find(&loop, 1e-7 * size, &meets, edge, error);
    if (code || !meets)
        return code;
    if (edge[0] == edge[1])
        return cloth_fail(error, CLOTH_E_INPUT, "panel '%s': edge %u crosses or touches itself",
                          panel->name, edge[0]);
    return cloth_fail(error, CLOTH_E_INPUT,
                      "panel '%s': edges %u and %u cross or touch each other between their ends",
                      panel->name, edge[0], edge[1]);
}

static int check_panel(const struct garment_panel *panel, struct cloth_error *error)
{
    int code = check_loop(panel, error);
    code = code ? code : check_edges(panel, error);
    if (code)
        return code;
    uint32_t *start = cloth_alloc((size_t)panel->n_edges + 1, sizeof *start, error);
    double(*place)[2] = cloth_alloc((size_t)panel->n_edges * CURVE_PARTS, sizeof *place, error);
    code = start && place ? check_outline(panel, start, place, error) : CLOTH_E_MEMORY;
    free(start);
    free(place);
    return code;
}

/* by: for each edge of each panel, in their order, the stitch that has it plus 1. */
static int check_stitches(const struct garment_pattern *pattern, const uint32_t *first,
                          uint32_t *by, struct cloth_error *error)
{
    for (uint32_t s = 0; s < pattern->n_stitches; s++)
        for (int k = 0; k < 2; k++) {
            const struct garment_side side = pattern->stitch[s].side[k];
            uint32_t *of = &by[first[side.panel] + side.edge];
            if (*of == s + 1)
                return cloth_fail(error, CLOTH_E_INPUT,
                                  "stitch %u joins edge %u of panel '%s' to itself", s, side.edge,
                                  pattern->panel[side.panel].name);
            if (*of)
                return cloth_fail(error, CLOTH_E_INPUT,
                                  "stitch %u: edge %u of panel '%s' is stitched already, by stitch "
                                  "%u",
                                  s, side.edge, pattern->panel[side.panel].name, *of - 1);
            *of = s + 1;
        }
    return CLOTH_OK;
}

int garment_pattern_check(const struct garment_pattern *pattern, struct cloth_error *error)
{
    int code = CLOTH_OK;
    if (pattern->n_panels == 0)
        return cloth_fail(error, CLOTH_E_INPUT, "the pattern has no panels");
    uint32_t *first = cloth_alloc((size_t)pattern->n_panels + 1, sizeof *first, error), *by = NULL;
    if (!first)
        return CLOTH_E_MEMORY;
    for (uint32_t p = 0; p < pattern->n_panels && !code; p++) {
        code = check_panel(&pattern->panel[p], error);
        first[p + 1] = first[p] + pattern->panel[p].n_edges;
    }
    if (!code && !(by = cloth_alloc(first[pattern->n_panels], sizeof *by, error)))
        code = CLOTH_E_MEMORY;
    code = code ? code : check_stitches(pattern, first, by, error);
    free(first);
    free(by);
    return code;
}

/* Size of a panel, by its corners. */
static double size_of(const struct garment_panel *panel)
{
    double size = 0;
    for (uint32_t i = 0; i < panel->n_corners; i++)
        for (int k = 0; k < 2; k++)
            size = fmax(size, fabs(panel->corner[i][k] - panel->corner[0][k]));
    return size;
}

bool garment_pattern_unusual(const struct garment_pattern *pattern, char *text, size_t size)
{
    const double least = 0.05, most = 4; /* m: a doll's, a curtain's */
    const struct garment_panel *largest = pattern->panel;
    for (uint32_t p = 1; p < pattern->n_panels; p++)
        if (size_of(pattern->panel + p) > size_of(largest))
            largest = pattern->panel + p;
    const double found = size_of(largest);
    if (found >= least && found <= most)
        return false;
    snprintf(text, size,
             "panel '%.60s' is %g m large; panels have %g to %g m: is units_in_meter "
             "right?",
             largest->name, found, least, most);
    return true;
}
