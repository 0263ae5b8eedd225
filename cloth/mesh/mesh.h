#ifndef CLOTH_MESH_MESH_H
#define CLOTH_MESH_MESH_H

#include "cloth/base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The diagonals that cut the cells of a grid in two triangles. SAME: that from vertex (i, j) to (i
 * + 1, j + 1) in all. ALTERNATE: this one and the other by turns, as on a chessboard. MIRRORED:
 * this one in the first quarter of the sheet; the other quarters are mirror images of the first at
 * the lines through the middle. If the number of cells along an axis is odd, those in the middle
 * have no image: in this row or column of cells the diagonals go by turns. EQUILATERAL: not cells
 * but equilateral triangles, see mesh_grid. */
enum mesh_cells { MESH_SAME, MESH_ALTERNATE, MESH_MIRRORED, MESH_EQUILATERAL };

/* A mesh as it was given: vertices, polygons in the input's order and numbering, their triangles,
 * and edges that were given without triangles (chains). All arrays belong to the mesh. A grid
 * stores only positions: mesh_face, mesh_corners and mesh_uv give faces, triangles and uv of any
 * mesh. Local functions. */
struct mesh {
    uint32_t n_vertices;
    double *position; /* n_vertices x 3, metres */
    double *uv; /* (n_vertices + n_more_uv) x 2, or NULL unless every corner of a face has one: of
                 * each vertex that of its first corner, 0 of one without faces; then those that
                 * other corners of a vertex have, where islands of uv meet */
    uint32_t n_more_uv;
    uint32_t n_without_uv; /* faces with a corner that has none, where others have one */

    uint32_t n_faces;
    uint32_t *face_start;  /* n_faces + 1: corners of face f are face_corner[face_start[f] ..] */
    uint32_t *face_corner; /* vertices of the polygons, as in the input */
    uint32_t *face_uv;     /* numbers of their uv; NULL: those of the vertices */

    uint32_t n_triangles;
    uint32_t *triangle; /* n_triangles x 3: of the polygons, in order; a convex one is fanned from
                         * its first corner, others are cut by clipping ears */
    uint32_t *triangle_uv; /* n_triangles x 3: numbers of the uv; NULL: those of the vertices */
    bool placed_by_uv;     /* positions are one for each uv, of a flat shape at rest */

    uint32_t n_lone_edges;
    uint32_t n_bare_edges; /* of these, that no triangle has: they come first */
    uint32_t *lone_edge;   /* n_lone_edges x 2: edges given without triangles */

    uint32_t n_groups, n_group_runs;
    char **group; /* n_groups: names of faces, each once; */
    struct mesh_group_run {
        uint32_t group, first, n; /* faces first .. first + n - 1 are in this group */
    } * group_run;                /* by their first faces */
    uint32_t n_materials, n_material_runs, n_libraries;
    char **material; /* likewise, the materials of faces: a face has one or none */
    struct mesh_group_run *material_run;
    char **library; /* n_libraries: paths of the files that have the materials */

    uint32_t grid_nx, grid_ny;      /* vertices in u and v of a grid; 0: not a grid */
    double grid_width, grid_height; /* m, before any transform */
    enum mesh_cells grid_cells;
};

/* Makes a flat sheet in the x-z plane (y = 0, +y its normal's side), centred on the origin. width
 * is along x (u), height along z (v), both in metres. nx, ny >= 2 vertices are row-major, u
 * fastest: vertex j * nx + i. The faces are triangles, two a cell, cut along the diagonal that
 * `cells` says and wound so that normals are +y. uv is in metres from vertex 0.
 *
 * MESH_EQUILATERAL: rows have nx and nx - 1 vertices by turns, so all triangles are equilateral and
 * both sides ragged. Row j begins at vertex j * nx - j / 2. The height follows from the width;
 * `height` is not read. Such a mesh stores its arrays: other functions do not see it as a grid.
 *
 * Errors: CLOTH_E_INPUT for sizes that are not positive and finite, fewer than 2 vertices a side,
 * more than 2^31 corners; CLOTH_E_MEMORY. After an error the mesh is empty; likewise in
 * mesh_read_obj and mesh_inline. */
int mesh_grid(struct mesh *mesh, double width, double height, uint32_t nx, uint32_t ny,
              enum mesh_cells cells, struct cloth_error *error);

