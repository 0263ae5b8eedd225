#ifndef TESTS_SUPPORT_SKINNED_H
#define TESTS_SUPPORT_SKINNED_H

#include <stdbool.h>
#include <stdint.h>

/* A figure with a closed form: a closed cylinder along y, of radius 0.1 m, from y = 0 to 1 m, whose
 * upper half bends about z at y = 0.5 m. Two bones, blended straight from y = 0.4 to 0.6 m. The
 * clip "bend" turns the upper one evenly from 0 to SKINNED_TURN in a second, by `keys` keys. The
 * wall is cut along a line for uv, so that its vertices there stand twice in the file. */
struct skinned {
    uint32_t around, along, keys; /* divisions, at least 3 and 1; at least 2 keys */
    bool bare;                    /* the mesh has no skin */
    bool hangs;   /* nor that: it hangs at the upper bone's node, from y = 0.5 m on */
    double scale; /* of the root node; 0: 1 */
};
#define SKINNED_TURN 1.5707963267948966 /* rad, counterclockwise as seen from +z */

/* How many vertices and triangles the surface has. */
uint32_t skinned_vertices(const struct skinned *of);
uint32_t skinned_triangles(const struct skinned *of);

/* Writes it as binary glTF 2.0; 0: it is written. */
int skinned_write(const struct skinned *of, const char *path);

/* Where a place of the cylinder is at a time from 0 to 1 s: x becomes it. */
void skinned_bend(double time, double x[3]);

#endif
