#ifndef CLOTH_SCENE_BUILD_BUILD_H
#define CLOTH_SCENE_BUILD_BUILD_H

#include "cloth/base/memory.h"
#include "cloth/garment/garment.h"
#include "cloth/mannequin/pose.h"
#include "cloth/model/model.h"
#include "cloth/scene/yaml/tree.h"

/* These functions complete tree->model, which scene_check filled. They make the parts that are no
 * copy of a value: meshes, motions, indices for names. They check what a table cannot: names,
 * sizes, indices, files. Their allocations belong to the model, also after an error. Each returns
 * 0, or another number after a failure, which tree->error tells. `node` is a map or value of the
 * scene where nothing else is said. */

/* A step of the whole scene, and one of a cloth, by number, and its map. scene.c has their order,
 * in which each relies on those before. */
typedef int scene_build_step(struct scene_tree *tree);
typedef int scene_build_cloth_step(struct scene_tree *tree, uint32_t cloth, int node);

/* The names of the phases, no two of which are the same; all but the cloths; the cloths, which name
 * materials. */
scene_build_step scene_build_phases, scene_build_world, scene_build_obstacles;
scene_build_cloth_step scene_build_cloth;

/* No two obstacles exclude each other around a cloth. */
scene_build_step scene_build_check_obstacles;

/* contact.pairs and contact.ignore, whose names are of materials, cloths, obstacles and groups; the
 * mode of contact where the scene does not say it; whether the integrator supports the contact, and
 * it is not too thin for the places of the cloths; whether there is anything to touch, which probes
 * may ask. */
scene_build_step scene_build_sides, scene_build_contact, scene_build_check_contact;
scene_build_step scene_build_contact_idle;

/* The report of a run. */
scene_build_step scene_build_probes, scene_build_hdf5, scene_build_drape;

/* Joints and welds; those of mesh.weld; those of seams, and all vertices that seams make meet as
 * one; a warning of unjoined vertices at one place; folds of sewn cloths. */
scene_build_step scene_build_joints, scene_build_welds, scene_build_sewn;
scene_build_cloth_step scene_build_mesh_weld, scene_build_seams, scene_build_pieces;
scene_build_cloth_step scene_build_folds, scene_build_bands;

/* Warnings: sewn cloths that are too small for a body, where it starts at rest; seams of one cloth
 * that cross where it starts; values that are hardly ever meant; keys that do nothing, after all
 * others, as the tree gets a default. */
scene_build_cloth_step scene_build_girths, scene_build_warn_seams;
scene_build_step scene_build_unusual, scene_build_needs;

/* The first fills in the grain that a scene does not give, the second writes the settings. */
scene_build_step scene_build_grain, scene_build_settings;

/* ---- Names (names.c) ---- */

/* Kinds of things with names. Fabrics and groups (of cloths and obstacles) are only listed. */
enum scene_named {
    SCENE_CLOTHS,
    SCENE_MATERIALS,
    SCENE_OBSTACLES,
    SCENE_PROBES,
    SCENE_FABRICS,
    SCENE_GROUPS
};

/* The number of a name; UINT32_MAX: there is none. */
uint32_t scene_build_find(const struct model *model, enum scene_named kind, const char *name);

/* Gives an entry that has no name its usual one, "cloth1", and refuses a name that one before it
 * has. node: its map, with the key name. */
int scene_build_name(const struct scene_tree *tree, enum scene_named kind, uint32_t i, int node);

/* The error that a node names no `what`; it lists n names. The same with all names of several
 * kinds, bits 1 << kind. */
int scene_build_no_such(const struct scene_tree *tree, int node, const char *what,
                        const char *const *names, size_t n);
int scene_build_no_name(const struct scene_tree *tree, int node, const char *what, unsigned kinds);

/* The list of the groups of a side, cloths before obstacles; 0: it has none. */
int scene_build_groups(const struct scene_tree *tree, uint32_t side);

/* The cloth, by number, that the key cloth of a map names; the only cloth where the key is missing.
 * what: whose key it is, in messages: "a probe". */
int scene_build_cloth_of(uint32_t *cloth, const char *what, const struct scene_tree *tree,
                         int node);

/* The material, by number, that the key material of a map names, for a cloth whose
 * mass_per_vertex is known. */