/* Makes a flat disc in the x-z plane, centred on the origin, +y its normal's side. A vertex is in
 * the middle, then come `rings` rings; the k-th has 6 k vertices and the radius radius k / rings
 * (m). Ring k begins with vertex 1 + 3 k (k - 1), on +x, and goes on towards +z. Edges are 1 to
 * 1.45 times radius / rings long; no triangle has less than 3/4 of the area of another. uv is in
 * metres. The mesh is no grid: it stores its arrays. Errors: CLOTH_E_INPUT for a radius that is not
 * positive and finite, and for less than one ring or more than MESH_DISC_RINGS; CLOTH_E_MEMORY. */
enum { MESH_DISC_RINGS = 10000 };
int mesh_disc(struct mesh *mesh, double radius, uint32_t rings, struct cloth_error *error);

/* Makes an ellipsoid around the origin, half its axes along x, y and z (m, > 0): the edges of an
 * icosahedron are halved four times, and all vertices lie on it; normals point outwards. No uv.
 * Error: CLOTH_E_MEMORY. */
int mesh_ellipsoid(struct mesh *mesh, const double half[3], struct cloth_error *error);

/* How far the rows of a sheet of equilateral triangles are from each other, m. */
double mesh_row_distance(double width, uint32_t nx);

/* True if cell (i, j) of a grid is cut along the diagonal from (i + 1, j) to (i, j + 1). */
bool mesh_cell_turned(const struct mesh *mesh, uint32_t i, uint32_t j);

/* Reads a mesh: of a file of another program (figure.h) by the ending of its name, else a Wavefront
 * OBJ file: v (x y z, the rest is ignored), vt, f (any polygon; v, v/vt, v//vn,
 * v/vt/vn; negative indices), l (lone edges), g and o (groups), usemtl and mtllib (materials). All
 * else is skipped. A face is in each group that the last g names, and in that of the last o, whose
 * name is the whole line; without a name it is in none. A repeated name continues its group. Groups
 * without faces are dropped. A library found beside the file has an absolute path, another one its
 * name. Errors name file and line. They are: no vertices, numbers that are malformed or not finite,
 * indices out of range, faces with fewer than 3 or repeated corners. A polygon of more than 3
 * corners must have area, and not cross or touch itself. More errors are: an edge of more than two
 * triangles (non-manifold, at the third face), a repeated lone edge, more than 2^31 vertices or
 * corners. A line that ends with `\` continues in the next and counts as the first. Codes:
 * CLOTH_E_INPUT, CLOTH_E_IO (cannot be read), CLOTH_E_MEMORY. */
int mesh_read_obj(struct mesh *mesh, const char *path, struct cloth_error *error);

/* The same for a surface that is neither folded nor cut: polygons that cross or touch themselves
 * are fanned from their first corner, since modellers leave twisted ones in bodies. */
int mesh_read_surface(struct mesh *mesh, const char *path, struct cloth_error *error);

/* Reads an animation of a file that mesh_read_obj reads by another ending: where the vertices of
 * its mesh are at the times k / rate (1/s) of the clip, from 0 to its end. clip: its name, or
 * "first". *place: n_frames x n_vertices x 3 as in the file, to be freed; NULL after an error.
 * CLOTH_E_INPUT: there is no such clip, it moves no vertex, or its frames take more than 4 GB;
 * CLOTH_E_IO, CLOTH_E_MEMORY, and CLOTH_E_LIBRARY where Assimp is left out. */
int mesh_read_clip(const char *path, uint32_t n_vertices, const char *clip, double rate,
                   uint32_t *n_frames, double **place, struct cloth_error *error);

/* Reads a frame of a PC2 file of version 1, or all: *place is n_frames x n_vertices x 3 as in the
 * file, of one frame n_vertices x 3, to be freed; NULL after an error. *n_frames: of the file. A
 * missing frame is no error: *place is NULL then. Codes: CLOTH_E_INPUT for another format, frames
 * of another size, no frames, an early end, or a coordinate that is not finite; CLOTH_E_IO,
 * CLOTH_E_MEMORY. */
#define MESH_ALL_FRAMES UINT32_MAX
#define MESH_LAST_FRAME (MESH_ALL_FRAMES - 1)
int mesh_read_pc2(const char *path, uint32_t n_vertices, uint32_t frame, uint32_t *n_frames,
                  double **place, struct cloth_error *error);

