#ifndef CLOTH_SCENE_BUILD_BUILD_H
#define CLOTH_SCENE_BUILD_BUILD_H

#include "cloth/model/model.h"
#include "cloth/scene/yaml/tree.h"

/* These functions complete a model that scene_check filled. They make the parts that are no copy of
 * a value: meshes, motions, indices for names. They check what a table cannot: names, sizes,
 * indices, files. Their allocations belong to the model, also after an error. */

/* A step of the whole scene. scene.c has their order, in which each relies on those before. */
typedef int scene_build_step(struct model *model, struct scene_tree *tree,
                             struct cloth_error *error);

/* The names of the phases, no two of which are the same; all but the cloths; the cloths, which name
 * materials. */
scene_build_step scene_build_phases, scene_build_world, scene_build_obstacles, scene_build_cloths;

/* No two obstacles exclude each other around a cloth. */
scene_build_step scene_build_check_obstacles;

/* contact.pairs and contact.ignore, whose names are of materials, cloths, obstacles and groups; the
 * mode of contact where the scene does not say it; whether the integrator supports the contact, and
 * it is not too thin for the places of the cloths; whether there is anything to touch, which probes
 * may ask. */
scene_build_step scene_build_sides, scene_build_contact, scene_build_check_contact;
scene_build_step scene_build_contact_idle;

/* What a run reports. */
scene_build_step scene_build_probes, scene_build_hdf5, scene_build_drape;

/* Joints and welds; those of mesh.weld; those of seams; a warning of unjoined vertices at one
 * place; edges that are shorter than contact.thickness; folds of sewn cloths. */
scene_build_step scene_build_joints, scene_build_welds, scene_build_mesh_welds, scene_build_seams;
scene_build_step scene_build_pieces, scene_build_short_edges, scene_build_folds;

/* Warnings: sewn cloths that are too small for a body, where it starts at rest; seams of one cloth
 * that cross where it starts; values that are hardly ever meant; keys that do nothing, after all
 * others, as the tree gets a default. */
scene_build_step scene_build_girths, scene_build_warn_seams, scene_build_unusual, scene_build_needs;

/* Writes the settings of the model. */
scene_build_step scene_build_settings;

/* One more weld of the model, with room for n pairs of vertices of a cloth, but no place. NULL:
 * out of memory. */
struct model_weld *scene_build_add_weld(struct model *model, double tolerance, uint32_t cloth,
                                        uint32_t n, struct cloth_error *error);
/* The pair of a mesh that says its kind, of the cloth at a node. */
yaml_node_pair_t scene_build_mesh_kind(const struct scene_tree *tree, int node);

/* Reads the seams of an OBJ mesh (docs/garments.md), for a mesh that has as many vertices and
 * triangles. Faults of the file are in `inner`. The seams belong to `seams`, also after an
 * error. */
int scene_read_seams(struct model_seams *seams, const struct mesh *mesh, const char *path,
                     struct cloth_error *inner);

/* The cloth, by number, that the key cloth of a map names; the only cloth where the key is missing.
 * what: whose key it is, in messages: "a probe". */
int scene_build_cloth_of(uint32_t *cloth, const char *what, const struct model *model,
                         const struct scene_tree *tree, int node, struct cloth_error *error);

/* The settings of a node, a line each: its path and its value. To be freed. NULL: CLOTH_E_MEMORY.
 */
char *scene_build_text(const struct scene_tree *tree, int node, const char *path,
                       struct cloth_error *error);

/* The material, by number, that the key material of a map names, for a cloth whose
 * mass_per_vertex is known. */
int scene_build_material(uint32_t *material, const struct model_cloth *cloth,
                         const struct model *model, const struct scene_tree *tree, int node,
                         struct cloth_error *error);

/* The panels and regions of a cloth that has its mesh, name and material. */
int scene_build_parts(struct model_cloth *cloth, struct model *model, struct scene_tree *tree,
                      int node, struct cloth_error *error);