int scene_build_material(uint32_t *material, const struct model_cloth *cloth,
                         const struct scene_tree *tree, int node);

/* ---- Vertices (pick.c) ---- */

/* The group of the cloth's mesh that a node names, by number. */
int scene_build_group(uint32_t *group, const struct model_cloth *cloth,
                      const struct scene_tree *tree, int node);

/* Checks a pick that a map with one of the keys vertices, nearest, box, group, edge filled: there
 * are such vertices. Puts the corners of a box in order, and lists the vertices of a group or edge.
 */
int scene_build_pick(struct model_pick *pick, const struct scene_tree *tree, int node,
                     const struct model_cloth *cloth);

/* The same, and refuses a vertex that stands twice in its list. what: "one load", and the remedy.
 */
int scene_build_pick_once(struct model_pick *pick, const struct scene_tree *tree, int node,
                          const struct model_cloth *cloth, const char *what);

/* Checks n numbers of vertices, which a node has: a list, or one value. */
int scene_build_check_vertices(const uint32_t *vertices, uint32_t n,
                               const struct model_cloth *cloth, const struct scene_tree *tree,
                               int node);

/* Checks a path of vertices, which a list has: the mesh, whose edges these are, has one between
 * each and the next. what: "a fold" */
int scene_build_check_path(const uint32_t *vertices, uint32_t n, const char *what,
                           const struct model_cloth *cloth, const struct mesh_edges *edges,
                           const struct scene_tree *tree, int list);

/* ---- Parts of a cloth, which has its name and those before ---- */

/* Its mesh, transformed; that of a map pattern: a file, or an own garment, whose faults are in
 * tree->inner; the seams, and edges of panels, of an OBJ mesh with a file of them; its panels and
 * regions; its start by the key from; its masses and starts; its loads.
 * Files, curves and motions are added to the model's. */
typedef int scene_build_part(struct model_cloth *cloth, struct scene_tree *tree, int node);
scene_build_part scene_build_mesh, scene_build_pattern, scene_build_parts, scene_build_settled;
scene_build_part scene_build_borders;
scene_build_part scene_build_starts, scene_build_loads;

/* Reads the seams, and the edges of the panels, of an OBJ mesh (docs/garments.md), for a cloth
 * whose mesh has as many vertices and triangles. They belong to it, also after an error. */
int scene_read_seams(struct model_cloth *cloth, const char *path, struct cloth_error *error);

/* Gives new pairs of vertices of a cloth the place of a node, and room for n of them; adds one. */
int scene_build_room(struct model_pairs *pairs, uint32_t cloth, uint32_t n,
                     const struct scene_tree *tree, int node);
void scene_build_pair(struct model_pairs *pairs, uint32_t a, uint32_t b);

/* The pairs of all seams of a cloth. */
size_t scene_build_count_pairs(const struct model_seams *seams);

/* The key curve of a map, if it has one: of a load, or of the air. *number: the model's new one;
 * 0: there is none. After the time. */
int scene_build_curve(uint32_t *number, const struct scene_tree *tree, int node);
/* A curve of a list of keys that are factors of lengths at rest, if there is a list. */
int scene_build_size(uint32_t *number, const struct scene_tree *tree, int list);

/* ---- Places and motions (motion.c) ---- */

/* The constraint of a pin, its motion and its curve, which are added to the model's, like sliders.
 */
int scene_build_constraint(struct model_pin *pin, const struct scene_tree *tree, int node);

/* The vertices of a pin that its key weights picks, if it has one, and their weights (weights.c).
 */
int scene_build_weights(struct model_pin *pin, const struct model_cloth *cloth,
                        struct scene_tree *tree, int node);

/* A motion by key frames, whose keys become the model's last. */
int scene_build_motion(struct model_motion *motion, const struct scene_tree *tree, int node);

/* The rest of a transform that its map has filled: keys rotate, units and up. */
int scene_build_transform(struct mesh_transform *transform, const struct scene_tree *tree,
                          int node);

/* The quaternion of a rotation: four numbers as they stand there, or that of its axis and angle. */
int scene_build_quaternion(double rotate[4], const struct scene_tree *tree, int node);

/* The same, made of length 1; what: "a rotation of a motion". A direction, likewise; what: "the
 * normal of a plane". */
int scene_build_rotation(double rotate[4], const char *what, const struct scene_tree *tree,
                         int node);
