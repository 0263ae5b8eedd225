/* The light is a fixed set of directions: a disk of them around the sun and a spiral of them over
 * the sky. Each has its own layer of depths of the cloth, so that soft shadows and the darkening in
 * folds are one and the same sum. The sun's are fine, and cast by all triangles; the sky's light
 * varies slowly: its layers are coarse, and cast by few triangles. The sun's layers are slanted
 * views along one direction, so that a place has the same depth in all of them. */
#include "cloth/view/draw/draw.h"

#include <math.h>
#include <string.h>

static const double GOLDEN =
    2.39996322972865332; /* radians: the golden angle, spreads points evenly */

static void lights_cross(const double a[3], const double b[3], double c[3])
{
    for (int i = 0; i < 3; i++)
        c[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static void normalise(double a[3])
{
    double length = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    for (int i = 0; i < 3; i++)
        a[i] /= length;
}

/* Two directions square to d and to each other. */
static void across(const double d[3], double u[3], double v[3])
{
    double other[3] = {fabs(d[0]) < 0.7 ? 1 : 0, 0, fabs(d[0]) < 0.7 ? 0 : 1};
    lights_cross(other, d, u);
    normalise(u);
    lights_cross(d, u, v);
}

static void lights_set_vector(float to[4], const double from[3])
{
    for (int k = 0; k < 3; k++)
        to[k] = (float)from[k];
}

static void set_sun(struct draw_light_block *block)
{
    double toward[3] = {-0.50, 1.0, 0.38}, right[3], up[3];
    normalise(toward);
    across(toward, right, up);
    lights_set_vector(block->toward, toward);
    lights_set_vector(block->right, right);
    lights_set_vector(block->up, up);
}

static void set_sky(struct draw_light_block *block)
{
    for (int i = 0; i < DRAW_SKY; i++) {
        const double y = (i + 0.5) / DRAW_SKY, r = sqrt(1 - y * y), a = GOLDEN * i;
        const double d[3] = {r * cos(a), y, r * sin(a)};
        double right[3], up[3];
        across(d, right, up);
        lights_set_vector(block->sky[2 * i], d);
        lights_set_vector(block->sky[2 * i + 1], right);
    }
}

static GLuint make_maps(int size, int n)
{
    static const float NOTHING[4] = {1, 1, 1, 1};
    GLuint maps;
    glGenTextures(1, &maps);
    glBindTexture(GL_TEXTURE_2D_ARRAY, maps);
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_DEPTH_COMPONENT24, size, size, n, 0, GL_DEPTH_COMPONENT,
                 GL_UNSIGNED_INT, NULL);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
    glTexParameterfv(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_BORDER_COLOR, NOTHING);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    return maps;
}

int draw_lights_make(struct draw_lights *lights, struct cloth_error *error)
{
    memset(lights, 0, sizeof *lights);
    set_sun(&lights->block);
    set_sky(&lights->block);
    lights->suns = make_maps(DRAW_SUN_MAP, DRAW_SUN);
    lights->skies = make_maps(DRAW_SKY_MAP, DRAW_SKY);
    glGenBuffers(1, &lights->buffer);
    glGenFramebuffers(1, &lights->frame);
    GLint before = 0;
    glGetIntegerv(GL_FRAMEBUFFER_BINDING, &before);
    glBindFramebuffer(GL_FRAMEBUFFER, lights->frame);
    glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, lights->suns, 0, 0);
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
    GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    glBindFramebuffer(GL_FRAMEBUFFER, (GLuint)before);
    return status == GL_FRAMEBUFFER_COMPLETE
               ? 0
               : cloth_fail(error, CLOTH_E_LIBRARY, "OpenGL gives no maps for shadows (0x%x)",
                            status);
}

/* From the world to a layer whose square just holds the lights' sphere: x, y, and depth, which runs
 * from the light's side of it to the other. axis: x, y, towards the light; slant: how far x and y
 * move a unit towards it */
static void make_rows(const struct draw_lights *lights, const float *const axis[3],
                      const double slant[2], float row[3][4])
{
    const float *sphere = lights->block.sphere;
    for (int i = 0; i < 3; i++) {
        double offset = 0.5;
        for (int k = 0; k < 3; k++) {
            const double toward = (double)axis[2][k];
            const double part =
                (double)sphere[3] * (i < 2 ? (double)axis[i][k] - slant[i] * toward : -toward);
            row[i][k] = (float)part;
            offset -= part * (double)sphere[k];
        }
        row[i][3] = (float)offset;
    }
}

