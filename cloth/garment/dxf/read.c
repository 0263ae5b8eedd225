/* Entities of a DXF file: an entity is the pairs from one of code 0 up to the next. A piece's last
 * line is `open` to vertices until an entity of another type begins. */
#include "cloth/garment/dxf/dxf.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const double MM = 1e-3, INCH = 0.0254;
enum { MOST_COPIES = 100 };

struct entity {
    const char *type, *text, *name; /* codes 0, 1, 2; NULL: there is none */
    size_t at;
    long layer, flags; /* 8 and 70; layers that are no numbers are 0 */
    double x[2][2];    /* 10 and 20, 11 and 21 */
};

struct reader {
    struct dxf *dxf;
    struct cloth_error *error;
    struct dxf_text text;
    bool units_told;
    struct entity entity;
    char variable[16];              /* of the header, that is read */
    bool in_block, open, in_blocks; /* the last piece of the list takes entities, lines vertices */
    bool ever;                      /* a section began */
};

#define WRONG(reader, ...)                                                                         \
    dxf_fail((reader)->dxf, (reader)->text.line, (reader)->error, __VA_ARGS__)

/* ---- Texts ---- */

static int keep_text(struct reader *reader, char **to, const char *text)
{
    if (*to || !text || !*text)
        return CLOTH_OK;
    *to = strdup(text);
    return *to ? CLOTH_OK : cloth_fail(reader->error, CLOTH_E_MEMORY, "no memory for a text");
}

/* The value of "KEY: VALUE", in letters of any case; NULL: another key. */
static const char *value_of(const char *text, const char *key)
{
    const size_t n = strlen(key);
    const char *at = text + n;
    if (strncasecmp(text, key, n) != 0)
        return NULL;
    at += strspn(at, " ");
    return *at == ':' ? at + 1 + strspn(at + 1, " ") : NULL;
}

static int read_units(struct reader *reader, const char *word)
{
    static const struct {
        const char *word;
        double unit;
    } units[] = {{"METRIC", MM}, {"ENGLISH", INCH}, {"MM", MM}, {"CM", 0.01}, {"INCH", INCH}};
    size_t i = 0;
    while (i < sizeof units / sizeof *units && strcasecmp(word, units[i].word) != 0)
        i++;
    if (i == sizeof units / sizeof *units)
        return dxf_fail(reader->dxf, reader->entity.at, reader->error,
                        "the units are '%.40s'; METRIC (mm), ENGLISH (inches), MM, CM or INCH are "
                        "expected",
                        word);
    reader->dxf->unit = units[i].unit;
    reader->units_told = true;
    return CLOTH_OK;
}

/* "1,1": one as drawn and one mirrored, as ASTM has it; "2", as AAMA has it, is the same pair. */
static int read_quantity(struct reader *reader, struct dxf_piece *piece, const char *text)
{
    char *end;
    const long n = strtol(text, &end, 10);
    const long other = *end == ',' ? strtol(end + 1, &end, 10) : n / 2;
    const long drawn = strchr(text, ',') ? n : n - other;
    if (*end || n < 0 || other < 0 || n > MOST_COPIES || other > MOST_COPIES)
        return dxf_fail(reader->dxf, reader->entity.at, reader->error,
                        "the quantity of a piece is '%.40s'; a number, or two with a comma, of at "
                        "most %d are expected",
                        text, MOST_COPIES);
    piece->copies = (uint32_t)drawn;
    piece->mirrored = (uint32_t)other;
    return CLOTH_OK;
}

static struct dxf_piece *last_piece(const struct reader *reader)
{
    struct dxf_piece *piece = reader->dxf->piece.items;
    return reader->in_block ? piece + reader->dxf->piece.n - 1 : NULL;
}

static int take_text(struct reader *reader, const char *text)
{
    struct dxf_piece *piece = last_piece(reader);
    const char *value;
    if ((value = value_of(text, "Units")))
        return read_units(reader, value);
    if ((value = value_of(text, "Sample Size")))
        return keep_text(reader, &reader->dxf->sample, value);
    if (piece && (value = value_of(text, "Piece Name")))
        return keep_text(reader, &piece->name, value);
    if (piece && (value = value_of(text, "Size")))
        return keep_text(reader, &piece->size, value);
    if (piece && (value = value_of(text, "Quantity")))
        return read_quantity(reader, piece, value);
    return CLOTH_OK;
}

/* ---- Lines ---- */

static bool is_of_use(long layer)
{
    return layer == DXF_BOUNDARY || layer == DXF_MIRROR || layer == DXF_GRAIN || layer == DXF_SEW;
}