/* Reads weights, 0 to 1, from a text file: a number a line for each vertex; empty lines and
 * comments (#) are skipped. weight: n_vertices of the caller. Errors name file and line. Codes:
 * CLOTH_E_INPUT for other words and another number of weights; CLOTH_E_IO, CLOTH_E_MEMORY. */
int mesh_read_weights(const char *path, uint32_t n_vertices, double *weight,
                      struct cloth_error *error);

/* Takes copies of the arrays: vertices n x 3, edges n_edges x 2, triangles n_triangles x 3 (either
 * may be absent). Checks indices, repeated corners, finite positions, non-manifold edges and edges
 * that stand twice as mesh_read_obj does, naming the entry
 * ("triangles[4]: ..."), all counted from 0. At least one vertex. No uv. */
int mesh_inline(struct mesh *mesh, uint32_t n_vertices, const double *vertices, uint32_t n_edges,
                const uint32_t *edges, uint32_t n_triangles, const uint32_t *triangles,
                struct cloth_error *error);

/* x -> rotate(scale * x) + translate; rotation is a quaternion (w, x, y, z), normalised here
 * (of length 0 it turns nothing). Parts that are the identity leave every bit as it is. */
struct mesh_transform {
    double scale[3], rotate[4], translate[3];
};
extern const struct mesh_transform mesh_identity;
void mesh_apply(struct mesh *mesh, const struct mesh_transform *transform);

/* Finds vertices that coincide. same[v] is the lowest vertex u within the distance (m, > 0) of v
 * that has same[u] = u, else v. Vertices that no face or lone edge uses, or 2^52 distances from the
 * origin, stand for themselves. same: n_vertices of the caller. Error: CLOTH_E_MEMORY. */
int mesh_coincide(const struct mesh *mesh, double distance, uint32_t *same,
                  struct cloth_error *error);

/* One byte a vertex, 1 if a face or a lone edge uses it. used: n_vertices bytes of the caller. */
void mesh_used(const struct mesh *mesh, unsigned char *used);

/* The corners of triangle t. */
void mesh_corners(const struct mesh *mesh, uint32_t t, uint32_t corner[3]);

/* How many corners face f has; *corner: these, in the mesh or in `room`. */
uint32_t mesh_face(const struct mesh *mesh, uint32_t f, uint32_t room[3], const uint32_t **corner);

/* The uv of that number, which is a vertex or one of the further ones; 0 if the mesh has none. */
int mesh_uv(const struct mesh *mesh, uint32_t number, double uv[2]);

/* The number of the uv that a vertex has in triangle t, of which it is a corner; t UINT32_MAX: in
 * its first. */
uint32_t mesh_uv_number(const struct mesh *mesh, uint32_t t, uint32_t vertex);
/* Its place there, m: a shape at rest from uv may have several places of a vertex. */
const double *mesh_place(const struct mesh *mesh, uint32_t t, uint32_t vertex);
double mesh_triangle_area(const struct mesh *mesh, uint32_t t);
/* The triangles whose least altitude is below a height (m), and the first of the lowest of them. */
struct mesh_low {
    uint32_t n, lowest;
    double height, below; /* m: of that one; the height asked for */
};
void mesh_find_low(const struct mesh *mesh, double below, struct mesh_low *low);
/* The distance of two positions (n x 3), m, and the area of a triangle with these corners, m^2. */
double mesh_distance(const double *position, uint32_t a, uint32_t b);
double mesh_area(const double *position, const uint32_t corner[3]);

/* The group of that name; UINT32_MAX: there is none. */
uint32_t mesh_group_of(const struct mesh *mesh, const char *name);
/* Adds a group with a new name: n faces from `first` on. The mesh is no grid. Error:
 * CLOTH_E_MEMORY. */
int mesh_group_add(struct mesh *mesh, const char *name, uint32_t first, uint32_t n,
                   struct cloth_error *error);
/* Writes 1 to the bytes of all vertices, or triangles, that a group's faces have. mark: n_vertices,
 * or n_triangles, bytes of the caller. */
void mesh_group_vertices(const struct mesh *mesh, uint32_t group, unsigned char *mark);
void mesh_group_triangles(const struct mesh *mesh, uint32_t group, unsigned char *mark);