static void sun_rows(const struct draw_lights *lights, int i, float row[3][4])
{
    const struct draw_light_block *block = &lights->block;
    const double r = DRAW_SUN_RADIUS * sqrt((i + 0.5) / DRAW_SUN), a = GOLDEN * i;
    make_rows(lights, (const float *const[3]){block->right, block->up, block->toward},
              (const double[2]){r * cos(a), r * sin(a)}, row);
}

static void sky_rows(const struct draw_lights *lights, int i, float row[3][4])
{
    static const double STRAIGHT[2];
    const float *d = lights->block.sky[2 * i], *right = lights->block.sky[2 * i + 1];
    float up[3];
    for (int k = 0; k < 3; k++)
        up[k] = d[(k + 1) % 3] * right[(k + 2) % 3] - d[(k + 2) % 3] * right[(k + 1) % 3];
    make_rows(lights, (const float *const[3]){right, up, d}, STRAIGHT, row);
}

static void cast_layer(GLuint maps, int layer, float row[3][4], bool coarse,
                       const struct draw_casting *casting)
{
    glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, maps, 0, layer);
    glClear(GL_DEPTH_BUFFER_BIT);
    glUniform4fv(casting->row_uniform, 3, row[0]);
    casting->cast(casting->context, coarse);
}

static void cast_all(const struct draw_lights *lights, const struct draw_casting *casting)
{
    GLint frame = 0, viewport[4];
    float row[3][4];
    glGetIntegerv(GL_FRAMEBUFFER_BINDING, &frame);
    glGetIntegerv(GL_VIEWPORT, viewport);
    glBindFramebuffer(GL_FRAMEBUFFER, lights->frame);
    glEnable(GL_DEPTH_TEST);
    glViewport(0, 0, DRAW_SUN_MAP, DRAW_SUN_MAP);
    for (int i = 0; i < DRAW_SUN; i++) {
        sun_rows(lights, i, row);
        cast_layer(lights->suns, i, row, false, casting);
    }
    glViewport(0, 0, DRAW_SKY_MAP, DRAW_SKY_MAP);
    for (int i = 0; i < DRAW_SKY; i++) {
        sky_rows(lights, i, row);
        cast_layer(lights->skies, i, row, true, casting);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, (GLuint)frame);
    glViewport(viewport[0], viewport[1], viewport[2], viewport[3]);
}

void draw_lights_aim(struct draw_lights *lights, const float center[3], float radius,
                     const struct draw_casting *casting)
{
    radius *= 1.0f + 6.0f / DRAW_SKY_MAP; /* a margin for the blur, and for what is slanted */
    lights->radius = radius;
    memcpy(lights->block.sphere, center, 3 * sizeof *center);
    lights->block.sphere[3] = 0.5f / radius;
    lights->block.bias[0] = 3.0f * 2 * radius / DRAW_SUN_MAP;
    lights->block.bias[1] = 2.0f / DRAW_SUN_MAP;
    lights->block.bias[2] = 2.0f * 2 * radius / DRAW_SKY_MAP;
    if (casting)
        cast_all(lights, casting);
    glBindBuffer(GL_UNIFORM_BUFFER, lights->buffer);
    glBufferData(GL_UNIFORM_BUFFER, sizeof lights->block, &lights->block, GL_DYNAMIC_DRAW);
}

void draw_lights_bind(const struct draw_lights *lights)
{
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, lights->buffer);
    glActiveTexture(GL_TEXTURE0 + DRAW_UNIT_SKIES);
    glBindTexture(GL_TEXTURE_2D_ARRAY, lights->skies);
    glActiveTexture(GL_TEXTURE0 + DRAW_UNIT_SUNS);
    glBindTexture(GL_TEXTURE_2D_ARRAY, lights->suns);
}

void draw_lights_free(struct draw_lights *lights)
{
    glDeleteTextures(1, &lights->suns);
    glDeleteTextures(1, &lights->skies);
    glDeleteFramebuffers(1, &lights->frame);
    glDeleteBuffers(1, &lights->buffer);
}
