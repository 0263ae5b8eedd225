#ifndef CLOTH_VIEW_DRAW_DRAW_H
#define CLOTH_VIEW_DRAW_DRAW_H

#include "cloth/base/error.h"

#include <epoxy/gl.h>
#include <stdbool.h>
#include <stdint.h>

/* The parts of a scene. An OpenGL context is current in all functions. */

/* --- lights.c: directions of light, each with a depth map of what the cloth keeps from it --- */

/* A wide sun for soft shadows, and the sky. shaders.c counts on the same numbers. The maps' pixels
 * along a side. */
enum { DRAW_SUN = 8, DRAW_SKY = 48, DRAW_SUN_MAP = 512, DRAW_SKY_MAP = 256 };

#define DRAW_SUN_RADIUS 0.13 /* tangent of half the angle that the sun fills; shaders.c, too */

/* As the shaders see it (std140). */
struct draw_light_block {
    float sky[2 * DRAW_SKY][4]; /* of each: towards it, and to the right in its map; of length 1 */
    float right[4], up[4], toward[4]; /* those of the sun, in all its maps */
    float sphere[4];                  /* that all maps hold: centre (m), 1 / diameter (1/m) */
    /* Metres off the surface where the sun's shadows are looked up; their blur, a part of a map's
     * width; metres of the sky's. */
    float bias[4];
};

struct draw_lights {
    struct draw_light_block block;
    float radius; /* m: of the sphere that they are aimed at, and a margin */
    GLuint suns, skies, frame, buffer;
};
/* Draws what throws shadows, with the program that is in use, whose rows of a map are at
 * row_uniform: few triangles where coarse ones do. */
struct draw_casting {
    void (*cast)(const void *context, bool coarse);
    const void *context;
    GLint row_uniform;
};
int draw_lights_make(struct draw_lights *lights, struct cloth_error *error);
/* Aims the maps at a sphere, fills them, and hands the block to the shaders. casting NULL: the maps
 * stay as they are, for shaders that do not look. Restores the framebuffer and viewport that were
 * bound. */
void draw_lights_aim(struct draw_lights *lights, const float center[3], float radius,
                     const struct draw_casting *casting);
/* For all programs: the block, and the maps. */
void draw_lights_bind(const struct draw_lights *lights);
void draw_lights_free(struct draw_lights *lights);

/* --- sky.c: light that is worked out once for all pixels --- */

/* Units of textures: the maps of the sun and the sky; two of light; surfaces. */
enum { DRAW_UNIT_SUNS, DRAW_UNIT_SKIES, DRAW_UNIT_FRONT, DRAW_UNIT_BACK, DRAW_UNIT_SURFACES };

/* The light on both sides, a texel for each vertex of a mesh, or for each place of a square. */
struct draw_sky {
    GLuint light[2], frame; /* front, back */
    GLuint source;          /* of a mesh: place and normal of each vertex; 0: of a square */
    int width, height;
};
enum { DRAW_SKY_ROW = 1024 }; /* vertices a row */
/* For n vertices. */
int draw_sky_make(struct draw_sky *sky, uint32_t n, struct cloth_error *error);
/* For a square of n x n places. */
int draw_sky_make_square(struct draw_sky *sky, int n, struct cloth_error *error);
/* vertex: n x (position, normal), where they are now. */
void draw_sky_place(const struct draw_sky *sky, const float *vertex, uint32_t n);
/* Runs the program in use over all texels, with what is bound: the lights' block, the maps, a
 * vertex array; a texture to read is at DRAW_UNIT_FRONT. Restores the framebuffer and viewport that
 * were bound. */
void draw_sky_light(const struct draw_sky *sky, GLuint read);
void draw_sky_bind(const struct draw_sky *sky);
void draw_sky_free(struct draw_sky *sky);

/* --- ground.c: planes --- */

/* The light of the sky, or how much of the sun is seen, on a square of a plane. */
struct draw_square {
    double centre[3], half; /* m: half its side */
    float blur;             /* the radius, in parts of the side, that it is to be smoothed in */
    struct draw_sky light;
};
enum { DRAW_BY_SKY, DRAW_BY_SUN, DRAW_SQUARES };
extern const int DRAW_SQUARE_SIZE[DRAW_SQUARES]; /* texels along a side */

/* The foot of the cloth's centre on a plane, and directions square to each other, of length 1. */
struct draw_ground {
    double foot[3], u[3], v[3], n[3];
    struct draw_square square[DRAW_SQUARES];
};
int draw_ground_make(struct draw_ground *ground, struct cloth_error *error);
/* plane: point, normal; center, radius: of a sphere around the cloth; lights: aimed at it */
void draw_ground_place(struct draw_ground *ground, const double plane[6], const float center[3],
                       float radius, const struct draw_lights *lights);
