/* Shared by all own garments: their names, sizes and ranges, and how they are drawn. A mirrored
 * panel has its corners in the opposite order, so that its loop is counterclockwise, too: line i of
 * the drawing is then edge n - 1 - i of the panel. */
#include "cloth/garment/own/own.h"
#include "cloth/base/memory.h"
#include "cloth/garment/own/draw.h"

#include <string.h>

/* Ended by one without a name. */
static const struct garment_own owns[] = {
    {"tshirt", "a T-shirt: front, back, and sleeves of two halves each", draw_tshirt_measures,
     draw_tshirt},
    {"trousers", "jeans: four panels of legs, and a waistband of two", draw_trousers_measures,
     draw_trousers},
    {"skirt", "a skirt: front and back, gathered to a waistband of two", draw_skirt_measures,
     draw_skirt},
    {0}};
const char garment_own_words[] = "tshirt, trousers, skirt";

enum { SIZES = 5, MIDDLE = 2 };
static const char *const SIZE[SIZES] = {"XS", "S", "M", "L", "XL"};
const char garment_size_words[] = "XS, S, M, L, XL";

const struct garment_own *garment_own_find(const char *name)
{
    for (const struct garment_own *own = owns; own->name; own++)
        if (!strcmp(own->name, name))
            return own;
    return NULL;
}

int garment_size_find(const char *name)
{
    for (int i = 0; i < SIZES; i++)
        if (!strcmp(SIZE[i], name))
            return i;
    return -1;
}

void garment_own_size(const struct garment_own *own, int size, double *value)
{
    memset(value, 0, GARMENT_MEASURES * sizeof *value);
    for (int i = 0; own->measure[i].name; i++)
        value[i] = own->measure[i].fallback + (size - MIDDLE) * own->measure[i].step;
}

int garment_own_measure(const struct garment_own *own, const char *name)
{
    for (int i = 0; own->measure[i].name; i++)
        if (!strcmp(own->measure[i].name, name))
            return i;
    return -1;
}

static int check_ranges(const struct draw *draw, const struct garment_measure *measure,
                        const double *value)
{
    for (; measure->name; measure++, value++)
        if (!(*value >= measure->least && *value <= measure->most))
            return DRAW_FAIL(draw, "the measure %s is %g; it has to be %g to %g", measure->name,
                             *value, measure->least, measure->most);
    return CLOTH_OK;
}

int garment_own_make(struct garment_pattern *pattern, const struct garment_own *own,
                     const double *value, struct cloth_error *error)
{
    struct draw draw = {.name = own->name, .pattern = pattern, .error = error};
    *pattern = (struct garment_pattern){0};
    int code = check_ranges(&draw, own->measure, value);
    if (code)
        return code;
    pattern->panel = cloth_alloc(DRAW_PANELS, sizeof *pattern->panel, error);
    pattern->stitch = cloth_alloc(DRAW_STITCHES, sizeof *pattern->stitch, error);
    if (!pattern->panel || !pattern->stitch)
        return CLOTH_E_MEMORY;
    own->draw(&draw, value);
    return draw.code ? draw.code : garment_pattern_check(pattern, error);
}

int draw_check_waist(struct draw *draw, double waist, double hip)
{
    const double least = 0.6 * hip, most = hip + 0.3;
    return waist >= least && waist <= most
               ? CLOTH_OK
               : DRAW_FAIL(draw,
                           "a waist of %g m does not go with a hip of %g m; waist has to be %g to "
                           "%g",
                           waist, hip, least, most);
}

/* ---- Lines ---- */

/* The mirror image of a line, which runs the other way. An arc on the right of its chord stays
 * there. */
static struct draw_line image_of(const struct draw_outline *outline, uint32_t line)
{
    const struct draw_line *of = &outline->line[line];
    const double *end = outline->line[(line + 1) % outline->n].corner;
    const int last = of->curve == GARMENT_CUBIC;
    struct draw_line image = *of;
    image.corner[0] = -end[0];
    image.corner[1] = end[1];
    for (int i = 0; i <= last; i++) {
        image.control[i][0] = -of->control[last - i][0];
        image.control[i][1] = of->control[last - i][1];
    }
    return image;
}

