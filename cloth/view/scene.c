/* A scene holds the cloth of the last move and the shadows it throws; drawing changes neither, and
 * draws into whatever framebuffer is bound. */
#include "cloth/view/draw/draw.h"
#include "cloth/view/view.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

enum program {
    PROGRAM_CAST,
    PROGRAM_BACK,
    PROGRAM_CLOTH,
    PROGRAM_GROUND,
    PROGRAM_SKY,
    PROGRAM_SKY_GROUND,
    PROGRAM_SKY_BLUR,
    N_PROGRAMS
};

/* Colours of fronts and backs, linear. Those of cloths go round. They differ in lightness, too, for
 * those who see no red or no green. */
enum { N_COLOURS = 6 };
static const float CLOTH[N_COLOURS][2][3] = {{{0.40f, 0.030f, 0.028f}, {0.46f, 0.120f, 0.050f}},
                                             {{0.035f, 0.085f, 0.24f}, {0.09f, 0.15f, 0.30f}},
                                             {{0.55f, 0.38f, 0.07f}, {0.52f, 0.42f, 0.18f}},
                                             {{0.03f, 0.20f, 0.13f}, {0.09f, 0.26f, 0.19f}},
                                             {{0.50f, 0.48f, 0.43f}, {0.45f, 0.43f, 0.40f}},
                                             {{0.17f, 0.04f, 0.20f}, {0.24f, 0.10f, 0.26f}}};
static const float WIRE[2][3] = {{0.01f, 0.01f, 0.012f}, {0.01f, 0.01f, 0.012f}};
static const float STONE[2][3] = {{0.22f, 0.25f, 0.28f}, {0.22f, 0.25f, 0.28f}};

struct view_scene {
    const struct view_obstacles *obstacles; /* NULL: none */
    struct draw_mesh mesh, shapes;          /* the cloth; the obstacles that have a surface */
    struct draw_sky mesh_sky, shapes_sky;
    size_t n_grounds;
    struct draw_ground *ground; /* n_grounds */
    struct draw_sky unsmooth;   /* of one ground after the other */
    struct draw_lights lights;
    GLuint program[N_PROGRAMS];
    GLuint nothing;    /* a vertex array without attributes */
    bool wired, plain; /* plain: without shadows */
    enum view_paint paint;
    int n_map; /* colours of the map, unless each cloth has its own */
    const float (*map)[3];
    uint32_t n_parts;
    struct draw_part *part; /* n_parts: cloths */
};

static int make_programs(struct view_scene *scene, struct cloth_error *error)
{
    static const char *const text[N_PROGRAMS][2] = {
        [PROGRAM_CAST] = {DRAW_CAST_VERTEX, DRAW_CAST_FRAGMENT},
        [PROGRAM_BACK] = {DRAW_BACK_VERTEX, DRAW_BACK_FRAGMENT},
        [PROGRAM_CLOTH] = {DRAW_CLOTH_VERTEX, DRAW_CLOTH_FRAGMENT},
        [PROGRAM_GROUND] = {DRAW_GROUND_VERTEX, DRAW_GROUND_FRAGMENT},
        [PROGRAM_SKY] = {DRAW_BACK_VERTEX, DRAW_SKY_FRAGMENT},
        [PROGRAM_SKY_GROUND] = {DRAW_BACK_VERTEX, DRAW_SKY_GROUND_FRAGMENT},
        [PROGRAM_SKY_BLUR] = {DRAW_BACK_VERTEX, DRAW_SKY_BLUR_FRAGMENT},
    };
    for (int i = 0; i < N_PROGRAMS; i++) {
        int code = draw_program(&scene->program[i], text[i][0], text[i][1], error);
        if (code)
            return code;
    }
    return 0;
}

/* What of n runs of `corners` vertices belongs to a cloth, from `first` on. */
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

static bool has_shapes(const struct view_scene *scene)
{
    return scene->obstacles && scene->obstacles->n_vertices;
}

static int make_grounds(struct view_scene *scene, struct cloth_error *error)
{
    const size_t n = scene->obstacles ? scene->obstacles->n_planes : 0;
    scene->ground = calloc(n + 1, sizeof *scene->ground);
    if (!scene->ground)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for %zu planes", n);
    int code = n ? draw_sky_make(&scene->unsmooth, 0, error) : CLOTH_OK;
    for (; scene->n_grounds < n && !code; scene->n_grounds++)
        code = draw_sky_make(&scene->ground[scene->n_grounds].sky, 0, error);
    return code;
}

