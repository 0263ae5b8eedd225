/* Numbers have 17 digits, which read back as the same bits. */
#include "cloth/output/garment.h"
#include "cloth/output/files/files.h"
#include "cloth/output/files/json.h"

struct both {
    const struct garment *garment;
    const struct garment_pattern *pattern;
};

static int fill_obj(FILE *file, const void *what)
{
    const struct both *both = what;
    const struct garment *garment = both->garment;
    for (uint32_t v = 0; v < garment->n_vertices; v++) {
        const double *x = garment->position[v];
        fprintf(file, "v %.17g %.17g %.17g\n", x[0], x[1], x[2]);
    }
    for (uint32_t v = 0; v < garment->n_vertices; v++)
        fprintf(file, "vt %.17g %.17g\n", garment->uv[v][0], garment->uv[v][1]);
    for (uint32_t p = 0; p < garment->n_pieces && !ferror(file); p++) {
        const struct garment_piece *piece = &garment->piece[p];
        fprintf(file, "g %s\n", both->pattern->panel[p].name);
        for (uint32_t t = 0; t < piece->n_triangles; t++) {
            const uint32_t *v = garment->triangle[piece->first_triangle + t];
            fprintf(file, "f %u/%u %u/%u %u/%u\n", v[0] + 1, v[0] + 1, v[1] + 1, v[1] + 1, v[2] + 1,
                    v[2] + 1);
        }
    }
    return ferror(file);
}

static void put_edge(FILE *file, const struct garment_piece *piece, uint32_t n_edges, uint32_t e)
{
    const uint32_t n = piece->start[n_edges];
    fputs(e ? ",\n       [" : "[", file);
    for (uint32_t k = piece->start[e]; k <= piece->start[e + 1]; k++)
        fprintf(file, "%s%u", k > piece->start[e] ? ", " : "", piece->first + k % n);
    fputc(']', file);
}

static void output_garment_put_panel(FILE *file, const struct both *both, uint32_t p)
{
    const struct garment_panel *panel = &both->pattern->panel[p];
    const struct garment_piece *piece = &both->garment->piece[p];
    fputs(p ? ",\n    {\"name\": " : "\n    {\"name\": ", file);
    output_json_string(file, panel->name);
    fprintf(file, ", \"vertices\": [%u, %u], \"triangles\": [%u, %u],\n     \"edges\":\n      [",
            piece->first, piece->n_vertices, piece->first_triangle, piece->n_triangles);
    for (uint32_t e = 0; e < panel->n_edges; e++)
        put_edge(file, piece, panel->n_edges, e);
    fputs("]}", file);
}

static void output_garment_put_side(FILE *file, const struct both *both,
                                    const struct garment_side *side)
{
    const struct garment_panel *panel = &both->pattern->panel[side->panel];
    fputs("{\"panel\": ", file);
    output_json_string(file, panel->name);
    fprintf(file, ", \"edge\": %u, \"length\": ", side->edge);
    output_json_number(file, garment_edge_length(panel, side->edge));
    fputc('}', file);
}

static void put_seam(FILE *file, const struct both *both, uint32_t s)
{
    const struct garment_seam *seam = &both->garment->seam[s];
    const struct garment_side *side = both->pattern->stitch[s].side;
    fputs(s ? ",\n    {\"sides\": [" : "\n    {\"sides\": [", file);
    output_garment_put_side(file, both, &side[0]);
    fputs(", ", file);
    output_garment_put_side(file, both, &side[1]);
    fprintf(file, "],\n     \"reversed\": %s, \"distances\": ", seam->reversed ? "true" : "false");
    output_json_put_numbers(file, 2, seam->distance);
    fputs(",\n     \"pairs\": [", file);
    for (uint32_t k = 0; k < seam->n_pairs; k++)
        fprintf(file, "%s[%u, %u]", k ? ", " : "", seam->pair[k][0], seam->pair[k][1]);
    fputs("]}", file);
}

static int fill_seams(FILE *file, const void *what)
{
    const struct both *both = what;
    fprintf(file, "{\n  \"schema\": 1, \"vertices\": %u, \"triangles\": %u,\n  \"panels\": [",
            both->garment->n_vertices, both->garment->n_triangles);
    for (uint32_t p = 0; p < both->garment->n_pieces; p++)
        output_garment_put_panel(file, both, p);
    fputs("],\n  \"seams\": [", file);
    for (uint32_t s = 0; s < both->garment->n_seams; s++)
        put_seam(file, both, s);
    fputs("]\n}\n", file);
    return ferror(file);
}

int output_garment_obj(const char *path, const struct garment *garment,
                       const struct garment_pattern *pattern, struct cloth_error *error)
{
    const struct both both = {garment, pattern};
    return output_replace_file(path, fill_obj, &both, error);
}

int output_garment_seams(const char *path, const struct garment *garment,
                         const struct garment_pattern *pattern, struct cloth_error *error)
{
    const struct both both = {garment, pattern};
    return output_replace_file(path, fill_seams, &both, error);
}
