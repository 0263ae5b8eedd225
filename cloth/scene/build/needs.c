/* Keys that a scene gives and that do nothing draw a warning each: their rules say what they need
 * (schema/needs.h), and it is not there. A key that stands there by default draws none, nor does a
 * value of 0 or `off`, which asks for nothing. */
#include "cloth/scene/schema/needs.h"
#include "cloth/scene/build/build.h"
#include "cloth/scene/schema/faults.h"
#include "cloth/scene/yaml/edit.h"
#include "cloth/scene/yaml/scalar.h"

#include <stdio.h>
#include <string.h>

/* ---- Facts ---- */

static bool has_any_triangles(const struct model *model, uint32_t entry)
{
    bool has = false;
    (void)entry;
    for (uint32_t i = 0; i < model->n_cloths; i++)
        has = has || model->cloths[i].mesh.n_triangles;
    return has;
}

static bool has_wind(const struct model *model, uint32_t entry)
{
    const double *wind = model->air.wind;
    (void)entry;
    return wind[0] < 0 || wind[0] > 0 || wind[1] < 0 || wind[1] > 0 || wind[2] < 0 || wind[2] > 0;
}

static bool has_no_sine(const struct model *model, uint32_t entry)
{
    bool sine = false;
    (void)entry;
    for (uint32_t i = 0; i < model->n_curves; i++)
        sine = sine || !model->curves[i].n;
    return !sine;
}

static bool has_springs(const struct model *model, uint32_t entry)
{
    bool springs = model->n_joints > 0;
    (void)entry;
    for (uint32_t i = 0; i < model->n_materials; i++) {
        bool triangles, edges;
        model_parts(model, i, &triangles, &edges);
        springs = springs || edges || (triangles && model->materials[i].model == MODEL_SPRINGS);
    }
    return springs;
}

static bool has_only_springs(const struct model *model, uint32_t entry)
{
    (void)entry;
    return model->format == SOLVE_SPRINGS;
}

/* By project cloths never meet each other. */
static bool needs_has_meetings(const struct model *model, uint32_t entry)
{
    bool left_out = model_seeks(model);
    (void)entry;
    for (uint32_t c = 0; c < model->n_cloths; c++)
        for (uint32_t i = 0; i < model->n_obstacles; i++)
            left_out = left_out || !model_meets(model, c, model->n_cloths + i);
    return left_out;
}

static bool is_guarded(const struct model *model, uint32_t entry)
{
    (void)entry;
    return model_is_guarded(model);
}

static bool is_used(const struct model *model, uint32_t material)
{
    bool used = false;
    for (uint32_t c = 0; c < model->n_cloths; c++)
        used = used || model_has_material(model->cloths + c, material);
    return used;
}

static bool has_own_triangles(const struct model *model, uint32_t material)
{
    bool triangles, edges;
    model_parts(model, material, &triangles, &edges);
    return triangles || !is_used(model, material);
}

static bool has_own_links(const struct model *model, uint32_t material)
{
    bool triangles, edges;
    model_parts(model, material, &triangles, &edges);
    return edges || !is_used(model, material);
}

static bool has_own_edges(const struct model *model, uint32_t material)
{
    return has_own_triangles(model, material) || has_own_links(model, material);
}

static bool has_diagonals(const struct model *model, uint32_t material)
{
    bool has = model->materials[material].model == MODEL_TRIANGLES || !is_used(model, material);
    for (uint32_t c = 0; c < model->n_cloths; c++)
        has = has ||
              (model->cloths[c].mesh.grid_nx && model_has_material(model->cloths + c, material));
    return has;
}