/* A mesh and the sky's light on it. */
static int make_surface(struct draw_mesh *mesh, struct draw_sky *sky,
                        const struct view_shape *shape, struct cloth_error *error)
{
    const int code = draw_mesh_make(mesh, shape->n_vertices, shape->n_triangles, shape->triangle,
                                    shape->n_lines, shape->line, error);
    return code ? code : draw_sky_make(sky, shape->n_vertices ? shape->n_vertices : 1, error);
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
    int code = make_programs(made, error);
    code = code ? code : make_parts(made, shape, error);
    code = code ? code : draw_lights_make(&made->lights, error);
    code = code ? code : make_grounds(made, error);
    code = code ? code : make_surface(&made->mesh, &made->mesh_sky, shape, error);
    if (!code && has_shapes(made)) {
        const struct view_shape shapes = {.n_vertices = made->obstacles->n_vertices,
                                          .n_triangles = made->obstacles->n_triangles,
                                          .triangle = made->obstacles->triangle[0]};
        code = make_surface(&made->shapes, &made->shapes_sky, &shapes, error);
    }
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
    if (has_shapes(scene))
        draw(&scene->shapes);
}

/* Of a sphere around the cloth and what is near to it: shadows beyond are not worth their loss of
 * sharpness. */
static float lit_radius(const struct view_scene *scene)
{
    const float *centre = scene->mesh.center, least = scene->mesh.radius;
    float max = least;
    for (size_t v = 0; has_shapes(scene) && v < scene->shapes.n_vertices; v++) {
        float square = 0;
        for (size_t k = 0; k < 3; k++) {
            const float away = scene->shapes.vertex[6 * v + k] - centre[k];
            square += away * away;
        }
        max = fmaxf(max, fminf(sqrtf(square), 2 * least));
    }
    return max;
}

static void bind_lights(const struct view_scene *scene)
{
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, scene->lights.buffer);
    glActiveTexture(GL_TEXTURE0 + DRAW_UNIT_SKIES);
    glBindTexture(GL_TEXTURE_2D_ARRAY, scene->lights.skies);
    glActiveTexture(GL_TEXTURE0 + DRAW_UNIT_SUNS);
    glBindTexture(GL_TEXTURE_2D_ARRAY, scene->lights.suns);
}

static GLuint use(const struct view_scene *scene, enum program which, int width, int height)
{
    static const char *const units[] = {[DRAW_UNIT_SUNS] = "suns",
                                        [DRAW_UNIT_SKIES] = "skies",
                                        [DRAW_UNIT_FRONT] = "fronts",
                                        [DRAW_UNIT_BACK] = "backs"};
    const GLuint program = scene->program[which];
    glUseProgram(program);
    glUniform2f(glGetUniformLocation(program, "size"), (float)width, (float)height);
    glUniform1i(glGetUniformLocation(program, "shadows"), !scene->plain);
    for (int i = 0; i < (int)(sizeof units / sizeof *units); i++)
        glUniform1i(glGetUniformLocation(program, units[i]), i);
    return program;
}

static GLuint use_to_see(const struct view_scene *scene, enum program which,
                         const struct view_camera *camera, int width, int height)
{
    const GLuint program = use(scene, which, width, height);
    glUniformMatrix4fv(glGetUniformLocation(program, "clip"), 1, GL_FALSE, camera->clip[0]);
    glUniform3fv(glGetUniformLocation(program, "eye"), 1, camera->eye);
    return program;
}

static void light_ground(struct view_scene *scene, const struct draw_ground *ground)
{
    GLuint program = use(scene, PROGRAM_SKY_GROUND, DRAW_SKY_SQUARE, DRAW_SKY_SQUARE);
    draw_ground_square(ground, program, ground->lit);
    draw_sky_light(&scene->unsmooth, 0);
    program = use(scene, PROGRAM_SKY_BLUR, DRAW_SKY_SQUARE, DRAW_SKY_SQUARE);
    glUniform1f(glGetUniformLocation(program, "blur"), draw_ground_sky_blur(ground));
    draw_sky_light(&ground->sky, scene->unsmooth.light[0]);
}

