/* Frames of bodies: of a PC2 file, of OBJ files of which each has the faces of the body's, or of an
 * animation of the body's file. */
#include "cloth/scene/build/build.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double JUMP = 0.25; /* of the body's largest extent, from a frame to the next */

static int read_pc2(struct scene_tree *tree, int node, const struct mesh *mesh, uint32_t *n,
                    double **place)
{
    char *path = scene_build_path(tree, node);
    const int code =
        path ? mesh_read_pc2(path, mesh->n_vertices, MESH_ALL_FRAMES, n, place, &tree->inner)
             : tree->error->code;
    free(path);
    return scene_build_blame(code, "frames", tree, node);
}

static int read_clip(struct scene_tree *tree, int node, int body, const struct mesh *mesh,
                     struct contact_frames *frames, double **place)
{
    const int file = scene_tree_get(tree, body, "file");
    char *path = file ? scene_tree_beside(tree, file, scene_tree_scalar(tree, file)) : NULL;
    if (!file)
        return scene_tree_fail(tree, node,
                               "frames.clip is an animation of a body's file, but this body has no "
                               "key file");
    const int code = path ? mesh_read_clip(path, mesh->n_vertices, scene_tree_scalar(tree, node),
                                           frames->rate, &frames->n, place, &tree->inner)
                          : !scene_build_out_of_memory(tree->error);
    free(path);
    return scene_build_blame(code, "frames", tree, node);
}

/* Checks that a frame's mesh has the vertices and faces of the body's. */
static int check_body_frame(const struct scene_tree *tree, int node, const struct mesh *mesh,
                            const struct mesh *frame)
{
    const char *name = scene_tree_scalar(tree, node);
    if (frame->n_vertices != mesh->n_vertices || frame->n_faces != mesh->n_faces)
        return scene_tree_fail(tree, node,
                               "frames: %.200s has %u vertices and %u faces, but the mesh of the "
                               "body has %u and %u",
                               name, frame->n_vertices, frame->n_faces, mesh->n_vertices,
                               mesh->n_faces);
    const size_t starts = ((size_t)mesh->n_faces + 1) * sizeof *mesh->face_start;
    const size_t corners = mesh->face_start[mesh->n_faces] * sizeof *mesh->face_corner;
    if (memcmp(frame->face_start, mesh->face_start, starts) != 0 ||
        memcmp(frame->face_corner, mesh->face_corner, corners) != 0)
        return scene_tree_fail(tree, node,
                               "frames: the faces of %.200s have other corners than those of the "
                               "mesh of the body",
                               name);
    return CLOTH_OK;
}

static int read_objs(struct scene_tree *tree, int list, const struct mesh *mesh, uint32_t *n,
                     double **place)
{
    const size_t bytes = 3 * (size_t)mesh->n_vertices * sizeof **place;
    *n = (uint32_t)scene_tree_length(tree, list);
    *place = cloth_alloc(*n, bytes, tree->error);
    int code = tree->error->code;
    for (uint32_t k = 0; k < *n && !code; k++) {
        const int node = scene_tree_item(tree, list, k);
        struct mesh frame = {0};
        code = scene_build_obj(&frame, mesh_read_surface, "frames", tree, node) ||
               check_body_frame(tree, node, mesh, &frame);
        if (!code)
            memcpy((char *)*place + k * bytes, frame.position, bytes);
        mesh_free(&frame);
    }
    return code;
}

/* Warns of the first vertex that goes too far at once. */
static int warn_of_jump(const struct scene_tree *tree, int node, const struct mesh *mesh,
                        const struct contact_frames *frames)
{
    const size_t n = mesh->n_vertices;
    double low[3], high[3];
    const double most = JUMP * mesh_box(mesh, low, high);
    for (size_t i = 0; i + n < n * frames->n; i++) {
        double square = 0;
        for (int c = 0; c < 3; c++)
            square += pow(frames->place[i + n][c] - frames->place[i][c], 2);
        if (square > most * most)
            return scene_build_warn(tree, node,
                                    "vertex %zu of the body jumps by %g m from frame %zu to the "
                                    "next, by more than a quarter of the body's size",
                                    i % n + 1, sqrt(square), i / n + 1);
    }
    return CLOTH_OK;
}

int scene_build_frames(struct contact_frames *frames, double **place, const struct mesh *mesh,
                       const struct mesh_transform *transform, struct scene_tree *tree, int body)
{
    const int node = scene_tree_get(tree, body, "frames");
    const int motion = scene_tree_get(tree, body, "motion");
    const int pc2 = scene_tree_get(tree, node, "pc2"), clip = scene_tree_get(tree, node, "clip");
    if (motion)
        return scene_tree_fail(tree, motion,
                               "a body with frames has no motion: its frames say where it is");
    *frames = (struct contact_frames){.first = scene_tree_number(tree, node, "start"),
                                      .rate = scene_tree_number(tree, node, "fps")};
    if (pc2    ? read_pc2(tree, pc2, mesh, &frames->n, place)
        : clip ? read_clip(tree, clip, body, mesh, frames, place)
               : read_objs(tree, scene_tree_get(tree, node, "obj"), mesh, &frames->n, place))
        return tree->error->code;
    for (uint32_t k = 0; k < frames->n; k++) {
        struct mesh moved = {.n_vertices = mesh->n_vertices,
                             .position = *place + 3 * (size_t)k * mesh->n_vertices};
        mesh_apply(&moved, transform);
    }
    frames->place = (const double(*)[3])(void *)*place;
    return warn_of_jump(tree, node, mesh, frames);
}
