/* The surface has the size of the window. Its pixels are premultiplied and lie upside down for
 * OpenGL; the vertex shader turns them. */
#include "cloth/view/overlay.h"

#include "cloth/view/draw/draw.h"

#include <cairo.h>
#include <math.h>

/* Pixels. */
static const double MARGIN = 24, BAR = 6, REACH = 14, LETTER = 15, LINE = 24;

static const char VERTEX[] = "out vec2 at;\n"
                             "void main()\n"
                             "{\n"
                             "    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);\n"
                             "    at = vec2(corner.x, 1.0 - corner.y);\n"
                             "    gl_Position = vec4(2.0 * corner - 1.0, 0.0, 1.0);\n"
                             "}\n";
static const char FRAGMENT[] = "in vec2 at;\n"
                               "out vec4 shade;\n"
                               "uniform sampler2D picture;\n"
                               "void main() { shade = texture(picture, at); }\n";

static double bar_height(int height)
{
    return height - MARGIN - BAR / 2;
}

double view_overlay_part(double x, double y, int width, int height)
{
    const double length = width - 2 * MARGIN;
    if (!(length > 0) || fabs(y - bar_height(height)) > REACH || x < MARGIN - REACH ||
        x > width - MARGIN + REACH)
        return -1;
    return fmin(fmax((x - MARGIN) / length, 0), 1);
}

int view_overlay_make(struct view_overlay *overlay, struct cloth_error *error)
{
    glGenVertexArrays(1, &overlay->array);
    glGenTextures(1, &overlay->texture);
    glBindTexture(GL_TEXTURE_2D, overlay->texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return draw_program(&overlay->program, VERTEX, FRAGMENT, error);
}

static void line(cairo_t *cairo, double from, double to, double y, double grey, double alpha)
{
    cairo_set_source_rgba(cairo, grey, grey, grey, alpha);
    cairo_move_to(cairo, from, y);
    cairo_line_to(cairo, to, y);
    cairo_stroke(cairo);
}

static void draw_line(cairo_t *cairo, const struct view_overlay_text *text, int width, int height)
{
    const double y = bar_height(height), end = width - MARGIN;
    const double now = MARGIN + text->part * (end - MARGIN);
    view_letters_from(cairo, MARGIN, text->part < 0 ? y : y - REACH, text->status);
    if (text->part < 0)
        return;
    cairo_set_line_cap(cairo, CAIRO_LINE_CAP_ROUND);
    cairo_set_line_width(cairo, BAR);
    line(cairo, MARGIN, end, y, 0.1, 0.5);
    line(cairo, MARGIN, now, y, 0.95, 0.9);
    cairo_arc(cairo, now, y, BAR, 0, 2 * acos(-1.0));
    cairo_fill(cairo);
}

static void draw_help(cairo_t *cairo, const char *const *help)
{
    double keys = 0, wide = 0;
    size_t n = 0;
    for (; help[2 * n]; n++) {
        keys = fmax(keys, view_letters_width(cairo, help[2 * n]));
        wide = fmax(wide, view_letters_width(cairo, help[2 * n + 1]));
    }
    cairo_rectangle(cairo, MARGIN, MARGIN, keys + wide + 4 * LETTER, ((double)n + 0.7) * LINE);
    cairo_set_source_rgba(cairo, 0, 0, 0, 0.55);
    cairo_fill(cairo);
    for (size_t i = 0; i < n; i++) {
        const double y = MARGIN + ((double)i + 1) * LINE;
        view_letters_from(cairo, MARGIN + LETTER, y, help[2 * i]);
        view_letters_from(cairo, MARGIN + keys + 3 * LETTER, y, help[2 * i + 1]);
    }
}

static int paint(cairo_surface_t *surface, const struct view_overlay_text *text, int width,
                 int height, struct cloth_error *error)
{
    cairo_t *cairo = cairo_create(surface);
    view_legend_paint(text->legend, cairo, width, height);
    view_letters(cairo, LETTER);
    if (text->status)
        draw_line(cairo, text, width, height);
    if (text->help)
        draw_help(cairo, text->help);
    const cairo_status_t status = cairo_status(cairo);
    cairo_destroy(cairo);
    cairo_surface_flush(surface);
    return status == CAIRO_STATUS_SUCCESS
               ? 0
               : cloth_fail(error, CLOTH_E_LIBRARY, "cairo cannot draw the time line: %s",
                            cairo_status_to_string(status));
}

static void overlay_lay(const struct view_overlay *overlay, cairo_surface_t *surface)
{
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, overlay->texture);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, cairo_image_surface_get_stride(surface) / 4);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, cairo_image_surface_get_width(surface),
                 cairo_image_surface_get_height(surface), 0, GL_BGRA, GL_UNSIGNED_INT_8_8_8_8_REV,
                 cairo_image_surface_get_data(surface));
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    glUseProgram(overlay->program);
    glUniform1i(glGetUniformLocation(overlay->program, "picture"), 0);
    glBindVertexArray(overlay->array);
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glDisable(GL_BLEND);
}

int view_overlay_draw(const struct view_overlay *overlay, const struct view_overlay_text *text,
                      int width, int height, struct cloth_error *error)
{
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width, height);
    const int code = paint(surface, text, width, height, error);
    if (!code)
        overlay_lay(overlay, surface);
    cairo_surface_destroy(surface);
    return code;
}

void view_overlay_free(const struct view_overlay *overlay)
{
    glDeleteProgram(overlay->program);
    glDeleteVertexArrays(1, &overlay->array);
    glDeleteTextures(1, &overlay->texture);
}
