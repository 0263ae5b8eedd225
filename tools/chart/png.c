/* A chart as PNG, drawn by cairo where configure found it. */
#include "config.h"

#include "tools/chart/canvas.h"

#include "runtime/base/error.h"

#include <duite.h>

#ifdef HAVE_CAIRO
#include <cairo.h>

static void png_colour(cairo_t *cairo, uint32_t rgb)
{
    cairo_set_source_rgb(cairo, (rgb >> 16 & 0xff) / 255.0, (rgb >> 8 & 0xff) / 255.0,
                         (rgb & 0xff) / 255.0);
}

static void png_rectangle(void *cairo, int x, int y, int width, int height, uint32_t rgb)
{
    png_colour(cairo, rgb);
    cairo_rectangle(cairo, x, y, width, height);
    cairo_fill(cairo);
}

static void png_columns(void *cairo, int x, int base, int n, const int *height, uint32_t rgb)
{
    int next;
    png_colour(cairo, rgb);
    for (int i = 0; i < n; i = next) {
        for (next = i + 1; next < n && height[next] == height[i];)
            next++;
        cairo_rectangle(cairo, x + i, base - height[i], next - i, height[i]);
    }
    cairo_fill(cairo);
}

static void png_line(void *cairo, const double from[2], const double to[2], double width,
                     uint32_t rgb)
{
    png_colour(cairo, rgb);
    cairo_set_line_width(cairo, width);
    cairo_move_to(cairo, from[0], from[1]);
    cairo_line_to(cairo, to[0], to[1]);
    cairo_stroke(cairo);
}

static void png_text(void *cairo, double x, double y, enum chart_anchor anchor, int size,
                     const char *text)
{
    cairo_text_extents_t extents;
    png_colour(cairo, 0);
    cairo_set_font_size(cairo, size);
    cairo_text_extents(cairo, text, &extents);
    cairo_move_to(cairo, x - extents.x_advance * (int)anchor / 2, y);
    cairo_show_text(cairo, text);
}

static cairo_status_t png_put(void *file, const unsigned char *data, unsigned int n)
{
    return fwrite(data, 1, n, file) == n ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

static int png_draw(const struct chart *chart, FILE *file)
{
    cairo_surface_t *surface =
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, chart_width(chart), chart_height(chart));
    cairo_t *cairo = cairo_create(surface);
    const struct chart_canvas canvas = {cairo, png_rectangle, png_columns, png_line, png_text};
    cairo_select_font_face(cairo, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    int code = chart_draw(chart, &canvas);
    cairo_status_t status = cairo_status(cairo);
    if (!code && !status)
        status = cairo_surface_write_to_png_stream(surface, png_put, file);
    cairo_destroy(cairo);
    cairo_surface_destroy(surface);
    if (!code && status && status != CAIRO_STATUS_WRITE_ERROR)
        code = base_error(DUITE_E_SYSTEM, "cairo cannot draw the chart: %s",
                          cairo_status_to_string(status));
    return code;
}

int chart_write_png(const struct trace_run *run, const struct chart_options *options, FILE *file)
{
    struct chart *chart;
    int code = chart_new(&chart, run, options);
    if (!code)
        code = png_draw(chart, file);
    chart_free(chart);
    return code;
}

#else

int chart_write_png(const struct trace_run *run, const struct chart_options *options, FILE *file)
{
    (void)run;
    (void)options;
    (void)file;
    return base_error(DUITE_E_ARGUMENT, "charts are PNG only in a build with cairo (install "
                                        "libcairo2-dev, then call configure); SVG needs nothing");
}

#endif
