/* Keys that a scene gives and that do nothing draw a warning each: their rules say what they need
 * (schema/needs.h), and it is not there. A key that stands there by default draws none, nor does a
 * value of 0 or `off`, which asks for nothing. */
#include "cloth/scene/schema/needs.h"
#include "cloth/base/number.h"
#include "cloth/scene/build/build.h"
#include "cloth/scene/schema/check.h"

#include <stdio.h>
#include <string.h>

/* ---- Facts ---- */

static bool has_any_triangles(const struct model *model)
{
    bool has = false;
    for (uint32_t i = 0; i < model->n_cloths; i++)
        has = has || model->cloths[i].mesh.n_triangles;
    return has;
}

static bool has_wind(const struct model *model)
{
    const double *wind = model->air.wind;
    return wind[0] < 0 || wind[0] > 0 || wind[1] < 0 || wind[1] > 0 || wind[2] < 0 || wind[2] > 0;
}

static bool has_no_sine(const struct model *model)
{
    bool sine = false;
    for (uint32_t i = 0; i < model->n_curves; i++)
        sine = sine || !model->curves[i].n;
    return !sine;
}

static bool has_springs(const struct model *model)
{
    bool springs = model->n_joints > 0;
    for (uint32_t i = 0; i < model->n_materials; i++) {
        bool triangles, edges;
        model_parts(model, i, &triangles, &edges);
        springs = springs || edges || (triangles && model->materials[i].model == MODEL_SPRINGS);
    }
    return springs;
}

static bool has_only_springs(const struct model *model)
{
    return model->format == SOLVE_SPRINGS;
}

/* By project cloths never meet each other. */
static bool needs_has_meetings(const struct model *model)
{
    bool left_out = model_seeks(model);
    for (uint32_t c = 0; c < model->n_cloths; c++)
        for (uint32_t i = 0; i < model->n_obstacles; i++)
            left_out = left_out || !model_meets(model, c, model->n_cloths + i);
    return left_out;
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

/* Facts of the scene, or of the material that the key is of, by number. */
static const struct {
    const char *text;
    bool (*scene)(const struct model *model);
    bool (*material)(const struct model *model, uint32_t material);
} facts[] = {
    {NEEDS_TRIANGLES, .scene = has_any_triangles},
    {NEEDS_WIND, .scene = has_wind},
    {NEEDS_NO_SINE, .scene = has_no_sine},
    {NEEDS_SPRINGS, .scene = has_springs},
    {NEEDS_ONLY_SPRINGS, .scene = has_only_springs},
    {NEEDS_MEETINGS, .scene = needs_has_meetings},
    {NEEDS_GUARDED, .scene = model_is_guarded},
    {NEEDS_OWN_TRIANGLES, .material = has_own_triangles},
    {NEEDS_OWN_LINKS, .material = has_own_links},
    {NEEDS_OWN_EDGES, .material = has_own_edges},
    {NEEDS_DIAGONALS, .material = has_diagonals},
};

/* ---- Terms ---- */

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
    return !text || (strcmp(text, "off") && (!cloth_number(text, &value) || value != 0));
}

/* The node of a key that a term names; 0: it is not there. rule: whose need it is, which does not
 * mean itself. */
