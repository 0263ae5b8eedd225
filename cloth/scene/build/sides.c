/* Obstacles and sides of contacts by their names. contact.pairs gives two of them a coefficient:
 * materials and obstacles. contact.ignore keeps two from meeting: cloths, obstacles and groups of
 * both. A name of several is all of them. */
#include "cloth/scene/build/build.h"

#include <stdlib.h>
#include <string.h>

/* ---- Obstacles ---- */

uint32_t scene_build_obstacle_named(const struct model *model, const char *name)
{
    for (uint32_t i = 0; i < model->n_obstacles; i++)
        if (model->obstacle_names[i] && !strcmp(model->obstacle_names[i], name))
            return i;
    return UINT32_MAX;
}

size_t scene_build_add_obstacles(const struct model *model, size_t n, const char **names)
{
    for (uint32_t i = 0; i < model->n_obstacles; i++)
        if (model->obstacle_names[i])
            names[n++] = model->obstacle_names[i];
    return n;
}

int scene_build_no_obstacle(const struct model *model, const struct scene_tree *tree, int node,
                            struct cloth_error *error)
{
    const char *name = scene_tree_scalar(tree, node);
    const char **names = scene_build_array(model->n_obstacles, sizeof *names, error);
    if (!names)
        return error->code;
    const size_t n = scene_build_add_obstacles(model, 0, names);
    const int code =
        n ? scene_build_no_such("obstacle", name, names, n, tree, node, error)
          : scene_tree_fail(tree, node, error,
                            "there is no obstacle '%.60s'; there are %u, counted from 0, "
                            "and none has a name",
                            name, model->n_obstacles);
    free(names);
    return code;
}

/* ---- Coefficients ---- */

static int no_surface(const struct model *model, const char *name, const struct scene_tree *tree,
                      int node, struct cloth_error *error)
{
    const char **names =
        scene_build_array((size_t)model->n_materials + model->n_obstacles, sizeof *names, error);
    if (!names)
        return error->code;
    for (uint32_t i = 0; i < model->n_materials; i++)
        names[i] = model->materials[i].name;
    const size_t n = scene_build_add_obstacles(model, model->n_materials, names);
    const int code = scene_build_no_such("material or obstacle", name, names, n, tree, node, error);
    free(names);
    return code;
}

static int find_surface(const struct model *model, uint32_t *number, const struct scene_tree *tree,
                        int node, struct cloth_error *error)
{
    const char *name = scene_tree_scalar(tree, node);
    for (uint32_t i = 0; i < model->n_materials; i++)
        if (!strcmp(model->materials[i].name, name)) {
            *number = i;
            return CLOTH_OK;
        }
    const uint32_t obstacle = scene_build_obstacle_named(model, name);
    *number = model->n_materials + obstacle;
    return obstacle != UINT32_MAX ? CLOTH_OK : no_surface(model, name, tree, node, error);
}

static bool build_sides_is_of(const struct model_rub *pair, const uint32_t of[2])
{
    return (pair->of[0] == of[0] && pair->of[1] == of[1]) ||
           (pair->of[0] == of[1] && pair->of[1] == of[0]);
}

static int build_pair(struct model *model, uint32_t i, const struct scene_tree *tree, int node,
                      struct cloth_error *error)
{
    struct model_rub *pairs = model->contact.pairs;
    const int of = scene_tree_get(tree, node, "of");
    int code = CLOTH_OK;
    for (size_t k = 0; k < 2 && !code; k++)
        code = find_surface(model, pairs[i].of + k, tree, scene_tree_item(tree, of, k), error);
    for (uint32_t k = 0; k < i && !code; k++)
        if (build_sides_is_of(pairs + k, pairs[i].of))
            code = scene_tree_fail(tree, of, error,
                                   "contact.pairs[%u] and contact.pairs[%u] are of the same two; "
                                   "one is expected",
                                   k, i);
    if (code || pairs[i].of[0] < model->n_materials || pairs[i].of[1] < model->n_materials)
        return code;
    return scene_build_warn(model, tree, of, error,
                            "contact.pairs[%u] means nothing: obstacles do not touch each other",
                            i);
}

/* ---- Sides that do not meet ---- */

/* The list of the groups of a side, cloths before obstacles. */
static int groups_of(const struct model *model, const struct scene_tree *tree, uint32_t side)
{
    const bool cloth = side < model->n_cloths;
    const int list = scene_tree_get(tree, 1, cloth ? "cloths" : "obstacles");
    const int item = scene_tree_item(tree, list, cloth ? side : side - model->n_cloths);
    const int map = cloth ? item : scene_tree_pair(tree, item, 0).value;
    return scene_tree_get(tree, map, "groups");
}

