/* A scene holds the cloth of the last move and the shadows it throws; drawing changes neither, and
 * draws into whatever framebuffer is bound. */
#include "cloth/view/draw/draw.h"
#include "cloth/view/view.h"

#include <math.h>
#include <stdlib.h>

enum program { PROGRAM_CAST, PROGRAM_BACK, PROGRAM_CLOTH, PROGRAM_GROUND, N_PROGRAMS };

struct view_scene {
    size_t n_planes;
    const double (*planes)[6];
    struct draw_mesh mesh;
    struct draw_lights lights;
    GLuint program[N_PROGRAMS];
    GLuint nothing; /* a vertex array without attributes */
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

int view_scene_new(struct view_scene **scene, const struct view_shape *shape,
                   struct cloth_error *error)
{
    *scene = NULL;
    struct view_scene *made = calloc(1, sizeof *made);
    if (!made)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for a scene");
    made->n_planes = shape->n_planes;
    made->planes = shape->planes;
    glGenVertexArrays(1, &made->nothing);
    int code = make_programs(made, error);
    code = code ? code : draw_lights_make(&made->lights, error);
    code = code ? code
                : draw_mesh_make(&made->mesh, shape->n_vertices, shape->n_triangles,
                                 shape->triangle, shape->n_lines, shape->line, error);
    if (code) {
        view_scene_free(made);
        return code;
    }
    *scene = made;
    return 0;
}

static void cast(const void *context)
{
    draw_mesh_draw(context);
}

int view_scene_move(struct view_scene *scene, const double *position, struct cloth_error *error)
{
    draw_mesh_move(&scene->mesh, position);
    GLuint program = scene->program[PROGRAM_CAST];
    glUseProgram(program);
    draw_lights_aim(&scene->lights, scene->mesh.center, scene->mesh.radius,
                    glGetUniformLocation(program, "map"), cast, &scene->mesh);
    GLenum trouble = glGetError();
    return trouble == GL_NO_ERROR
               ? 0
               : cloth_fail(error, CLOTH_E_LIBRARY, "OpenGL took no vertices (0x%x)", trouble);
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

/* The sky's directions are about sqrt(2 pi / n) radians apart, so that the shadows that they throw
 * from a height are so much of it apart on the ground: blurred by 0.7 of that they melt into one.
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
    for (size_t i = 0; i < scene->n_planes; i++)
        draw_plane(scene, ground, scene->planes[i], camera);
    glDisable(GL_POLYGON_OFFSET_FILL);

    use(scene, PROGRAM_CLOTH, camera, width, height);
    draw_mesh_draw(&scene->mesh);
}

void view_scene_free(struct view_scene *scene)
{
    if (!scene)
        return;
    draw_mesh_free(&scene->mesh);
    draw_lights_free(&scene->lights);
    for (int i = 0; i < N_PROGRAMS; i++)
        glDeleteProgram(scene->program[i]);
    glDeleteVertexArrays(1, &scene->nothing);
    free(scene);
}
