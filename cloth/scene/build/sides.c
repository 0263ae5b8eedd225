/* Sides of contacts by their names. contact.pairs gives two of them a coefficient: materials and
 * obstacles. contact.ignore keeps two from meeting: cloths, obstacles and groups of both. A name of
 * several is all of them. */
#include "cloth/scene/build/build.h"

#include <string.h>

/* ---- Coefficients ---- */

static int find_surface(uint32_t *number, const struct scene_tree *tree, int node)
{
    const struct model *model = tree->model;
    const char *name = scene_tree_scalar(tree, node);
    *number = scene_build_find(model, SCENE_MATERIALS, name);
    if (*number != UINT32_MAX)
        return CLOTH_OK;
    const uint32_t obstacle = scene_build_find(model, SCENE_OBSTACLES, name);
    *number = model->n_materials + obstacle;
    return obstacle == UINT32_MAX
               ? scene_build_no_name(tree, node, "material or obstacle",
                                     1U << SCENE_MATERIALS | 1U << SCENE_OBSTACLES)
               : CLOTH_OK;
}

static bool is_pair_of(const struct model_rub *pair, const uint32_t of[2])
{
    return (pair->of[0] == of[0] && pair->of[1] == of[1]) ||
           (pair->of[0] == of[1] && pair->of[1] == of[0]);
}

static int build_pair(uint32_t i, const struct scene_tree *tree, int node)
{
    const struct model *model = tree->model;
    struct model_rub *pairs = model->contact.pairs;
    const int of = scene_tree_get(tree, node, "of");
    int code = CLOTH_OK;
    for (size_t k = 0; k < 2 && !code; k++)
        code = find_surface(pairs[i].of + k, tree, scene_tree_item(tree, of, k));
    for (uint32_t k = 0; k < i && !code; k++)
        if (is_pair_of(pairs + k, pairs[i].of))
            code = scene_tree_fail(tree, of,
                                   "contact.pairs[%u] and contact.pairs[%u] are of the same two; "
                                   "one is expected",
                                   k, i);
    if (code || pairs[i].of[0] < model->n_materials || pairs[i].of[1] < model->n_materials)
        return code;
    return scene_build_warn(
        tree, of, "contact.pairs[%u] means nothing: obstacles do not touch each other", i);
}

/* ---- Sides that do not meet ---- */

/* True if a name is that of a side or of one of its groups. */
static bool is_side(const struct scene_tree *tree, uint32_t side, const char *name)
{
    const struct model *model = tree->model;
    const char *own = side < model->n_cloths ? model->cloths[side].name
                                             : model->obstacle_names[side - model->n_cloths];
    const int groups = scene_build_groups(tree, side);
    bool is = own && !strcmp(own, name);
    for (size_t k = 0; k < scene_tree_length(tree, groups); k++)
        is = is || !strcmp(scene_tree_scalar(tree, scene_tree_item(tree, groups, k)), name);
    return is;
}

static int check_side(const struct scene_tree *tree, int node)
{
    for (uint32_t i = 0; i < tree->model->n_cloths + tree->model->n_obstacles; i++)
        if (is_side(tree, i, scene_tree_scalar(tree, node)))
            return CLOTH_OK;
    return scene_build_no_name(tree, node, "cloth, obstacle or group",
                               1U << SCENE_CLOTHS | 1U << SCENE_OBSTACLES | 1U << SCENE_GROUPS);
}

/* Marks a cloth and another side, both ways. Returns false if neither is a cloth. */
static bool mark_apart(struct contact_apart *all, uint32_t a, uint32_t b)
{
    const size_t n_sides = (size_t)all->n_cloths + all->n_obstacles;
    if (a < all->n_cloths)
        all->apart[a * n_sides + b] = 1;
    if (b < all->n_cloths)
        all->apart[b * n_sides + a] = 1;
    return a < all->n_cloths || b < all->n_cloths;
}

static int ignore_pair(const struct scene_tree *tree, int node)
{
    struct model *model = tree->model;
    const uint32_t n_sides = model->n_cloths + model->n_obstacles;
    const int name[2] = {scene_tree_item(tree, node, 0), scene_tree_item(tree, node, 1)};
    bool any = false;
    int code = check_side(tree, name[0]) || check_side(tree, name[1]);
    for (uint32_t a = 0; a < n_sides && !code; a++)
        for (uint32_t b = 0; b < n_sides; b++)
            if (is_side(tree, a, scene_tree_scalar(tree, name[0])) &&
                is_side(tree, b, scene_tree_scalar(tree, name[1])))
                any |= mark_apart(&model->contact.apart, a, b);
    if (code || any)
        return code;
    return scene_build_warn(tree, node,
                            "contact.ignore means nothing here: obstacles do not touch each other");
}

/* ignores: some sides do not meet. */
static int build_apart(struct model *model, bool ignores, struct cloth_error *error)
{
    struct contact_apart *all = &model->contact.apart;
    all->n_cloths = model->n_cloths;
    all->n_obstacles = model->n_obstacles;
    all->end = cloth_alloc(model->n_cloths, sizeof *all->end, error);
    for (uint32_t c = 0; c < model->n_cloths && all->end; c++)
        all->end[c] = model_first(model, c + 1);
    if (ignores)
        all->apart =
            cloth_alloc((size_t)model->n_cloths * (model->n_cloths + model->n_obstacles), 1, error);
    return error->code;
}

int scene_build_sides(struct scene_tree *tree)
{
    const int pairs = scene_tree_at(tree, 1, "contact.pairs");
    const int ignored = scene_tree_at(tree, 1, "contact.ignore");
    const size_t n_ignored = scene_tree_length(tree, ignored);
    int code = CLOTH_OK;
    for (uint32_t i = 0; i < tree->model->contact.n_pairs && !code; i++)
        code = build_pair(i, tree, scene_tree_item(tree, pairs, i));
    code = code || build_apart(tree->model, n_ignored, tree->error);
    for (size_t i = 0; i < n_ignored && !code; i++)
        code = ignore_pair(tree, scene_tree_item(tree, ignored, i));
    return code;
}