/* True if a name is that of a side or of one of its groups. */
static bool is_side(const struct model *model, const struct scene_tree *tree, uint32_t side,
                    const char *name)
{
    const char *own = side < model->n_cloths ? model->cloths[side].name
                                             : model->obstacle_names[side - model->n_cloths];
    const int groups = groups_of(model, tree, side);
    bool is = own && !strcmp(own, name);
    for (size_t k = 0; k < scene_tree_length(tree, groups); k++)
        is = is || !strcmp(scene_tree_scalar(tree, scene_tree_item(tree, groups, k)), name);
    return is;
}

/* Adds the groups of a list that are not yet among the first n names. Returns how many there are
 * then. */
static size_t add_groups(const struct scene_tree *tree, int groups, size_t n, const char **names)
{
    for (size_t k = 0; k < scene_tree_length(tree, groups); k++) {
        const char *name = scene_tree_scalar(tree, scene_tree_item(tree, groups, k));
        size_t i = 0;
        while (i < n && strcmp(names[i], name) != 0)
            i++;
        names[n] = name;
        n += i == n;
    }
    return n;
}

static int check_side(const struct model *model, const struct scene_tree *tree, int node,
                      struct cloth_error *error)
{
    const uint32_t n_sides = model->n_cloths + model->n_obstacles;
    const char *name = scene_tree_scalar(tree, node);
    size_t room = n_sides;
    for (uint32_t i = 0; i < n_sides; i++) {
        if (is_side(model, tree, i, name))
            return CLOTH_OK;
        room += scene_tree_length(tree, groups_of(model, tree, i));
    }
    const char **names = scene_build_array(room, sizeof *names, error);
    if (!names)
        return error->code;
    for (uint32_t i = 0; i < model->n_cloths; i++)
        names[i] = model->cloths[i].name;
    size_t n = scene_build_add_obstacles(model, model->n_cloths, names);
    for (uint32_t i = 0; i < n_sides; i++)
        n = add_groups(tree, groups_of(model, tree, i), n, names);
    const int code =
        scene_build_no_such("cloth, obstacle or group", name, names, n, tree, node, error);
    free(names);
    return code;
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

static int ignore_pair(struct model *model, const struct scene_tree *tree, int node,
                       struct cloth_error *error)
{
    const uint32_t n_sides = model->n_cloths + model->n_obstacles;
    const int name[2] = {scene_tree_item(tree, node, 0), scene_tree_item(tree, node, 1)};
    bool any = false;
    int code = check_side(model, tree, name[0], error);
    if (!code)
        code = check_side(model, tree, name[1], error);
    for (uint32_t a = 0; a < n_sides && !code; a++)
        for (uint32_t b = 0; b < n_sides; b++)
            if (is_side(model, tree, a, scene_tree_scalar(tree, name[0])) &&
                is_side(model, tree, b, scene_tree_scalar(tree, name[1])))
                any |= mark_apart(&model->contact.apart, a, b);
    if (code || any)
        return code;
    return scene_build_warn(model, tree, node, error,
                            "contact.ignore means nothing here: obstacles do not touch each other");
}

/* ignores: some sides do not meet. */
static int build_apart(struct model *model, bool ignores, struct cloth_error *error)
{
    struct contact_apart *all = &model->contact.apart;
    all->n_cloths = model->n_cloths;
    all->n_obstacles = model->n_obstacles;
    all->end = scene_build_array(model->n_cloths, sizeof *all->end, error);
    for (uint32_t c = 0; c < model->n_cloths && all->end; c++)
        all->end[c] = model_first(model, c + 1);
    if (ignores)
        all->apart = scene_build_array(
            (size_t)model->n_cloths * (model->n_cloths + model->n_obstacles), 1, error);
    return all->end && (all->apart || !ignores) ? CLOTH_OK : error->code;
}

int scene_build_sides(struct model *model, struct scene_tree *tree, struct cloth_error *error)
{
    const int contact = scene_tree_get(tree, 1, "contact");
    const int pairs = scene_tree_get(tree, contact, "pairs");
    const int ignored = scene_tree_get(tree, contact, "ignore");
    const size_t n_ignored = scene_tree_length(tree, ignored);
    int code = CLOTH_OK;
    for (uint32_t i = 0; i < model->contact.n_pairs && !code; i++)
        code = build_pair(model, i, tree, scene_tree_item(tree, pairs, i), error);
    if (!code)
        code = build_apart(model, n_ignored, error);
    for (size_t i = 0; i < n_ignored && !code; i++)
        code = ignore_pair(model, tree, scene_tree_item(tree, ignored, i), error);
    return code;
}
