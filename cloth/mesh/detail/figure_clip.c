/* Between keys places, scales and weights go straight, rotations along the shorter arc; before the
 * first key and after the last one they rest. */
#include "cloth/mesh/detail/figure_scene.h"

#include "cloth/mesh/detail/finish.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double USUAL_TICKS = 25; /* 1/s: of a clip that does not say it */
static const double MOST_BYTES = 4e9; /* of all frames */

double figure_ticks(const struct aiAnimation *clip)
{
    return clip->mTicksPerSecond > 0 ? clip->mTicksPerSecond : USUAL_TICKS;
}

/* ---- Keys ---- */

/* The last of n keys at or before the time, or the first; *part: of the way to the next one. time:
 * of key 0; step: bytes from one to the next. */
static unsigned find_key(const double *time, size_t step, unsigned n, double ticks, double *part)
{
    const char *at = (const char *)time;
    unsigned low = 0, high = n;
    while (high - low > 1) {
        const unsigned middle = low + (high - low) / 2;
        if (*(const double *)(const void *)(at + middle * step) <= ticks)
            low = middle;
        else
            high = middle;
    }
    *part = 0;
    if (low + 1 >= n)
        return low;
    const double from = *(const double *)(const void *)(at + low * step);
    const double to = *(const double *)(const void *)(at + (low + 1) * step);
    if (to > from)
        *part = fmin(fmax((ticks - from) / (to - from), 0), 1);
    return low;
}

/* n > 0. */
static void vector_at(const struct aiVectorKey *key, unsigned n, double ticks, double to[3])
{
    double part;
    const struct aiVectorKey *from = key + find_key(&key->mTime, sizeof *key, n, ticks, &part);
    const struct aiVector3D *a = &from->mValue, *b = &from[part > 0].mValue;
    const double one[3] = {(double)a->x, (double)a->y, (double)a->z},
                 two[3] = {(double)b->x, (double)b->y, (double)b->z};
    for (int c = 0; c < 3; c++)
        to[c] = one[c] + part * (two[c] - one[c]);
}

static void make_unit(double q[4])
{
    const double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int c = 0; c < 4 && length > 0; c++)
        q[c] /= length;
}

/* Slerp (Shoemake 1985), w x y z of length 1. The arc is halved, since sines of the C library
 * differ between processors. n > 0. */
static void rotation_at(const struct aiQuatKey *key, unsigned n, double ticks, double q[4])
{
    enum { HALVINGS = 50 }; /* the arc that is left is below rounding */
    double part, dot = 0;
    const struct aiQuatKey *from = key + find_key(&key->mTime, sizeof *key, n, ticks, &part);
    const struct aiQuaternion *a = &from->mValue, *b = &from[part > 0].mValue;
    double low[4] = {(double)a->w, (double)a->x, (double)a->y, (double)a->z},
           high[4] = {(double)b->w, (double)b->x, (double)b->y, (double)b->z};
    for (int c = 0; c < 4; c++)
        dot += low[c] * high[c];
    for (int c = 0; c < 4 && dot < 0; c++)
        high[c] = -high[c];
    make_unit(low);
    make_unit(high);
    for (int k = 0; k < HALVINGS; k++) {
        double middle[4];
        for (int c = 0; c < 4; c++)
            middle[c] = low[c] + high[c];
        make_unit(middle);
        const bool beyond = part >= 0.5;
        memcpy(beyond ? low : high, middle, sizeof middle);
        part = 2 * part - beyond;
    }
    memcpy(q, low, sizeof low);
}

static struct figure_matrix compose(const double scale[3], const double q[4], const double x[3])
{
    const double w = q[0], i = q[1], j = q[2], k = q[3];
    struct figure_matrix m = {
        {{1 - 2 * (j * j + k * k), 2 * (i * j - k * w), 2 * (i * k + j * w), x[0]},
         {2 * (i * j + k * w), 1 - 2 * (i * i + k * k), 2 * (j * k - i * w), x[1]},
         {2 * (i * k - j * w), 2 * (j * k + i * w), 1 - 2 * (i * i + j * j), x[2]}}};
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            m.row[r][c] *= scale[c];
    return m;
}

