/* Indices and places that Assimp read are checked before they are used. Its own steps that change
 * meshes are not asked for. */
#include "cloth/mesh/detail/figure_scene.h"

#include "cloth/base/file.h"
#include "cloth/mesh/detail/finish.h"
#include "cloth/mesh/detail/obj.h"

#include <assimp/cimport.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_NODES = 1 << 20, MOST_DEPTH = 1000 };

static int figure_wrong(const struct figure *figure, const char *what)
{
    return cloth_fail(figure->error, CLOTH_E_INPUT, "%s: %s", mesh_path_shown(figure->path), what);
}

/* ---- Nodes and parts ---- */

static int add_part(struct figure *figure, uint32_t node, const struct aiMesh *mesh)
{
    const struct figure_part part = {mesh, node, figure->n_all};
    if (mesh->mNumVertices > MESH_MAX - figure->n_all)
        return figure_wrong(figure, "its meshes have too many vertices");
    figure->n_all += mesh->mNumVertices;
    return cloth_list_put(&figure->part, &part, sizeof part, figure->error);
}

/* wanted: its parent is. */
static int add_nodes(struct figure *figure, const struct aiNode *of, uint32_t parent,
                     uint32_t depth, bool wanted)
{
    const struct figure_node node = {of, parent};
    const uint32_t number = (uint32_t)figure->node.n;
    if (number >= MOST_NODES || depth > MOST_DEPTH)
        return figure_wrong(figure, "its nodes are too many, or too deep in each other");
    int code = cloth_list_put(&figure->node, &node, sizeof node, figure->error);
    wanted = wanted || !strcmp(of->mName.data, figure->wanted);
    for (unsigned i = 0; wanted && i < of->mNumMeshes && !code; i++)
        code = of->mMeshes[i] < figure->scene->mNumMeshes
                   ? add_part(figure, number, figure->scene->mMeshes[of->mMeshes[i]])
                   : figure_wrong(figure, "a node has a mesh that is not there");
    for (unsigned i = 0; i < of->mNumChildren && !code; i++)
        code = add_nodes(figure, of->mChildren[i], number, depth + 1, wanted);
    return code;
}

uint32_t figure_node_of(const struct figure *figure, const struct aiString *name)
{
    const struct figure_node *node = figure->node.items;
    for (uint32_t i = 0; i < figure->node.n; i++)
        if (!strcmp(node[i].of->mName.data, name->data))
            return i;
    return UINT32_MAX;
}

/* ---- Vertices at one place of one node ---- */

struct spot {
    float x[3];
    uint32_t node, number;
};

static int compare_spots(const void *a, const void *b)
{
    const struct spot *one = a, *two = b;
    if (one->node != two->node)
        return one->node < two->node ? -1 : 1;
    for (int c = 0; c < 3; c++)
        if (one->x[c] < two->x[c] || one->x[c] > two->x[c])
            return one->x[c] < two->x[c] ? -1 : 1;
    return one->number < two->number ? -1 : 1;
}

static bool is_same(const struct spot *a, const struct spot *b)
{
    return a->node == b->node && !(a->x[0] < b->x[0]) && !(a->x[1] < b->x[1]) &&
           !(a->x[2] < b->x[2]);
}

static int list_spots(const struct figure *figure, struct spot *spot)
{
    const struct figure_part *part = figure->part.items;
    for (size_t p = 0; p < figure->part.n; p++)
        for (uint32_t v = 0; v < part[p].mesh->mNumVertices; v++, spot++) {
            const struct aiVector3D *x = &part[p].mesh->mVertices[v];
            *spot = (struct spot){{x->x, x->y, x->z}, part[p].node, part[p].first + v};
            if (!isfinite(x->x) || !isfinite(x->y) || !isfinite(x->z))
                return figure_wrong(figure, "a vertex has a place that is no finite number");
        }
    return CLOTH_OK;
}

/* The first of those that are one stands for all; these are numbered in the file's order. */
static int join_vertices(struct figure *figure)
{
    const uint32_t n = figure->n_all;
    struct spot *spot = cloth_alloc(n, sizeof *spot, figure->error);
    figure->vertex = cloth_alloc(n, sizeof *figure->vertex, figure->error);
    figure->source = cloth_alloc(n, sizeof *figure->source, figure->error);
    int code = figure->error->code ? figure->error->code : list_spots(figure, spot);
    if (!code)
        qsort(spot, n, sizeof *spot, compare_spots);
    for (uint32_t i = 0, first = 0; i < n && !code; i++) {
        first = is_same(spot + first, spot + i) ? first : i;
        figure->source[spot[i].number] = spot[first].number;
    }
    free(spot);
    for (uint32_t i = 0; i < n && !code; i++) {
        const uint32_t first = figure->source[i];
        figure->vertex[i] = first == i ? figure->n_vertices : figure->vertex[first];
        if (first == i)
            figure->source[figure->n_vertices++] = i;
    }
    return code;
}

/* ---- The file ---- */

/* Assimp's own sentence of a file that is not there would name no reason. */
static int import(struct figure *figure)
{
    char *path = strndup(figure->path, mesh_figure_path(figure->path));
    if (!path)
        return cloth_fail(figure->error, CLOTH_E_MEMORY, "no memory for a path");
    FILE *file = cloth_file_open(path);
    if (file)
        fclose(file);
    else
        cloth_fail(figure->error, CLOTH_E_IO, "%s: cannot be read: %s",
                   mesh_path_shown(figure->path), cloth_file_why());
    figure->scene = file ? aiImportFile(path, 0) : NULL;
    free(path);
    if (!file)
        return figure->error->code;
    if (!figure->scene || !figure->scene->mRootNode)
        return cloth_fail(figure->error, CLOTH_E_INPUT, "%s: Assimp cannot read it: %.300s",
                          mesh_path_shown(figure->path), aiGetErrorString());
    if (!figure->scene->mNumMeshes)
        return figure_wrong(figure, "it has no mesh");
    return CLOTH_OK;
}

