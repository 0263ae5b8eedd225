/* Seams become joints or welds: one entry of the model a seam, of the pairs that no seam before it
 * has. A pair of one vertex, where the two edges of a dart begin, joins nothing. */
#include "cloth/scene/build/build.h"

#include "cloth/base/sets.h"

#include <fnmatch.h>
#include <stdlib.h>
#include <string.h>

/* s: partners that are otherwise free approach e-fold in this time, if no damping is given. Else
 * their joint would close within a step from any distance. */
static const double CLOSING = 0.1;

enum { MOST_NAMED = 12 }; /* in a warning */

/* ---- Pairs that a seam joins ---- */

struct pair {
    uint32_t low, high; /* vertices */
    uint32_t seam, i;   /* pair i of this seam */
};

static int build_seams_compare_pairs(const void *va, const void *vb)
{
    const struct pair *a = va, *b = vb;
    const uint32_t left[4] = {a->low, a->high, a->seam, a->i};
    const uint32_t right[4] = {b->low, b->high, b->seam, b->i};
    for (int k = 0; k < 4; k++)
        if (left[k] != right[k])
            return left[k] < right[k] ? -1 : 1;
    return 0;
}

/* joins: for each pair, seam after seam, 1 if it is the first with its two vertices among the seams
 * of a state. root: by vertex, the one that welds make it. */
static int find_firsts(const struct model_seams *seams, enum model_seams_state state,
                       const uint32_t *root, size_t n, unsigned char *joins,
                       struct cloth_error *error)
{
    struct pair *all = cloth_alloc(n, sizeof *all, error);
    size_t k = 0, of_state = 0;
    if (!all)
        return error->code;
    for (uint32_t s = 0; s < seams->n; s++)
        for (uint32_t i = 0; i < seams->seam[s].n_pairs; i++, k++) {
            const uint32_t *v = seams->seam[s].pair[i], a = root[v[0]], b = root[v[1]];
            if (seams->seam[s].sewing.state == state)
                all[of_state++] = (struct pair){a < b ? a : b, a < b ? b : a, s, (uint32_t)k};
        }
    qsort(all, of_state, sizeof *all, build_seams_compare_pairs);
    for (k = 0; k < of_state; k++) {
        const bool again = k && all[k].low == all[k - 1].low && all[k].high == all[k - 1].high;
        joins[all[k].i] = !again && all[k].low != all[k].high;
    }
    free(all);
    return CLOTH_OK;
}

/* ---- Joints and welds ---- */

/* The pairs of a new joint or weld of the model; NULL: no memory. */
static struct model_pairs *add_sewn(struct model *model, const struct model_sewing *sewing,
                                    struct cloth_error *error)
{
    if (sewing->state == MODEL_SEAMS_WELDED) {
        struct model_weld *weld =
            scene_build_add(&model->welds, &model->n_welds, 1, sizeof *weld, error);
        if (weld)
            weld->tolerance = sewing->tolerance;
        return weld ? &weld->pairs : NULL;
    }
    struct model_joint *joint =
        scene_build_add(&model->joints, &model->n_joints, 1, sizeof *joint, error);
    if (!joint)
        return NULL;
    model->n_pulled++;
    joint->stiffness = sewing->stiffness;
    joint->damping = sewing->damping;
    return &joint->pairs;
}

/* joins: of each pair of the seam, whether it joins. */
static int sew_seam(uint32_t cloth, uint32_t seam, const unsigned char *joins,
                    const struct scene_tree *tree, int node)
{
    const struct model_seam *of = tree->model->cloths[cloth].seams.seam + seam;
    struct model_pairs *pairs = add_sewn(tree->model, &of->sewing, tree->error);
    if (!pairs || scene_build_room(pairs, cloth, of->n_pairs, tree, node))
        return tree->error->code;
    pairs->seam = seam + 1;
    for (uint32_t i = 0; i < of->n_pairs; i++)
        if (joins[i])
            scene_build_pair(pairs, of->pair[i][0], of->pair[i][1]);
    return CLOTH_OK;
}

static void join_seam_pairs(const struct model *model, const struct model_pairs *pairs,
                            uint32_t *set)
{
    const struct model_end *end = pairs->end;
    for (uint32_t i = 0; i < end[0].n; i++)
        cloth_sets_join(set, model_first(model, end[0].cloth) + end[0].vertices[i],
                        model_first(model, end[1].cloth) + end[1].vertices[i]);
}

/* By vertex of all cloths: the lowest that welds make it one with. The caller frees it; NULL: no
 * memory. */
static uint32_t *find_roots(const struct model *model, struct cloth_error *error)
{
    const uint32_t n = model_first(model, model->n_cloths);
    uint32_t *root = cloth_alloc(n, sizeof *root, error);
    if (!root)
        return NULL;
    cloth_sets_start(root, n);
    for (uint32_t w = 0; w < model->n_welds; w++)
        join_seam_pairs(model, &model->welds[w].pairs, root);
    for (uint32_t v = 0; v < n; v++)
        root[v] = cloth_sets_root(root, v);
    return root;
}

