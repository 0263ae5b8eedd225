/* The report of a run: probes, the fields of scientific frames, the drape test. A field that a
 * scene cannot have is an error: users do not notice a field that a run leaves out. */
#include "cloth/scene/build/build.h"
#include "cloth/scene/schema/rules.h"

#include <stdio.h>
#include <string.h>

/* Sets the flags of a structure that a list of words asks for; a word says where its flag is. what:
 * "the values of a probe". */
static int build_flags(void *base, const struct model_word *words, const char *what,
                       const struct scene_tree *tree, int list)
{
    for (size_t i = 0; i < scene_tree_length(tree, list); i++) {
        const int item = scene_tree_item(tree, list, i);
        const char *word = scene_tree_scalar(tree, item);
        bool *flag = (bool *)((char *)base + scene_word_value(words, word, NULL));
        if (*flag)
            return scene_tree_fail(tree, item, "%s stands twice in %s", word, what);
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

/* The node that asks for the force of contact; 0: none does. */
static int contact_at(const struct model_probe *probe, const struct scene_tree *tree, int node)
{
    return probe->by_obstacle                       ? scene_tree_get(tree, node, "obstacle")
           : probe->contact || probe->contact_total ? scene_tree_get(tree, node, "values")
                                                    : 0;
}

static int check_contact(const struct model_probe *probe, const struct scene_tree *tree, int node)
{
    const int at = contact_at(probe, tree, node);
    if (!at || model_promise(tree->model).force)
        return CLOTH_OK;
    return scene_tree_fail(tree, at,
                           "probe '%.60s' reports the force of contact, which contact.mode "
                           "certified knows; here it is %s, which reports none",
                           probe->name, model_contact_name(tree->model));
}

/* By its name, or its number. */
static int find_obstacle(uint32_t *obstacle, const struct scene_tree *tree, int node)
{
    const char *text = scene_tree_scalar(tree, node);
    for (*obstacle = 0; *obstacle < tree->model->n_obstacles; ++*obstacle) {
        char number[16];
        snprintf(number, sizeof number, "%u", *obstacle);
        if (!strcmp(text, number))
            return CLOTH_OK;
    }
    *obstacle = scene_build_find(tree->model, SCENE_OBSTACLES, text);
    return *obstacle == UINT32_MAX
               ? scene_build_no_name(tree, node, "obstacle", 1U << SCENE_OBSTACLES)
               : CLOTH_OK;
}

/* One of an obstacle has no vertices, and one value. */
static int build_obstacle(struct model_probe *probe, const struct scene_tree *tree, int node)
{
    static const char *const others[] = {"cloth", "values"};
    if (find_obstacle(&probe->obstacle, tree, scene_tree_get(tree, node, "obstacle")))
        return tree->error->code;
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        const int at = scene_tree_get(tree, node, others[i]);
        if (scene_tree_is_given(tree, at))
            return scene_tree_fail(tree, at,
                                   "probe '%.60s' is of an obstacle: its force on all cloth is "
                                   "reported, and %s means nothing",
                                   probe->name, others[i]);
    }
    return check_contact(probe, tree, node);
}

static int build_probe(uint32_t i, const struct scene_tree *tree, int node)
{
    struct model_probe *probe = &tree->model->probes[i];
    if (probe->name && !is_header_word(probe->name))
        return scene_tree_fail(tree, scene_tree_get(tree, node, "name"),
                               "the name of a probe is '%.60s'; at most 60 letters, digits, _ and "
                               "- are expected",
                               probe->name);
    if (scene_build_name(tree, SCENE_PROBES, i, node))
        return tree->error->code;
    if (probe->by_obstacle)
        return build_obstacle(probe, tree, node);
    return scene_build_cloth_of(&probe->cloth, "a probe", tree, node) ||
           /* a vertex twice would be two columns of one name */
           scene_build_pick_once(&probe->pick, tree, node, tree->model->cloths + probe->cloth,
                                 "one probe") ||
           build_flags(probe, scene_probe_values, "the values of a probe", tree,
                       scene_tree_get(tree, node, "values")) ||
           check_contact(probe, tree, node);
}

int scene_build_probes(struct scene_tree *tree)
{
    int list = scene_tree_get(tree, 1, "probes"), code = CLOTH_OK;
    for (uint32_t i = 0; !code && i < tree->model->n_probes; i++)
        code = build_probe(i, tree, scene_tree_item(tree, list, i));
    return code;
}

/* ---- Scientific frames ---- */

static int check_field(const struct scene_tree *tree, int item)
{
    const struct model *model = tree->model;
    const char *word = scene_tree_scalar(tree, item);
    bool triangles = false;
    for (uint32_t c = 0; c < model->n_cloths; c++)
        triangles = triangles || model_has_triangles(model, model->cloths + c);
    if (!strcmp(word, "stress") && !triangles)
        return scene_tree_fail(tree, item,
                               "output.hdf5 has the field %s, which materials with model: "
                               "triangles have; no cloth has one",
                               word);
    if (!strcmp(word, "contact_force") && !model_shows_contact(model))
        return scene_tree_fail(tree, item,
                               "output.hdf5 has the field %s, which contact: {mode: certified, "
                               "force: on} knows, where there is anything to touch",
                               word);
    return CLOTH_OK;
}

int scene_build_hdf5(struct scene_tree *tree)
{
    const int list = scene_tree_at(tree, 1, "output.hdf5.fields");
    int code =
        build_flags(&tree->model->hdf5, scene_hdf5_fields, "the fields of output.hdf5", tree, list);
    for (size_t i = 0; i < scene_tree_length(tree, list) && !code; i++)
        code = check_field(tree, scene_tree_item(tree, list, i));
    return code;
}

/* ---- The drape test ---- */

/* A drape test has a border to look at: its cloth is larger than the disc that carries it. */
int scene_build_drape(struct scene_tree *tree)
{
    struct model_drape *drape = &tree->model->drape;
    const int node = scene_tree_get(tree, 1, "drape");
    if (!node)
        return CLOTH_OK;
    if (scene_build_cloth_of(&drape->cloth, "drape", tree, node) ||
        scene_build_direction(drape->axis, "drape.axis", tree, scene_tree_get(tree, node, "axis")))
        return tree->error->code;
    const struct model_cloth *cloth = tree->model->cloths + drape->cloth;
    const double area = model_area(cloth), disc = model_disc(drape);
    if (disc < area)
        return CLOTH_OK;
    return scene_tree_fail(tree, scene_tree_get(tree, node, "radius"),
                           "drape.radius is %g m, a disc of %.3g m2; the triangles of cloth "
                           "'%.60s' have %.3g m2: a smaller disc is expected",
                           drape->radius, disc, cloth->name, area);
}
