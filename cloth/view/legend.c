/* All text of pictures and windows is drawn here. A picture gets the same pixels as a window of its
 * size: both are painted by one function. */
#include "config.h"

#include "cloth/view/legend.h"

#ifdef HAVE_CAIRO

#include <cairo.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- Letters ---- */

void view_letters(cairo_t *cairo, double size)
{
    cairo_select_font_face(cairo, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cairo, size);
    cairo_set_line_width(cairo, size / 5);
}

void view_letters_from(cairo_t *cairo, double x, double y, const char *text)
{
    cairo_save(cairo);
    cairo_new_path(cairo);
    cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
    cairo_move_to(cairo, x, y);
    cairo_text_path(cairo, text);
    cairo_set_source_rgba(cairo, 0, 0, 0, 0.6);
    cairo_stroke_preserve(cairo);
    cairo_set_source_rgba(cairo, 1, 1, 1, 1);
    cairo_fill(cairo);
    cairo_restore(cairo);
}

double view_letters_width(cairo_t *cairo, const char *text)
{
    cairo_text_extents_t extents;
    cairo_text_extents(cairo, text, &extents);
    return extents.x_advance;
}

/* Writes up to x. */
static void view_letters_to(cairo_t *cairo, double x, double y, const char *text)
{
    view_letters_from(cairo, x - view_letters_width(cairo, text), y, text);
}

/* ---- The legend ---- */

enum { LISTED = 12 }; /* parts that are named one by one */

/* Pixels: where the legend is, and how large its letters are. */
struct place {
    double letter, right, top, bar, height;
};

static struct place legend_place_of(int width, int height)
{
    const double letter = fmin(fmax(height / 48.0, 9), 40);
    return (struct place){.letter = letter,
                          .right = width - 1.2 * letter,
                          .top = 2.2 * letter,
                          .bar = 1.2 * letter,
                          .height = fmin(16 * letter, 0.5 * height)};
}

/* A title that is too long for the picture gets smaller letters. */
static void paint_title(cairo_t *cairo, const struct place *at, const char *title)
{
    const double wide = view_letters_width(cairo, title), room = at->right - at->letter;
    if (wide > room && room > 0)
        view_letters(cairo, at->letter * room / wide);
    view_letters_to(cairo, at->right, at->top, title);
    view_letters(cairo, at->letter);
}

static void paint_frame(cairo_t *cairo, double x, double y, double width, double height)
{
    cairo_rectangle(cairo, x, y, width, height);
    cairo_set_source_rgba(cairo, 0, 0, 0, 0.7);
    cairo_set_line_width(cairo, 1);
    cairo_stroke(cairo);
}

/* One row of pixels after the other, without smoothing, has the very colours of the map. */
static void paint_map(cairo_t *cairo, double x, double y, double width, double height)
{
    for (double row = 0; row < height; row++) {
        float c[3];
        view_map_at(1 - (row + 0.5) / height, c);
        cairo_rectangle(cairo, x, y + row, width, 1);
        cairo_set_source_rgb(cairo, (double)c[0], (double)c[1], (double)c[2]);
        cairo_fill(cairo);
    }
}

static void paint_scale(cairo_t *cairo, const struct place *at, const struct view_scale *scale)
{
    struct view_ticks ticks;
    const double x = floor(at->right - at->bar), y = floor(at->top + 1.2 * at->letter);
    const double width = floor(at->bar), height = floor(at->height);
    cairo_set_antialias(cairo, CAIRO_ANTIALIAS_NONE);
    paint_map(cairo, x, y, width, height);
    cairo_set_antialias(cairo, CAIRO_ANTIALIAS_DEFAULT);
    paint_frame(cairo, x - 0.5, y - 0.5, width + 1, height + 1);
    view_scale_ticks(scale, &ticks);
    view_letters(cairo, at->letter);
    for (size_t i = 0; i < ticks.n; i++) {
        const double row = y + height * (1 - view_scale_part(scale, ticks.value[i]));
        cairo_rectangle(cairo, x - 0.35 * at->letter, floor(row - 0.5), 0.35 * at->letter, 1);
        cairo_set_source_rgba(cairo, 0, 0, 0, 0.8);
        cairo_fill(cairo);
        view_letters_to(cairo, x - 0.6 * at->letter, row + 0.35 * at->letter, ticks.text[i]);
    }
}

