/* The picture is written under another name and renamed, so that its path never holds half a
 * picture. */
#include "cloth/view/view.h"

#include <errno.h>
#include <png.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static int view_image_fail(struct cloth_error *error, const char *path, const char *reason)
{
    return cloth_fail(error, CLOTH_E_IO, "cannot write %s: %s", path, reason);
}

/* name: the file that is opened; path: its final name, for sentences. */
static int view_image_write_file(const struct view_picture *picture, const char *name,
                                 const char *path, struct cloth_error *error)
{
    FILE *file = fopen(name, "wbe");
    if (!file)
        return view_image_fail(error, path, strerror(errno));
    png_image image = {.version = PNG_IMAGE_VERSION,
                       .width = (png_uint_32)picture->width,
                       .height = (png_uint_32)picture->height,
                       .format = PNG_FORMAT_RGB};
    errno = 0;
    bool whole = png_image_write_to_stdio(&image, file, 0, picture->rgb, 0, NULL) != 0;
    int reason = errno;
    if (fclose(file) != 0 && whole) {
        whole = false;
        reason = errno;
    }
    return whole ? 0 : view_image_fail(error, path, reason ? strerror(reason) : image.message);
}

int view_picture_write(const struct view_picture *picture, const char *path,
                       struct cloth_error *error)
{
    struct stat status;
    if (stat(path, &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode))
        return view_image_write_file(picture, path, path, error); /* a pipe or a device */
    char *part = NULL;
    if (asprintf(&part, "%s.part", path) < 0)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory to write %s", path);
    int code = view_image_write_file(picture, part, path, error);
    if (!code && rename(part, path) != 0)
        code = view_image_fail(error, path, strerror(errno));
    if (code)
        unlink(part);
    free(part);
    return code;
}

void view_picture_free(struct view_picture *picture)
{
    free(picture->rgb);
    picture->rgb = NULL;
}
