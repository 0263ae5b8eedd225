/* The sky's light varies slowly over a surface: it is worked out for vertices, and for squares of
 * each plane, and pixels take what lies between. Front and back are textures of one size. */
#include "cloth/view/draw/draw.h"

static GLuint make_texture(GLint format, int width, int height, GLint filter)
{
    GLuint texture;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, GL_RGB, GL_FLOAT, NULL);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return texture;
}

static int make_light(struct draw_sky *sky, int width, int height, struct cloth_error *error)
{
    static const GLenum both[2] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    GLint before = 0;
    sky->width = width;
    sky->height = height;
    glGetIntegerv(GL_FRAMEBUFFER_BINDING, &before);
    glGenFramebuffers(1, &sky->frame);
    glBindFramebuffer(GL_FRAMEBUFFER, sky->frame);
    for (int i = 0; i < 2; i++) {
        sky->light[i] = make_texture(GL_RGBA16F, sky->width, sky->height, GL_LINEAR);
        glFramebufferTexture2D(GL_FRAMEBUFFER, both[i], GL_TEXTURE_2D, sky->light[i], 0);
    }
    glDrawBuffers(2, both);
    const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    glBindFramebuffer(GL_FRAMEBUFFER, (GLuint)before);
    if (status == GL_FRAMEBUFFER_COMPLETE)
        return CLOTH_OK;
    return cloth_fail(error, CLOTH_E_LIBRARY,
                      "OpenGL gives no room for the light on %d x %d places (0x%x)", width, height,
                      status);
}

int draw_sky_make(struct draw_sky *sky, uint32_t n, struct cloth_error *error)
{
    const int height = (int)((n + DRAW_SKY_ROW - 1) / DRAW_SKY_ROW);
    sky->source = make_texture(GL_RGB32F, 2 * DRAW_SKY_ROW, height, GL_NEAREST);
    return make_light(sky, DRAW_SKY_ROW, height, error);
}

int draw_sky_make_square(struct draw_sky *sky, int n, struct cloth_error *error)
{
    return make_light(sky, n, n, error);
}

void draw_sky_place(const struct draw_sky *sky, const float *vertex, uint32_t n)
{
    const int whole = (int)(n / DRAW_SKY_ROW), left = (int)(n % DRAW_SKY_ROW);
    glBindTexture(GL_TEXTURE_2D, sky->source);
    if (whole)
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 2 * sky->width, whole, GL_RGB, GL_FLOAT, vertex);
    if (left)
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, whole, 2 * left, 1, GL_RGB, GL_FLOAT,
                        vertex + (size_t)6 * DRAW_SKY_ROW * (size_t)whole);
}

void draw_sky_light(const struct draw_sky *sky, GLuint read)
{
    GLint frame = 0, viewport[4];
    glGetIntegerv(GL_FRAMEBUFFER_BINDING, &frame);
    glGetIntegerv(GL_VIEWPORT, viewport);
    glBindFramebuffer(GL_FRAMEBUFFER, sky->frame);
    glViewport(0, 0, sky->width, sky->height);
    glDisable(GL_DEPTH_TEST);
    glActiveTexture(GL_TEXTURE0 + DRAW_UNIT_FRONT);
    glBindTexture(GL_TEXTURE_2D, read);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glActiveTexture(GL_TEXTURE0);
    glEnable(GL_DEPTH_TEST);
    glBindFramebuffer(GL_FRAMEBUFFER, (GLuint)frame);
    glViewport(viewport[0], viewport[1], viewport[2], viewport[3]);
}

void draw_sky_bind(const struct draw_sky *sky)
{
    for (int i = 0; i < 2; i++) {
        glActiveTexture(GL_TEXTURE0 + (i ? DRAW_UNIT_BACK : DRAW_UNIT_FRONT));
        glBindTexture(GL_TEXTURE_2D, sky->light[i]);
    }
    glActiveTexture(GL_TEXTURE0);
}

void draw_sky_free(struct draw_sky *sky)
{
    glDeleteTextures(2, sky->light);
    glDeleteTextures(1, &sky->source);
    glDeleteFramebuffers(1, &sky->frame);
}
