/* Cloths whose mesh is made of a sewing pattern. */
#include "tests/cloth/scene/scene_file.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Two rectangles of 20 x 30 cm, face to face, 3 cm from each other. */
static const char *const PILLOW =
    "{\"pattern\": {\"panels\": {\n"
    "  \"front\": {\"vertices\": [[0, 0], [20, 0], [20, 30], [0, 30]], \"edges\": [{\"endpoints\": "
    "[0, 1]}, {\"endpoints\": [1, 2]}, {\"endpoints\": [2, 3]}, {\"endpoints\": [3, 0]}],\n"
    "    \"translation\": [0, 0, 3], \"rotation\": [0, 0, 0]},\n"
    "  \"back\": {\"vertices\": [[0, 0], [20, 0], [20, 30], [0, 30]], \"edges\": [{\"endpoints\": "
    "[0, 1]}, {\"endpoints\": [1, 2]}, {\"endpoints\": [2, 3]}, {\"endpoints\": [3, 0]}],\n"
    "    \"translation\": [20, 0, 0], \"rotation\": [0, 180, 0]}},\n"
    "  \"stitches\": [[{\"panel\": \"front\", \"edge\": 1}, {\"panel\": \"back\", \"edge\": 3}],\n"
    "    [{\"panel\": \"front\", \"edge\": 3}, {\"panel\": \"back\", \"edge\": 1}]]},\n"
    " \"properties\": {\"curvature_coords\": \"relative\", \"units_in_meter\": 100}}\n";

static const char *const GRID = "{grid: {width: 1, height: 2, nx: 4, ny: 3}}";

/* The scene that is right, with the mesh of the pattern and without what names its vertices. */
static char *scene_of(const char *mesh)
{
    scene_write_file("pillow.json", PILLOW, strlen(PILLOW));
    char *text =
        scene_changed(scene_right, "    loads: [{vertices: [11], force: [0, 1, 0]}]\n", "");
    char *whole = scene_changed(text, GRID, mesh);
    free(text);
    return whole;
}

/* Areas and places are those of the panels, and lengths in uv those in space. */
UNIT_TEST(panels_as_a_mesh)
{
    char *text = scene_of("{pattern: {file: pillow.json, edge: 0.03}}");
    UNIT_OWNED(model_free) struct model model = scene_read_right(text, 0, NULL);
    const struct mesh *mesh = &model.cloths[0].mesh;
    double low[3], high[3];
    ck_assert_ptr_nonnull(mesh->uv);
    ck_assert_uint_eq(mesh->n_faces, mesh->n_triangles);
    ck_assert_double_eq_tol(mesh_surface(mesh), 2 * 0.2 * 0.3, 1e-12);
    mesh_box(mesh, low, high);
    for (int k = 0; k < 3; k++) {
        ck_assert_double_eq_tol(low[k], 0, 1e-12);
        ck_assert_double_eq_tol(high[k], k == 0 ? 0.2 : k == 1 ? 0.3 : 0.03, 1e-12);
    }
    for (uint32_t t = 0; t < mesh->n_triangles; t++)
        for (uint32_t k = 0; k < 3; k++) {
            const uint32_t a = mesh->triangle[3 * t + k], b = mesh->triangle[3 * t + (k + 1) % 3];
            const double *x = mesh->position + 3 * a, *y = mesh->position + 3 * b;
            const double *u = mesh->uv + 2 * a, *v = mesh->uv + 2 * b;
            ck_assert_double_eq_tol(sqrt((x[0] - y[0]) * (x[0] - y[0]) +
                                         (x[1] - y[1]) * (x[1] - y[1]) +
                                         (x[2] - y[2]) * (x[2] - y[2])),
                                    hypot(u[0] - v[0], u[1] - v[1]), 1e-12);
        }
    ck_assert_uint_eq(mesh->n_groups, 2);
    unsigned char *front = calloc(mesh->n_vertices, 1);
    mesh_group_vertices(mesh, mesh_group_of(mesh, "front"), front);
    for (uint32_t v = 0; v < mesh->n_vertices; v++)
        ck_assert((mesh->position[3 * v + 2] > 0.015) == front[v]);
    free(front);
    ck_assert_uint_eq(model.n_files, 2);
    unit_says(model.files[1], "/pillow.json");
    free(text);
}

