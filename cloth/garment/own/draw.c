/* A mirrored panel has its corners in the opposite order, so that its loop is counterclockwise,
 * too: line i of the drawing is then edge n - 1 - i of the panel. */
#include "cloth/garment/own/draw.h"
#include "cloth/base/memory.h"

#include <string.h>

static struct draw_line *draw_add(struct draw_outline *outline, double x, double y)
{
    const uint32_t i = outline->n++;
    outline->corner[i][0] = x;
    outline->corner[i][1] = y;
    outline->line[i] = (struct draw_line){.curve = GARMENT_STRAIGHT};
    return &outline->line[i];
}

void draw_straight(struct draw_outline *outline, double x, double y)
{
    draw_add(outline, x, y);
}

void draw_quadratic(struct draw_outline *outline, double x, double y, double cx, double cy)
{
    *draw_add(outline, x, y) = (struct draw_line){GARMENT_QUADRATIC, {{cx, cy}}, 0};
}

void draw_cubic(struct draw_outline *outline, double x, double y, double cx, double cy, double dx,
                double dy)
{
    *draw_add(outline, x, y) = (struct draw_line){GARMENT_CUBIC, {{cx, cy}, {dx, dy}}, 0};
}

/* The mirror image of a line, which runs the other way. An arc on the right of its chord stays
 * there. */
static struct draw_line image_of(const struct draw_line *line)
{
    struct draw_line image = *line;
    const int last = line->curve == GARMENT_CUBIC;
    for (int i = 0; i <= last; i++) {
        image.control[i][0] = -line->control[last - i][0];
        image.control[i][1] = line->control[last - i][1];
    }
    return image;
}

/* Puts the mirror images of corner and line j of one outline at place i of another. */
static void put_image(struct draw_outline *to, uint32_t i, const struct draw_outline *from,
                      uint32_t corner, uint32_t line)
{
    to->corner[i][0] = -from->corner[corner][0];
    to->corner[i][1] = from->corner[corner][1];
    to->line[i] = image_of(&from->line[line]);
}

void draw_unfold(struct draw_outline *outline, const struct draw_line *bottom,
                 const struct draw_line *top)
{
    const struct draw_outline half = *outline;
    const uint32_t n = half.n;
    put_image(outline, 0, &half, 0, 0);
    outline->line[0] = *bottom;
    for (uint32_t i = 0; i < n; i++) {
        memcpy(outline->corner[i + 1], half.corner[i], sizeof half.corner[0]);
        outline->line[i + 1] = i + 1 < n ? half.line[i] : *top;
    }
    for (uint32_t i = n + 1; i < 2 * n; i++)
        put_image(outline, i, &half, 2 * n - i, 2 * n - i - 1);
    outline->n = 2 * n;
}

/* Line i of an outline as an edge of a panel, whose corners are there. */
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
    const uint32_t next = (line + 1) % outline->n;
    double corner[2][2];
    memcpy(corner[0], outline->corner[line], sizeof corner[0]);
    memcpy(corner[1], outline->corner[next], sizeof corner[1]);
    struct garment_edge edge = draw_edge_of(&outline->line[line], 0, 1);
    const struct garment_panel panel = {
        .n_corners = 2, .n_edges = 1, .corner = corner, .edge = &edge};
    return garment_edge_length(&panel, 0);
}

static void place_panel(struct garment_panel *panel, const struct draw_place *place)
{
    panel->translate[0] = place->right ? -place->x : place->x;
    panel->translate[1] = place->y;
    panel->translate[2] = place->z;
    panel->rotate[1] = place->back ? 180 : 0;
    panel->rotate[2] = place->right ? place->turn : -place->turn;
}

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
        memcpy(panel->corner[i], outline->corner[i], sizeof panel->corner[i]);
        panel->edge[i] = draw_edge_of(&outline->line[i], i, (i + 1) % outline->n);
    }
    return CLOTH_OK;
}

uint32_t draw_panel(struct draw *draw, const char *name, const struct draw_outline *outline,
                    const struct draw_place *place)
{
    const uint32_t p = draw->pattern->n_panels, n = outline->n;
    struct draw_outline mirrored = {.n = n};
    if (draw->code)
        return 0;
    draw->pattern->n_panels++;
    draw->mirrored[p] = place->right != place->back;
    for (uint32_t i = 0; i < n; i++)
        put_image(&mirrored, i, outline, (n - i) % n, n - 1 - i);
    struct garment_panel *panel = &draw->pattern->panel[p];
    draw->code = make_panel(panel, name, draw->mirrored[p] ? &mirrored : outline, draw->error);
    place_panel(panel, place);
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
