/* A cloth that starts where an earlier run left it, in a frame of its folder. One file there has
 * the frames of all cloths; cloth.obj has their names and numbers of vertices. It starts at rest
 * there but for its own velocity; lengths at rest stay those of the mesh. */
#include "cloth/base/file.h"
#include "cloth/scene/build/build.h"
#include "cloth/scene/schema/check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A folder, its files, and the vertices of the cloth among those of all. */
struct folder {
    const char *path;
    char *obj, *pc2;
    uint32_t first, n, n_all; /* of the cloth; of all */
    bool found;
};

/* ---- Its cloths ---- */

/* Counts vertices up to the name, then those behind it, up to the next name. */
static void scan_cloths(FILE *file, const char *wanted, struct folder *folder)
{
    char *line = NULL;
    size_t room = 0;
    bool here = false;
    while (getline(&line, &room, file) >= 0) {
        line[strcspn(line, "\r\n")] = '\0';
        if (line[0] == 'o' && line[1] == ' ') {
            here = !folder->found && !strcmp(line + 2, wanted);
            folder->first = here ? folder->n_all : folder->first;
            folder->found = folder->found || here;
        }
        const bool vertex = line[0] == 'v' && line[1] == ' ';
        folder->n += here && vertex;
        folder->n_all += vertex;
    }
    free(line);
}

static int find_cloth(struct folder *folder, const char *wanted, const struct model_cloth *cloth,
                      const struct scene_tree *tree, int node)
{
    FILE *file = cloth_file_open(folder->obj);
    if (!file)
        return scene_tree_fail(tree, scene_tree_get(tree, node, "frames"),
                               "from: cannot read %.300s: %s", folder->obj, cloth_file_why());
    scan_cloths(file, wanted, folder);
    const bool failed = ferror(file);
    fclose(file);
    const int name = scene_tree_get(tree, node, "cloth");
    if (failed)
        return scene_tree_fail(tree, node, "from: cannot read %.300s", folder->obj);
    if (!folder->found)
        return scene_tree_fail(tree, name ? name : node,
                               "from: %.300s has no cloth '%.60s'; from.cloth names another one",
                               folder->obj, wanted);
    if (folder->n != cloth->mesh.n_vertices)
        return scene_tree_fail(tree, name ? name : node,
                               "from: cloth '%.60s' has %u vertices in %.300s, but %u here; the "
                               "same mesh is expected",
                               wanted, folder->n, folder->obj, cloth->mesh.n_vertices);
    return CLOTH_OK;
}

/* ---- Its frames ---- */

static int check_from_frame(const struct scene_settled *from, uint32_t n_frames,
                            const struct folder *folder, const struct scene_tree *tree, int node)
{
    if (from->frame == SCENE_LAST_FRAME ||
        (from->frame < n_frames && from->frame == floor(from->frame)))
        return CLOTH_OK;
    return scene_tree_fail(tree, scene_tree_get(tree, node, "frame"),
                           "from.frame is %g, but %.300s has the frames 0 to %u; one of them, or "
                           "last, is expected",
                           from->frame, folder->path, n_frames - 1);
}

/* The number of a frame as files count; one that does not fit becomes a number that no file has. */
static uint32_t build_start_frame_of(const struct scene_settled *from)
{
    return from->frame == SCENE_LAST_FRAME ? MESH_LAST_FRAME
           : from->frame < MESH_LAST_FRAME ? (uint32_t)from->frame
                                           : MESH_LAST_FRAME - 1;
}

/* place: of all vertices in the frame, m. */
static int build_start_take_places(struct model_cloth *cloth, const struct folder *folder,
                                   const double *place, const struct scene_tree *tree, int node)
{
    const uint32_t n = cloth->mesh.n_vertices;
    cloth->start = cloth_alloc(n, 6 * sizeof *cloth->start, tree->error);
    for (uint32_t v = 0; v < n && cloth->start; v++)
        for (size_t c = 0; c < 3; c++) {
            const double x = place[3 * ((size_t)folder->first + v) + c];
            if (!isfinite(x))
                return scene_tree_fail(
                    tree, node,
                    "from: vertex %u of the frame in %.300s is nowhere (vertices count from 1)",
                    v + 1, folder->pc2);
            cloth->start[6 * (size_t)v + c] = x;
            cloth->start[6 * (size_t)v + 3 + c] = cloth->velocity[c];
        }
    return tree->error->code;
}

static int build_start_take_frame(struct model_cloth *cloth, const struct scene_settled *from,
                                  const struct folder *folder, struct scene_tree *tree, int node)
{
    uint32_t n_frames = 0;
    double *places = NULL;
    int code = mesh_read_pc2(folder->pc2, folder->n_all, build_start_frame_of(from), &n_frames,
                             &places, &tree->inner);
    code = scene_build_blame(code, "from", tree, scene_tree_get(tree, node, "frames")) ||
           check_from_frame(from, n_frames, folder, tree, node) ||
           build_start_take_places(cloth, folder, places, tree, node);
    free(places);
    return code;
}

/* ---- All of it ---- */

/* The path of a file of the folder, which is added to the model's. */
static char *start_path(const struct scene_tree *tree, const char *folder, const char *name)
{
    char *path;
    if (asprintf(&path, "%s/%s", folder, name) < 0)
        return scene_build_out_of_memory(tree->error);
    scene_build_file(tree, path);
    return path;
}

int scene_build_settled(struct model_cloth *cloth, struct scene_tree *tree, int node)
{
    const int at = scene_tree_get(tree, node, "from");
    struct scene_settled from = {0};
    struct folder folder = {0};
    if (!at || scene_fill(&from, &scene_settled, tree, at))
        return tree->error->code;
    char *path = scene_build_path(tree, scene_tree_get(tree, at, "frames"));
    if (path) {
        folder.path = path;
        folder.obj = start_path(tree, path, "cloth.obj");
        folder.pc2 = start_path(tree, path, "cloth.pc2");
    }
    const int code = tree->error->code ||
                     find_cloth(&folder, from.cloth ? from.cloth : cloth->name, cloth, tree, at) ||
                     build_start_take_frame(cloth, &from, &folder, tree, at);
    free(folder.obj);
    free(folder.pc2);
    free(path);
    free(from.cloth);
    return code;
}