static void paint_parts(cairo_t *cairo, const struct place *at, const struct view_legend *legend)
{
    for (uint32_t p = 0; p < legend->n_parts; p++) {
        const float *c = view_hue[legend->hue[p]];
        const double x = floor(at->right - at->bar);
        const double y = floor(at->top + (0.9 + 1.5 * p) * at->letter);
        char text[16];
        snprintf(text, sizeof text, "%u", p);
        cairo_rectangle(cairo, x, y, floor(at->bar), floor(at->bar));
        cairo_set_source_rgb(cairo, (double)c[0], (double)c[1], (double)c[2]);
        cairo_fill(cairo);
        paint_frame(cairo, x - 0.5, y - 0.5, floor(at->bar) + 1, floor(at->bar) + 1);
        view_letters(cairo, at->letter);
        view_letters_to(cairo, x - 0.6 * at->letter, y + 0.95 * at->letter, text);
    }
}

void view_legend_paint(const struct view_legend *legend, cairo_t *cairo, int width, int height)
{
    const struct place at = legend_place_of(width, height);
    const bool parts = view_colour_is_of_parts(legend->by);
    const bool listed =
        legend->n_parts <= LISTED && 1.5 * legend->n_parts * at.letter < 0.8 * height;
    char title[100];
    if (legend->by == VIEW_COLOUR_CLOTH)
        return;
    if (parts && !listed)
        snprintf(title, sizeof title, "%s, 0 to %u (colours repeat)", view_colour_title[legend->by],
                 legend->n_parts - 1);
    else
        snprintf(title, sizeof title, "%s", view_colour_title[legend->by]);
    view_letters(cairo, at.letter);
    paint_title(cairo, &at, title);
    if (!parts)
        paint_scale(cairo, &at, &legend->scale);
    else if (listed)
        paint_parts(cairo, &at, legend);
}

/* The surface has premultiplied colours, a word a pixel. */
static void legend_blend(const unsigned char *words, int stride, struct view_picture *picture)
{
    const size_t width = (size_t)picture->width;
    for (size_t y = 0; y < (size_t)picture->height; y++)
        for (size_t x = 0; x < width; x++) {
            unsigned char *rgb = picture->rgb + 3 * (y * width + x);
            uint32_t word;
            memcpy(&word, words + y * (size_t)stride + 4 * x, sizeof word);
            const unsigned through = 255 - (word >> 24);
            for (int k = 0; k < 3 && through < 255; k++) {
                const unsigned over = word >> (16 - 8 * k) & 0xff;
                rgb[k] = (unsigned char)(over + (through * rgb[k] + 127) / 255);
            }
        }
}

int view_legend_lay(const struct view_legend *legend, struct view_picture *picture,
                    struct cloth_error *error)
{
    if (legend->by == VIEW_COLOUR_CLOTH)
        return 0;
    cairo_surface_t *surface =
        cairo_image_surface_create(CAIRO_FORMAT_ARGB32, picture->width, picture->height);
    cairo_t *cairo = cairo_create(surface);
    view_legend_paint(legend, cairo, picture->width, picture->height);
    const cairo_status_t status = cairo_status(cairo);
    cairo_destroy(cairo);
    cairo_surface_flush(surface);
    if (status == CAIRO_STATUS_SUCCESS)
        legend_blend(cairo_image_surface_get_data(surface), cairo_image_surface_get_stride(surface),
                     picture);
    cairo_surface_destroy(surface);
    return status == CAIRO_STATUS_SUCCESS
               ? 0
               : cloth_fail(error, CLOTH_E_LIBRARY, "cairo cannot draw the scale: %s",
                            cairo_status_to_string(status));
}

#else

int view_legend_lay(const struct view_legend *legend, struct view_picture *picture,
                    struct cloth_error *error)
{
    (void)legend, (void)picture, (void)error;
    return 0;
}

#endif