int scene_build_direction(double direction[3], const char *what, const struct scene_tree *tree,
                          int node);

/* ---- Bodies ---- */

/* The frames of a body that has the key frames. mesh: that of the body, transformed, as frames
 * are. *place: the memory of the frames, to be freed in any case. */
int scene_build_frames(struct contact_frames *frames, double **place, const struct mesh *mesh,
                       const struct mesh_transform *transform, struct scene_tree *tree, int body);

/* The mesh of the figure of a body's key mannequin. Its frames, transformed, if it walks or has
 * poses; else frames are unchanged. *place: the memory of the frames, to be freed in any case.
 * After the time. */
int scene_build_mannequin(struct mesh *mesh, const struct mesh_transform *transform,
                          struct contact_frames *frames, double **place, struct scene_tree *tree,
                          int body);

/* Warns of a body whose surface meets itself where the run starts. place: of its vertices in the
 * first of its frames; NULL: it has none. */
int scene_build_warn_crossed(const struct mesh *mesh, const double *place,
                             const struct scene_tree *tree, int file);

/* ---- Helpers (build.c) ---- */

/* Adds `more` > 0 zeroed entries of `size` bytes to a list of *n; list: the address of its pointer.
 * Returns the first of them, or NULL with an error: the list stays. */
void *scene_build_add(void *list, uint32_t *n, size_t more, size_t size, struct cloth_error *error);
/* NULL, with the error that there is no memory. */
void *scene_build_out_of_memory(struct cloth_error *error);
char *scene_build_copy(const char *text, struct cloth_error *error);
/* The place of a node, for the model. */
char *scene_build_place(const struct scene_tree *tree, int node);

/* Adds the warning "place: sentence" of a node to the model's. Only memory can fail. */
int scene_build_warn(const struct scene_tree *tree, int node, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* The error of a file or part, which tree->inner has, at the node that names it: "what: sentence".
 * Without one: code. */
int scene_build_blame(int code, const char *what, struct scene_tree *tree, int node);

/* Adds the path of a file that is read to the model's. The path of one that a node names, relative
 * to the scene's folder, is added, too; NULL: out of memory. */
int scene_build_file(const struct scene_tree *tree, const char *path);
char *scene_build_path(const struct scene_tree *tree, int node);

/* The mesh of the OBJ file that a node names, by mesh_read_obj or mesh_read_surface; the file is
 * added to the model's. what: as of scene_build_blame. */
typedef int scene_obj_reader(struct mesh *mesh, const char *path, struct cloth_error *error);
int scene_build_obj(struct mesh *mesh, scene_obj_reader *reads, const char *what,
                    struct scene_tree *tree, int node);

/* The edge of a panel of a pattern that a map with the keys panel and edge names. */
int scene_build_pattern_side(struct garment_side *side, const struct garment_pattern *pattern,
                             const struct scene_tree *tree, int node);

/* Gives stitches of a pattern the pleats of a list. */
int scene_build_pleats(struct garment_pattern *pattern, const struct scene_tree *tree, int list);

/* Checks that this machine may have room for a mesh of n vertices. node: the key that asks for so
 * many; what: "nx times ny is". */
int scene_build_check_memory(uint64_t n, const char *what, const struct scene_tree *tree, int node);

/* The settings of a node, a line each: its path and its value, sorted. To be freed. NULL:
 * CLOTH_E_MEMORY. */
char *scene_build_text(const struct scene_tree *tree, int node, const char *path);

/* ---- Parts that phases share (build.c) ---- */

/* Garments and figures of the scene that is read, each made once for all its phases. One is known
 * by its key: the settings that it follows from. All begins as zero. Local. */
struct scene_made_part {
    struct scene_made_part *next;
    char *key;
    size_t size; /* bytes of the key */
    bool is_made;
    struct garment_pattern pattern;
    struct garment garment;
    struct mesh mesh;
    struct mannequin_rig rig;
};
struct scene_made {
    struct scene_made_part *parts;
};

/* The part of a key, to be made where is_made is false. NULL: CLOTH_E_MEMORY. */
struct scene_made_part *scene_made_part(struct scene_made *made, const void *key, size_t size,
                                        struct cloth_error *error);
void scene_made_free(struct scene_made *made);

#endif
