/* A scene holds the cloth of the last move and the shadows it throws; drawing changes neither, and
 * draws into whatever framebuffer is bound. */
#include "cloth/view/draw/draw.h"
#include "cloth/view/view.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

enum program { PROGRAM_CAST, PROGRAM_BACK, PROGRAM_CLOTH, PROGRAM_GROUND, N_PROGRAMS };

/* Colours of fronts and backs, linear. Those of cloths go round. They differ in lightness, too, for
 * those who see no red or no green. */
enum { N_COLOURS = 6 };
static const float CLOTH[N_COLOURS][2][3] = {{{0.40f, 0.030f, 0.028f}, {0.46f, 0.120f, 0.050f}},
                                             {{0.035f, 0.085f, 0.24f}, {0.09f, 0.15f, 0.30f}},
                                             {{0.55f, 0.38f, 0.07f}, {0.52f, 0.42f, 0.18f}},
                                             {{0.03f, 0.20f, 0.13f}, {0.09f, 0.26f, 0.19f}},
                                             {{0.50f, 0.48f, 0.43f}, {0.45f, 0.43f, 0.40f}},
                                             {{0.17f, 0.04f, 0.20f}, {0.24f, 0.10f, 0.26f}}};
static const float PALE[2][3] = {{0.42f, 0.42f, 0.40f}, {0.36f, 0.36f, 0.35f}};
static const float WIRE[2][3] = {{0.01f, 0.01f, 0.012f}, {0.01f, 0.01f, 0.012f}};
static const float STONE[2][3] = {{0.22f, 0.25f, 0.28f}, {0.22f, 0.25f, 0.28f}};

struct view_scene {
    const struct view_obstacles *obstacles; /* NULL: none */
    struct draw_mesh mesh, shapes;          /* the cloth; the obstacles that have a surface */
    struct draw_lights lights;
    GLuint program[N_PROGRAMS];
    GLuint nothing;            /* a vertex array without attributes */
    bool heated, wired, plain; /* plain: without shadows */
    uint32_t n_parts;
    struct draw_part *part; /* n_parts: cloths */
};

