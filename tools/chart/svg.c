/* A chart as SVG. Successive shapes of one style are one path, so the file is small. */
#include "tools/chart/canvas.h"

#include <inttypes.h>

struct svg {
    FILE *file;
    enum { SVG_NOTHING, SVG_AREA, SVG_LINE } open; /* a path, which goes on as long as... */
    uint32_t rgb;                                  /* ... it has this colour, */
    double width;                                  /* ... and a line this width */
};

static void svg_close(struct svg *svg)
{
    if (svg->open == SVG_AREA)
        fputs("\"/>\n", svg->file);
    if (svg->open == SVG_LINE)
        fprintf(svg->file, "\" fill=\"none\" stroke=\"#%06" PRIx32 "\" stroke-width=\"%g\"/>\n",
                svg->rgb, svg->width);
    svg->open = SVG_NOTHING;
}

static void svg_open(struct svg *svg, int kind, uint32_t rgb, double width)
{
    if ((int)svg->open == kind && svg->rgb == rgb && (kind == SVG_AREA || !(svg->width != width)))
        return;
    svg_close(svg);
    if (kind == SVG_AREA)
        fprintf(svg->file, "<path fill=\"#%06" PRIx32 "\" d=\"", rgb);
    else
        fputs("<path d=\"", svg->file);
    svg->open = kind == SVG_AREA ? SVG_AREA : SVG_LINE;
    svg->rgb = rgb;
    svg->width = width;
}

static void svg_rectangle(void *context, int x, int y, int width, int height, uint32_t rgb)
{
    svg_open(context, SVG_AREA, rgb, 0);
    fprintf(((struct svg *)context)->file, "M%d %dh%dv%dh%dz", x, y, width, height, -width);
}

static void svg_columns(void *context, int x, int base, int n, const int *height, uint32_t rgb)
{
    struct svg *svg = context;
    int before = 0, next;
    svg_open(svg, SVG_AREA, rgb, 0);
    for (int i = 0; i < n; i = next) {
        for (next = i + 1; next < n && height[next] == height[i];)
            next++;
        if (!before && height[i])
            fprintf(svg->file, "M%d %d", x + i, base);
        if (height[i])
            fprintf(svg->file, "v%dh%d", before - height[i], next - i);
        else if (before)
            fprintf(svg->file, "V%dz", base);
        before = height[i];
    }
    if (before)
        fprintf(svg->file, "V%dz", base);
}

static void svg_line(void *context, const double from[2], const double to[2], double width,
                     uint32_t rgb)
{
    svg_open(context, SVG_LINE, rgb, width);
    fprintf(((struct svg *)context)->file, "M%.1f %.1fL%.1f %.1f", from[0], from[1], to[0], to[1]);
}

void chart_escape(FILE *file, const char *text)
{
    for (; *text; text++)
        if (*text == '&')
            fputs("&amp;", file);
        else if (*text == '<')
            fputs("&lt;", file);
        else if (*text == '>')
            fputs("&gt;", file);
        else
            fputc(*text, file);
}

static void svg_text(void *context, double x, double y, enum chart_anchor anchor, int size,
                     const char *text)
{
    static const char *const anchors[] = {"start", "middle", "end"};
    struct svg *svg = context;
    svg_close(svg);
    fprintf(svg->file, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" font-size=\"%d\">", x, y,
            anchors[anchor], size);
    chart_escape(svg->file, text);
    fputs("</text>\n", svg->file);
}

int chart_write_svg(const struct trace_run *run, const struct chart_options *options, FILE *file)
{
    struct svg svg = {.file = file};
    const struct chart_canvas canvas = {&svg, svg_rectangle, svg_columns, svg_line, svg_text};
    struct chart *chart;
    int code = chart_new(&chart, run, options);
    if (code)
        return code;
    const int width = chart_width(chart), height = chart_height(chart);
    fprintf(file,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" width=\"%d\" "
            "height=\"%d\" font-family=\"Helvetica, Arial, sans-serif\" role=\"img\">\n<title>",
            width, height, width, height);
    chart_escape(file, chart_title(chart));
    fputs("</title>\n", file);
    code = chart_draw(chart, &canvas);
    svg_close(&svg);
    fputs("</svg>\n", file);
    chart_free(chart);
    return code;
}
