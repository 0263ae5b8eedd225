#ifndef CLOTH_VIEW_DRAW_DRAW_H
#define CLOTH_VIEW_DRAW_DRAW_H

#include "cloth/base/error.h"

#include <epoxy/gl.h>
#include <stddef.h>
#include <stdint.h>

/* The parts of a scene. An OpenGL context is current in all functions. */

/* --- lights.c: directions of light, each with a depth map of what the cloth keeps from it --- */

/* A wide sun for soft shadows, and the sky. shaders.c counts on the same numbers. */
enum { DRAW_SUN = 24, DRAW_SKY = 48, DRAW_LIGHTS = DRAW_SUN + DRAW_SKY, DRAW_MAP = 512 };

/* As the shaders see it (std140). */
struct draw_light_block {
    float direction[DRAW_LIGHTS][4]; /* towards the light, length 1 */
    float colour[DRAW_LIGHTS][4];    /* linear */
    float row[3 * DRAW_LIGHTS][4];   /* world to map: x, y, depth in 0 .. 1 */
    /* x: metres off the surface where shadows are looked up; y: blur, of a map's width */
    float bias[4];
};

struct draw_lights {
    struct draw_light_block block;
    GLuint maps, frame, buffer;
};
int draw_lights_make(struct draw_lights *lights, struct cloth_error *error);
/* Aims the maps at a sphere, fills them by `cast`, and hands the block to the shaders. `cast` draws
 * what throws shadows with the program that is in use, whose map's rows are set; NULL: the maps
 * stay as they are, for shaders that do not look. Restores the framebuffer and viewport that were
 * bound. */
void draw_lights_aim(struct draw_lights *lights, const float center[3], float radius,
                     GLint row_uniform, void (*cast)(const void *context), const void *context);
void draw_lights_free(struct draw_lights *lights);

/* --- mesh.c: vertices of the cloth, or of obstacles, on the graphics card --- */

enum { DRAW_HEAT = 2 }; /* the attribute: position and normal come before it */
struct draw_mesh {
    uint32_t n_vertices, n_triangles, n_lines;
    const uint32_t *triangle;
    float *vertex; /* n_vertices x (position, normal) */
    GLuint array, vertices, indices, heats;
    float center[3], radius; /* a sphere around the vertices */
};
int draw_mesh_make(struct draw_mesh *mesh, uint32_t n_vertices, uint32_t n_triangles,
                   const uint32_t *triangle, uint32_t n_lines, const uint32_t *line,
                   struct cloth_error *error);
void draw_mesh_move(struct draw_mesh *mesh, const double *position);
/* The same with normals given. vertex: n_vertices x (position, normal) */
void draw_mesh_place(struct draw_mesh *mesh, const double (*vertex)[6]);
/* How hot each vertex is drawn, 0 .. 1: n_vertices; 0 until this is called. */
void draw_mesh_heat(struct draw_mesh *mesh, const float *heat);
/* The mean length of the triangles' edges; 0 without triangles. */
float draw_mesh_edge(const struct draw_mesh *mesh);
void draw_mesh_draw(const struct draw_mesh *mesh);
/* A run of its triangles, and of its lines. */
struct draw_part {
    uint32_t triangle, n_triangles, line, n_lines;
};
void draw_mesh_draw_part(const struct draw_mesh *mesh, const struct draw_part *part);
void draw_mesh_free(struct draw_mesh *mesh);
/* Area-weighted normals into vertex[6 v + 3 ..]; up where no triangle says. Pure. */
void draw_normals(uint32_t n_vertices, float *vertex, uint32_t n_triangles,
                  const uint32_t *triangle);

/* --- program.c --- */

int draw_program(GLuint *program, const char *vertex, const char *fragment,
                 struct cloth_error *error);

/* --- shaders.c --- */

extern const char DRAW_COMMON[], DRAW_CAST_VERTEX[], DRAW_CAST_FRAGMENT[], DRAW_BACK_VERTEX[],
    DRAW_BACK_FRAGMENT[], DRAW_CLOTH_VERTEX[], DRAW_CLOTH_FRAGMENT[], DRAW_GROUND_VERTEX[],
    DRAW_GROUND_FRAGMENT[];

#endif
