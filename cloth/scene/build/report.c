/* What a run reports: probes, the fields of scientific frames, the drape test. What a scene cannot
 * have is an error: users do not notice a field that a run leaves out. */
#include "cloth/scene/build/build.h"
#include "cloth/scene/schema/rules.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Sets the flags of a structure that a list of words asks for; a word says where its flag is. what:
 * "the values of a probe". */
static int build_flags(void *base, const struct model_word *words, const char *what,
                       const struct scene_tree *tree, int list, struct cloth_error *error)
{
    for (size_t i = 0; i < scene_tree_length(tree, list); i++) {
        const int item = scene_tree_item(tree, list, i);
        const char *word = scene_tree_scalar(tree, item);
        bool *flag = (bool *)((char *)base + scene_word_value(words, word, NULL));
        if (*flag)
            return scene_tree_fail(tree, item, error, "%s stands twice in %s", word, what);
        *flag = true;
    }
    return CLOTH_OK;
}

/* ---- Probes ---- */

/* Names of probes stand in the header of a table, so they have no commas or quotes. */
static bool is_header_word(const char *name)
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
    if (!is_header_word(name))
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

/* By its name, or its number. */
static int find_obstacle(const struct model *model, uint32_t *obstacle,
                         const struct scene_tree *tree, int node, struct cloth_error *error)
{
    const char *text = scene_tree_scalar(tree, node);
    for (uint32_t i = 0; i < model->n_obstacles; i++) {
        char number[16];
        snprintf(number, sizeof number, "%u", i);
        *obstacle = i;
        if (!strcmp(text, number))
            return CLOTH_OK;
    }
    *obstacle = scene_build_obstacle_named(model, text);
    return *obstacle != UINT32_MAX ? CLOTH_OK : scene_build_no_obstacle(model, tree, node, error);
}

/* One of an obstacle has no vertices, and one value. */
static int build_obstacle(const struct model *model, struct model_probe *probe,
                          const struct scene_tree *tree, int node, struct cloth_error *error)
{
    static const char *const others[] = {"cloth", "values"};
    if (find_obstacle(model, &probe->obstacle, tree, scene_tree_get(tree, node, "obstacle"), error))
        return error->code;
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        const int at = scene_tree_get(tree, node, others[i]);
        if (scene_tree_is_given(tree, at))
            return scene_tree_fail(tree, at, error,
                                   "probe '%.60s' is of an obstacle: its force on all cloth is "
                                   "reported, and %s means nothing",
                                   probe->name, others[i]);
    }
    return check_contact(model, probe, tree, node, error);
}

static int build_probe(struct model *model, uint32_t i, const struct scene_tree *tree, int node,
                       struct cloth_error *error)
{
    struct model_probe *probe = &model->probes[i];
    int code = name_probe(model, i, tree, node, error);
    if (!code && probe->by_obstacle)
        return build_obstacle(model, probe, tree, node, error);
    if (!code)
        code = scene_build_cloth_of(&probe->cloth, "a probe", model, tree, node, error);
    if (!code) /* a vertex twice would be two columns of one name */
        code = scene_build_pick_once(&probe->pick, tree, node, model->cloths + probe->cloth,
                                     "one probe", error);
    if (!code)
        code = build_flags(probe, scene_probe_values, "the values of a probe", tree,
                           scene_tree_get(tree, node, "values"), error);
    return code ? code : check_contact(model, probe, tree, node, error);
}

int scene_build_probes(struct model *model, struct scene_tree *tree, struct cloth_error *error)
{
    int list = scene_tree_get(tree, 1, "probes"), code = CLOTH_OK;
    for (uint32_t i = 0; !code && i < model->n_probes; i++)
        code = build_probe(model, i, tree, scene_tree_item(tree, list, i), error);
    return code;
}

/* ---- Scientific frames ---- */

static int check_field(const struct model *model, const struct scene_tree *tree, int item,
                       struct cloth_error *error)
{
    const char *word = scene_tree_scalar(tree, item);
    bool triangles = false;
    for (uint32_t c = 0; c < model->n_cloths; c++)
        triangles = triangles || model_has_triangles(model, model->cloths + c);
    if (!strcmp(word, "stress") && !triangles)
        return scene_tree_fail(tree, item, error,
                               "output.hdf5 has the field %s, which materials with model: "
                               "triangles have; no cloth has one",
                               word);
    if (!strcmp(word, "contact_force") && !model_shows_contact(model))
        return scene_tree_fail(tree, item, error,
                               "output.hdf5 has the field %s, which contact: {mode: certified, "
                               "force: on} knows, where there is anything to touch",
                               word);
    return CLOTH_OK;
}

int scene_build_hdf5(struct model *model, struct scene_tree *tree, struct cloth_error *error)
{
    const int output = scene_tree_get(tree, 1, "output");
    const int list = scene_tree_get(tree, scene_tree_get(tree, output, "hdf5"), "fields");
    int code = build_flags(&model->hdf5, scene_hdf5_fields, "the fields of output.hdf5", tree, list,
                           error);
    for (size_t i = 0; i < scene_tree_length(tree, list) && !code; i++)
        code = check_field(model, tree, scene_tree_item(tree, list, i), error);
    return code;
}

/* ---- The drape test ---- */

/* A drape test has a border to look at: its cloth is larger than the disc that carries it. */
int scene_build_drape(struct model *model, struct scene_tree *tree, struct cloth_error *error)
{
    struct model_drape *drape = &model->drape;
    const int node = scene_tree_get(tree, 1, "drape");
    if (!node)
        return CLOTH_OK;
    int code = scene_build_cloth_of(&drape->cloth, "drape", model, tree, node, error);
    if (!code)
        code = scene_build_direction(drape->axis, "drape.axis", tree,
                                     scene_tree_get(tree, node, "axis"), error);
    if (code)
        return code;
    const struct model_cloth *cloth = model->cloths + drape->cloth;
    const double area = model_area(cloth), disc = model_disc(drape);
    if (disc < area)
        return CLOTH_OK;
    return scene_tree_fail(tree, scene_tree_get(tree, node, "radius"), error,
                           "drape.radius is %g m, a disc of %.3g m2; the triangles of cloth "
                           "'%.60s' have %.3g m2: a smaller disc is expected",
                           drape->radius, disc, cloth->name, area);
}
