/* Names of the parts of a scene. Those of one kind differ. Only obstacles may have none. */
#include "cloth/scene/build/build.h"
#include "cloth/scene/schema/rules.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static uint32_t named_count(const struct model *model, enum scene_named kind)
{
    const uint32_t n[] = {[SCENE_CLOTHS] = model->n_cloths,
                          [SCENE_MATERIALS] = model->n_materials,
                          [SCENE_OBSTACLES] = model->n_obstacles,
                          [SCENE_PROBES] = model->n_probes};
    return n[kind];
}

static char **named_at(const struct model *model, enum scene_named kind, uint32_t i)
{
    return kind == SCENE_CLOTHS      ? &model->cloths[i].name
           : kind == SCENE_MATERIALS ? &model->materials[i].name
           : kind == SCENE_OBSTACLES ? &model->obstacle_names[i]
                                     : &model->probes[i].name;
}

uint32_t scene_build_find(const struct model *model, enum scene_named kind, const char *name)
{
    for (uint32_t i = 0; i < named_count(model, kind); i++) {
        const char *other = *named_at(model, kind, i);
        if (other && !strcmp(other, name))
            return i;
    }
    return UINT32_MAX;
}

int scene_build_name(const struct scene_tree *tree, enum scene_named kind, uint32_t i, int node)
{
    static const char *const nouns[] = {
        [SCENE_CLOTHS] = "cloth", [SCENE_OBSTACLES] = "obstacle", [SCENE_PROBES] = "probe"};
    const int at = scene_tree_get(tree, node, "name");
    char usual[32], **name = named_at(tree->model, kind, i);
    snprintf(usual, sizeof usual, "%s%u", nouns[kind], i + 1);
    if (!*name)
        *name = scene_build_copy(at ? scene_tree_scalar(tree, at) : usual, tree->error);
    if (!*name)
        return tree->error->code;
    if (scene_build_find(tree->model, kind, *name) >= i)
        return CLOTH_OK;
    return scene_tree_fail(tree, at ? at : node, "a second %s is named '%.60s'; names must differ",
                           nouns[kind], *name);
}

/* ---- Names that are none ---- */

int scene_build_no_such(const struct scene_tree *tree, int node, const char *what,
                        const char *const *names, size_t n)
{
    const char *name = scene_tree_scalar(tree, node);
    char allowed[400];
    scene_allowed_words(name, names, n, allowed, sizeof allowed);
    return scene_tree_fail(tree, node, "there is no %s '%.60s'%s", what, name, allowed);
}

int scene_build_groups(const struct scene_tree *tree, uint32_t side)
{
    const uint32_t n_cloths = tree->model->n_cloths;
    const bool cloth = side < n_cloths;
    const int list = scene_tree_get(tree, 1, cloth ? "cloths" : "obstacles");
    const int item = scene_tree_item(tree, list, cloth ? side : side - n_cloths);
    return scene_tree_get(tree, cloth ? item : scene_tree_pair(tree, item, 0).value, "groups");
}

/* A list has each name once. */
static void list_name(struct cloth_list *names, const char *name, struct cloth_error *error)
{
    const char **all = names->items;
    for (size_t i = 0; i < names->n; i++)
        if (!strcmp(all[i], name))
            return;
    const char **last = cloth_list_add(names, sizeof *last, 1, error);
    if (last)
        *last = name;
}

static void list_groups(struct cloth_list *names, const struct scene_tree *tree)
{
    for (uint32_t side = 0; side < tree->model->n_cloths + tree->model->n_obstacles; side++) {
        const int groups = scene_build_groups(tree, side);
        for (size_t i = 0; i < scene_tree_length(tree, groups); i++)
            list_name(names, scene_tree_scalar(tree, scene_tree_item(tree, groups, i)),
                      tree->error);
    }
}

int scene_build_no_name(const struct scene_tree *tree, int node, const char *what, unsigned kinds)
{
    const struct model *model = tree->model;
    struct cloth_list names = {0};
    for (enum scene_named kind = SCENE_CLOTHS; kind <= SCENE_PROBES; kind++)
        for (uint32_t i = 0; kinds & 1U << kind && i < named_count(model, kind); i++)
            if (*named_at(model, kind, i))
                list_name(&names, *named_at(model, kind, i), tree->error);
    for (size_t i = 0; kinds & 1U << SCENE_FABRICS && scene_fabrics[i].word; i++)
        list_name(&names, scene_fabrics[i].word, tree->error);
    if (kinds & 1U << SCENE_GROUPS)
        list_groups(&names, tree);
    if (names.n && !tree->error->code)
        scene_build_no_such(tree, node, what, names.items, names.n);
    else
        scene_tree_fail(tree, node,
                        "there is no obstacle '%.60s'; there are %u, counted from 0, and none has "
                        "a name",
                        scene_tree_scalar(tree, node), model->n_obstacles);
    free(names.items);
    return tree->error->code;
}

/* ---- Keys that are names ---- */

int scene_build_cloth_of(uint32_t *cloth, const char *what, const struct scene_tree *tree, int node)
{
    const struct model *model = tree->model;
    const int at = scene_tree_get(tree, node, "cloth");
    *cloth = 0;
    if (!at && model->n_cloths == 1)
        return CLOTH_OK;
    if (!at)
        return scene_tree_fail(tree, node, "%s does not name its cloth, of which there are %u",
                               what, model->n_cloths);
    *cloth = scene_build_find(model, SCENE_CLOTHS, scene_tree_scalar(tree, at));
    return *cloth == UINT32_MAX ? scene_build_no_name(tree, at, "cloth", 1U << SCENE_CLOTHS)
                                : CLOTH_OK;
}

int scene_build_material(uint32_t *material, const struct model_cloth *cloth,
                         const struct scene_tree *tree, int node)
{
    const int at = scene_tree_get(tree, node, "material");
    *material = scene_build_find(tree->model, SCENE_MATERIALS, scene_tree_scalar(tree, at));
    if (*material == UINT32_MAX)
        return scene_build_no_name(tree, at, "material",
                                   1U << SCENE_MATERIALS | 1U << SCENE_FABRICS);
    const struct model_material *found = tree->model->materials + *material;
    if (found->density > 0 || cloth->mass_per_vertex > 0)
        return CLOTH_OK;
    return scene_tree_fail(tree, at,
                           "material '%.60s' has no density and the cloth no mass_per_vertex; one "
                           "of them is expected",
                           found->name);
}
