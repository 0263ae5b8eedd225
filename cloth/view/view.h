#ifndef CLOTH_VIEW_VIEW_H
#define CLOTH_VIEW_VIEW_H

#include "cloth/base/error.h"
#include "cloth/contact/shape.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Pictures of cloth with desktop OpenGL 3.3 core. Right-handed, metres, +y up. One thread; a
 * context must be open while scenes and pictures are made, drawn and freed. */

/* --- obstacles.c: where obstacles are at one time. Pure functions. --- */

struct view_obstacles {
    size_t n, n_planes;
    const struct contact_shape *shape; /* n */
    const struct phys_key *keys;
    const struct contact_bodies *bodies;
    double (*plane)[6]; /* n_planes: point, normal; at the time, */
    uint32_t n_vertices, n_triangles;
    double (*own)[6], (*vertex)[6]; /* n_vertices: point, normal; without motion, and at the time */
    uint32_t (*triangle)[3];
};
/* Makes the surfaces of n obstacles, with places and body shapes at time 0 (s). The caller owns
 * shape, keys and bodies, which outlive it. To be freed in any case. Error: CLOTH_E_MEMORY. */
int view_obstacles_make(struct view_obstacles *obstacles, size_t n,
                        const struct contact_shape *shape, const struct phys_key *keys,
                        const struct contact_bodies *bodies, struct cloth_error *error);
void view_obstacles_at(struct view_obstacles *obstacles, double time);
void view_obstacles_free(struct view_obstacles *obstacles);

/* --- camera.c: where to look from. Pure functions. --- */

struct view_camera {
    float clip[4][4], world[4][4]; /* columns: from the world to clip coordinates, and back */
    float eye[3];                  /* m */
    float reach;                   /* largest extent of the fitted points, m; > 0 */
};

/* Gathers points that the picture must show, seen from one direction. */
struct view_fit {
    double azimuth, elevation; /* degrees */
    double side[3][3];         /* right, up, back of the camera: orthonormal rows */
    double tangent[2];         /* of half the angle of view that the points may fill, x and y */
    double aspect, zoom;
    double
        max[4]; /* the largest x + tz, tz - x, y + tz, tz - y of the points, in the rows of side */
    double low[3], high[3]; /* box of the points in the world */
    double near, far;       /* largest and smallest coordinate along back */
};

/* azimuth: degrees around +y, 0 looks from +z, 90 from +x; elevation: degrees above the horizon,
 * within +-89; aspect: width / height; zoom: 1 shows everything, 2 half of it. */
void view_fit_start(struct view_fit *fit, double azimuth, double elevation, double aspect,
                    double zoom);
/* position: n x 3 */
void view_fit_add(struct view_fit *fit, size_t n, const double *position);
/* Adds the feet of the points on the planes (point, normal) that they are near to. */
void view_fit_planes(struct view_fit *fit, size_t n, const double (*planes)[6]);
/* Adds the points of an obstacle, of n, that are within half the points' extent of their box. A
 * body with a point there adds all, unless it is more than four times as large. */
void view_fit_near(struct view_fit *fit, size_t n, const double (*vertex)[6], bool body);
/* The nearest camera of that direction that has all points within its margins. */
void view_fit_camera(const struct view_fit *fit, struct view_camera *camera);

/* A camera that turns around a target. */
struct view_orbit {
    double azimuth, elevation, zoom; /* as view_fit_start has them */
    double target[3], distance;      /* m; of the eye */
    double front,
        behind; /* m: how far the fitted points reach from the target, to and from the eye */
    double radius, size; /* m: of a sphere around it; its largest extent */
};
/* The one that view_fit_camera has. */
void view_fit_orbit(const struct view_fit *fit, struct view_orbit *orbit);
void view_orbit_camera(const struct view_orbit *orbit, double aspect, struct view_camera *camera);
/* Turns by degrees; the elevation stays within +-89. */
void view_orbit_turn(struct view_orbit *orbit, double azimuth, double elevation);
/* Moves the target's image by parts of the picture's height. */
void view_orbit_pan(struct view_orbit *orbit, double right, double up);
/* The zoom stays within 0.2 and 1000. */
void view_orbit_zoom(struct view_orbit *orbit, double factor);

/* --- context.c: OpenGL without a display --- */

struct view_context;
/* EGL surfaceless (Mesa) or the first EGL device that works. CLOTH_E_LIBRARY says which packages to
 * install. */
int view_context_open(struct view_context **context, struct cloth_error *error);
void view_context_close(struct view_context *context);

/* --- scene.c: the scene drawn --- */

struct view_shape {
    uint32_t n_vertices, n_triangles, n_lines;
    const uint32_t *triangle,
        *line; /* x 3, x 2; read during view_scene_new only but for triangle */
    const struct view_obstacles *obstacles; /* as they are when the cloth moves; NULL: none */
    uint32_t n_cloths;                      /* each has a colour; 0: there is one cloth */
    const uint32_t *cloth_end; /* n_cloths: one behind the last vertex of each; triangles and lines
                                * are in the order of cloths */
};

struct view_scene;
/* The arrays must outlive the scene. */
int view_scene_new(struct view_scene **scene, const struct view_shape *shape,
                   struct cloth_error *error);
/* position: n_vertices x 3 of the frame to be drawn; obstacles are drawn where they are now. */
int view_scene_move(struct view_scene *scene, const double *position, struct cloth_error *error);
/* How the cloth is coloured. Light and shadow change only the lightness of a mapped colour. */
enum view_paint {
    VIEW_PAINT_CLOTH, /* each cloth has a colour of its own */
    VIEW_PAINT_SCALE, /* a vertex has the colour of a map that is as far along it as its number, 0
                         .. 1 */
    VIEW_PAINT_PARTS  /* a triangle has the colour of a map that its last corner's number counts */
};
enum { VIEW_MAP_MAX = 16 };
/* map: n colours (sRGB, 0 .. 1; at most VIEW_MAP_MAX), which outlives the scene; value: n_vertices;
 * negative: there is none, which is grey. Neither is read of VIEW_PAINT_CLOTH. */
void view_scene_paint(struct view_scene *scene, enum view_paint paint, int n, const float (*map)[3],
                      const float *value);
/* wired: draws the edges of the cloth's triangles, too; plain: without shadows, from the next move
 * on. A new scene is neither. */
void view_scene_style(struct view_scene *scene, bool wired, bool plain);
/* Draws into the bound framebuffer, with four samples a pixel. */
int view_scene_draw(struct view_scene *scene, const struct view_camera *camera, int width,
                    int height, struct cloth_error *error);
void view_scene_free(struct view_scene *scene);

/* --- picture.c --- */

struct view_picture {
    int width, height;
    unsigned char *rgb; /* height x width x 3, from the top */
};
/* Draws off screen; picture->width and height are the caller's, rgb is made here. */
int view_picture_draw(struct view_picture *picture, struct view_scene *scene,
                      const struct view_camera *camera, struct cloth_error *error);
/* Draws the same into the framebuffer of a window of that size, which is bound after it. */
int view_window_draw(int width, int height, struct view_scene *scene,
                     const struct view_camera *camera, struct cloth_error *error);
/* A PNG file, written whole or not at all. Errors: those of output_replace_file. */
int view_picture_write(struct view_picture *picture, const char *path, struct cloth_error *error);
void view_picture_free(struct view_picture *picture);

#endif