/* The two longest principal axes of the vertices, of length 1, each with its largest component
 * above 0: u the longer one; of equal ones the earlier coordinate's. */
void mesh_axes(const struct mesh *mesh, double u[3], double v[3]);

/* The box around all vertices, m; from INFINITY to -INFINITY of none. Returns its longest side, 0
 * of none. */
double mesh_box(const struct mesh *mesh, double low[3], double high[3]);

/* Frees the arrays of a mesh and clears it; a zeroed mesh is fine. */
void mesh_free(struct mesh *mesh);

/* All edges of the triangles and the lone edges, each once, a < b, sorted by (a, b). A lone edge
 * between the ends of a triangle's edge is that edge. Errors: CLOTH_E_INPUT for a third triangle at
 * an edge, CLOTH_E_MEMORY. */
struct mesh_edge {
    uint32_t a, b;
    uint32_t
        opposite[2]; /* the third vertices of its triangles, in their order; UINT32_MAX: none */
    uint32_t triangle[2]; /* these; UINT32_MAX: none */
    bool against;         /* both wind round in one direction here, so the mesh has no outside */
    double area;          /* sum of the areas of its triangles in the positions given, m^2 */
};
struct mesh_edges {
    uint32_t n;
    struct mesh_edge *edge;
};
int mesh_edges_find(struct mesh_edges *edges, const struct mesh *mesh, struct cloth_error *error);
/* The edge between two vertices, in any order; NULL: there is none. */
const struct mesh_edge *mesh_edges_get(const struct mesh_edges *edges, uint32_t a, uint32_t b);
void mesh_edges_free(struct mesh_edges *edges);
/* How long the edge from a to b is, m: the mean of both triangles, each of which may lack
 * (UINT32_MAX). */
double mesh_length(const struct mesh *mesh, const uint32_t triangle[2], uint32_t a, uint32_t b);
/* Places of the corners of two triangles with a common edge, m: its ends, then opposite. If the
 * triangles have other places for the ends, the second is laid flat beside the first. */
void mesh_hinge(const struct mesh *mesh, const uint32_t triangle[2], const uint32_t corner[4],
                double x[12]);
/* Lays the triangle b beside the triangle a (ends of the edge, then opposite), flat: where its
 * opposite vertex comes to lie. */
void mesh_lay_beside(const double a[9], const double b[9], double x[3]);

/* The corner that triangle t lacks of the cell of a grid that it is in; UINT32_MAX: no grid. */
uint32_t mesh_fourth(const struct mesh *mesh, uint32_t t);
/* Mass of a triangle, its area (as positioned) times density (kg/m^2), on each of its corners, kg.
 * by_cell: in a grid each corner of its cell gets a quarter, so that the masses of a sheet do not
 * depend on its diagonals. */
struct mesh_share {
    uint32_t n, vertex[4];
    double mass;
};
void mesh_share_of(const struct mesh *mesh, uint32_t triangle, double density, bool by_cell,
                   struct mesh_share *share);
/* Adds the shares of all triangles to mass[v] (kg, n_vertices). */
void mesh_add_mass(const struct mesh *mesh, double density, bool by_cell, double *mass);

/* The sum of the areas of all triangles, as positioned, m^2. */
double mesh_surface(const struct mesh *mesh);

/* Triangles of which the arrays are lent. */
struct mesh_shape {
    uint32_t n_vertices, n_triangles;
    const double *position; /* n_vertices x 3, finite, m */
    const uint32_t (*corner)[3];
};
/* The area that the triangles shade in light along an axis of any length but 0, m^2: that of the
 * union of their projections. It is cut by 2048 lines across the axis: exact along each line,
 * summed across them by the midpoint rule. So a polygon's error is of second order in the lines'
 * distance; a border along a line counts up to half a distance too far. Error: CLOTH_E_MEMORY. */
int mesh_shadow(const struct mesh_shape *shape, const double axis[3], double *area,
                struct cloth_error *error);

/* Regions of a mesh are bits in a mask by vertex. The last region that has all of n > 0 vertices;
 * -1: there is none. */
static inline int mesh_region(const uint64_t *mask, size_t n, const uint32_t *vertex)
{
    uint64_t common = mask ? UINT64_MAX : 0;
    for (size_t i = 0; i < n && mask; i++)
        common &= mask[vertex[i]];
    return common ? 63 - __builtin_clzll(common) : -1;
}

#endif