/* entry: the number of the material that the key is of. */
static const struct {
    const char *text;
    bool (*holds)(const struct model *model, uint32_t entry);
} facts[] = {
    {NEEDS_TRIANGLES, has_any_triangles},
    {NEEDS_WIND, has_wind},
    {NEEDS_NO_SINE, has_no_sine},
    {NEEDS_SPRINGS, has_springs},
    {NEEDS_ONLY_SPRINGS, has_only_springs},
    {NEEDS_MEETINGS, needs_has_meetings},
    {NEEDS_GUARDED, is_guarded},
    {NEEDS_OWN_TRIANGLES, has_own_triangles},
    {NEEDS_OWN_LINKS, has_own_links},
    {NEEDS_OWN_EDGES, has_own_edges},
    {NEEDS_DIAGONALS, has_diagonals},
};
enum { N_FACTS = sizeof facts / sizeof *facts };

/* ---- Terms ---- */

/* The scene that is checked. */
struct needs_walk {
    struct model *model;
    const struct scene_tree *tree;
    struct cloth_error *error;
};

/* A map of the scene, in the maps around it. */
struct needs_scope {
    const struct needs_scope *up; /* NULL: none */
    const struct scene_rule *map;
    int node;
    uint32_t entry; /* of the list or named map that it stands in */
};

static bool asks_for_anything(const struct scene_tree *tree, int node)
{
    const char *text = scene_tree_scalar(tree, node);
    double value = 1;
    return !text || (strcmp(text, "off") && (!scene_scalar_number(text, &value) || value != 0));
}

/* The node of a key that a term names; 0: it is not there. rule: whose need it is, which does not
 * mean itself. */
static int find_key(const struct needs_walk *walk, const struct needs_scope *scope,
                    const struct scene_rule *rule, char *key)
{
    char *rest = key;
    const char *word = strsep(&rest, ".");
    for (; scope; scope = scope->up) {
        const struct scene_rule *found = scene_rule_of(scope->map->inside, word);
        if (found && found != rule)
            break;
    }
    int node = scope ? scene_tree_get(walk->tree, scope->node, word) : 0;
    while (node && rest)
        node = scene_tree_get(walk->tree, node, strsep(&rest, "."));
    return node;
}

/* Cuts the next of several words with " or " between them off a text. */
static char *next_word(char **text)
{
    char *word = *text, * or = strstr(word, " or ");
    if (or)
        * or = 0;
    *text = or ? or +strlen(" or ") : NULL;
    return word;
}

/* The value of a key that a term compares, which is cut before the comparison. *rest: behind it.
 * NULL: the key is not there. */
static const char *compared_value(const struct needs_walk *walk, const struct needs_scope *scope,
                                  const struct scene_rule *rule, char *term, char *at, char **rest)
{
    *at = 0;
    *rest = at + strlen(" = ");
    const int node = find_key(walk, scope, rule, term);
    return node ? scene_tree_scalar(walk->tree, node) : NULL;
}

/* True if a term that is no fact holds; its text is changed. */
static bool term_holds(const struct needs_walk *walk, const struct needs_scope *scope,
                       const struct scene_rule *rule, char *term)
{
    const bool is_no = !strncmp(term, "no ", 3);
    char *rest = is_no ? term + 3 : term, *equal = strstr(term, " = "), *more = strstr(term, " > ");
    double value = 0, least = 0;
    bool any = false;
    if (more) {
        const char *text = compared_value(walk, scope, rule, term, more, &rest);
        return text && scene_scalar_number(text, &value) && scene_scalar_number(rest, &least) &&
               value > least;
    }
    if (equal) {
        const char *text = compared_value(walk, scope, rule, term, equal, &rest);
        while (rest && text)
            any = !strcmp(next_word(&rest), text) || any;
        return any;
    }
    while (rest) {
        const int node = find_key(walk, scope, rule, next_word(&rest));
        any = any || (scene_tree_is_given(walk->tree, node) && asks_for_anything(walk->tree, node));
    }
    return any != is_no;
}

/* True if the fact that a text begins with holds; *end: behind it, or NULL: it begins with none. */
static bool fact_holds(const struct needs_walk *walk, const struct needs_scope *scope,
                       const char *text, const char **end)
{
    *end = NULL;
    for (size_t i = 0; i < N_FACTS; i++)
        if (!strncmp(text, facts[i].text, strlen(facts[i].text))) {
            *end = text + strlen(facts[i].text);
            return facts[i].holds(walk->model, scope->entry);
        }
    return false;
}