/* Sets the program's square. half: m, half its side */
void draw_ground_square(const struct draw_ground *ground, GLuint program, const double centre[3],
                        double half);
/* Draws the plane, unless it is seen from behind: a square that fades before its edges; floors
 * reach farther than slopes. The program is in use. eye: where the camera is; reach: m, the extent
 * of what is shown */
void draw_ground(const struct draw_ground *ground, GLuint program, const float eye[3], float reach);
void draw_ground_free(struct draw_ground *ground);

/* --- surfaces.c: what a picture shows, before it is shaded --- */

/* Normal towards the eye, and paint; light of the sky, and whether it is an edge that is drawn;
 * depth. All have several samples a pixel. */
enum { DRAW_SURFACES = 3 };
struct draw_surfaces {
    GLuint frame, texture[DRAW_SURFACES];
    int width, height, samples;
};
/* Paints: those of cloths and obstacles, front and back; of parts; grey; places on a scale, to the
 * end. The two before are no surface, and a colour that is ready. shaders.c has the same numbers.
 */
enum {
    DRAW_PAINT_FIRST = 2,
    DRAW_PAINT_PARTS = 16,
    DRAW_PAINT_GREY = 32,
    DRAW_PAINT_SCALE = 33,
    DRAW_PAINTS = 256
};
/* Binds their framebuffer, of that size, with nothing in it. Zero before the first time. */
int draw_surfaces_start(struct draw_surfaces *surfaces, int width, int height,
                        struct cloth_error *error);
void draw_surfaces_bind(const struct draw_surfaces *surfaces);
void draw_surfaces_free(struct draw_surfaces *surfaces);

/* --- mesh.c: vertices of the cloth, or of obstacles, on the graphics card --- */

enum { DRAW_VALUE = 2 }; /* the attribute: position and normal come before it */
struct draw_mesh {
    uint32_t n_vertices, n_triangles, n_lines, n_coarse;
    const uint32_t *triangle;
    float *vertex; /* n_vertices x (position, normal) */
    GLuint array, vertices, indices, values;
    float center[3], radius; /* a sphere around the vertices */
    struct draw_sky sky;     /* its light on them, where they were lit last */
};
int draw_mesh_make(struct draw_mesh *mesh, uint32_t n_vertices, uint32_t n_triangles,
                   const uint32_t *triangle, uint32_t n_lines, const uint32_t *line,
                   struct cloth_error *error);
void draw_mesh_move(struct draw_mesh *mesh, const double *position);
/* The same with normals given. vertex: n_vertices x (position, normal) */
void draw_mesh_place(struct draw_mesh *mesh, const double (*vertex)[6]);
/* The number that each vertex is coloured by: n_vertices; 0 until this is called. */
void draw_mesh_values(struct draw_mesh *mesh, const float *value);
/* The mean length of the triangles' edges; 0 without triangles. */
float draw_mesh_edge(const struct draw_mesh *mesh);
void draw_mesh_draw(const struct draw_mesh *mesh);
/* Few triangles over some of its vertices, which are about where it is, chosen in each place anew:
 * a picture of a frame does not depend on what was drawn before. */
void draw_mesh_draw_coarse(const struct draw_mesh *mesh);
/* A run of its triangles, and of its lines. */
struct draw_part {
    uint32_t triangle, n_triangles, line, n_lines;
};
void draw_mesh_draw_part(const struct draw_mesh *mesh, const struct draw_part *part);
void draw_mesh_free(struct draw_mesh *mesh);

/* Joins vertices over edges shorter than `longest` (m) to others that are at most `flat` (m) off
 * their planes, and they off theirs, so that about a fifth of the triangles are left where all
 * edges are: n of them are in and out. Returns how many are left. vertex: n_vertices x (position,
 * normal); join: scratch, n_vertices. Pure. */
uint32_t draw_coarsen(uint32_t n_vertices, const float *vertex, float longest, float flat,
                      uint32_t *join, uint32_t n, uint32_t (*triangle)[3]);

/* --- program.c --- */

int draw_program(GLuint *program, const char *vertex, const char *fragment,
                 struct cloth_error *error);

/* --- shaders.c --- */

extern const char DRAW_COMMON[], DRAW_CAST_VERTEX[], DRAW_CAST_FRAGMENT[], DRAW_ALL_VERTEX[],
    DRAW_SURFACE_VERTEX[], DRAW_SURFACE_FRAGMENT[], DRAW_GROUND_VERTEX[], DRAW_GROUND_FRAGMENT[],
    DRAW_SHADE_FRAGMENT[], DRAW_SKY_FRAGMENT[], DRAW_SKY_SQUARE_FRAGMENT[],
    DRAW_SUN_SQUARE_FRAGMENT[], DRAW_BLUR_FRAGMENT[];

#endif
