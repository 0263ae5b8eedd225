/* A picture of a scene: all surfaces first, then the light on their visible parts. */
#include "cloth/view/scene.h"

#include <math.h>
#include <string.h>

/* Colours of fronts and backs, linear, of cloths and of obstacles. Those of cloths go round. They
 * differ in lightness, too, for eyes that see no red or no green. */
enum { N_COLOURS = 6, STONE = DRAW_PAINT_FIRST + 2 * N_COLOURS };
static const float PAINT[2 * (N_COLOURS + 1)][3] = {
    {0.40f, 0.030f, 0.028f}, {0.46f, 0.120f, 0.050f}, {0.035f, 0.085f, 0.24f},
    {0.09f, 0.15f, 0.30f},   {0.55f, 0.38f, 0.07f},   {0.52f, 0.42f, 0.18f},
    {0.03f, 0.20f, 0.13f},   {0.09f, 0.26f, 0.19f},   {0.50f, 0.48f, 0.43f},
    {0.45f, 0.43f, 0.40f},   {0.17f, 0.04f, 0.20f},   {0.24f, 0.10f, 0.26f},
    {0.22f, 0.25f, 0.28f},   {0.22f, 0.25f, 0.28f}};

/* Mixes two sRGB colours, so much of the way from one to the other, into a linear one. */
static void decode(float linear[3], const float from[3], const float to[3], float way)
{
    for (int k = 0; k < 3; k++) {
        const float c = from[k] + way * (to[k] - from[k]);
        linear[k] = c < 0.04045f ? c / 12.92f : powf((c + 0.055f) / 1.055f, 2.4f);
    }
}

static void upload_paints(const struct view_scene *scene)
{
    static const float GREY[3] = {0.5f, 0.5f, 0.5f};
    float paint[DRAW_PAINTS][3] = {{0}};
    memcpy(paint[DRAW_PAINT_FIRST], PAINT, sizeof PAINT);
    decode(paint[DRAW_PAINT_GREY], GREY, GREY, 0);
    for (int i = 0; i < scene->n_map; i++)
        decode(paint[DRAW_PAINT_PARTS + i], scene->map[i], scene->map[i], 0);
    for (int i = DRAW_PAINT_SCALE; i < DRAW_PAINTS && scene->n_map > 1; i++) {
        const float at = (float)((i - DRAW_PAINT_SCALE) * (scene->n_map - 1)) /
                         (DRAW_PAINTS - 1 - DRAW_PAINT_SCALE);
        const int before = at < (float)(scene->n_map - 1) ? (int)at : scene->n_map - 2;
        decode(paint[i], scene->map[before], scene->map[before + 1], at - (float)before);
    }
    glActiveTexture(GL_TEXTURE0 + DRAW_UNIT_FRONT);
    glBindTexture(GL_TEXTURE_2D, scene->paints);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB32F, DRAW_PAINTS, 1, 0, GL_RGB, GL_FLOAT, paint);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