static int open_line(struct reader *reader, struct dxf_piece *piece)
{
    const struct entity *entity = &reader->entity;
    const struct dxf_line line = {.layer = (enum dxf_layer)entity->layer,
                                  .first = (uint32_t)piece->place.n,
                                  .closed = entity->flags & 1,
                                  .at = entity->at};
    if (piece->line.n >= DXF_LINES)
        return WRONG(reader, "a piece has more than %d lines", DXF_LINES);
    return cloth_list_put(&piece->line, &line, sizeof line, reader->error);
}

static int put_place(struct reader *reader, struct dxf_piece *piece, const double x[2])
{
    struct dxf_line *line = piece->line.items;
    if (piece->place.n >= DXF_PLACES)
        return WRONG(reader, "a piece has more than %d points", DXF_PLACES);
    line[piece->line.n - 1].n++;
    return cloth_list_put(&piece->place, x, 2 * sizeof *x, reader->error);
}

/* The profile's lines are straight from vertex to vertex. */
static int refuse_curve(struct reader *reader, const char *what)
{
    return dxf_fail(reader->dxf, reader->entity.at, reader->error,
                    "%s on layer %ld: the AAMA and ASTM profiles have polylines alone; export in "
                    "one of these, or turn curves into polylines",
                    what, reader->entity.layer);
}

/* The list that takes an entity's first place; NULL: none. Notches are points, or lines from the
 * boundary on. */
static struct cloth_list *points_of(struct dxf_piece *piece, const struct entity *entity)
{
    const long layer = entity->layer;
    const bool point = !strcmp(entity->type, "POINT");
    if (point && layer == DXF_TURN_POINTS)
        return &piece->turn;
    return (point || !strcmp(entity->type, "LINE")) &&
                   (layer == DXF_NOTCHES ||
                    (layer >= DXF_OTHER_NOTCHES && layer <= DXF_LAST_NOTCHES))
               ? &piece->notch
               : NULL;
}

static int take_drawing(struct reader *reader, struct dxf_piece *piece)
{
    static const char *const curves[] = {"ARC", "CIRCLE", "ELLIPSE", "SPLINE"};
    const struct entity *entity = &reader->entity;
    const bool of_use = is_of_use(entity->layer);
    struct cloth_list *points = points_of(piece, entity);
    if (points)
        return points->n >= DXF_LINES
                   ? CLOTH_OK
                   : cloth_list_put(points, entity->x[0], sizeof entity->x[0], reader->error);
    if (!strcmp(entity->type, "LINE") && of_use)
        return open_line(reader, piece) || put_place(reader, piece, entity->x[0]) ||
               put_place(reader, piece, entity->x[1]);
    if (!strcmp(entity->type, "POLYLINE") && of_use) {
        reader->open = true;
        return open_line(reader, piece);
    }
    for (size_t i = 0; i < sizeof curves / sizeof *curves; i++)
        if (!strcmp(entity->type, curves[i]) && of_use)
            return refuse_curve(reader, curves[i]);
    return CLOTH_OK;
}

/* ---- Blocks ---- */

static void free_piece(struct dxf_piece *piece)
{
    free(piece->block);
    free(piece->name);
    free(piece->size);
    free(piece->line.items);
    free(piece->place.items);
    free(piece->turn.items);
    free(piece->notch.items);
}

static int begin_block(struct reader *reader)
{
    const struct dxf_piece piece = {.at = reader->entity.at};
    if (reader->dxf->piece.n >= DXF_PIECES)
        return WRONG(reader, "the file has more than %d blocks", DXF_PIECES);
    reader->in_block = !cloth_list_put(&reader->dxf->piece, &piece, sizeof piece, reader->error);
    return reader->in_block ? keep_text(reader, &last_piece(reader)->block, reader->entity.name)
                            : reader->error->code;
}

/* A block without a boundary, as that of a title, is no piece. */
static int end_block(struct reader *reader)
{
    struct dxf_piece *piece = last_piece(reader);
    reader->in_block = false;
    if (piece && dxf_line_of(piece, DXF_BOUNDARY))
        return keep_text(reader, &piece->name, piece->block ? piece->block : "piece");
    if (!piece)
        return CLOTH_OK;
    free_piece(piece);
    reader->dxf->piece.n--;
    return CLOTH_OK;
}

/* ---- Entities ---- */

static int end_entity(struct reader *reader)
{
    const struct entity *entity = &reader->entity;
    struct dxf_piece *piece = last_piece(reader);
    const char *type = entity->type;
    if (!type)
        return CLOTH_OK;
    if (!strcmp(type, "VERTEX"))
        return reader->open && piece ? put_place(reader, piece, entity->x[0]) : CLOTH_OK;
    reader->open = false;
    if (!strcmp(type, "SECTION")) {
        reader->ever = true;
        reader->in_blocks = entity->name && !strcmp(entity->name, "BLOCKS");
    }
    if (!strcmp(type, "BLOCK") && reader->in_blocks)
        return end_block(reader) || begin_block(reader);
    if (!strcmp(type, "ENDBLK") || !strcmp(type, "ENDSEC"))
        return end_block(reader);
    if (!strcmp(type, "TEXT") || !strcmp(type, "MTEXT"))
        return entity->text ? take_text(reader, entity->text) : CLOTH_OK;
    return piece ? take_drawing(reader, piece) : CLOTH_OK;
}

