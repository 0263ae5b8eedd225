/* The surfaces of a picture before it is shaded: of each sample its surface, the light of the sky
 * on it and its depth. Triangles are small: shading each once would cost many times what its pixels
 * do. */
#include "cloth/view/draw/draw.h"

enum { SAMPLES = 4 };

static GLint max_samples(void)
{
    GLint max = SAMPLES;
    for (int i = 0; i < 2; i++) {
        GLint here = 0;
        glGetIntegerv(i ? GL_MAX_DEPTH_TEXTURE_SAMPLES : GL_MAX_COLOR_TEXTURE_SAMPLES, &here);
        max = here < max ? here : max;
    }
    return max > 1 ? max : 1;
}

static void surfaces_make(struct draw_surfaces *surfaces)
{
    static const GLint format[DRAW_SURFACES] = {GL_RGBA8, GL_RGBA8, GL_DEPTH_COMPONENT24};
    static const GLenum attachment[DRAW_SURFACES] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1,
                                                     GL_DEPTH_ATTACHMENT};
    glGenFramebuffers(1, &surfaces->frame);
    glGenTextures(DRAW_SURFACES, surfaces->texture);
    glBindFramebuffer(GL_FRAMEBUFFER, surfaces->frame);
    for (int i = 0; i < DRAW_SURFACES; i++) {
        glBindTexture(GL_TEXTURE_2D_MULTISAMPLE, surfaces->texture[i]);
        glTexImage2DMultisample(GL_TEXTURE_2D_MULTISAMPLE, surfaces->samples, (GLenum)format[i],
                                surfaces->width, surfaces->height, GL_TRUE);
        glFramebufferTexture2D(GL_FRAMEBUFFER, attachment[i], GL_TEXTURE_2D_MULTISAMPLE,
                               surfaces->texture[i], 0);
    }
    glDrawBuffers(2, attachment);
}

int draw_surfaces_start(struct draw_surfaces *surfaces, int width, int height,
                        struct cloth_error *error)
{
    static const float NOTHING[4], FAR = 1;
    if (width != surfaces->width || height != surfaces->height) {
        draw_surfaces_free(surfaces);
        *surfaces =
            (struct draw_surfaces){.width = width, .height = height, .samples = max_samples()};
        surfaces_make(surfaces);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, surfaces->frame);
    const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        draw_surfaces_free(surfaces);
        return cloth_fail(error, CLOTH_E_LIBRARY, "OpenGL gives no framebuffer of %d x %d (0x%x)",
                          width, height, status);
    }
    glViewport(0, 0, width, height);
    glClearBufferfv(GL_COLOR, 0, NOTHING);
    glClearBufferfv(GL_DEPTH, 0, &FAR);
    return CLOTH_OK;
}

void draw_surfaces_bind(const struct draw_surfaces *surfaces)
{
    for (int i = 0; i < DRAW_SURFACES; i++) {
        glActiveTexture(GL_TEXTURE0 + DRAW_UNIT_SURFACES + (GLenum)i);
        glBindTexture(GL_TEXTURE_2D_MULTISAMPLE, surfaces->texture[i]);
    }
    glActiveTexture(GL_TEXTURE0);
}

void draw_surfaces_free(struct draw_surfaces *surfaces)
{
    glDeleteFramebuffers(1, &surfaces->frame);
    glDeleteTextures(DRAW_SURFACES, surfaces->texture);
    *surfaces = (struct draw_surfaces){0};
}