static int make_programs(struct view_scene *scene, struct cloth_error *error)
{
    static const char *const text[N_PROGRAMS][2] = {
        {DRAW_CAST_VERTEX, DRAW_CAST_FRAGMENT},
        {DRAW_BACK_VERTEX, DRAW_BACK_FRAGMENT},
        {DRAW_CLOTH_VERTEX, DRAW_CLOTH_FRAGMENT},
        {DRAW_GROUND_VERTEX, DRAW_GROUND_FRAGMENT},
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
    code = code ? code
                : draw_mesh_make(&made->mesh, shape->n_vertices, shape->n_triangles,
                                 shape->triangle, shape->n_lines, shape->line, error);
    if (!code && has_shapes(made))
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

static void cast(const void *context)
{
    const struct view_scene *scene = context;
    draw_mesh_draw(&scene->mesh);
    if (has_shapes(scene))
        draw_mesh_draw(&scene->shapes);
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

int view_scene_move(struct view_scene *scene, const double *position, struct cloth_error *error)
{
    draw_mesh_move(&scene->mesh, position);
    if (has_shapes(scene))
        draw_mesh_place(&scene->shapes, (const double(*)[6])scene->obstacles->vertex);
    GLuint program = scene->program[PROGRAM_CAST];
    glUseProgram(program);
    draw_lights_aim(&scene->lights, scene->mesh.center, lit_radius(scene),
                    glGetUniformLocation(program, "map"), scene->plain ? NULL : cast, scene);
    GLenum trouble = glGetError();
    return trouble == GL_NO_ERROR
               ? 0
               : cloth_fail(error, CLOTH_E_LIBRARY, "OpenGL took no vertices (0x%x)", trouble);
}

void view_scene_heat(struct view_scene *scene, const float *heat)
{
    draw_mesh_heat(&scene->mesh, heat);
    scene->heated = true;
}

void view_scene_wire(struct view_scene *scene, bool wire)
{
    scene->wired = wire;
}

void view_scene_shadows(struct view_scene *scene, bool shadows)
{
    scene->plain = !shadows;
}

static GLuint use(const struct view_scene *scene, enum program which,
                  const struct view_camera *camera, int width, int height)
{
    GLuint program = scene->program[which];
    glUseProgram(program);
    glUniformMatrix4fv(glGetUniformLocation(program, "clip"), 1, GL_FALSE, camera->clip[0]);
    glUniform3fv(glGetUniformLocation(program, "eye"), 1, camera->eye);
    glUniform2f(glGetUniformLocation(program, "size"), (float)width, (float)height);
    glUniform1i(glGetUniformLocation(program, "maps"), 0);
    glUniform1i(glGetUniformLocation(program, "looks"), scene->plain ? 0 : 4);
    return program;
}

static void set_vector(GLuint program, const char *name, const double v[3], double scale)
{
    glUniform3f(glGetUniformLocation(program, name), (float)(v[0] * scale), (float)(v[1] * scale),
                (float)(v[2] * scale));
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Directions u and v on a plane, square to each other and to its normal n; all of length 1. */
static void span(const double n[3], double u[3], double v[3])
{
    double other[3] = {fabs(n[0]) < 0.7, 0, fabs(n[0]) >= 0.7}, along = dot(other, n);
    for (int k = 0; k < 3; k++)
        u[k] = other[k] - along * n[k];
    double length = sqrt(dot(u, u));
    for (int k = 0; k < 3; k++)
        u[k] /= length;
    for (int k = 0; k < 3; k++)
        v[k] = n[(k + 1) % 3] * u[(k + 2) % 3] - n[(k + 2) % 3] * u[(k + 1) % 3];
}

/* The sky's directions are about sqrt(2 pi / n) radians apart. So on the ground the shadows of a
 * point are that fraction of its height apart. Blurred by 0.7 of this distance they melt into one.
 * In units of the lights' own blur. */
static double ground_blur(const struct view_scene *scene, double height)
{
    const double apart = sqrt(2 * acos(-1.0) / DRAW_SKY) * fabs(height);
    const double unit = (double)scene->lights.block.bias[1] * 2 * (double)scene->mesh.radius;
    return fmax(5, 0.7 * apart / unit);
}

/* A square around the foot of the cloth's centre, which fades before its edges; floors reach
 * farther than slopes. */
static void draw_plane(const struct view_scene *scene, GLuint program, const double plane[6],
                       const struct view_camera *camera)
{
    double n[3], u[3], v[3], foot[3], eye[3], length = sqrt(dot(plane + 3, plane + 3));
    for (int k = 0; k < 3; k++) {
        n[k] = plane[3 + k] / length;
        eye[k] = (double)camera->eye[k] - plane[k];
        foot[k] = (double)scene->mesh.center[k];
    }
    if (dot(n, eye) <= 0)
        return; /* seen from behind it would hide everything */
    double height = dot(n, foot) - dot(n, plane);
    for (int k = 0; k < 3; k++)
        foot[k] -= height * n[k];
    span(n, u, v);
    double end = (n[1] > 0.95 ? 7 : 1.5) * (double)camera->reach;
    set_vector(program, "centre", foot, 1);
    set_vector(program, "u", u, end);
    set_vector(program, "v", v, end);
    set_vector(program, "n", n, 1);
    glUniform1f(glGetUniformLocation(program, "blur"), (float)ground_blur(scene, height));
    glUniform2f(glGetUniformLocation(program, "fade"), (float)(0.15 * end), (float)end);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
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
    const double distance = sqrt(dot(away, away));
    for (int k = 0; k < 3; k++)
        far[k] = near[k] + part * (double)draw_mesh_edge(&scene->mesh) * away[k] / distance;
    return (float)(units * (depth_of(camera, far) - depth_of(camera, near)));
}

static void draw_cloths(const struct view_scene *scene, GLuint surface)
{
    if (scene->wired) { /* lines lie on top of the triangles that they bound */
        glPolygonOffset(1, 1);
        glEnable(GL_POLYGON_OFFSET_FILL);
    }
    for (uint32_t c = 0; c < scene->n_parts; c++) {
        glUniform3fv(glGetUniformLocation(surface, "paint"), 2,
                     scene->heated ? PALE[0] : CLOTH[c % N_COLOURS][0]);
        draw_mesh_draw_part(&scene->mesh, scene->part + c);
    }
    if (!scene->wired)
        return;
    glDisable(GL_POLYGON_OFFSET_FILL);
    glUniform3fv(glGetUniformLocation(surface, "paint"), 2, WIRE[0]);
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    draw_mesh_draw(&scene->mesh);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

void view_scene_draw(const struct view_scene *scene, const struct view_camera *camera, int width,
                     int height)
{
    glViewport(0, 0, width, height);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, scene->lights.buffer);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D_ARRAY, scene->lights.maps);
    glEnable(GL_DEPTH_TEST);
    glClear(GL_DEPTH_BUFFER_BIT);

    glBindVertexArray(scene->nothing);
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_LEQUAL); /* the background lies at the far end */
    use(scene, PROGRAM_BACK, camera, width, height);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDepthMask(GL_TRUE);

    GLuint ground = use(scene, PROGRAM_GROUND, camera, width, height);
    glEnable(GL_POLYGON_OFFSET_FILL); /* cloth that lies on a plane lies on top of it */
    glPolygonOffset(1, 16);
    for (size_t i = 0; scene->obstacles && i < scene->obstacles->n_planes; i++)
        draw_plane(scene, ground, scene->obstacles->plane[i], camera);
    glDisable(GL_POLYGON_OFFSET_FILL);

    const GLuint surface = use(scene, PROGRAM_CLOTH, camera, width, height);
    if (has_shapes(scene)) {
        glPolygonOffset(0, behind(scene, camera));
        glEnable(GL_POLYGON_OFFSET_FILL);
        glEnable(GL_CULL_FACE); /* a shape around the eye would hide everything */
        glUniform3fv(glGetUniformLocation(surface, "paint"), 2, STONE[0]);
        draw_mesh_draw(&scene->shapes);
        glDisable(GL_CULL_FACE);
        glDisable(GL_POLYGON_OFFSET_FILL);
    }
    draw_cloths(scene, surface);
}

void view_scene_free(struct view_scene *scene)
{
    if (!scene)
        return;
    draw_mesh_free(&scene->mesh);
    draw_mesh_free(&scene->shapes);
    draw_lights_free(&scene->lights);
    for (int i = 0; i < N_PROGRAMS; i++)
        glDeleteProgram(scene->program[i]);
    glDeleteVertexArrays(1, &scene->nothing);
    free(scene->part);
    free(scene);
}