static void light_surface(const struct draw_mesh *mesh, const struct draw_sky *sky)
{
    draw_sky_place(sky, mesh->vertex, mesh->n_vertices);
    draw_sky_light(sky, sky->source);
}

/* The sky's light where everything is now. */
static void light(struct view_scene *scene)
{
    bind_lights(scene);
    glBindVertexArray(scene->nothing);
    use(scene, PROGRAM_SKY, 0, 0);
    light_surface(&scene->mesh, &scene->mesh_sky);
    if (has_shapes(scene))
        light_surface(&scene->shapes, &scene->shapes_sky);
    for (size_t i = 0; i < scene->n_grounds; i++) {
        draw_ground_place(scene->ground + i, scene->obstacles->plane[i], scene->mesh.center,
                          scene->mesh.radius);
        light_ground(scene, scene->ground + i);
    }
}

int view_scene_move(struct view_scene *scene, const double *position, struct cloth_error *error)
{
    draw_mesh_move(&scene->mesh, position);
    if (has_shapes(scene))
        draw_mesh_place(&scene->shapes, (const double(*)[6])scene->obstacles->vertex);
    const GLuint program = scene->program[PROGRAM_CAST];
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
    scene->n_map = n;
    scene->map = map;
    if (paint != VIEW_PAINT_CLOTH)
        draw_mesh_values(&scene->mesh, value);
}

void view_scene_wire(struct view_scene *scene, bool wire)
{
    scene->wired = wire;
}

void view_scene_shadows(struct view_scene *scene, bool shadows)
{
    scene->plain = !shadows;
}

static double depth_of(const struct view_camera *camera, const double x[3])
{
    double clip[4];
    for (int i = 0; i < 4; i++) {
        clip[i] = (double)camera->clip[3][i];
        for (int k = 0; k < 3; k++)
            clip[i] += (double)camera->clip[k][i] * x[k];
    }
    return 0.5 * clip[2] / clip[3];
}

/* Vertices of cloth lie on an obstacle, so that its triangles cut through what is round. Obstacles
 * are drawn as if they were a part of an edge of the cloth farther away, in units of the depth. */
static float behind(const struct view_scene *scene, const struct view_camera *camera)
{
    const double part = 0.3, units = 1 << 24;
    double near[3], far[3], away[3];
    for (int k = 0; k < 3; k++) {
        near[k] = (double)scene->mesh.center[k];
        away[k] = near[k] - (double)camera->eye[k];
    }
    const double distance = sqrt(away[0] * away[0] + away[1] * away[1] + away[2] * away[2]);
    for (int k = 0; k < 3; k++)
        far[k] = near[k] + part * (double)draw_mesh_edge(&scene->mesh) * away[k] / distance;
    return (float)(units * (depth_of(camera, far) - depth_of(camera, near)));
}

/* How many pixels an edge of the cloth is long, in the mean, where the middle of the cloth is. */
static double edge_pixels(const struct view_scene *scene, const struct view_camera *camera,
                          int height)
{
    double up = 0, away = (double)camera->clip[3][3];
    for (int k = 0; k < 3; k++) {
        up += (double)(camera->clip[k][1] * camera->clip[k][1]);
        away += (double)(camera->clip[k][3] * scene->mesh.center[k]);
    }
    return away > 0 ? (double)draw_mesh_edge(&scene->mesh) * sqrt(up) / away * height / 2 : 1;
}

/* Lines are paler where they are dense, so that they do not hide the cloth. */
static void draw_edges(const struct view_scene *scene, GLuint surface,
                       const struct view_camera *camera, int height)
{
    const double pixels = edge_pixels(scene, camera, height);
    glBlendColor(0, 0, 0, (float)fmin(fmax(pixels / 10, 0.05), 1));
    glBlendFuncSeparate(GL_CONSTANT_ALPHA, GL_ONE_MINUS_CONSTANT_ALPHA, GL_ZERO, GL_ONE);
    glEnable(GL_BLEND);
    glUniform3fv(glGetUniformLocation(surface, "paint"), 2, WIRE[0]);
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    draw_mesh_draw(&scene->mesh);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glDisable(GL_BLEND);
}

