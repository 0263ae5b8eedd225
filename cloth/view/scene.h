#ifndef CLOTH_VIEW_SCENE_H
#define CLOTH_VIEW_SCENE_H

#include "cloth/view/draw/draw.h"
#include "cloth/view/view.h"

/* The parts of a scene: scene.c makes, moves and lights it, scene_draw.c draws it. */

enum view_program {
    VIEW_CAST,
    VIEW_SURFACE,
    VIEW_GROUND,
    VIEW_SHADE,
    VIEW_SKY,
    VIEW_SKY_SQUARE,
    VIEW_SUN_SQUARE,
    VIEW_BLUR,
    VIEW_PROGRAMS
};

struct view_scene {
    const struct view_obstacles *obstacles; /* NULL: none */
    struct draw_mesh mesh, shapes;          /* the cloth; the obstacles that have a surface */
    size_t n_grounds;
    struct draw_ground *ground;             /* n_grounds */
    struct draw_sky unsmooth[DRAW_SQUARES]; /* of one ground after the other */
    struct draw_surfaces surfaces;          /* of the last drawing */
    struct draw_lights lights;
    GLuint program[VIEW_PROGRAMS];
    GLuint nothing;    /* a vertex array without attributes */
    GLuint paints;     /* a texture of their colours */
    bool wired, plain; /* plain: without shadows */
    enum view_paint paint;
    int n_map; /* colours of the map; 0: each cloth has its own */
    const float (*map)[3];
    uint32_t n_parts;
    struct draw_part *part; /* n_parts: cloths */
};

bool view_scene_has_shapes(const struct view_scene *scene);
/* Takes a program into use, for a framebuffer of that size, and returns it. */
GLuint view_scene_use(const struct view_scene *scene, enum view_program which, int width,
                      int height);

#endif