/* Checks that the materials of a cloth with its regions have the moduli that its mesh needs. */
int scene_build_check_moduli(const struct model_cloth *cloth, const struct model *model,
                             const struct scene_tree *tree, int node, struct cloth_error *error);

/* The group of the cloth's mesh that a node names, by number. */
int scene_build_group(uint32_t *group, const struct model_cloth *cloth,
                      const struct scene_tree *tree, int node, struct cloth_error *error);

/* Checks that a map that picks vertices has no radius without nearest. */
int scene_build_check_radius(const struct scene_tree *tree, int node, struct cloth_error *error);

/* Checks a pick that a map with one of the keys vertices, nearest, box, group filled: there are
 * such vertices. Puts the corners of a box in order, and lists the vertices of a group. */
int scene_build_pick(struct model_pick *pick, const struct scene_tree *tree, int node,
                     const struct model_cloth *cloth, struct cloth_error *error);

/* The same, and refuses a vertex that stands twice in its list. what: "one load", and the remedy.
 */
int scene_build_pick_once(struct model_pick *pick, const struct scene_tree *tree, int node,
                          const struct model_cloth *cloth, const char *what,
                          struct cloth_error *error);

/* The error `inner` of a file or part, at the node that names it: "what: sentence". Without one:
 * code. */
int scene_build_blame(int code, const struct cloth_error *inner, const char *what,
                      const struct scene_tree *tree, int node, struct cloth_error *error);

/* Checks n numbers of vertices, which the list at a node has. */
int scene_build_check_vertices(const uint32_t *vertices, uint32_t n,
                               const struct model_cloth *cloth, const struct scene_tree *tree,
                               int list, struct cloth_error *error);

/* The error that the mesh of the cloth has no vertex of this number. */
int scene_build_no_vertex(uint32_t vertex, const struct model_cloth *cloth,
                          const struct scene_tree *tree, int node, struct cloth_error *error);

/* The key curve of a map, if it has one: of a load, or of the air. *number: the model's new one;
 * 0: there is none. After the time. */
int scene_build_curve(struct model *model, uint32_t *number, const struct scene_tree *tree,
                      int node, struct cloth_error *error);

/* The loads of a cloth that has its mesh and name; their curves are added to the model's. */
int scene_build_loads(struct model *model, struct model_cloth *cloth, const struct scene_tree *tree,
                      int node, struct cloth_error *error);

/* The masses and starts of a cloth that has its mesh and name. */
int scene_build_starts(struct model_cloth *cloth, const struct scene_tree *tree, int node,
                       struct cloth_error *error);

/* The start of a cloth by its key from; the cloth has its mesh, name and velocity. Files of the
 * folder are added to the model's. */
int scene_build_settled(struct model *model, struct model_cloth *cloth, struct scene_tree *tree,
                        int node, struct cloth_error *error);

/* Checks that the key rotate of a map, which filled the transform, is a rotation. */
int scene_build_check_turn(const struct mesh_transform *transform, const struct scene_tree *tree,
                           int node, struct cloth_error *error);

/* The constraint of a pin, and its motion: motions and sliders are added to the model's. */
int scene_build_constraint(struct model *model, struct model_pin *pin,
                           const struct scene_tree *tree, int node, struct cloth_error *error);

/* A motion by key frames, whose keys become the model's last. */
int scene_build_motion(struct model *model, struct model_motion *motion,
                       const struct scene_tree *tree, int node, struct cloth_error *error);

/* A quaternion, made of length 1; what: "a rotation of a motion". */
int scene_build_rotation(double rotate[4], const char *what, const struct scene_tree *tree,
                         int node, struct cloth_error *error);

/* A direction, made of length 1; what: "the normal of a plane". */
int scene_build_direction(double direction[3], const char *what, const struct scene_tree *tree,
                          int node, struct cloth_error *error);

/* The error that there is no `what` of this name; it lists the existing names. names: n strings. */
int scene_build_no_such(const char *what, const char *name, const char *const *names, size_t n,
                        const struct scene_tree *tree, int node, struct cloth_error *error);