/* Lists the nodes with meshes, as far as a sentence has room. */
static int fail_without(const struct figure *figure)
{
    const struct figure_node *node = figure->node.items;
    char names[300] = "";
    for (size_t i = 0; i < figure->node.n; i++)
        if (node[i].of->mNumMeshes)
            cloth_text_add(names, sizeof names, "%s'%s'", *names ? ", " : "",
                           node[i].of->mName.data);
    if (!figure->wanted || !*names)
        return figure_wrong(figure, "no node has a mesh with vertices");
    return cloth_fail(figure->error, CLOTH_E_INPUT,
                      "%s: no node '%.60s' has a mesh, nor what hangs at it; these have one: %s",
                      mesh_path_shown(figure->path), figure->wanted, names);
}

int figure_open(struct figure *figure, const char *path, struct cloth_error *error)
{
    const char *mark = path + mesh_figure_path(path);
    *figure = (struct figure){.path = path, .wanted = *mark ? mark + 1 : NULL, .error = error};
    int code = import(figure);
    code = code ? code : add_nodes(figure, figure->scene->mRootNode, 0, 0, !figure->wanted);
    if (!code && !figure->n_all)
        code = fail_without(figure);
    return code ? code : join_vertices(figure);
}

void figure_close(struct figure *figure)
{
    if (figure->scene)
        aiReleaseImport(figure->scene);
    free(figure->node.items);
    free(figure->part.items);
    free(figure->vertex);
    free(figure->source);
}

/* ---- The mesh ---- */

/* A corner that is that before it goes. An index that is out of range is no vertex of the mesh. */
static int put_face(struct obj_parts *to, const struct figure *figure,
                    const struct figure_part *part, const struct aiFace *face)
{
    const bool has_uv = part->mesh->mTextureCoords[0];
    const uint32_t first = (uint32_t)to->corner.n;
    if (face->mNumIndices > MESH_MAX - first)
        return figure_wrong(figure, "its polygons have too many corners");
    for (unsigned i = 0; i < face->mNumIndices; i++) {
        if (face->mIndices[i] >= part->mesh->mNumVertices)
            return figure_wrong(figure, "a polygon has a corner that is no vertex of its mesh");
        const uint32_t number = part->first + face->mIndices[i];
        const uint32_t corner[2] = {figure->vertex[number], has_uv ? number : OBJ_NO_UV};
        const uint32_t(*before)[2] = to->corner.items;
        const size_t n = to->corner.n;
        const bool closes =
            i + 1 == face->mNumIndices && n > first && corner[0] == before[first][0];
        if (!closes && (n == first || corner[0] != before[n - 1][0]) &&
            cloth_list_put(&to->corner, corner, sizeof corner, figure->error))
            return figure->error->code;
    }
    if (to->corner.n < (size_t)first + 3) {
        to->corner.n = first;
        return CLOTH_OK;
    }
    return cloth_list_put(&to->face_start, &first, sizeof first, figure->error);
}

static int put_part(struct obj_parts *to, const struct figure *figure,
                    const struct figure_part *part)
{
    const struct aiMesh *mesh = part->mesh;
    const struct figure_node *node = figure->node.items;
    int code = obj_naming_line(&to->naming, OBJ_OBJECTS, node[part->node].of->mName.data,
                               (uint32_t)to->face_start.n, figure->error);
    for (unsigned f = 0; f < mesh->mNumFaces && !code; f++)
        code = put_face(to, figure, part, &mesh->mFaces[f]);
    for (unsigned v = 0; v < mesh->mNumVertices && !code; v++) {
        const struct aiVector3D *from =
            mesh->mTextureCoords[0] ? mesh->mTextureCoords[0] + v : NULL;
        const double uv[2] = {from && isfinite(from->x) ? from->x : 0,
                              from && isfinite(from->y) ? from->y : 0};
        code = cloth_list_put(&to->uv, uv, sizeof uv, figure->error);
    }
    return code;
}

static int put_places(struct obj_parts *to, const struct figure *figure)
{
    struct figure_skin skin;
    double *x = cloth_list_add(&to->position, 3 * sizeof *x, figure->n_vertices, figure->error);
    int code = figure_skin_make(&skin, figure, NULL);
    if (!code && x)
        figure_place(&skin, 0, x);
    figure_skin_free(&skin);
    for (size_t i = 0; i < 3 * (size_t)figure->n_vertices && !code && x; i++)
        if (!isfinite(x[i]))
            code = figure_wrong(figure, "a node puts its mesh at no finite place");
    return x ? code : figure->error->code;
}

int mesh_read_figure(struct mesh *mesh, const char *path, bool fans, struct cloth_error *error)
{
    struct cloth_error own = {0};
    struct figure figure;
    struct obj_parts parts = {0};
    *mesh = (struct mesh){0};
    int code = figure_open(&figure, path, &own);
    const struct figure_part *part = figure.part.items;
    for (size_t p = 0; p < figure.part.n && !code; p++)
        code = put_part(&parts, &figure, part + p);
    if (!code && !parts.face_start.n)
        code = figure_wrong(&figure, "it has no polygons, only points or lines");
    code = code ? code : put_places(&parts, &figure);
    if (!code)
        obj_parts_make(&parts, path, fans, mesh, &own);
    obj_parts_free(&parts);
    figure_close(&figure);
    return own.code ? cloth_fail(error, own.code, "%s", own.text) : CLOTH_OK;
}
