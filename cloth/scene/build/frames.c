/* Frames of bodies: of a PC2 file, or of OBJ files of which each has the faces of the body's. */
#include "cloth/scene/build/build.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double JUMP = 0.25; /* of the body's largest extent, from a frame to the next */

/* The reading of a body's frames, and its place in the scene. */
struct reading {
    struct model *model;
    const struct scene_tree *tree;
    const struct mesh *mesh;
    int node; /* the frames */
    struct cloth_error *error;
};

static int read_pc2(const struct reading *r, int node, uint32_t *n, double **place)
{
    struct cloth_error inner = {0};
    char *path = scene_build_path(r->model, r->tree, node, r->error);
    const int code =
        path ? mesh_read_pc2(path, r->mesh->n_vertices, n, place, &inner) : r->error->code;
    free(path);
    return scene_build_blame(code, &inner, "frames", r->tree, node, r->error);
}

/* Checks that a frame's mesh has the vertices and faces of the body's. */
static int check_body_frame(const struct reading *r, int node, const struct mesh *frame)
{
    const struct mesh *mesh = r->mesh;
    const char *name = scene_tree_scalar(r->tree, node);
    if (frame->n_vertices != mesh->n_vertices || frame->n_faces != mesh->n_faces)
        return scene_tree_fail(r->tree, node, r->error,
                               "frames: %.200s has %u vertices and %u faces, but the mesh of the "
                               "body has %u and %u",
                               name, frame->n_vertices, frame->n_faces, mesh->n_vertices,
                               mesh->n_faces);
    const size_t starts = ((size_t)mesh->n_faces + 1) * sizeof *mesh->face_start;
    const size_t corners = mesh->face_start[mesh->n_faces] * sizeof *mesh->face_corner;
    if (memcmp(frame->face_start, mesh->face_start, starts) != 0 ||
        memcmp(frame->face_corner, mesh->face_corner, corners) != 0)
        return scene_tree_fail(r->tree, node, r->error,
                               "frames: the faces of %.200s have other corners than those of the "
                               "mesh of the body",
                               name);
    return CLOTH_OK;
}

static int build_frames_read_obj(const struct reading *r, int node, double *place)
{
    struct cloth_error inner = {0};
    struct mesh frame = {0};
    int code =
        scene_build_obj(r->model, &frame, mesh_read_surface, r->tree, node, r->error, &inner);
    code = scene_build_blame(code, &inner, "frames", r->tree, node, r->error);
    if (!code)
        code = check_body_frame(r, node, &frame);
    if (!code)
        memcpy(place, frame.position, 3 * (size_t)frame.n_vertices * sizeof *place);
    mesh_free(&frame);
    return code;
}

static int read_objs(const struct reading *r, int list, uint32_t *n, double **place)
{
    const size_t stride = 3 * (size_t)r->mesh->n_vertices;
    int code = CLOTH_OK;
    *n = (uint32_t)scene_tree_length(r->tree, list);
    *place = scene_build_array(*n, stride * sizeof **place, r->error);
    for (uint32_t k = 0; *place && k < *n && !code; k++)
        code = build_frames_read_obj(r, scene_tree_item(r->tree, list, k), *place + k * stride);
    return *place ? code : r->error->code;
}

/* Warns of the first vertex that goes too far at once. */
static int warn_of_jump(const struct reading *r, const struct contact_frames *frames)
{
    const size_t n = r->mesh->n_vertices;
    double low[3], high[3];
    const double most = JUMP * mesh_box(r->mesh, low, high);
    for (size_t i = 0; i + n < n * frames->n; i++) {
        double square = 0;
        for (int c = 0; c < 3; c++)
            square += pow(frames->place[i + n][c] - frames->place[i][c], 2);
        if (square > most * most)
            return scene_build_warn(r->model, r->tree, r->node, r->error,
                                    "vertex %zu of the body jumps by %g m from frame %zu to the "
                                    "next, by more than a quarter of the body's size",
                                    i % n + 1, sqrt(square), i / n + 1);
    }
    return CLOTH_OK;
}

int scene_build_frames(struct model *model, struct contact_frames *frames, double **place,
                       const struct mesh *mesh, const struct mesh_transform *transform,
                       const struct scene_tree *tree, int body, struct cloth_error *error)
{
    const int node = scene_tree_get(tree, body, "frames");
    const int motion = scene_tree_get(tree, body, "motion");
    const int pc2 = scene_tree_get(tree, node, "pc2"), list = scene_tree_get(tree, node, "obj");
    const struct reading reading = {model, tree, mesh, node, error};
    *frames = (struct contact_frames){0};
    if (!node)
        return CLOTH_OK;
    if (motion)
        return scene_tree_fail(tree, motion, error,
                               "a body with frames has no motion: its frames say where it is");
    int code = pc2 ? read_pc2(&reading, pc2, &frames->n, place)
                   : read_objs(&reading, list, &frames->n, place);
    if (code)
        return code;
    for (uint32_t k = 0; k < frames->n; k++) {
        struct mesh moved = {.n_vertices = mesh->n_vertices,
                             .position = *place + 3 * (size_t)k * mesh->n_vertices};
        mesh_apply(&moved, transform);
    }
    frames->first = scene_tree_number(tree, node, "start");
    frames->rate = scene_tree_number(tree, node, "fps");
    frames->place = (const double(*)[3])(void *)*place;
    return warn_of_jump(&reading, frames);
}