size_t scene_build_count_pairs(const struct model_seams *seams)
{
    size_t n = 0;
    for (uint32_t s = 0; s < seams->n; s++)
        n += seams->seam[s].n_pairs;
    return n;
}

/* The seams of one state. */
static int sew_state(uint32_t cloth, enum model_seams_state state, const struct scene_tree *tree,
                     int node)
{
    struct model *model = tree->model;
    const struct model_seams *seams = &model->cloths[cloth].seams;
    const size_t n = scene_build_count_pairs(seams);
    unsigned char *joins = cloth_alloc(n, 1, tree->error), *of = joins;
    uint32_t *root = joins ? find_roots(model, tree->error) : NULL;
    int code =
        root ? find_firsts(seams, state, root + model_first(model, cloth), n, joins, tree->error)
             : tree->error->code;
    for (uint32_t s = 0; s < seams->n && !code; of += seams->seam[s++].n_pairs)
        if (memchr(of, 1, seams->seam[s].n_pairs)) /* else another's, or joined already */
            code = sew_seam(cloth, s, of, tree, node);
    free(joins);
    free(root);
    return code;
}

/* ---- The keys ---- */

static void reverse_seam(struct model_seam *seam)
{
    for (uint32_t i = 0, k = seam->n_pairs - 1; i < k; i++, k--) {
        const uint32_t vertex = seam->pair[i][1];
        seam->pair[i][1] = seam->pair[k][1];
        seam->pair[k][1] = vertex;
    }
    seam->reversed = !seam->reversed;
    seam->unsure = false; /* the scene says so */
}

/* Checks that a list of the scene names existing seams. */
static int check_numbers(const struct model_cloth *cloth, const uint32_t *number, uint32_t n,
                         const struct scene_tree *tree, int list)
{
    for (uint32_t i = 0; i < n; i++)
        if (number[i] >= cloth->seams.n)
            return scene_tree_fail(tree, scene_tree_item(tree, list, i),
                                   "seam %u is none of cloth '%.60s', which has %u seams, counted "
                                   "from 0",
                                   number[i], cloth->name, cloth->seams.n);
    return CLOTH_OK;
}

static int reverse_some(struct model_cloth *cloth, const struct scene_tree *tree, int node)
{
    struct model_seams *seams = &cloth->seams;
    const int list = scene_tree_get(tree, node, "reversed");
    int code = check_numbers(cloth, seams->reversed, seams->n_reversed, tree, list);
    for (uint32_t i = 0; i < seams->n_reversed && !code; i++) {
        for (uint32_t j = 0; j < i; j++)
            if (seams->reversed[j] == seams->reversed[i])
                return scene_tree_fail(tree, scene_tree_item(tree, list, i),
                                       "seam %u stands twice in seams.reversed",
                                       seams->reversed[i]);
        reverse_seam(seams->seam + seams->reversed[i]);
    }
    return code;
}

/* ---- Seams that are sewn otherwise than the cloth's ---- */

/* Replaces values by those of the keys of a map. */
static void lay_over(struct model_sewing *to, const struct model_sewing *from,
                     const struct scene_tree *tree, int node)
{
    if (scene_tree_get(tree, node, "state"))
        to->state = from->state;
    if (scene_tree_get(tree, node, "stiffness"))
        to->stiffness = from->stiffness;
    if (scene_tree_get(tree, node, "damping"))
        to->damping = from->damping;
    if (scene_tree_get(tree, node, "tolerance"))
        to->tolerance = from->tolerance;
    if (scene_tree_get(tree, node, "bending"))
        to->bending = from->bending;
}

static bool seam_is_between(const struct model_seam *seam, const char *const panel[2])
{
    bool is = false;
    for (int k = 0; k < 2; k++)
        is = is || (!fnmatch(panel[0], seam->side[k].panel, 0) &&
                    !fnmatch(panel[1], seam->side[!k].panel, 0));
    return is;
}

/* The entry of `some` gets the numbers of the seams between two panels. */
static int find_between(const struct model_cloth *cloth, struct model_some_seams *some,
                        const struct scene_tree *tree, int of)
{
    const char *panel[2];
    for (size_t k = 0; k < 2; k++)
        panel[k] = scene_tree_scalar(tree, scene_tree_item(tree, of, k));
    some->number = cloth_alloc(cloth->seams.n, sizeof *some->number, tree->error);
    if (!some->number)
        return tree->error->code;
    for (uint32_t s = 0; s < cloth->seams.n; s++)
        if (seam_is_between(cloth->seams.seam + s, panel))
            some->number[some->n++] = s;
    if (some->n)
        return CLOTH_OK;
    return scene_tree_fail(tree, of,
                           "no seam of cloth '%.60s' is between a panel '%.60s' and one '%.60s'; a "
                           "panel's name is expected, in which * stands for any characters",
                           cloth->name, panel[0], panel[1]);
}