static int find_key(const struct scene_tree *tree, const struct needs_scope *scope,
                    const struct scene_rule *rule, char *key)
{
    char *rest = key;
    const char *word = strsep(&rest, ".");
    for (; scope; scope = scope->up) {
        const struct scene_rule *found = scene_rule_of(scope->map->inside, word);
        if (found && found != rule)
            break;
    }
    const int node = scope ? scene_tree_get(tree, scope->node, word) : 0;
    return node && rest ? scene_tree_at(tree, node, rest) : node;
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

/* True if a term that is no fact holds; its text is changed. */
static bool term_holds(const struct scene_tree *tree, const struct needs_scope *scope,
                       const struct scene_rule *rule, char *term)
{
    const bool is_no = !strncmp(term, "no ", 3);
    char *rest = is_no ? term + 3 : term, *sign = strpbrk(term, "=>");
    bool any = false;
    if (sign) {
        const bool more = *sign == '>';
        sign[-1] = 0;
        rest = sign + 2;
        const int node = find_key(tree, scope, rule, term);
        const char *text = node ? scene_tree_scalar(tree, node) : NULL;
        double value = 0, least = 0;
        if (more)
            return text && cloth_number(text, &value) && cloth_number(rest, &least) &&
                   value > least;
        while (rest && text)
            any = !strcmp(next_word(&rest), text) || any;
        return any;
    }
    while (rest) {
        const int node = find_key(tree, scope, rule, next_word(&rest));
        any = any || (scene_tree_is_given(tree, node) && asks_for_anything(tree, node));
    }
    return any != is_no;
}

/* True if the fact that a text begins with holds; *end: behind it, or NULL: it begins with none. */
static bool fact_holds(const struct scene_tree *tree, const struct needs_scope *scope,
                       const char *text, const char **end)
{
    *end = NULL;
    for (size_t i = 0; i < sizeof facts / sizeof *facts; i++)
        if (!strncmp(text, facts[i].text, strlen(facts[i].text))) {
            *end = text + strlen(facts[i].text);
            return facts[i].scene ? facts[i].scene(tree->model)
                                  : facts[i].material(tree->model, scope->entry);
        }
    return false;
}

static bool are_met(const struct scene_tree *tree, const struct needs_scope *scope,
                    const struct scene_rule *rule, const char *needs)
{
    static const char and[] = " and ";
    bool met = true;
    while (needs && met) {
        const char *end;
        char term[200];
        met = fact_holds(tree, scope, needs, &end);
        if (!end) {
            end = strstr(needs, and);
            end = end ? end : needs + strlen(needs);
            snprintf(term, sizeof term, "%.*s", (int)(end - needs), needs);
            met = term_holds(tree, scope, rule, term);
        }
        needs = *end ? end + strlen(and) : NULL;
    }
    return met;
}

/* ---- The walk ---- */

/* Warns of a key of the scope's map, or inside it, that lacks what its rule needs. True if it does.
 */
static bool warn_of_needs(const struct scene_tree *tree, const struct needs_scope *scope,
                          const struct scene_place *at, const struct scene_rule *rule, int node)
{
    const char *value = strstr(rule->needs, ": "), *needs = value ? value + 2 : rule->needs;
    const char *text = scene_tree_scalar(tree, node);
    const size_t n = value ? (size_t)(value - rule->needs) : 0;
    char path[SCENE_PATH];
    if (!asks_for_anything(tree, node) ||
        (n && (strlen(text) != n || strncmp(text, rule->needs, n))) ||
        are_met(tree, scope, rule, needs))
        return false;
    scene_build_warn(tree, node, "%s%s%.*s means nothing: it needs %s", scene_place_path(at, path),
                     n ? " " : "", (int)n, rule->needs, needs);
    return true;
}

/* entry: number of the node in the list or named map that it stands in. */
static void check_needs(const struct scene_tree *tree, const struct needs_scope *up,
                        const struct scene_place *at, const struct scene_rule *rule, int node,
                        uint32_t entry)
{
    const bool map = rule->type == SCENE_MAP || rule->type == SCENE_ONE_OF;
    const bool list = rule->type == SCENE_LIST && scene_tree_is(tree, node, YAML_SEQUENCE_NODE);
    const struct needs_scope own = {up, rule, node, entry}, *scope = map ? &own : up;
    if (!scene_tree_is_given(tree, node) ||
        (rule->needs && warn_of_needs(tree, scope, at, rule, node)) ||
        !(map || list || rule->type == SCENE_NAMED))
        return;
    for (uint32_t i = 0; i < scene_tree_length(tree, node); i++) {
        const yaml_node_pair_t pair = list ? (yaml_node_pair_t){0, scene_tree_item(tree, node, i)}
                                           : scene_tree_pair(tree, node, i);
        const char *name = list ? NULL : scene_tree_scalar(tree, pair.key);
        const struct scene_rule *key = map ? scene_rule_of(rule->inside, name) : rule->inside;
        if (key) /* else it is of another map that shares this one by an alias */
            check_needs(tree, scope, &(struct scene_place){at, name, i}, key, pair.value,
                        map ? entry : i);
    }
}

int scene_build_needs(struct scene_tree *tree)
{
    const struct scene_place root = {0};
    if (!tree->model->contact.assumed ||
        !scene_edit_default(tree, scene_tree_get(tree, 1, "contact"), "mode",
                            model_contact_name(tree->model)))
        check_needs(tree, NULL, &root, &scene_root, 1, 0);
    return tree->error->code;
}
