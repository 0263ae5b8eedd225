#ifndef CLOTH_VIEW_COLOUR_H
#define CLOTH_VIEW_COLOUR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Quantities that colour cloth, and the colours of numbers. Pure functions. */

enum view_colour {
    VIEW_COLOUR_CLOTH,   /* each cloth its own, as light falls on it */
    VIEW_COLOUR_BLOCK,   /* that has the vertex */
    VIEW_COLOUR_RANK,    /* that keeps the block */
    VIEW_COLOUR_STRAIN,  /* the largest principal strain, m/m */
    VIEW_COLOUR_STRESS,  /* the largest principal stress, N/m */
    VIEW_COLOUR_CONTACT, /* how large the force of contact is, N */
    VIEW_COLOURS
};

struct view_scale {
    double min, max; /* min < max: the numbers of the map's first and last colour */
};

struct view_colouring {
    enum view_colour by;
    bool has_scale; /* else the frames say */
    struct view_scale scale;
};

/* cloth, block, ...; the title above a scale, with the unit. */
extern const char *const view_colour_word[VIEW_COLOURS], *const view_colour_title[VIEW_COLOURS];
/* True for colours of parts, which have no order; all others but the cloth's are of numbers on a
 * scale. */
static inline bool view_colour_is_of_parts(enum view_colour by)
{
    return by == VIEW_COLOUR_BLOCK || by == VIEW_COLOUR_RANK;
}
static inline bool view_colour_has_scale(enum view_colour by)
{
    return by >= VIEW_COLOUR_STRAIN;
}
/* WORD, or with a scale WORD,MAX (from 0) or WORD,MIN:MAX. NULL, or its fault. */
const char *view_colouring_parse(const char *text, struct view_colouring *colouring);

/* --- Numbers: viridis, by S. van der Walt and N. Smith (2015, matplotlib, CC0): its lightness
 * grows evenly, also without red, green or blue. These are ten of its colours, evenly spread, as
 * sRGB, 0 .. 1; between them it is linear. --- */

enum { VIEW_MAP = 10 };
extern const float view_map[VIEW_MAP][3];
/* At part 0 .. 1; parts outside have the colour of the end. */
void view_map_at(double part, float colour[3]);
/* The part of a number on a scale, 0 .. 1 and, outside, the end. */
double view_scale_part(const struct view_scale *scale, double value);
/* From 0 to the next round number: 1, 2 or 5 with zeros; to 1 where nothing is above 0. */
struct view_scale view_scale_up_to(double max);

/* Marks of a scale: round numbers within it, at least two and at most VIEW_TICKS (Heckbert 1990,
 * Graphics Gems, "Nice numbers for graph labels"). */
enum { VIEW_TICKS = 7, VIEW_TICK_TEXT = 24 };
struct view_ticks {
    size_t n;
    double value[VIEW_TICKS];
    char text[VIEW_TICKS][VIEW_TICK_TEXT];
};
void view_scale_ticks(const struct view_scale *scale, struct view_ticks *ticks);

/* --- Parts: the colours of Okabe and Ito (2008, "Color Universal Design"), which everyone can tell
 * apart, with a grey in the place of their black. sRGB, 0 .. 1. --- */

enum { VIEW_HUES = 8 };
extern const float view_hue[VIEW_HUES][3];
/* Gives each of n_parts parts a colour, below VIEW_HUES. If there are at most VIEW_HUES parts, each
 * has the colour of its number. Otherwise a part takes the first one from its number on that no
 * earlier neighbour has. Parts are neighbours if a triangle has vertices of both; a vertex of part
 * -1 is of none. part: of each vertex; near: room for n_parts numbers. */
void view_hues_spread(uint32_t n_triangles, const uint32_t *triangle, const int32_t *part,
                      uint32_t n_parts, unsigned char *hue, unsigned *near);

#endif
