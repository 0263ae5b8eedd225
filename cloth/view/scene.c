/* A scene holds the cloth of the last move and the shadows it throws; drawing changes neither. */
#include "cloth/view/scene.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

static int make_programs(struct view_scene *scene, struct cloth_error *error)
{
    static const char *const text[VIEW_PROGRAMS][2] = {
        [VIEW_CAST] = {DRAW_CAST_VERTEX, DRAW_CAST_FRAGMENT},
        [VIEW_SURFACE] = {DRAW_SURFACE_VERTEX, DRAW_SURFACE_FRAGMENT},
        [VIEW_GROUND] = {DRAW_GROUND_VERTEX, DRAW_GROUND_FRAGMENT},
        [VIEW_SHADE] = {DRAW_ALL_VERTEX, DRAW_SHADE_FRAGMENT},
        [VIEW_SKY] = {DRAW_ALL_VERTEX, DRAW_SKY_FRAGMENT},
        [VIEW_SKY_SQUARE] = {DRAW_ALL_VERTEX, DRAW_SKY_SQUARE_FRAGMENT},
        [VIEW_SUN_SQUARE] = {DRAW_ALL_VERTEX, DRAW_SUN_SQUARE_FRAGMENT},
        [VIEW_BLUR] = {DRAW_ALL_VERTEX, DRAW_BLUR_FRAGMENT},
    };
    for (int i = 0; i < VIEW_PROGRAMS; i++) {
        int code = draw_program(&scene->program[i], text[i][0], text[i][1], error);
        if (code)
            return code;
    }
    return 0;
}

/* Counts the runs of `corners` vertices that belong to a cloth, from `first` on, of n in all. */
static uint32_t count_of(const uint32_t *vertex, uint32_t corners, uint32_t first, uint32_t n,
                         uint32_t end)
{
    uint32_t last = first;
    while (last < n && vertex[(size_t)corners * last] < end)
        last++;
    return last - first;
}

static int make_parts(struct view_scene *scene, const struct view_shape *shape,
                      struct cloth_error *error)
{
    const uint32_t n = shape->n_cloths ? shape->n_cloths : 1;
    struct draw_part next = {0};
    scene->part = calloc(n, sizeof *scene->part);
    if (!scene->part)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the colours of %u cloths", n);
    scene->n_parts = n;
    for (uint32_t c = 0; c < n; c++) {
        const uint32_t end = c + 1 < n ? shape->cloth_end[c] : UINT32_MAX;
        next.n_triangles = count_of(shape->triangle, 3, next.triangle, shape->n_triangles, end);
        next.n_lines = count_of(shape->line, 2, next.line, shape->n_lines, end);
        scene->part[c] = next;
        next.triangle += next.n_triangles;
        next.line += next.n_lines;
    }
    return CLOTH_OK;
}

bool view_scene_has_shapes(const struct view_scene *scene)
{
    return scene->obstacles && scene->obstacles->n_vertices;
}

static int make_grounds(struct view_scene *scene, struct cloth_error *error)
{
    const size_t n = scene->obstacles ? scene->obstacles->n_planes : 0;
    scene->ground = calloc(n + 1, sizeof *scene->ground);
    if (!scene->ground)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for %zu planes", n);
    int code = CLOTH_OK;
    for (int i = 0; i < DRAW_SQUARES && n && !code; i++)
        code = draw_sky_make_square(scene->unsmooth + i, DRAW_SQUARE_SIZE[i], error);
    for (; scene->n_grounds < n && !code; scene->n_grounds++)
        code = draw_ground_make(scene->ground + scene->n_grounds, error);
    return code;
}

int view_scene_new(struct view_scene **scene, const struct view_shape *shape,
                   struct cloth_error *error)
{
    *scene = NULL;
    struct view_scene *made = calloc(1, sizeof *made);
    if (!made)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for a scene");
    made->obstacles = shape->obstacles;
    glGenVertexArrays(1, &made->nothing);
    glGenTextures(1, &made->paints);
    int code = make_programs(made, error);
    code = code ? code : make_parts(made, shape, error);
    code = code ? code : draw_lights_make(&made->lights, error);
    code = code ? code : make_grounds(made, error);
    code = code ? code
                : draw_mesh_make(&made->mesh, shape->n_vertices, shape->n_triangles,
                                 shape->triangle, shape->n_lines, shape->line, error);
    if (!code && view_scene_has_shapes(made))
        code =
            draw_mesh_make(&made->shapes, made->obstacles->n_vertices, made->obstacles->n_triangles,
                           made->obstacles->triangle[0], 0, NULL, error);
    if (code) {
        view_scene_free(made);
        return code;
    }
    *scene = made;
    return 0;
}

static void cast(const void *context, bool coarse)
{
    const struct view_scene *scene = context;
    void (*const draw)(const struct draw_mesh *) = coarse ? draw_mesh_draw_coarse : draw_mesh_draw;
    draw(&scene->mesh);
    if (view_scene_has_shapes(scene))
        draw(&scene->shapes);
}

/* Radius of a sphere around the cloth and shapes near it: shadows beyond are not worth the loss of
 * sharpness. */
