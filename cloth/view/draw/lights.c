/* The light is a fixed set of directions: a disk of them around the sun and a spiral of them over
 * the sky. Each has its own layer of depths of the cloth, so that soft shadows and the darkening in
 * folds are one and the same sum. The sun's are fine, and cast by all triangles; the sky's light
 * varies slowly: its layers are coarse, and cast by few triangles. */
#include "cloth/view/draw/draw.h"

#include <math.h>
#include <string.h>

static const double GOLDEN =
    2.39996322972865332; /* radians: the golden angle, spreads points evenly */

static void cross(const double a[3], const double b[3], double c[3])
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
    cross(other, d, u);
    normalise(u);
    cross(d, u, v);
}

static void set_sun(struct draw_light_block *block)
{
    static const float COLOUR[3] = {1.62f, 1.48f, 1.27f};
    double sun[3] = {-0.50, 1.0, 0.38}, u[3], v[3];
    normalise(sun);
    across(sun, u, v);
    for (int i = 0; i < DRAW_SUN; i++) {
        double r = DRAW_SUN_RADIUS * sqrt((i + 0.5) / DRAW_SUN), a = GOLDEN * i, d[3];
        for (int k = 0; k < 3; k++)
            d[k] = sun[k] + r * (cos(a) * u[k] + sin(a) * v[k]);
        normalise(d);
        for (int k = 0; k < 3; k++) {
            block->direction[i][k] = (float)d[k];
            block->colour[i][k] = COLOUR[k] / DRAW_SUN;
        }
    }
    for (int k = 0; k < 3; k++) {
        block->toward[k] = (float)sun[k];
        block->sunlight[k] = COLOUR[k];
    }
}

static void set_sky(struct draw_light_block *block)
{
    static const float HORIZON[3] = {0.78f, 0.76f, 0.74f}, ZENITH[3] = {0.62f, 0.76f, 0.98f};
    for (int i = 0; i < DRAW_SKY; i++) {
        double y = (i + 0.5) / DRAW_SKY, r = sqrt(1 - y * y), a = GOLDEN * i;
        float *d = block->direction[DRAW_SUN + i], *colour = block->colour[DRAW_SUN + i];
        d[0] = (float)(r * cos(a));
        d[1] = (float)y;
        d[2] = (float)(r * sin(a));
        for (int k = 0; k < 3; k++) /* a level surface sees half the sum of the weights */
            colour[k] = (HORIZON[k] + (ZENITH[k] - HORIZON[k]) * d[1]) * 2 / DRAW_SKY;
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

/* A map's square just holds the sphere, seen along -d; depth runs from the light's side of it to
 * the other. */
static void aim(struct draw_light_block *block, int light, const float center[3], float radius)
{
    double axis[3][3], d[3];
    for (int k = 0; k < 3; k++)
        d[k] = (double)block->direction[light][k];
    across(d, axis[0], axis[1]);
    for (int k = 0; k < 3; k++)
        axis[2][k] = -d[k];
    for (int i = 0; i < 3; i++) {
        double offset = 0.5;
        for (int k = 0; k < 3; k++) {
            double part = axis[i][k] / (2 * (double)radius);
            block->row[3 * light + i][k] = (float)part;
            offset -= part * (double)center[k];
        }
        block->row[3 * light + i][3] = (float)offset;
    }
}

/* Layer `layer` of the maps, of light `light`. */
static void cast_layer(struct draw_lights *lights, int light, GLuint maps, int layer,
                       const struct draw_casting *casting)
{
    glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, maps, 0, layer);
    glClear(GL_DEPTH_BUFFER_BIT);
    glUniform4fv(casting->row_uniform, 3, lights->block.row[3 * light]);
    casting->cast(casting->context, maps == lights->skies);
}

static void cast_all(struct draw_lights *lights, const struct draw_casting *casting)
{
    GLint frame = 0, viewport[4];
    glGetIntegerv(GL_FRAMEBUFFER_BINDING, &frame);
    glGetIntegerv(GL_VIEWPORT, viewport);
    glBindFramebuffer(GL_FRAMEBUFFER, lights->frame);
    glEnable(GL_DEPTH_TEST);
    glViewport(0, 0, DRAW_SUN_MAP, DRAW_SUN_MAP);
    for (int i = 0; i < DRAW_SUN; i++)
        cast_layer(lights, i, lights->suns, i, casting);
    glViewport(0, 0, DRAW_SKY_MAP, DRAW_SKY_MAP);
    for (int i = 0; i < DRAW_SKY; i++)
        cast_layer(lights, DRAW_SUN + i, lights->skies, i, casting);
    glBindFramebuffer(GL_FRAMEBUFFER, (GLuint)frame);
    glViewport(viewport[0], viewport[1], viewport[2], viewport[3]);
}

void draw_lights_aim(struct draw_lights *lights, const float center[3], float radius,
                     const struct draw_casting *casting)
{
    radius *= 1.0f + 4.0f / DRAW_SKY_MAP; /* a margin for the blur */
    lights->radius = radius;
    for (int i = 0; i < DRAW_LIGHTS; i++)
        aim(&lights->block, i, center, radius);
    lights->block.bias[0] = 3.0f * 2 * radius / DRAW_SUN_MAP;
    lights->block.bias[1] = 2.0f / DRAW_SUN_MAP;
    lights->block.bias[2] = 2.0f * 2 * radius / DRAW_SKY_MAP;
    lights->block.bias[3] = 1.0f / DRAW_SKY_MAP;
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
