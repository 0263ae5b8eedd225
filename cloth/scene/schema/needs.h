#ifndef CLOTH_SCENE_SCHEMA_NEEDS_H
#define CLOTH_SCENE_SCHEMA_NEEDS_H

/* The needs of a key, without which it does nothing (struct scene_rule), in words that the page
 * shows, that warnings quote and that scene_build_needs (build/needs.c) understands:
 *
 *   [VALUE: ]TERM[ and TERM]...   with VALUE: only where the key has this value
 *   TERM: KEY = VALUE[ or VALUE]...; KEY > NUMBER; KEY[ or KEY]...: one is given; no KEY; or a fact
 *
 * A KEY is a path. Its first word is looked for among the keys of the map itself, then among those
 * of the map that the key stands in, and so on up to the scene. A key does not mean itself. */

#define NEEDS_IMPLICIT  "integrator = implicit_euler or bdf2"
#define NEEDS_MET       "contact.mode = certified or repulsion"
#define NEEDS_CERTIFIED "contact.mode = certified"
#define NEEDS_REPULSION "contact.mode = repulsion"
#define NEEDS_MOVING    "translate or rotate"

/* Facts of the scene. */
#define NEEDS_TRIANGLES    "a cloth with triangles"
#define NEEDS_WIND         "a wind other than 0"
#define NEEDS_NO_SINE      "an end of all curves, which a sine has not"
#define NEEDS_SPRINGS      "joints, or a material of springs"
#define NEEDS_ONLY_SPRINGS "a scene without triangles that resist, bending and limits of strain"
#define NEEDS_MEETINGS     "a pair that could meet (by project a cloth and an obstacle)"
#define NEEDS_GUARDED                                                                              \
    "implicit steps in which nothing does work on the cloth (no wind, no curve, no pin or "        \
    "obstacle "                                                                                    \
    "that moves)"

/* Facts of a material, by the cloths that have it. */
#define NEEDS_OWN_TRIANGLES "a cloth of the material with triangles"
#define NEEDS_OWN_LINKS     "a cloth of the material with edges without triangles"
#define NEEDS_OWN_EDGES     "a cloth of the material with edges"
#define NEEDS_DIAGONALS     "a grid, or model = triangles"

#endif