/* A channel has keys of all three, Assimp says; without them its node rests. */
struct figure_matrix figure_local(const struct aiNode *node, const struct aiNodeAnim *channel,
                                  double ticks)
{
    double scale[3], rotation[4], place[3];
    if (!channel || !channel->mNumScalingKeys || !channel->mNumRotationKeys ||
        !channel->mNumPositionKeys)
        return figure_matrix_of(&node->mTransformation);
    vector_at(channel->mScalingKeys, channel->mNumScalingKeys, ticks, scale);
    rotation_at(channel->mRotationKeys, channel->mNumRotationKeys, ticks, rotation);
    vector_at(channel->mPositionKeys, channel->mNumPositionKeys, ticks, place);
    return compose(scale, rotation, place);
}

/* ---- Shapes ---- */

static double weight_in(const struct aiMeshMorphKey *key, uint32_t shape)
{
    for (unsigned i = 0; i < key->mNumValuesAndWeights; i++)
        if (key->mValues[i] == shape)
            return key->mWeights[i];
    return 0;
}

/* Channels name a mesh or its node, in FBX with a star and more behind it. */
static bool names(const struct aiString *channel, const struct aiString *name)
{
    const size_t n = strcspn(channel->data, "*");
    return n && n == name->length && !strncmp(channel->data, name->data, n);
}

double figure_shape_weight(const struct figure_skin *skin, const struct figure_part *part,
                           uint32_t shape, double ticks)
{
    const struct figure_node *node = skin->figure->node.items;
    const struct aiAnimation *clip = skin->clip;
    for (unsigned c = 0; clip && c < clip->mNumMorphMeshChannels; c++) {
        const struct aiMeshMorphAnim *channel = clip->mMorphMeshChannels[c];
        double between;
        if (!channel->mNumKeys || (!names(&channel->mName, &node[part->node].of->mName) &&
                                   !names(&channel->mName, &part->mesh->mName)))
            continue;
        const struct aiMeshMorphKey *key =
            channel->mKeys + find_key(&channel->mKeys->mTime, sizeof *channel->mKeys,
                                      channel->mNumKeys, ticks, &between);
        const double one = weight_in(key, shape), two = weight_in(key + (between > 0), shape);
        return one + between * (two - one);
    }
    return (double)part->mesh->mAnimMeshes[shape]->mWeight;
}

/* ---- Frames ---- */

/* Ticks up to the last key. */
static double end_of(const struct aiAnimation *clip)
{
    double end = 0;
    for (unsigned c = 0; c < clip->mNumChannels; c++) {
        const struct aiNodeAnim *channel = clip->mChannels[c];
        if (channel->mNumPositionKeys)
            end = fmax(end, channel->mPositionKeys[channel->mNumPositionKeys - 1].mTime);
        if (channel->mNumRotationKeys)
            end = fmax(end, channel->mRotationKeys[channel->mNumRotationKeys - 1].mTime);
        if (channel->mNumScalingKeys)
            end = fmax(end, channel->mScalingKeys[channel->mNumScalingKeys - 1].mTime);
    }
    for (unsigned c = 0; c < clip->mNumMorphMeshChannels; c++) {
        const struct aiMeshMorphAnim *channel = clip->mMorphMeshChannels[c];
        if (channel->mNumKeys)
            end = fmax(end, channel->mKeys[channel->mNumKeys - 1].mTime);
    }
    return end;
}