/* The obstacle, by number, of a name; UINT32_MAX: there is none. The error that a node names none.
 */
uint32_t scene_build_obstacle_named(const struct model *model, const char *name);
int scene_build_no_obstacle(const struct model *model, const struct scene_tree *tree, int node,
                            struct cloth_error *error);

/* Adds the names of obstacles behind the first n of a list. Returns how many there are then. */
size_t scene_build_add_obstacles(const struct model *model, size_t n, const char **names);

/* Adds the path of a file that is read to the model's. */
int scene_build_file(struct model *model, const char *path, struct cloth_error *error);

/* The mesh of a cloth, the map `node`, transformed; its file is added to the model's. */
int scene_build_mesh(struct model *model, struct model_cloth *cloth, struct scene_tree *tree,
                     int node, struct cloth_error *error);

/* The mesh of the pattern that the map `node` names: a file, which is added to the model's, or an
 * own garment. Faults of the pattern are in `inner`, without the place in the scene. */
int scene_build_pattern(struct model *model, struct model_cloth *cloth, struct scene_tree *tree,
                        int node, struct cloth_error *error, struct cloth_error *inner);

/* Checks that this machine may have room for a mesh of n vertices. node: the key that asks for so
 * many; what: "nx times ny is". */
int scene_build_check_memory(uint64_t n, const char *what, const struct scene_tree *tree, int node,
                             struct cloth_error *error);

/* The path of the file that a node names, relative to the scene's folder; the file is added to the
 * model's. NULL: out of memory. */
char *scene_build_path(struct model *model, const struct scene_tree *tree, int node,
                       struct cloth_error *error);

/* The frames of a body's key; n 0: it has none. mesh: that of the body, transformed, as frames are.
 * *place: the memory of the frames, to be freed in any case. */
int scene_build_frames(struct model *model, struct contact_frames *frames, double **place,
                       const struct mesh *mesh, const struct mesh_transform *transform,
                       const struct scene_tree *tree, int body, struct cloth_error *error);

/* The mesh of the figure of a body's key mannequin, transformed. Its frames if it walks or has
 * poses; else frames are unchanged. *place: the memory of the frames, to be freed in any case.
 * After the time. */
int scene_build_mannequin(const struct model *model, struct mesh *mesh,
                          const struct mesh_transform *transform, struct contact_frames *frames,
                          double **place, struct scene_tree *tree, int body,
                          struct cloth_error *error);

/* Warns of a body whose surface meets itself where the run starts. place: of its vertices in the
 * first of its frames; NULL: it has none. */
int scene_build_warn_crossed(struct model *model, const struct mesh *mesh, const double *place,
                             const struct scene_tree *tree, int file, struct cloth_error *error);

/* The mesh of the OBJ file that a node names, relative to the scene's folder, by mesh_read_obj or
 * mesh_read_surface; the file is added to the model's. Faults of the file are in `inner`, without
 * the place in the scene. */
typedef int scene_obj_reader(struct mesh *mesh, const char *path, struct cloth_error *error);
int scene_build_obj(struct model *model, struct mesh *mesh, scene_obj_reader *reads,
                    const struct scene_tree *tree, int node, struct cloth_error *error,
                    struct cloth_error *inner);

/* Adds the warning "place: sentence" of a node to the model's. */
int scene_build_warn(struct model *model, const struct scene_tree *tree, int node,
                     struct cloth_error *error, const char *format, ...)
    __attribute__((format(printf, 5, 6)));

/* n zeroed entries (at least one), or NULL with an error. */
void *scene_build_array(size_t n, size_t size, struct cloth_error *error);
/* A list of n entries, moved, with zeroed room for `more`; or NULL with an error: the list stays.
 */
void *scene_build_grow(void *list, size_t n, size_t more, size_t size, struct cloth_error *error);
char *scene_build_copy(const char *text, struct cloth_error *error);
/* The place of a node, for the model. */
char *scene_build_place(const struct scene_tree *tree, int node, struct cloth_error *error);

#endif
