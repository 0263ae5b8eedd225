#ifndef CLOTH_VIEW_COLOURS_H
#define CLOTH_VIEW_COLOURS_H

#include "cloth/element/strain.h"
#include "cloth/output/colours.h"
#include "cloth/output/output.h"
#include "cloth/view/legend.h"

/* How the cloth of a folder's frames is coloured, and the numbers of its vertices that it is
 * coloured by. Local; one thread. */

/* --- values.c: numbers of vertices --- */

/* Files are opened when they are asked for. */
struct view_values {
    struct output_cache *cache;
    const char *folder;
    struct output_colours_read *colours; /* NULL until it is asked for */
    struct element_strains strains;      /* shapes at rest that count in the frame asked for last */
    uint64_t since;             /* from which frame on they count; UINT64_MAX: there are none */
    double *cell, (*stress)[3]; /* of each triangle and edge */
    double *weight;             /* of each vertex */
    int32_t *number;            /* as this; */
    double *force;              /* x 3 */
};

/* cache and folder stay the caller's, and outlive it. To be closed in any case. Error:
 * CLOTH_E_MEMORY. */
int view_values_open(struct view_values *values, struct output_cache *cache, const char *folder,
                     struct cloth_error *error);
/* Gives each vertex of a frame the number of its part, or its number on a scale; NaN: there is
 * none. position: n_vertices x 3 of the frame, m. Strain of a vertex: the mean of that of its
 * triangles (cloth/element/strain.h), by their area at rest; without triangles, that of its edges,
 * by length. Stress is averaged likewise, from the larger eigenvalue of each triangle's elastic
 * stress; vertices of springs have none. Errors: CLOTH_E_INPUT, the folder does not say;
 * CLOTH_E_MEMORY. */
int view_values_at(struct view_values *values, enum view_colour by, uint64_t frame,
                   const double *position, double *value, struct cloth_error *error);
/* How many frames have these numbers. Errors as before. */
int view_values_frames(struct view_values *values, enum view_colour by, uint64_t *n_frames,
                       struct cloth_error *error);
void view_values_close(struct view_values *values);

/* --- colours.c: their colours --- */

/* All frames of a run of n are looked at, or of a long run a hundred, spread evenly: how many, and
 * which one is look i. */
static inline uint64_t view_looks(uint64_t n)
{
    return n < 100 ? n : 100;
}
static inline uint64_t view_look(uint64_t n, uint64_t i)
{
    return n > 1 ? i * (n - 1) / (view_looks(n) - 1) : 0;
}

struct view_colours {
    struct view_values values;
    struct view_legend legend;    /* what they are by now, and how */
    bool has_scale[VIEW_COLOURS]; /* it is known, */
    struct view_scale scale[VIEW_COLOURS];
    double *value, *position; /* n_vertices: of the frame; room for the positions of another */
    double low, high;         /* the least and largest of the frame; NaN: it has none */
    float *number;            /* of each vertex, for the scene */
    unsigned char *hue;       /* of each part */
    unsigned *near;
    int32_t *part; /* of each vertex */
};

/* Opens colours, first by `first`, whose scale is kept for that quantity. *colours: zero before; to
 * be closed in any case. Errors: those of view_values_at, of the first frame that has it. */
int view_colours_open(struct view_colours *colours, struct output_cache *cache, const char *folder,
                      const struct view_colouring *first, struct cloth_error *error);
/* Colours by another quantity from now on. Its default scale goes from 0 to a round number above 19
 * of 20 vertices' numbers above 0, in all frames, or in a hundred spread evenly over a long run: so
 * pictures and frames go together. Errors as before; they leave the colours as they were. */
int view_colours_pick(struct view_colours *colours, enum view_colour by, struct cloth_error *error);
/* Finds those of a frame. position: n_vertices x 3, m. Errors as before. */
int view_colours_frame(struct view_colours *colours, uint64_t frame, const double *position,
                       struct cloth_error *error);
/* Hands them to a scene. */
void view_colours_paint(const struct view_colours *colours, struct view_scene *scene);
/* Prints the meaning of the colours, and the numbers of the frame, on standard output. */
void view_colours_say(const struct view_colours *colours);
void view_colours_close(struct view_colours *colours);

#endif
