/* Vertices without bones are moved by their node. A bone's matrix leads from its mesh to the node
 * that it is, as it was bound. */
#include "cloth/mesh/detail/figure_scene.h"

#include "cloth/mesh/detail/finish.h"

#include <stdlib.h>

struct figure_matrix figure_matrix_of(const struct aiMatrix4x4 *from)
{
    return (struct figure_matrix){{{from->a1, from->a2, from->a3, from->a4},
                                   {from->b1, from->b2, from->b3, from->b4},
                                   {from->c1, from->c2, from->c3, from->c4}}};
}

static struct figure_matrix multiply(const struct figure_matrix *a, const struct figure_matrix *b)
{
    struct figure_matrix c;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 4; k++) {
            c.row[i][k] = k == 3 ? a->row[i][3] : 0;
            for (int j = 0; j < 3; j++)
                c.row[i][k] += a->row[i][j] * b->row[j][k];
        }
    return c;
}

static const struct figure_part *part_at(const struct figure *figure, size_t p)
{
    return (const struct figure_part *)figure->part.items + p;
}

/* ---- Which matrices a vertex has ---- */

static int number_matrices(struct figure_skin *skin)
{
    const struct figure *figure = skin->figure;
    const size_t n_parts = figure->part.n;
    skin->bone_first = cloth_alloc(n_parts, sizeof *skin->bone_first, figure->error);
    if (!skin->bone_first)
        return CLOTH_E_MEMORY;
    skin->n_matrices = (uint32_t)n_parts;
    for (size_t p = 0; p < n_parts; p++) {
        skin->bone_first[p] = skin->n_matrices;
        skin->n_matrices += part_at(figure, p)->mesh->mNumBones;
    }
    skin->bone_node = cloth_alloc(skin->n_matrices, sizeof *skin->bone_node, figure->error);
    for (size_t p = 0; p < n_parts && skin->bone_node; p++) {
        const struct aiMesh *mesh = part_at(figure, p)->mesh;
        skin->bone_node[p] = part_at(figure, p)->node;
        for (unsigned b = 0; b < mesh->mNumBones; b++) {
            const struct aiString *name = &mesh->mBones[b]->mName;
            const uint32_t node = figure_node_of(figure, name);
            if (node == UINT32_MAX)
                return cloth_fail(figure->error, CLOTH_E_INPUT,
                                  "%s: the bone '%.60s' of mesh '%.60s' is no node of the file: "
                                  "export the skeleton with the mesh",
                                  mesh_path_shown(figure->path), name->data, mesh->mName.data);
            skin->bone_node[skin->bone_first[p] + b] = node;
        }
    }
    return figure->error->code;
}

/* Calls `take` for each weight above 0 of a vertex that stands for others. */
typedef void take_weight(struct figure_skin *skin, uint32_t vertex, uint32_t matrix, double weight);

static int walk_weights(struct figure_skin *skin, take_weight *take)
{
    const struct figure *figure = skin->figure;
    for (size_t p = 0; p < figure->part.n; p++) {
        const struct figure_part *part = part_at(figure, p);
        for (unsigned b = 0; b < part->mesh->mNumBones; b++) {
            const struct aiBone *bone = part->mesh->mBones[b];
            for (unsigned w = 0; w < bone->mNumWeights; w++) {
                const struct aiVertexWeight *weight = &bone->mWeights[w];
                if (weight->mVertexId >= part->mesh->mNumVertices)
                    return cloth_fail(figure->error, CLOTH_E_INPUT,
                                      "%s: the bone '%.60s' has a weight of no vertex of its mesh",
                                      mesh_path_shown(figure->path), bone->mName.data);
                const uint32_t number = part->first + weight->mVertexId;
                const uint32_t vertex = figure->vertex[number];
                if (figure->source[vertex] == number && weight->mWeight > 0)
                    take(skin, vertex, skin->bone_first[p] + b, (double)weight->mWeight);
            }
        }
    }
    return CLOTH_OK;
}

static void count_weight(struct figure_skin *skin, uint32_t vertex, uint32_t matrix, double weight)
{
    (void)matrix;
    (void)weight;
    skin->start[vertex + 1]++;
}

/* start[v]: where the next one of v goes. */
static void put_weight(struct figure_skin *skin, uint32_t vertex, uint32_t matrix, double weight)
{
    skin->influence[skin->start[vertex]++] = (struct figure_influence){matrix, weight};
}

/* The sum of a vertex's weights becomes 1; without any it follows its node. */
static void settle_weights(struct figure_skin *skin)
{
    const struct figure *figure = skin->figure;
    for (uint32_t v = figure->n_vertices; v > 0; v--)
        skin->start[v] = skin->start[v - 1];
    skin->start[0] = 0;
    for (uint32_t v = 0; v < figure->n_vertices; v++) {
        double sum = 0;
        for (uint32_t i = skin->start[v]; i < skin->start[v + 1]; i++)
            sum += skin->influence[i].weight;
        for (uint32_t i = skin->start[v]; i < skin->start[v + 1]; i++)
            skin->influence[i].weight /= sum;
    }
}

static int list_influences(struct figure_skin *skin)
{
    const struct figure *figure = skin->figure;
    const uint32_t n = figure->n_vertices;
    skin->start = cloth_alloc((size_t)n + 1, sizeof *skin->start, figure->error);
    int code = skin->start ? walk_weights(skin, count_weight) : CLOTH_E_MEMORY;
    for (uint32_t v = 0; v < n && !code; v++)
        skin->start[v + 1] += skin->start[v];
    if (!code)
        skin->influence = cloth_alloc(skin->start[n], sizeof *skin->influence, figure->error);
    code = code ? code : skin->influence ? walk_weights(skin, put_weight) : CLOTH_E_MEMORY;
    if (!code)
        settle_weights(skin);
    return code;
}