static bool are_met(const struct needs_walk *walk, const struct needs_scope *scope,
                    const struct scene_rule *rule, const char *needs)
{
    static const char and[] = " and ";
    bool met = true;
    while (needs && met) {
        const char *end;
        char term[200];
        met = fact_holds(walk, scope, needs, &end);
        if (!end) {
            end = strstr(needs, and);
            end = end ? end : needs + strlen(needs);
            snprintf(term, sizeof term, "%.*s", (int)(end - needs), needs);
            met = term_holds(walk, scope, rule, term);
        }
        needs = *end ? end + strlen(and) : NULL;
    }
    return met;
}

/* ---- The walk ---- */

/* Warns of a key of the scope's map, or inside it, that lacks what its rule needs; *idle: it does.
 */
static int warn_of_needs(const struct needs_walk *walk, const struct needs_scope *scope,
                         const struct scene_place *at, const struct scene_rule *rule, int node,
                         bool *idle)
{
    const char *value = strstr(rule->needs, ": "), *needs = value ? value + 2 : rule->needs;
    const char *text = scene_tree_scalar(walk->tree, node);
    const size_t n = value ? (size_t)(value - rule->needs) : 0;
    char path[200];
    *idle = false;
    if (!asks_for_anything(walk->tree, node) ||
        (n && (strlen(text) != n || strncmp(text, rule->needs, n))) ||
        are_met(walk, scope, rule, needs))
        return CLOTH_OK;
    *idle = true;
    scene_place_path(at, path, sizeof path);
    return scene_build_warn(walk->model, walk->tree, node, walk->error,
                            "%s%s%.*s means nothing: it needs %s", path, n ? " " : "", (int)n,
                            rule->needs, needs);
}

static int check_needs(const struct needs_walk *walk, const struct needs_scope *up,
                       const struct scene_place *at, const struct scene_rule *rule, int node,
                       uint32_t entry)
{
    const struct needs_scope scope = {up, rule, node, entry};
    const bool is_map = rule->type == SCENE_MAP || rule->type == SCENE_ONE_OF;
    bool idle = false;
    int code = CLOTH_OK;
    if (!scene_tree_is_given(walk->tree, node))
        return CLOTH_OK;
    if (rule->needs)
        code = warn_of_needs(walk, is_map ? &scope : up, at, rule, node, &idle);
    if (rule->type == SCENE_LIST && scene_tree_is(walk->tree, node, YAML_SEQUENCE_NODE))
        for (size_t i = 0; i < scene_tree_length(walk->tree, node) && !code && !idle; i++)
            code = check_needs(walk, up, &(struct scene_place){at, NULL, i}, rule->inside,
                               scene_tree_item(walk->tree, node, i), (uint32_t)i);
    if (!is_map && rule->type != SCENE_NAMED)
        return code;
    for (size_t i = 0; i < scene_tree_length(walk->tree, node) && !code && !idle; i++) {
        const yaml_node_pair_t pair = scene_tree_pair(walk->tree, node, i);
        const char *name = scene_tree_scalar(walk->tree, pair.key);
        const struct scene_rule *key = is_map ? scene_rule_of(rule->inside, name) : rule->inside;
        if (key) /* else it is of another map that shares this one by an alias */
            code = check_needs(walk, is_map ? &scope : up, &(struct scene_place){at, name, 0}, key,
                               pair.value, is_map ? entry : (uint32_t)i);
    }
    return code;
}

int scene_build_needs(struct model *model, struct scene_tree *tree, struct cloth_error *error)
{
    const struct needs_walk walk = {model, tree, error};
    const struct scene_place root = {0};
    const int contact = scene_tree_get(tree, 1, "contact");
    const int code = model->contact.assumed ? scene_edit_default(tree, contact, "mode",
                                                                 model_contact_name(model), error)
                                            : CLOTH_OK;
    return code ? code : check_needs(&walk, NULL, &root, &scene_root, 1, 0);
}