/* The scene's panels and stitches, beside the pattern's. */
UNIT_TEST(panels_that_the_scene_places_and_sews)
{
    char *text = scene_of("{pattern: {file: pillow.json, edge: 0.03, place: {back: {rotation: [0, "
                          "90, 0], translation: [0, 1, 2]}}, stitches: [[{panel: front, edge: 0}, "
                          "{panel: back, edge: 0}]]}}");
    UNIT_OWNED(model_free) struct model model = scene_read_right(text, 0, NULL);
    const struct mesh *mesh = &model.cloths[0].mesh;
    double low[3], high[3];
    mesh_box(mesh, low, high);
    ck_assert_double_eq_tol(high[1], 1.3, 1e-12);
    ck_assert_double_eq_tol(high[2], 2, 1e-12);
    ck_assert_uint_eq(model.cloths[0].seams.n, 3);
    ck_assert_str_eq(model.cloths[0].seams.seam[2].side[1].panel, "back");
    free(text);
}

UNIT_TEST(panels_by_count)
{
    char *text = scene_of("{pattern: {file: pillow.json, vertices: 4000}}");
    UNIT_OWNED(model_free) struct model model = scene_read_right(text, 0, NULL);
    ck_assert_double_eq_tol(model.cloths[0].mesh.n_vertices, 4000, 40);
    free(text);
}

static double width_of(const struct model *model)
{
    double low[3], high[3];
    mesh_box(&model->cloths[0].mesh, low, high);
    return high[0] - low[0];
}

/* A skirt's panels are half as wide as its hem; a transform scales and shifts all. */
UNIT_TEST(own_garments)
{
    char *text = scene_of("{pattern: {garment: skirt, edge: 0.1}}");
    UNIT_OWNED(model_free) struct model model = scene_read_right(text, 0, NULL);
    ck_assert_double_eq_tol(width_of(&model), 0.8, 1e-12);
    ck_assert_uint_eq(model.cloths[0].mesh.n_groups, 4);
    ck_assert_uint_eq(model.cloths[0].seams.n, 8);
    ck_assert_uint_eq(model.n_files, 1);
    model_free(&model);
    free(text);
    text = scene_of("{pattern: {garment: skirt, size: XL, edge: 0.1}}");
    model = scene_read_right(text, 0, NULL);
    ck_assert_double_eq_tol(width_of(&model), 0.85, 1e-12);
    model_free(&model);
    free(text);
    text = scene_of("{pattern: {garment: skirt, measures: {hem: 1.2, waist: 0.7}, edge: 0.1}}\n"
                    "    transform: {scale: 2}");
    model = scene_read_right(text, 0, NULL);
    ck_assert_double_eq_tol(width_of(&model), 1.2, 1e-12);
    free(text);
}

/* A skirt around a box of 0.2 x 0.2 m; *warning: the one that says too small, or NULL. */
static struct model worn(const char *waist, const char *state, const char **warning)
{
    static const char box[] =
        "v -.1 0 -.1\nv .1 0 -.1\nv .1 0 .1\nv -.1 0 .1\nv -.1 1.7 -.1\nv .1 1.7 -.1\nv .1 1.7 .1\n"
        "v -.1 1.7 .1\nf 1 2 3 4\nf 8 7 6 5\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n";
    char text[1024];
    scene_write_file("box.obj", box, strlen(box));
    snprintf(
        text, sizeof text,
        "schema: 1\ncloths:\n  - mesh: {pattern: {garment: skirt, measures: {waist: %s}, edge: "
        "0.05}}\n    material: denim\n    seams: {state: %s}\n"
        "obstacles:\n  - body: {obj: box.obj, name: figure}\n"
        "contact: {mode: certified, thickness: 0.003}\ntime: {end: 1, h: 0.01}\n",
        waist, state);
    struct model model = scene_read_right(text, 0, NULL);
    *warning = NULL;
    for (uint32_t i = 0; i < model.n_warnings; i++)
        if (strstr(model.warnings[i], "too small"))
            *warning = model.warnings[i];
    return model;
}

/* The waist is as narrow from 1.08 to 1.1 m: any of its heights may be named. */
UNIT_TEST(garments_that_are_too_small)
{
    const char *warning;
    UNIT_OWNED(model_free) struct model model = worn("0.7", "pulled", &warning);
    ck_assert_ptr_nonnull(warning);
    ck_assert_msg(strstr(warning, "the garment is too small for the body figure: at y = 1.") &&
                      strstr(warning, " its girth is 0.72 m, the body's 0.8 m"),
                  "%s", warning);
    model_free(&model);
    model = worn("0.8", "pulled", &warning);
    ck_assert_ptr_null(warning);
    model_free(&model);
    model = worn("0.7", "open", &warning);
    ck_assert_ptr_null(warning);
}