/* The first channel of each node. */
static int find_channels(struct figure_skin *skin)
{
    const struct figure *figure = skin->figure;
    skin->channel = cloth_alloc(figure->node.n, sizeof *skin->channel, figure->error);
    for (unsigned c = 0; skin->channel && skin->clip && c < skin->clip->mNumChannels; c++) {
        const struct aiNodeAnim *channel = skin->clip->mChannels[c];
        const uint32_t node = figure_node_of(figure, &channel->mNodeName);
        if (node != UINT32_MAX && !skin->channel[node])
            skin->channel[node] = channel;
    }
    return figure->error->code;
}

int figure_skin_make(struct figure_skin *skin, const struct figure *figure,
                     const struct aiAnimation *clip)
{
    *skin = (struct figure_skin){.figure = figure, .clip = clip};
    int code = number_matrices(skin);
    code = code ? code : list_influences(skin);
    code = code ? code : find_channels(skin);
    skin->world = cloth_alloc(figure->node.n, sizeof *skin->world, figure->error);
    skin->matrix = cloth_alloc(skin->n_matrices, sizeof *skin->matrix, figure->error);
    skin->own = cloth_alloc(figure->n_all, sizeof *skin->own, figure->error);
    return figure->error->code;
}

void figure_skin_free(struct figure_skin *skin)
{
    free(skin->start);
    free(skin->influence);
    free(skin->bone_first);
    free(skin->bone_node);
    free(skin->channel);
    free(skin->own);
    free(skin->world);
    free(skin->matrix);
    *skin = (struct figure_skin){0};
}

/* ---- Where vertices are ---- */

static void move_matrices(struct figure_skin *skin, double ticks)
{
    const struct figure *figure = skin->figure;
    const struct figure_node *node = figure->node.items;
    for (size_t i = 0; i < figure->node.n; i++) {
        const struct figure_matrix local = figure_local(node[i].of, skin->channel[i], ticks);
        skin->world[i] = i ? multiply(skin->world + node[i].parent, &local) : local;
    }
    for (size_t p = 0; p < figure->part.n; p++) {
        const struct aiMesh *mesh = part_at(figure, p)->mesh;
        skin->matrix[p] = skin->world[skin->bone_node[p]];
        for (unsigned b = 0; b < mesh->mNumBones; b++) {
            const uint32_t m = skin->bone_first[p] + b;
            const struct figure_matrix bound = figure_matrix_of(&mesh->mBones[b]->mOffsetMatrix);
            skin->matrix[m] = multiply(skin->world + skin->bone_node[m], &bound);
        }
    }
}

static void move_by_shapes(const struct figure_skin *skin, const struct figure_part *part,
                           double ticks)
{
    const struct aiMesh *mesh = part->mesh;
    double(*own)[3] = skin->own + part->first;
    for (unsigned v = 0; v < mesh->mNumVertices; v++) {
        const struct aiVector3D *x = &mesh->mVertices[v];
        const double place[3] = {(double)x->x, (double)x->y, (double)x->z};
        for (int c = 0; c < 3; c++)
            own[v][c] = place[c];
    }
    for (unsigned s = 0; s < mesh->mNumAnimMeshes; s++) {
        const struct aiAnimMesh *shape = mesh->mAnimMeshes[s];
        const double weight = figure_shape_weight(skin, part, s, ticks);
        if (!shape->mVertices || shape->mNumVertices != mesh->mNumVertices ||
            !(weight < 0 || weight > 0))
            continue;
        for (unsigned v = 0; v < mesh->mNumVertices; v++) {
            const struct aiVector3D *x = &mesh->mVertices[v], *to = &shape->mVertices[v];
            const double way[3] = {(double)to->x - (double)x->x, (double)to->y - (double)x->y,
                                   (double)to->z - (double)x->z};
            for (int c = 0; c < 3; c++)
                own[v][c] += weight * way[c];
        }
    }
}

static void add_moved(const struct figure_matrix *m, double weight, const double from[3],
                      double to[3])
{
    for (int c = 0; c < 3; c++)
        to[c] += weight * (m->row[c][0] * from[0] + m->row[c][1] * from[1] +
                           m->row[c][2] * from[2] + m->row[c][3]);
}

void figure_place(struct figure_skin *skin, double time, double *x)
{
    const struct figure *figure = skin->figure;
    const double ticks = skin->clip ? time * figure_ticks(skin->clip) : 0;
    move_matrices(skin, ticks);
    for (size_t p = 0; p < figure->part.n; p++)
        move_by_shapes(skin, part_at(figure, p), ticks);
    size_t p = 0;
    for (uint32_t v = 0; v < figure->n_vertices; v++, x += 3) {
        const double *own = skin->own[figure->source[v]];
        const uint32_t begin = skin->start[v], end = skin->start[v + 1];
        while (p + 1 < figure->part.n && part_at(figure, p + 1)->first <= figure->source[v])
            p++;
        x[0] = x[1] = x[2] = 0;
        if (begin == end)
            add_moved(skin->matrix + p, 1, own, x);
        for (uint32_t i = begin; i < end; i++)
            add_moved(skin->matrix + skin->influence[i].matrix, skin->influence[i].weight, own, x);
    }
}