static int take_some(struct model_cloth *cloth, struct model_some_seams *some,
                     const struct scene_tree *tree, int node)
{
    const int of = scene_tree_get(tree, node, "of");
    const int numbers = scene_tree_get(tree, node, "numbers");
    const int code = of ? find_between(cloth, some, tree, of)
                        : check_numbers(cloth, some->number, some->n, tree, numbers);
    for (uint32_t i = 0; i < some->n && !code; i++)
        lay_over(&cloth->seams.seam[some->number[i]].sewing, &some->sewing, tree, node);
    return code;
}

static int take_sewing(struct model_cloth *cloth, const struct scene_tree *tree, int node)
{
    struct model_seams *seams = &cloth->seams;
    const int list = scene_tree_get(tree, node, "some");
    int code = CLOTH_OK;
    for (uint32_t s = 0; s < seams->n; s++) {
        seams->seam[s].sewing = (struct model_sewing){.damping = -1, .bending = -1};
        lay_over(&seams->seam[s].sewing, &seams->sewing, tree, node);
    }
    for (uint32_t i = 0; i < seams->n_some && !code; i++)
        code = take_some(cloth, seams->some + i, tree, scene_tree_item(tree, list, i));
    for (uint32_t s = 0; s < seams->n; s++) {
        struct model_sewing *sewing = &seams->seam[s].sewing;
        if (sewing->damping < 0) /* it is not given */
            sewing->damping = CLOSING * sewing->stiffness;
    }
    return code;
}

static void warn_of_unsure(const struct model_cloth *cloth, const struct scene_tree *tree, int node)
{
    char numbers[160] = "";
    size_t size = 0;
    uint32_t n = 0;
    for (uint32_t s = 0; s < cloth->seams.n; s++)
        if (cloth->seams.seam[s].unsure && cloth->seams.seam[s].sewing.state != MODEL_SEAMS_OPEN &&
            n++ < MOST_NAMED)
            size += (size_t)snprintf(numbers + size, sizeof numbers - size, " %u", s);
    if (n)
        scene_build_warn(tree, node,
                         "%u of the seams of cloth '%.60s' may be sewn the wrong way round, the "
                         "first are%s: how far partners are from each other does not tell, or "
                         "contradicts other seams, so the fronts of the panels decide; the summary "
                         "has the distances, and seams.reversed turns a seam",
                         n, cloth->name, numbers);
}

static int read_seams_file(struct model_cloth *cloth, struct scene_tree *tree, int node)
{
    char *path = scene_build_path(tree, node);
    const int code = path ? scene_read_seams(cloth, path, &tree->inner) : tree->error->code;
    free(path);
    return scene_build_blame(code, "seams", tree, node);
}

int scene_build_borders(struct model_cloth *cloth, struct scene_tree *tree, int of)
{
    const int file = scene_tree_at(tree, of, "seams.file");
    const bool pattern = scene_tree_at(tree, of, "mesh.pattern");
    if (file && pattern)
        return scene_tree_fail(tree, file,
                               "seams.file is of OBJ meshes; the seams of a pattern are its "
                               "stitches");
    return file ? read_seams_file(cloth, tree, file) : CLOTH_OK;
}

static int check_seams(const struct model_cloth *cloth, const struct scene_tree *tree, int of,
                       int node)
{
    if (scene_tree_get(tree, node, "file") || scene_tree_at(tree, of, "mesh.pattern"))
        return CLOTH_OK;
    return scene_tree_fail(tree, node,
                           "the mesh of cloth '%.60s' has no seams; a mesh.pattern, or seams.file "
                           "is expected",
                           cloth->name);
}

/* Welds come first: vertices that they make one are not pulled. */
int scene_build_seams(struct scene_tree *tree, uint32_t c, int of)
{
    struct model_cloth *cloth = tree->model->cloths + c;
    const int node = scene_tree_get(tree, of, "seams");
    if (!node)
        return CLOTH_OK;
    if (check_seams(cloth, tree, of, node) || reverse_some(cloth, tree, node) ||
        take_sewing(cloth, tree, node))
        return tree->error->code;
    warn_of_unsure(cloth, tree, node);
    return sew_state(c, MODEL_SEAMS_WELDED, tree, node) ||
           sew_state(c, MODEL_SEAMS_PULLED, tree, node);
}

/* ---- Vertices that meet as one ---- */

int scene_build_sewn(struct scene_tree *tree)
{
    struct model *model = tree->model;
    if (model->sewn > 0 && !model->n_pulled)
        return scene_tree_fail(tree, scene_tree_at(tree, 1, "time.sewn"),
                               "time.sewn waits for pulled seams, and the scene has none: a cloth "
                               "with seams: {state: pulled} is expected, or time.sewn: null in a "
                               "phase that has welded them");
    uint32_t *joined = model->n_pulled ? find_roots(model, tree->error) : NULL;
    model->contact.apart.joined = joined;
    for (uint32_t j = 0; joined && j < model->n_joints; j++)
        if (model->joints[j].pairs.seam)
            join_seam_pairs(model, &model->joints[j].pairs, joined);
    const uint32_t n = model_first(model, model->n_cloths);
    for (uint32_t v = 0; joined && v < n; v++)
        joined[v] = cloth_sets_root(joined, v);
    return tree->error->code;
}
