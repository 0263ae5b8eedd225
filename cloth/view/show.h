#ifndef CLOTH_VIEW_SHOW_H
#define CLOTH_VIEW_SHOW_H

#include "cloth/view/colours.h"
#include "cloth/view/view.h"

#include <stdbool.h>
#include <stdint.h>

/* Frames of a folder, ready to be drawn. Pictures, films and windows show frames by these
 * functions. Local; one thread. */

struct view_wish {
    const char *folder;
    int width, height;
    double azimuth, elevation, zoom; /* as view_fit_start has them */
    struct view_colouring colouring; /* of the first frame */
    bool wire;                       /* with the edges of the triangles */
};

/* The camera with all that it was fitted to. */
struct view_sight {
    struct view_fit fit;
    struct view_orbit orbit, fitted; /* as it is; as the fit has it */
};

/* A show has one frame at a time. */
struct view_show {
    struct output_cache *cache;
    const struct view_wish *wish;
    struct view_obstacles obstacles;
    struct view_sight sight;     /* anyone may move its orbit */
    bool wire;                   /* with the edges of triangles; anyone may change it, */
    bool plain;                  /* and this: without shadows, from the next frame read on */
    struct view_scene *scene;    /* NULL until the first drawing */
    bool moved;                  /* the scene has another frame than was read last */
    unsigned char *used;         /* a vertex: true if a face or an edge uses it */
    uint64_t frame;              /* read last */
    double *position;            /* of it */
    struct view_colours colours; /* of it, with their legend */
};

/* Fits the camera to all frames, or to a hundred spread evenly over a long run, so that pictures of
 * a folder go together. The caller owns cache and wish, which outlive the show. *show: to be closed
 * in any case. Errors: CLOTH_E_INPUT, CLOTH_E_IO, CLOTH_E_MEMORY. */
int view_show_open(struct view_show **show, struct output_cache *cache,
                   const struct view_wish *wish, struct cloth_error *error);
/* Reads a frame, which is the one to be drawn from now on. */
int view_show_frame(struct view_show *show, uint64_t frame, struct cloth_error *error);
/* Draws it off screen, as view_picture_draw does. An OpenGL context is current, the same one in all
 * calls up to view_show_undraw. */
int view_show_picture(struct view_show *show, struct view_picture *picture,
                      struct cloth_error *error);
/* Fits the camera to the frame read last, too; unless somebody moved it, it is as fitted then. */
void view_show_follow(struct view_show *show);
/* Draws the frame into a window of that size, without the legend. */
int view_show_window(struct view_show *show, int width, int height, struct cloth_error *error);
/* Colours by the next quantity of enum view_colour that the folder has. */
int view_show_next_colour(struct view_show *show, struct cloth_error *error);
/* Frees the objects of drawing, while its context is current. */
void view_show_undraw(struct view_show *show);
void view_show_close(struct view_show *show);

#endif