static void draw_cloths(const struct view_scene *scene, GLuint surface)
{
    if (scene->wired) { /* lines lie on top of the triangles that they bound */
        glPolygonOffset(1, 1);
        glEnable(GL_POLYGON_OFFSET_FILL);
    }
    glUniform1i(glGetUniformLocation(surface, "colours"), (GLint)scene->paint);
    if (scene->paint != VIEW_PAINT_CLOTH) {
        glUniform1i(glGetUniformLocation(surface, "colours_n"), scene->n_map);
        glUniform3fv(glGetUniformLocation(surface, "map"), scene->n_map, scene->map[0]);
    }
    for (uint32_t c = 0; c < scene->n_parts; c++) {
        glUniform3fv(glGetUniformLocation(surface, "paint"), 2, CLOTH[c % N_COLOURS][0]);
        draw_mesh_draw_part(&scene->mesh, scene->part + c);
    }
    glUniform1i(glGetUniformLocation(surface, "colours"), VIEW_PAINT_CLOTH);
    glDisable(GL_POLYGON_OFFSET_FILL);
}

static void draw_shapes(const struct view_scene *scene, GLuint surface,
                        const struct view_camera *camera)
{
    glPolygonOffset(0, behind(scene, camera));
    glEnable(GL_POLYGON_OFFSET_FILL);
    glEnable(GL_CULL_FACE); /* a shape around the eye would hide everything */
    glUniform1i(glGetUniformLocation(surface, "colours"), VIEW_PAINT_CLOTH);
    glUniform3fv(glGetUniformLocation(surface, "paint"), 2, STONE[0]);
    draw_sky_bind(&scene->shapes_sky);
    draw_mesh_draw(&scene->shapes);
    glDisable(GL_CULL_FACE);
    glDisable(GL_POLYGON_OFFSET_FILL);
}

static void draw_grounds(const struct view_scene *scene, GLuint program,
                         const struct view_camera *camera)
{
    glBindVertexArray(scene->nothing);
    glEnable(GL_POLYGON_OFFSET_FILL); /* cloth that lies on a plane lies on top of it */
    glPolygonOffset(1, 16);
    for (size_t i = 0; i < scene->n_grounds; i++)
        draw_ground(scene->ground + i, program, &scene->lights, camera->eye, camera->reach);
    glDisable(GL_POLYGON_OFFSET_FILL);
}

/* The background lies at the far end. */
static void draw_background(const struct view_scene *scene)
{
    glBindVertexArray(scene->nothing);
    glDepthMask(GL_FALSE);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDepthMask(GL_TRUE);
}

/* What is near comes first, so that nothing is shaded which is then hidden. */
void view_scene_draw(const struct view_scene *scene, const struct view_camera *camera, int width,
                     int height)
{
    glViewport(0, 0, width, height);
    bind_lights(scene);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glClear(GL_DEPTH_BUFFER_BIT);

    GLuint surface = use_to_see(scene, PROGRAM_CLOTH, camera, width, height);
    draw_sky_bind(&scene->mesh_sky);
    draw_cloths(scene, surface);
    if (has_shapes(scene))
        draw_shapes(scene, surface, camera);
    draw_grounds(scene, use_to_see(scene, PROGRAM_GROUND, camera, width, height), camera);
    use_to_see(scene, PROGRAM_BACK, camera, width, height);
    draw_background(scene);
    if (!scene->wired)
        return;
    surface = use_to_see(scene, PROGRAM_CLOTH, camera, width, height);
    draw_sky_bind(&scene->mesh_sky);
    draw_edges(scene, surface, camera, height);
}

void view_scene_free(struct view_scene *scene)
{
    if (!scene)
        return;
    draw_mesh_free(&scene->mesh);
    draw_mesh_free(&scene->shapes);
    draw_sky_free(&scene->mesh_sky);
    draw_sky_free(&scene->shapes_sky);
    draw_sky_free(&scene->unsmooth);
    for (size_t i = 0; i < scene->n_grounds; i++)
        draw_sky_free(&scene->ground[i].sky);
    free(scene->ground);
    draw_lights_free(&scene->lights);
    for (int i = 0; i < N_PROGRAMS; i++)
        glDeleteProgram(scene->program[i]);
    glDeleteVertexArrays(1, &scene->nothing);
    free(scene->part);
    free(scene);
}
