/* Control points are places, not parts of their edge, which would be rounded on the way back. */
#include "cloth/output/files/files.h"
#include "cloth/output/files/json.h"
#include "cloth/output/garment.h"

static void put_curvature(FILE *file, const struct garment_edge *edge)
{
    static const char *const type[] = {[GARMENT_QUADRATIC] = "quadratic",
                                       [GARMENT_CUBIC] = "cubic",
                                       [GARMENT_CIRCLE] = "circle",
                                       [GARMENT_POLYLINE] = "polyline"};
    if (edge->curve == GARMENT_STRAIGHT)
        return;
    fprintf(file, ", \"curvature\": {\"type\": \"%s\", \"params\": [", type[edge->curve]);
    if (edge->curve == GARMENT_CIRCLE) {
        output_json_number(file, edge->radius);
        fprintf(file, ", %d, %d]}", edge->large, edge->right);
        return;
    }
    for (uint32_t i = 0; i < edge->n_points; i++) {
        fputs(i ? ", " : "", file);
        output_json_put_numbers(file, 2, edge->point[i]);
    }
    if (edge->curve != GARMENT_POLYLINE)
        output_json_put_numbers(file, 2, edge->control[0]);
    if (edge->curve == GARMENT_CUBIC) {
        fputs(", ", file);
        output_json_put_numbers(file, 2, edge->control[1]);
    }
    fputs("]}", file);
}

static void output_pattern_put_panel(FILE *file, const struct garment_panel *panel)
{
    output_json_string(file, panel->name);
    fputs(": {\n        \"translation\": ", file);
    output_json_put_numbers(file, 3, panel->translate);
    fputs(", \"rotation\": ", file);
    output_json_put_numbers(file, 3, panel->rotate);
    fputs(panel->warp_up ? ", \"warp\": \"y\"" : "", file);
    fputs(",\n        \"vertices\": [", file);
    for (uint32_t c = 0; c < panel->n_corners; c++) {
        fputs(c ? ", " : "", file);
        output_json_put_numbers(file, 2, panel->corner[c]);
    }
    fputs("],\n        \"edges\": [", file);
    for (uint32_t e = 0; e < panel->n_edges; e++) {
        const struct garment_edge *edge = &panel->edge[e];
        fprintf(file, "%s\n          {\"endpoints\": [%u, %u]", e ? "," : "", edge->end[0],
                edge->end[1]);
        put_curvature(file, edge);
        fputc('}', file);
    }
    fputs("]}", file);
}

static void put_stitch(FILE *file, const struct garment_pattern *pattern,
                       const struct garment_stitch *stitch)
{
    for (int k = 0; k < 2; k++) {
        fputs(k ? ", {\"panel\": " : "[{\"panel\": ", file);
        output_json_string(file, pattern->panel[stitch->side[k].panel].name);
        fprintf(file, ", \"edge\": %u}", stitch->side[k].edge);
    }
    fputs(stitch->right_wrong ? ", \"right_wrong\"]" : "]", file);
}

static int fill_pattern(FILE *file, const void *what)
{
    const struct garment_pattern *pattern = what;
    fputs("{\n  \"properties\": {\"units_in_meter\": 1, \"curvature_coords\": \"absolute\",\n"
          "                 \"normalize_panel_translation\": false},\n"
          "  \"pattern\": {\n    \"panels\": {",
          file);
    for (uint32_t p = 0; p < pattern->n_panels && !ferror(file); p++) {
        fputs(p ? ",\n      " : "\n      ", file);
        output_pattern_put_panel(file, &pattern->panel[p]);
    }
    fputs("\n    },\n    \"stitches\": [", file);
    for (uint32_t s = 0; s < pattern->n_stitches && !ferror(file); s++) {
        fputs(s ? ",\n      " : "\n      ", file);
        put_stitch(file, pattern, &pattern->stitch[s]);
    }
    fputs("\n    ]\n  }\n}\n", file);
    return ferror(file);
}

int output_pattern(const char *path, const struct garment_pattern *pattern,
                   struct cloth_error *error)
{
    return output_replace_file(path, fill_pattern, pattern, error);
}
