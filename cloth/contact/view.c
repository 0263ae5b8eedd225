/* A body whose frames are blended is no longer along an axis than the longer of them. */
#include "cloth/contact/view.h"

#include <math.h>

/* The largest sizes of its box in all frames, m. */
static void body_sizes(const struct contact_body *body, double size[3])
{
    const double(*place)[3] = (void *)((const char *)body + body->frames);
    for (int c = 0; c < 3; c++)
        size[c] = body->high[c] - body->low[c];
    for (uint32_t k = 0; k < body->n_frames; k++, place += body->n_vertices)
        for (int c = 0; c < 3; c++) {
            double low = place[0][c], high = low;
            for (uint32_t i = 1; i < body->n_vertices; i++) {
                low = fmin(low, place[i][c]);
                high = fmax(high, place[i][c]);
            }
            size[c] = fmax(size[c], high - low);
        }
}

static uint32_t count_pixels(double size, double pitch, uint32_t most)
{
    const double n = fmax(ceil(size / pitch), 1);
    return n < most ? (uint32_t)n : most;
}

void contact_view_make(const struct contact_body *body, uint32_t axis, uint32_t resolution,
                       struct contact_view *view)
{
    double size[3];
    body_sizes(body, size);
    for (uint32_t c = 0; c < 3 && axis >= CONTACT_THINNEST; c++)
        if (size[c] <= fmin(size[(c + 1) % 3], size[(c + 2) % 3]))
            axis = c;
    const double wide = size[(axis + 1) % 3], high = size[(axis + 2) % 3];
    *view = (struct contact_view){.axis = axis, .pitch = fmax(wide, high) / resolution};
    view->width = count_pixels(wide, view->pitch, resolution);
    view->height = count_pixels(high, view->pitch, resolution);
    contact_view_cut(view, 1);
}

void contact_view_cut(struct contact_view *view, uint32_t strips)
{
    view->rows = 1;
    while (contact_view_strips(view) > strips)
        view->rows *= 2;
}

uint32_t contact_view_strips(const struct contact_view *view)
{
    return (view->height + view->rows - 1) / view->rows;
}

uint32_t contact_view_rows(const struct contact_view *view, uint32_t strip)
{
    const uint32_t left = view->height - strip * view->rows;
    return left < view->rows ? left : view->rows;
}
