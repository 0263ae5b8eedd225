/* All text of pictures and windows is drawn here. */
#include "cloth/view/letters.h"

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

void view_letters_to(cairo_t *cairo, double x, double y, const char *text)
{
    view_letters_from(cairo, x - view_letters_width(cairo, text), y, text);
}