static float lit_radius(const struct view_scene *scene)
{
    const float *centre = scene->mesh.center, least = scene->mesh.radius;
    float max = least;
    for (size_t v = 0; view_scene_has_shapes(scene) && v < scene->shapes.n_vertices; v++) {
        float square = 0;
        for (size_t k = 0; k < 3; k++) {
            const float away = scene->shapes.vertex[6 * v + k] - centre[k];
            square += away * away;
        }
        max = fmaxf(max, fminf(sqrtf(square), 2 * least));
    }
    return max;
}

GLuint view_scene_use(const struct view_scene *scene, enum view_program which, int width,
                      int height)
{
    static const char *const units[] = {
        [DRAW_UNIT_SUNS] = "suns",          [DRAW_UNIT_SKIES] = "skies",
        [DRAW_UNIT_FRONT] = "fronts",       [DRAW_UNIT_BACK] = "backs",
        [DRAW_UNIT_SURFACES] = "surfaces",  [DRAW_UNIT_SURFACES + 1] = "lights",
        [DRAW_UNIT_SURFACES + 2] = "depths"};
    const GLuint program = scene->program[which];
    glUseProgram(program);
    glUniform2f(glGetUniformLocation(program, "size"), (float)width, (float)height);
    glUniform1i(glGetUniformLocation(program, "shadows"), !scene->plain);
    for (int i = 0; i < (int)(sizeof units / sizeof *units); i++)
        glUniform1i(glGetUniformLocation(program, units[i]), i);
    return program;
}

static void light_square(const struct view_scene *scene, const struct draw_ground *ground, int by)
{
    const struct draw_square *square = ground->square + by;
    const int size = DRAW_SQUARE_SIZE[by];
    GLuint program =
        view_scene_use(scene, by == DRAW_BY_SKY ? VIEW_SKY_SQUARE : VIEW_SUN_SQUARE, size, size);
    draw_ground_square(ground, program, square->centre, square->half);
    draw_sky_light(scene->unsmooth + by, 0);
    program = view_scene_use(scene, VIEW_BLUR, size, size);
    glUniform1f(glGetUniformLocation(program, "blur"), square->blur);
    draw_sky_light(&square->light, scene->unsmooth[by].light[0]);
}

static void light_surface(const struct draw_mesh *mesh)
{
    draw_sky_place(&mesh->sky, mesh->vertex, mesh->n_vertices);
    draw_sky_light(&mesh->sky, mesh->sky.source);
}

/* The sky's light where everything is now. */
static void light(struct view_scene *scene)
{
    draw_lights_bind(&scene->lights);
    glBindVertexArray(scene->nothing);
    view_scene_use(scene, VIEW_SKY, 0, 0);
    light_surface(&scene->mesh);
    if (view_scene_has_shapes(scene))
        light_surface(&scene->shapes);
    for (size_t i = 0; i < scene->n_grounds; i++) {
        draw_ground_place(scene->ground + i, scene->obstacles->plane[i], scene->mesh.center,
                          scene->mesh.radius, &scene->lights);
        light_square(scene, scene->ground + i, DRAW_BY_SKY);
        if (!scene->plain)
            light_square(scene, scene->ground + i, DRAW_BY_SUN);
    }
}

int view_scene_move(struct view_scene *scene, const double *position, struct cloth_error *error)
{
    draw_mesh_move(&scene->mesh, position);
    if (view_scene_has_shapes(scene))
        draw_mesh_place(&scene->shapes, (const double(*)[6])scene->obstacles->vertex);
    const GLuint program = scene->program[VIEW_CAST];
    const struct draw_casting casting = {cast, scene, glGetUniformLocation(program, "map")};
    glUseProgram(program);
    draw_lights_aim(&scene->lights, scene->mesh.center, lit_radius(scene),
                    scene->plain ? NULL : &casting);
    light(scene);
    const GLenum trouble = glGetError();
    return trouble == GL_NO_ERROR
               ? 0
               : cloth_fail(error, CLOTH_E_LIBRARY, "OpenGL took no vertices (0x%x)", trouble);
}

void view_scene_paint(struct view_scene *scene, enum view_paint paint, int n, const float (*map)[3],
                      const float *value)
{
    scene->paint = paint;
    scene->n_map = paint == VIEW_PAINT_CLOTH ? 0 : n;
    scene->map = map;
    if (paint != VIEW_PAINT_CLOTH)
        draw_mesh_values(&scene->mesh, value);
}

void view_scene_style(struct view_scene *scene, bool wired, bool plain)
{
    scene->wired = wired;
    scene->plain = plain;
}

void view_scene_free(struct view_scene *scene)
{
    if (!scene)
        return;
    draw_mesh_free(&scene->mesh);
    draw_mesh_free(&scene->shapes);
    for (int i = 0; i < DRAW_SQUARES; i++)
        draw_sky_free(scene->unsmooth + i);
    for (size_t i = 0; i < scene->n_grounds; i++)
        draw_ground_free(scene->ground + i);
    free(scene->ground);
    draw_surfaces_free(&scene->surfaces);
    draw_lights_free(&scene->lights);
    for (int i = 0; i < VIEW_PROGRAMS; i++)
        glDeleteProgram(scene->program[i]);
    glDeleteVertexArrays(1, &scene->nothing);
    glDeleteTextures(1, &scene->paints);
    free(scene->part);
    free(scene);
}
