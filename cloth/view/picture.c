/* A picture is drawn into a framebuffer and read. All that is made here is deleted here, whatever
 * fails. */
#include "cloth/view/view.h"

#include <epoxy/gl.h>
#include <stdlib.h>
#include <string.h>

struct target {
    GLuint frame, color;
};

static int target_make(struct target *target, const struct view_picture *picture,
                       struct cloth_error *error)
{
    glGenFramebuffers(1, &target->frame);
    glBindFramebuffer(GL_FRAMEBUFFER, target->frame);
    glGenRenderbuffers(1, &target->color);
    glBindRenderbuffer(GL_RENDERBUFFER, target->color);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, picture->width, picture->height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target->color);
    GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    return status == GL_FRAMEBUFFER_COMPLETE
               ? 0
               : cloth_fail(error, CLOTH_E_LIBRARY, "OpenGL gives no framebuffer of %d x %d (0x%x)",
                            picture->width, picture->height, status);
}

static void target_free(const struct target *target)
{
    glDeleteFramebuffers(1, &target->frame);
    glDeleteRenderbuffers(1, &target->color);
}

/* OpenGL's rows go up, ours go down. */
static void flip(struct view_picture *picture, unsigned char *row)
{
    size_t n = (size_t)3 * (size_t)picture->width;
    for (int low = 0, high = picture->height - 1; low < high; low++, high--) {
        unsigned char *a = picture->rgb + (size_t)low * n, *b = picture->rgb + (size_t)high * n;
        memcpy(row, a, n);
        memcpy(a, b, n);
        memcpy(b, row, n);
    }
}

static int read_back(struct view_picture *picture, struct cloth_error *error)
{
    size_t row_size = (size_t)3 * (size_t)picture->width;
    unsigned char *row = malloc(row_size);
    picture->rgb = malloc(row_size * (size_t)picture->height);
    if (!row || !picture->rgb) {
        free(row);
        view_picture_free(picture);
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for a picture of %d x %d",
                          picture->width, picture->height);
    }
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, picture->width, picture->height, GL_RGB, GL_UNSIGNED_BYTE, picture->rgb);
    flip(picture, row);
    free(row);
    return 0;
}

static int picture_check_size(const struct view_picture *picture, struct cloth_error *error)
{
    GLint max = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &max);
    if (picture->width > 0 && picture->height > 0 && picture->width <= max &&
        picture->height <= max)
        return 0;
    return cloth_fail(error, CLOTH_E_INPUT,
                      "a picture may be 1 x 1 to %d x %d pixels here, not %d x %d", max, max,
                      picture->width, picture->height);
}

static int fail_to_draw(struct cloth_error *error)
{
    const GLenum trouble = glGetError();
    return trouble == GL_NO_ERROR
               ? 0
               : cloth_fail(error, CLOTH_E_LIBRARY, "OpenGL failed to draw (0x%x)", trouble);
}

int view_picture_draw(struct view_picture *picture, struct view_scene *scene,
                      const struct view_camera *camera, struct cloth_error *error)
{
    picture->rgb = NULL;
    int code = picture_check_size(picture, error);
    if (code)
        return code;
    struct target target = {0};
    code = target_make(&target, picture, error);
    code = code ? code : view_scene_draw(scene, camera, picture->width, picture->height, error);
    code = code ? code : read_back(picture, error);
    code = code ? code : fail_to_draw(error);
    if (code)
        view_picture_free(picture);
    target_free(&target);
    return code;
}

int view_window_draw(int width, int height, struct view_scene *scene,
                     const struct view_camera *camera, struct cloth_error *error)
{
    const struct view_picture picture = {width, height, NULL};
    int code = picture_check_size(&picture, error);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    code = code ? code : view_scene_draw(scene, camera, width, height, error);
    return code ? code : fail_to_draw(error);
}
