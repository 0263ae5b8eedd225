/* Pieces of one size become panels. A panel's edges begin where its loop begins, or at the first
 * corner behind; places between two corners are an edge's polyline. */
#include "cloth/base/vector.h"
#include "cloth/garment/dxf/dxf.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MOST_PANELS = 1 << 16, NAME = 200 }; /* bytes of a panel's name */

/* ---- Sizes ---- */

static struct dxf_piece *piece_at(const struct dxf *dxf, size_t i)
{
    return (struct dxf_piece *)dxf->piece.items + i;
}

/* A piece without a size is of all. */
static bool is_of(const struct dxf_piece *piece, const char *size)
{
    return !size || !piece->size || !strcmp(piece->size, size);
}

static bool has_size(const struct dxf *dxf, const char *size)
{
    bool has = false;
    for (size_t i = 0; i < dxf->piece.n; i++)
        has = has || (piece_at(dxf, i)->size && is_of(piece_at(dxf, i), size));
    return has;
}

/* Each size once, with commas between, as far as there is room. */
static void list_sizes(const struct dxf *dxf, char *text, size_t room)
{
    text[0] = '\0';
    for (size_t i = 0; i < dxf->piece.n; i++) {
        const char *size = piece_at(dxf, i)->size;
        bool listed = !size;
        for (size_t k = 0; k < i && !listed; k++)
            listed = piece_at(dxf, k)->size && !strcmp(piece_at(dxf, k)->size, size);
        if (!listed)
            cloth_text_add(text, room, "%s%s", *text ? ", " : "", size);
    }
}

/* The size of all pieces that have one; NULL: there are several. */
static const char *only_size(const struct dxf *dxf)
{
    const char *size = NULL;
    for (size_t i = 0; i < dxf->piece.n; i++) {
        if (size && !is_of(piece_at(dxf, i), size))
            return NULL;
        size = size ? size : piece_at(dxf, i)->size;
    }
    return size;
}

/* The table of grade rules that some programs write beside a file with one size; empty: there is
 * none. */
static void find_rules(const struct dxf *dxf, char *path, size_t room)
{
    static const char *const endings[] = {"rul", "RUL"};
    const size_t n = strlen(dxf->path);
    for (int k = 0; k < 2 && n > 3 && n < room; k++) {
        snprintf(path, room, "%.*s%s", (int)(n - 3), dxf->path, endings[k]);
        if (access(path, F_OK) == 0)
            return;
    }
    *path = '\0';
}

/* *size: that of the pieces that are taken; NULL: none has one. */
static int choose_size(const struct dxf *dxf, const char **size, struct cloth_error *error)
{
    char sizes[200] = "", rules[PATH_MAX] = "";
    list_sizes(dxf, sizes, sizeof sizes);
    if (*size && !has_size(dxf, *size)) {
        find_rules(dxf, rules, sizeof rules);
        return cloth_fail(
            error, CLOTH_E_INPUT, "%s: no piece has the size '%.40s'; there %s%s%s%s", dxf->path,
            *size, *sizes ? "are " : "is none", sizes,
            *rules ? "; export all sizes as pieces, since grade rules are not read: " : "", rules);
    }
    if (*size || !*sizes)
        return CLOTH_OK;
    *size = dxf->sample && has_size(dxf, dxf->sample) ? dxf->sample : only_size(dxf);
    return *size ? CLOTH_OK
                 : cloth_fail(error, CLOTH_E_INPUT,
                              "%s: it has pieces of the sizes %s, and no sample size among them: "
                              "choose one of these sizes",
                              dxf->path, sizes);
}

/* ---- Names ---- */

static bool is_taken(const struct garment_pattern *pattern, const char *name)
{
    for (uint32_t p = 0; p < pattern->n_panels; p++)
        if (pattern->panel[p].name && !strcmp(pattern->panel[p].name, name))
            return true;
    return false;
}

/* One word of an OBJ file: white space becomes `_`. The second panel of a name has _2 behind it. */
static int give_name(const struct garment_pattern *pattern, struct garment_panel *panel,
                     const struct dxf_piece *piece, struct cloth_error *error)
{
    char name[NAME + 16];
    snprintf(name, NAME, "%s", piece->name);
    for (char *at = name; *at; at++)
        *at = (unsigned char)*at <= 32 || *at == 127 ? '_' : *at;
    const size_t n = strlen(name);
    for (uint32_t k = 2; is_taken(pattern, name); k++)
        snprintf(name + n, sizeof name - n, "_%u", k);
    panel->name = strdup(name);
    return panel->name ? CLOTH_OK : cloth_fail(error, CLOTH_E_MEMORY, "no memory for a name");
}

/* ---- Panels ---- */

/* From the file's places to those of the panel: the grain line points up. */
struct placing {
    double unit, up[2]; /* up: of length 1, in the file */
    bool mirrored;
};

static struct placing place_piece(const struct dxf *dxf, const struct dxf_piece *piece,
                                  bool mirrored)
{
    struct placing placing = {dxf->unit, {0, 1}, mirrored};
    const struct dxf_line *grain = dxf_line_of(piece, DXF_GRAIN);
    if (!grain)
        return placing;
    const double *a = (const double *)piece->place.items + 2 * (size_t)grain->first;
    const double *b = a + 2 * (size_t)(grain->n - 1), length = sqrt(cloth_square_2(a, b));
    for (int k = 0; k < 2 && length > 0; k++)
        placing.up[k] = (b[k] - a[k]) / length;
    return placing;
}