/* A vertex of a polyline whose vertices are pairs of its own. */
static int take_light_vertex(struct reader *reader)
{
    struct dxf_piece *piece = last_piece(reader);
    struct entity *entity = &reader->entity;
    if (!piece || !is_of_use(entity->layer))
        return CLOTH_OK;
    if (!reader->open && open_line(reader, piece))
        return reader->error->code;
    reader->open = true;
    return put_place(reader, piece, entity->x[0]);
}

static int take_whole(struct reader *reader)
{
    static const double units[] = {0, INCH, 12 * INCH, 0, MM, 0.01, 1}; /* $INSUNITS */
    const long n = strtol(reader->text.value, NULL, 10);
    reader->entity.flags = n;
    if (!strcmp(reader->variable, "$INSUNITS") && !reader->units_told && n > 0 &&
        n < (long)(sizeof units / sizeof *units) && units[n] > 0)
        reader->dxf->unit = units[n];
    return CLOTH_OK;
}

static int take_coordinate(struct reader *reader)
{
    struct entity *entity = &reader->entity;
    const bool light = entity->type && !strcmp(entity->type, "LWPOLYLINE");
    const long code = reader->text.code;
    if (dxf_text_number(&reader->text, &entity->x[code % 10][code / 10 - 1]))
        return reader->error->code;
    return light && code == 20 ? take_light_vertex(reader) : CLOTH_OK;
}

static int take_bulge(struct reader *reader)
{
    double bulge;
    const char *type = reader->entity.type;
    const bool of_use = reader->open || (type && is_of_use(reader->entity.layer));
    if (!of_use || !type || !last_piece(reader) ||
        (strcmp(type, "VERTEX") != 0 && strcmp(type, "LWPOLYLINE") != 0))
        return CLOTH_OK;
    if (dxf_text_number(&reader->text, &bulge))
        return reader->error->code;
    return bulge < 0 || bulge > 0 ? refuse_curve(reader, "a bulge (group code 42)") : CLOTH_OK;
}

static int take_pair(struct reader *reader)
{
    struct entity *entity = &reader->entity;
    switch (reader->text.code) {
    case 0:
        if (end_entity(reader))
            return reader->error->code;
        *entity = (struct entity){.type = reader->text.value, .at = reader->text.line};
        reader->variable[0] = '\0';
        return CLOTH_OK;
    case 1:
        entity->text = reader->text.value;
        return CLOTH_OK;
    case 2:
        entity->name = reader->text.value;
        return CLOTH_OK;
    case 8:
        entity->layer = strtol(reader->text.value, NULL, 10);
        return CLOTH_OK;
    case 9:
        snprintf(reader->variable, sizeof reader->variable, "%s", reader->text.value);
        return CLOTH_OK;
    case 10:
    case 11:
    case 20:
    case 21:
        return take_coordinate(reader);
    case 42:
        return take_bulge(reader);
    case 70:
        return take_whole(reader);
    default:
        return CLOTH_OK;
    }
}

/* ---- The file ---- */

int dxf_read(struct dxf *dxf, const char *path, struct cloth_error *error)
{
    *dxf = (struct dxf){.path = path, .unit = MM};
    struct reader reader = {.dxf = dxf, .error = error};
    int code = dxf_text_open(&reader.text, dxf, error);
    while (!code && !(code = dxf_text_next(&reader.text)) && !reader.text.over)
        code = take_pair(&reader);
    code = code || end_entity(&reader) || end_block(&reader);
    if (!code && !reader.ever)
        cloth_fail(error, CLOTH_E_INPUT, "%s: no DXF file: it has no SECTION", path);
    else if (!code && !dxf->piece.n)
        cloth_fail(error, CLOTH_E_INPUT,
                   "%s: no block has a boundary, a polyline on layer 1: export the pattern in the "
                   "AAMA or ASTM profile",
                   path);
    free(reader.text.bytes);
    return error->code;
}

void dxf_free(struct dxf *dxf)
{
    struct dxf_piece *piece = dxf->piece.items;
    for (size_t i = 0; i < dxf->piece.n; i++)
        free_piece(piece + i);
    free(piece);
    free(dxf->sample);
    *dxf = (struct dxf){0};
}

const struct dxf_line *dxf_line_of(const struct dxf_piece *piece, enum dxf_layer layer)
{
    const struct dxf_line *line = piece->line.items;
    for (size_t i = 0; i < piece->line.n; i++)
        if (line[i].layer == layer && line[i].n > 1)
            return line + i;
    return NULL;
}