static GLuint use_to_see(const struct view_scene *scene, enum view_program which,
                         const struct view_camera *camera, int width, int height)
{
    const GLuint program = view_scene_use(scene, which, width, height);
    glUniformMatrix4fv(glGetUniformLocation(program, "clip"), 1, GL_FALSE, camera->clip[0]);
    glUniform3fv(glGetUniformLocation(program, "eye"), 1, camera->eye);
    return program;
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

/* Vertices of cloth lie on an obstacle, so that its triangles cut through round shapes. Obstacles
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

/* A pixel's width, of its distance. */
static double pixel_width(const struct view_camera *camera, int height)
{
    double up = 0;
    for (int k = 0; k < 3; k++)
        up += (double)(camera->clip[k][1] * camera->clip[k][1]);
    return 2 / (sqrt(up) * height);
}

/* How many pixels an edge of the cloth is long, in the mean, where the middle of the cloth is. */
static double edge_pixels(const struct view_scene *scene, const struct view_camera *camera,
                          int height)
{
    double away = (double)camera->clip[3][3];
    for (int k = 0; k < 3; k++)
        away += (double)(camera->clip[k][3] * scene->mesh.center[k]);
    return away > 0 ? (double)draw_mesh_edge(&scene->mesh) / (away * pixel_width(camera, height))
                    : 1;
}

static void draw_cloths(const struct view_scene *scene, GLuint program)
{
    glUniform1i(glGetUniformLocation(program, "colours"), (GLint)scene->paint);
    glUniform1f(glGetUniformLocation(program, "parts"), (float)(scene->n_map - 1));
    for (uint32_t c = 0; c < scene->n_parts; c++) {
        glUniform1f(glGetUniformLocation(program, "paint"),
                    (float)(DRAW_PAINT_FIRST + 2 * (c % N_COLOURS)));
        draw_mesh_draw_part(&scene->mesh, scene->part + c);
    }
}

/* Lines lie on top of the triangles that they bound. */
static void draw_wired(const struct view_scene *scene, GLuint program)
{
    const GLint edge = glGetUniformLocation(program, "edge");
    glPolygonOffset(1, 1);
    glEnable(GL_POLYGON_OFFSET_FILL);
    draw_cloths(scene, program);
    glDisable(GL_POLYGON_OFFSET_FILL);
    glUniform1f(edge, 1);
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    draw_cloths(scene, program);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glUniform1f(edge, 0);
}

static void draw_shapes(const struct view_scene *scene, GLuint program,
                        const struct view_camera *camera)
{
    glPolygonOffset(0, behind(scene, camera));
    glEnable(GL_POLYGON_OFFSET_FILL);
    glEnable(GL_CULL_FACE); /* a shape around the eye would hide everything */
    glUniform1i(glGetUniformLocation(program, "colours"), VIEW_PAINT_CLOTH);
    glUniform1f(glGetUniformLocation(program, "paint"), (float)STONE);
    draw_sky_bind(&scene->shapes.sky);
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
        draw_ground(scene->ground + i, program, camera->eye, camera->reach);
    glDisable(GL_POLYGON_OFFSET_FILL);
}

static void draw_surfaces(const struct view_scene *scene, const struct view_camera *camera,
                          int width, int height)
{
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    const GLuint program = use_to_see(scene, VIEW_SURFACE, camera, width, height);
    draw_sky_bind(&scene->mesh.sky);
    if (scene->wired)
        draw_wired(scene, program);
    else
        draw_cloths(scene, program);
    if (view_scene_has_shapes(scene))
        draw_shapes(scene, program, camera);
    glColorMaski(1, GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    draw_grounds(scene, use_to_see(scene, VIEW_GROUND, camera, width, height), camera);
    glColorMaski(1, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDisable(GL_DEPTH_TEST);
}

/* Into the framebuffer that is bound. */
static void shade(const struct view_scene *scene, const struct view_camera *camera, int width,
                  int height)
{
    const GLuint program = use_to_see(scene, VIEW_SHADE, camera, width, height);
    double ink = 0; /* edges are paler where they are dense, so that they do not hide the cloth */
    glUniformMatrix4fv(glGetUniformLocation(program, "world"), 1, GL_FALSE, camera->world[0]);
    glUniform1f(glGetUniformLocation(program, "pixel"), (float)pixel_width(camera, height));
    glUniform1i(glGetUniformLocation(program, "samples"), scene->surfaces.samples);
    if (scene->wired)
        ink = fmin(fmax(edge_pixels(scene, camera, height) / 10, 0.05), 1);
    glUniform1f(glGetUniformLocation(program, "ink"), (float)ink);
    upload_paints(scene);
    draw_surfaces_bind(&scene->surfaces);
    glBindVertexArray(scene->nothing);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

int view_scene_draw(struct view_scene *scene, const struct view_camera *camera, int width,
                    int height, struct cloth_error *error)
{
    GLint frame = 0;
    glGetIntegerv(GL_FRAMEBUFFER_BINDING, &frame);
    const int code = draw_surfaces_start(&scene->surfaces, width, height, error);
    draw_lights_bind(&scene->lights);
    if (!code)
        draw_surfaces(scene, camera, width, height);
    glBindFramebuffer(GL_FRAMEBUFFER, (GLuint)frame);
    if (!code)
        shade(scene, camera, width, height);
    return code;
}