static void to_panel(const struct placing *placing, const double from[2], double to[2])
{
    const double x = placing->up[1] * from[0] - placing->up[0] * from[1];
    to[0] = placing->unit * (placing->mirrored ? -x : x);
    to[1] = placing->unit * (placing->up[0] * from[0] + placing->up[1] * from[1]);
}

/* The stops from corner to corner. first: number of a corner. */
static int fill_panel(struct garment_panel *panel, const struct dxf_loop *loop, size_t first,
                      const struct placing *placing, struct cloth_error *error)
{
    const struct dxf_stop *stop = loop->stop.items;
    const size_t n = loop->stop.n;
    for (size_t i = 0, next; i < n; i = next) {
        const uint32_t e = panel->n_edges++;
        struct garment_edge *edge = &panel->edge[e];
        to_panel(placing, stop[(first + i) % n].x, panel->corner[e]);
        for (next = i + 1; next < n && !stop[(first + next) % n].corner;)
            next++;
        edge->end[0] = e;
        edge->end[1] = (e + 1) % panel->n_corners;
        edge->curve = next > i + 1 ? GARMENT_POLYLINE : GARMENT_STRAIGHT;
        edge->point = cloth_alloc(next - i - 1, sizeof *edge->point, error);
        if (!edge->point)
            return CLOTH_E_MEMORY;
        for (size_t k = i + 1; k < next; k++)
            to_panel(placing, stop[(first + k) % n].x, edge->point[edge->n_points++]);
    }
    return CLOTH_OK;
}

/* The middle of the box around it comes to the origin. */
static void centre_panel(struct garment_panel *panel)
{
    double low[2], high[2];
    cloth_box(panel->n_corners, (const double(*)[2])panel->corner, low, high);
    for (uint32_t e = 0; e < panel->n_edges; e++)
        for (uint32_t i = 0; i < panel->edge[e].n_points; i++)
            for (int k = 0; k < 2; k++) {
                low[k] = fmin(low[k], panel->edge[e].point[i][k]);
                high[k] = fmax(high[k], panel->edge[e].point[i][k]);
            }
    for (int k = 0; k < 2; k++) {
        const double middle = (low[k] + high[k]) / 2;
        for (uint32_t e = 0; e < panel->n_edges; e++) {
            panel->corner[e][k] -= middle;
            for (uint32_t i = 0; i < panel->edge[e].n_points; i++)
                panel->edge[e].point[i][k] -= middle;
        }
    }
}

static int make_panel(struct garment_panel *panel, const struct dxf_loop *loop,
                      const struct placing *placing, struct cloth_error *error)
{
    const struct dxf_stop *stop = loop->stop.items;
    size_t first = 0;
    while (!stop[first].corner)
        first++;
    for (size_t i = 0; i < loop->stop.n; i++)
        panel->n_corners += stop[i].corner;
    panel->corner = cloth_alloc(panel->n_corners, sizeof *panel->corner, error);
    panel->edge = cloth_alloc(panel->n_corners, sizeof *panel->edge, error);
    if (error->code || fill_panel(panel, loop, first, placing, error))
        return error->code;
    panel->warp_up = true;
    centre_panel(panel);
    return CLOTH_OK;
}

/* All copies of a piece. panels: a list of struct garment_panel, which the pattern has. */
static int take_piece(struct garment_pattern *pattern, struct cloth_list *panels,
                      const struct dxf *dxf, const struct dxf_piece *piece, bool notches,
                      struct cloth_error *error)
{
    struct dxf_loop loop;
    const uint32_t drawn = piece->copies + piece->mirrored ? piece->copies : 1;
    int code = dxf_loop_make(&loop, dxf, piece, notches, error);
    for (uint32_t k = 0; k < drawn + piece->mirrored && !code; k++) {
        const struct placing placing = place_piece(dxf, piece, k >= drawn);
        struct garment_panel *panel = cloth_list_add(panels, sizeof *panel, 1, error);
        if (panels->n > MOST_PANELS)
            cloth_fail(error, CLOTH_E_INPUT, "%s: its pieces are more than %d panels", dxf->path,
                       MOST_PANELS);
        pattern->panel = panels->items;
        if (panel) {
            *panel = (struct garment_panel){0};
            pattern->n_panels++;
        }
        code = error->code || give_name(pattern, panel, piece, error) ||
               make_panel(panel, &loop, &placing, error);
    }
    free(loop.stop.items);
    return error->code;
}

int garment_read_dxf(struct garment_pattern *pattern, const char *path,
                     const struct garment_choice *choice, struct cloth_error *error)
{
    const char *size = choice ? choice->size : NULL;
    struct cloth_error own = {0};
    struct cloth_list panels = {0};
    struct dxf dxf;
    *pattern = (struct garment_pattern){0};
    int code = dxf_read(&dxf, path, &own) || choose_size(&dxf, &size, &own);
    for (size_t i = 0; i < dxf.piece.n && !code; i++)
        if (is_of(piece_at(&dxf, i), size))
            code = take_piece(pattern, &panels, &dxf, piece_at(&dxf, i), choice && choice->notches,
                              &own);
    dxf_free(&dxf);
    return own.code ? cloth_fail(error, own.code, "%s", own.text) : CLOTH_OK;
}