static const struct aiAnimation *find_clip(const struct figure *figure, const char *name)
{
    const struct aiScene *scene = figure->scene;
    char all[300] = "";
    if (scene->mNumAnimations && !strcmp(name, "first"))
        return scene->mAnimations[0];
    for (unsigned i = 0; i < scene->mNumAnimations; i++) {
        if (!strcmp(scene->mAnimations[i]->mName.data, name))
            return scene->mAnimations[i];
        cloth_text_add(all, sizeof all, "%s'%s'", i ? ", " : "", scene->mAnimations[i]->mName.data);
    }
    cloth_fail(figure->error, CLOTH_E_INPUT,
               scene->mNumAnimations ? "%s: it has no animation '%.60s'; there are %s, and `first`"
                                     : "%s: it has no animation, so no '%.60s'%s",
               mesh_path_shown(figure->path), name, all);
    return NULL;
}

/* A skeleton whose mesh has no bones, above all: its own clip leaves the mesh where it is. */
static int check_motion(const struct figure *figure, const char *clip, uint32_t n_frames,
                        const double *place)
{
    const size_t n = 3 * (size_t)figure->n_vertices;
    for (uint32_t k = 0; k < n_frames; k++)
        for (size_t i = 0; i < n; i++) {
            if (!isfinite(place[k * n + i]))
                return cloth_fail(figure->error, CLOTH_E_INPUT,
                                  "%s: the animation '%.60s' puts a vertex at no finite place",
                                  mesh_path_shown(figure->path), clip);
            if (place[k * n + i] < place[i] || place[k * n + i] > place[i])
                return CLOTH_OK;
        }
    return cloth_fail(figure->error, CLOTH_E_INPUT,
                      "%s: the animation '%.60s' moves no vertex: no mesh has bones or shapes that "
                      "it moves, or hangs at a node that it does; export the mesh with its skin",
                      mesh_path_shown(figure->path), clip);
}

static int sample_clip(const struct figure *figure, const struct aiAnimation *clip, double rate,
                       uint32_t *n_frames, double **place)
{
    struct figure_skin skin;
    const size_t stride = 3 * (size_t)figure->n_vertices;
    /* The last key's frame, too, where its time is rounded. */
    const double n = floor(end_of(clip) / figure_ticks(clip) * rate + 1e-3) + 1;
    const double bytes = n * (double)stride * sizeof **place;
    if (!(bytes <= MOST_BYTES))
        return cloth_fail(figure->error, CLOTH_E_INPUT,
                          "%s: the frames of '%.60s', %g a second, take %.3g GB; at most %g are "
                          "expected: use a lower fps",
                          mesh_path_shown(figure->path), clip->mName.data, rate, bytes / 1e9,
                          MOST_BYTES / 1e9);
    int code = figure_skin_make(&skin, figure, clip);
    *n_frames = (uint32_t)n;
    *place = cloth_alloc(*n_frames, stride * sizeof **place, figure->error);
    for (uint32_t k = 0; k < *n_frames && !code && *place; k++)
        figure_place(&skin, k / rate, *place + k * stride);
    figure_skin_free(&skin);
    return figure->error->code;
}

int mesh_read_clip(const char *path, uint32_t n_vertices, const char *clip, double rate,
                   uint32_t *n_frames, double **place, struct cloth_error *error)
{
    struct cloth_error own = {0};
    struct figure figure;
    const struct aiAnimation *of = NULL;
    *n_frames = 0;
    *place = NULL;
    int code = figure_open(&figure, path, &own);
    if (!code && figure.n_vertices != n_vertices)
        code = cloth_fail(&own, CLOTH_E_INPUT, "%s: it has %u vertices, but the mesh has %u",
                          mesh_path_shown(path), figure.n_vertices, n_vertices);
    if (!code)
        of = find_clip(&figure, clip);
    if (of && !sample_clip(&figure, of, rate, n_frames, place))
        check_motion(&figure, of->mName.data, *n_frames, *place);
    figure_close(&figure);
    if (!own.code)
        return CLOTH_OK;
    free(*place);
    *place = NULL;
    return cloth_fail(error, own.code, "%s", own.text);
}
