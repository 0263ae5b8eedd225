/* Probes. Their names stand in the header of a table, so they are words without commas or quotes.
 */
#include "cloth/scene/build/build.h"
#include "cloth/scene/schema/rules.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool is_word(const char *name)
{
    static const char allowed[] =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
    return strlen(name) <= 60 && strspn(name, allowed) == strlen(name);
}

static int name_probe(struct model *model, uint32_t i, const struct scene_tree *tree, int node,
                      struct cloth_error *error)
{
    char usual[32];
    snprintf(usual, sizeof usual, "probe%u", i + 1);
    const int at = scene_tree_get(tree, node, "name");
    const char *name = at ? model->probes[i].name : usual;
    if (!is_word(name))
        return scene_tree_fail(tree, at, error,
                               "the name of a probe is '%.60s'; at most 60 letters, digits, _ and "
                               "- are expected",
                               name);
    for (uint32_t j = 0; j < i; j++)
        if (!strcmp(model->probes[j].name, name))
            return scene_tree_fail(tree, at ? at : node, error,
                                   "a second probe is named '%.60s'; names must differ", name);
    if (!at)
        model->probes[i].name = scene_build_copy(name, error);
    return model->probes[i].name ? CLOTH_OK : error->code;
}

/* A value says where its flag is. */
static int build_values(struct model_probe *probe, const struct scene_tree *tree, int list,
                        struct cloth_error *error)
{
    for (size_t i = 0; i < scene_tree_length(tree, list); i++) {
        const int item = scene_tree_item(tree, list, i);
        const char *word = scene_tree_scalar(tree, item);
        bool *value = (bool *)((char *)probe + scene_word_value(scene_probe_values, word, NULL));
        if (*value)
            return scene_tree_fail(tree, item, error, "%s stands twice in the values of a probe",
                                   word);
        *value = true;
    }
    return CLOTH_OK;
}

/* The node that asks for the force of contact; 0: none does. */
static int contact_at(const struct model_probe *probe, const struct scene_tree *tree, int node)
{
    return probe->by_obstacle                       ? scene_tree_get(tree, node, "obstacle")
           : probe->contact || probe->contact_total ? scene_tree_get(tree, node, "values")
                                                    : 0;
}

static int check_contact(const struct model *model, const struct model_probe *probe,
                         const struct scene_tree *tree, int node, struct cloth_error *error)
{
    const int at = contact_at(probe, tree, node);
    if (!at || model_promise(model).force)
        return CLOTH_OK;
    return scene_tree_fail(tree, at, error,
                           "probe '%.60s' reports the force of contact, which contact.mode "
                           "certified knows; here it is %s, which reports none",
                           probe->name, model_contact_name(model));
}

static int no_obstacle(const struct model *model, const char *name, const struct scene_tree *tree,
                       int node, struct cloth_error *error)
{
    const char **names = scene_build_array(model->n_obstacles, sizeof *names, error);
    size_t n = 0;
    if (!names)
        return error->code;
    for (uint32_t i = 0; i < model->n_obstacles; i++)
        if (model->obstacle_names[i])
            names[n++] = model->obstacle_names[i];
    const int code =
        n ? scene_build_no_such("obstacle", name, names, n, tree, node, error)
          : scene_tree_fail(tree, node, error,
                            "there is no obstacle '%.60s'; there are %u, counted from 0, and none "
                            "has a name",
                            name, model->n_obstacles);
    free(names);
    return code;
}

/* By its name, or its number. */
static int find_obstacle(const struct model *model, uint32_t *obstacle,
                         const struct scene_tree *tree, int node, struct cloth_error *error)
{
    const char *text = scene_tree_scalar(tree, node);
    for (uint32_t i = 0; i < model->n_obstacles; i++) {
        char number[16];
        snprintf(number, sizeof number, "%u", i);
        *obstacle = i;
        if (!strcmp(text, number) ||
            (model->obstacle_names[i] && !strcmp(text, model->obstacle_names[i])))
            return CLOTH_OK;
    }
    return no_obstacle(model, text, tree, node, error);
}

/* It has no vertices, and one value. */
static int build_obstacle(const struct model *model, struct model_probe *probe,
                          const struct scene_tree *tree, int node, struct cloth_error *error)
{
    static const char *const others[] = {"cloth", "values"};
    if (find_obstacle(model, &probe->obstacle, tree, scene_tree_get(tree, node, "obstacle"), error))
        return error->code;
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        const int at = scene_tree_get(tree, node, others[i]);
        if (at && scene_tree_node(tree, at)->start_mark.index != SCENE_BY_DEFAULT)
            return scene_tree_fail(tree, at, error,
                                   "probe '%.60s' is of an obstacle: its force on all cloth is "
                                   "reported, and %s means nothing",
                                   probe->name, others[i]);
    }
    return check_contact(model, probe, tree, node, error);
}

static int build_probe(struct model *model, uint32_t i, const struct scene_tree *tree, int node,
                       uint32_t *seen, struct cloth_error *error)
{
    struct model_probe *probe = &model->probes[i];
    int code = name_probe(model, i, tree, node, error);
    if (!code && probe->by_obstacle)
        return build_obstacle(model, probe, tree, node, error);
    if (!code)
        code = scene_build_cloth_of(&probe->cloth, "a probe", model, tree, node, error);
    if (!code)
        code = scene_build_pick(&probe->pick, tree, node, model->cloths + probe->cloth, error);
    if (!code) /* it would be two columns of one name */
        code = scene_build_once(&probe->pick, tree, node, seen, i + 1, "one probe", error);
    if (!code)
        code = build_values(probe, tree, scene_tree_get(tree, node, "values"), error);
    return code ? code : check_contact(model, probe, tree, node, error);
}

int scene_build_probes(struct model *model, const struct scene_tree *tree,
                       struct cloth_error *error)
{
    int list = scene_tree_get(tree, 1, "probes"), code = CLOTH_OK;
    const uint32_t n = model->n_probes;
    uint32_t max = 0;
    for (uint32_t c = 0; c < model->n_cloths; c++)
        max = model->cloths[c].mesh.n_vertices > max ? model->cloths[c].mesh.n_vertices : max;
    uint32_t *seen = scene_build_array(n ? max : 0, sizeof *seen, error);
    if (!seen)
        return error->code;
    for (uint32_t i = 0; !code && i < n; i++)
        code = build_probe(model, i, tree, scene_tree_item(tree, list, i), seen, error);
    free(seen);
    return code;
}