void draw_unfold(struct draw_outline *half)
{
    const uint32_t n = half->n - 1;
    half->line[0].corner[0] = -half->line[1].corner[0];
    half->line[0].corner[1] = half->line[1].corner[1];
    for (uint32_t i = n + 1; i < 2 * n; i++)
        half->line[i] = image_of(half, 2 * n - i);
    half->n = 2 * n;
}

/* A line as an edge of a panel, whose corners are there. */
static struct garment_edge draw_edge_of(const struct draw_line *line, uint32_t from, uint32_t to)
{
    struct garment_edge edge = {.end = {from, to},
                                .curve = line->curve,
                                .radius = line->radius,
                                .right = line->curve == GARMENT_CIRCLE};
    memcpy(edge.control, line->control, sizeof edge.control);
    return edge;
}

double draw_length(const struct draw_outline *outline, uint32_t line)
{
    double corner[2][2];
    for (uint32_t i = 0; i < 2; i++)
        memcpy(corner[i], outline->line[(line + i) % outline->n].corner, sizeof corner[i]);
    struct garment_edge edge = draw_edge_of(&outline->line[line], 0, 1);
    const struct garment_panel panel = {
        .n_corners = 2, .n_edges = 1, .corner = corner, .edge = &edge};
    return garment_edge_length(&panel, 0);
}

/* ---- Panels ---- */

static int make_panel(struct garment_panel *panel, const char *name,
                      const struct draw_outline *outline, struct cloth_error *error)
{
    panel->name = strdup(name);
    panel->corner = cloth_alloc(outline->n, sizeof *panel->corner, error);
    panel->edge = cloth_alloc(outline->n, sizeof *panel->edge, error);
    if (!panel->name || !panel->corner || !panel->edge)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for a panel");
    panel->n_corners = panel->n_edges = outline->n;
    for (uint32_t i = 0; i < outline->n; i++) {
        memcpy(panel->corner[i], outline->line[i].corner, sizeof panel->corner[i]);
        panel->edge[i] = draw_edge_of(&outline->line[i], i, (i + 1) % outline->n);
    }
    return CLOTH_OK;
}

uint32_t draw_panel(struct draw *draw, const char *name, const struct draw_outline *outline,
                    const struct draw_place *place)
{
    const uint32_t p = draw->pattern->n_panels;
    struct draw_outline mirrored = {.n = outline->n};
    if (draw->code)
        return 0;
    draw->pattern->n_panels++;
    draw->mirrored[p] = place->right != place->back;
    for (uint32_t i = 0; i < outline->n; i++)
        mirrored.line[i] = image_of(outline, outline->n - 1 - i);
    struct garment_panel *panel = &draw->pattern->panel[p];
    draw->code = make_panel(panel, name, draw->mirrored[p] ? &mirrored : outline, draw->error);
    panel->translate[0] = place->right ? -place->x : place->x;
    panel->translate[1] = place->y;
    panel->translate[2] = place->z;
    panel->rotate[1] = place->back ? 180 : 0;
    panel->rotate[2] = place->right ? place->turn : -place->turn;
    return p;
}

static struct garment_side draw_side_of(const struct draw *draw, uint32_t panel, uint32_t line)
{
    const uint32_t n = draw->pattern->panel[panel].n_edges;
    return (struct garment_side){panel, draw->mirrored[panel] ? n - 1 - line : line};
}

void draw_sew(struct draw *draw, uint32_t panel, uint32_t line, uint32_t other, uint32_t other_line)
{
    if (draw->code)
        return;
    struct garment_stitch *stitch = &draw->pattern->stitch[draw->pattern->n_stitches++];
    stitch->side[0] = draw_side_of(draw, panel, line);
    stitch->side[1] = draw_side_of(draw, other, other_line);
}
