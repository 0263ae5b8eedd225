/* A picture is drawn into a framebuffer and read. All that is made here is deleted here, whatever
 * fails. */
#include "cloth/output/files/files.h"
#include "cloth/view/view.h"

#include <epoxy/gl.h>
#include <errno.h>
#include <png.h>
#include <stdlib.h>
#include <string.h>

/* ---- Drawing ---- */

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
static void flip(const struct view_picture *picture)
{
    const size_t n = (size_t)3 * (size_t)picture->width;
    unsigned char *low = picture->rgb, *high = low + n * (size_t)(picture->height - 1);
    for (; low < high; low += n, high -= n)
        for (size_t k = 0; k < n; k++) {
            const unsigned char byte = low[k];
            low[k] = high[k];
            high[k] = byte;
        }
}

static int read_back(struct view_picture *picture, struct cloth_error *error)
{
    picture->rgb = malloc((size_t)3 * (size_t)picture->width * (size_t)picture->height);
    if (!picture->rgb)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for a picture of %d x %d",
                          picture->width, picture->height);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, picture->width, picture->height, GL_RGB, GL_UNSIGNED_BYTE, picture->rgb);
    flip(picture);
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

/* ---- Files ---- */

static int fill_png(FILE *file, const void *what)
{
    const struct view_picture *picture = what;
    png_image image = {.version = PNG_IMAGE_VERSION,
                       .width = (png_uint_32)picture->width,
                       .height = (png_uint_32)picture->height,
                       .format = PNG_FORMAT_RGB};
    const bool whole = png_image_write_to_stdio(&image, file, 0, picture->rgb, 0, NULL);
    if (!whole && !errno)
        errno = EINVAL; /* a size that PNG has not */
    return !whole;
}

int view_picture_write(struct view_picture *picture, const char *path, struct cloth_error *error)
{
    return output_replace_file(path, fill_png, picture, error);
}

void view_picture_free(struct view_picture *picture)
{
    free(picture->rgb);
    picture->rgb = NULL;
}
