/* The list of all keys, and their page in Markdown, behind its opening (opening.md): the sections
 * of prose.md, each with the table of its keys. Maps without a section are rows of the table around
 * them. A section that several keys have is of the first of them; the others link to it. */
#include "cloth/scene/scene.h"
#include "cloth/scene/schema/rules.h"

#include <ctype.h>
#include <stdbool.h>
#include <string.h>

/* The map whose keys stand behind a rule: itself, or what its list or names are of; NULL: none. */
static const struct scene_rule *map_of(const struct scene_rule *rule)
{
    while (rule->type == SCENE_LIST || rule->type == SCENE_NAMED)
        rule = rule->inside;
    return rule->type <= SCENE_ROTATION ? rule : NULL;
}

/* ---- Words ---- */

/* A link to a section, by the target that Markdown gives its head. */
static void print_link(FILE *file, const char *text, const char *section)
{
    fprintf(file, "[%s](#", text);
    for (const char *c = section; *c; c++)
        if (isalnum((unsigned char)*c) || *c == '-' || *c == '_' || *c == ' ')
            fputc(*c == ' ' ? '-' : tolower((unsigned char)*c), file);
    fputc(')', file);
}

/* The value of a key that has other keys. */
static void print_map(FILE *file, const struct scene_rule *key)
{
    const bool list = key->type == SCENE_LIST;
    const bool turns = (list ? key->inside : key)->type == SCENE_ROTATION;
    const char *kind = turns                      ? list ? "list of rotations" : "rotation"
                       : list                     ? "list of maps"
                       : key->type == SCENE_NAMED ? "map of names"
                                                  : "map";
    if (key->section)
        print_link(file, kind, key->section);
    else
        fputs(kind, file);
}

/* The same as an error would expect, without articles. */
static void print_expected(FILE *file, const struct scene_rule *key)
{
    static const char finite[] = "a finite ", article[] = "a ";
    char expected[300];
    const char *text = scene_rule_expected(key, expected, sizeof expected);
    if (!strncmp(text, finite, strlen(finite)))
        text += strlen(finite);
    else if (!strncmp(text, article, strlen(article)))
        text += strlen(article);
    fputs(text, file);
}

/* The value of a key: its kind and unit. */
static void print_value(FILE *file, const struct scene_rule *key)
{
    if (key->type <= SCENE_NAMED || (key->type == SCENE_LIST && key->inside->type <= SCENE_NAMED))
        print_map(file, key);
    else if (key->type == SCENE_CHOICE)
        for (const struct model_word *word = key->words; word->word; word++)
            fprintf(file, "%s`%s`", word == key->words ? "" : ", ", word->word);
    else if (key->type == SCENE_INTEGER && key->max <= 0)
        fprintf(file, "whole number from %.0f on", key->min);
    else
        print_expected(file, key);
}

static void print_default(FILE *file, const struct scene_rule *key)
{
    if (key->fallback)
        fprintf(file, "`%s`", key->fallback);
    else
        fputs(key->choice ? "one of these" : key->required ? "required" : "", file);
}

static void print_needs(FILE *file, const struct scene_rule *key)
{
    const char *end = strstr(key->needs, ": ");
    if (end)
        fprintf(file, "*%.*s needs %s.*", (int)(end - key->needs), key->needs, end + 2);
    else
        fprintf(file, "*Needs %s.*", key->needs);
}

/* ---- Notes ---- */

/* A line of prose.md that is no text of its section: more of a row of the table, "- `KEY`: note".
 */
static bool is_note(const char *line)
{
    return !strncmp(line, "- `", 3) && strstr(line, "`: ");
}

/* The note below a head on the key at a path; NULL: there is none. */
static const char *note_of(const char *head, const char *path)
{
    const size_t n = strlen(path);
    const char *const *line = scene_prose;
    while (*line && (**line != '#' || strcmp(strchr(*line, ' ') + 1, head) != 0))
        line++;
    for (line += *line != NULL; *line && **line != '#'; line++)
        if (is_note(*line) && !strncmp(*line + 3, path, n) && !strncmp(*line + 3 + n, "`: ", 3))
            return *line + 3 + n + 3;
    return NULL;
}

/* ---- Tables ---- */

struct path {
    char text[160];
};

/* The path of a key in a map, and of the keys behind it. */
static struct path page_path_of(const char *map, const struct scene_rule *key)
{
    struct path path;
    snprintf(path.text, sizeof path.text, "%s%s%s", map, *map ? "." : "", key->key);
    return path;
}

static struct path path_inside(const char *map, const struct scene_rule *key)
{
    const char *entry = key->type == SCENE_LIST ? "[]" : key->type == SCENE_NAMED ? ".NAME" : "";
    struct path path;
    snprintf(path.text, sizeof path.text, "%s%s%s%s", map, *map ? "." : "", key->key, entry);
    return path;
}

static bool is_of(const struct scene_rule *key, const char *shared)
{
    return key->shared && !strcmp(key->shared, shared);
}

/* One row for all keys of a map that share a section. */
static void print_shared(FILE *file, const struct scene_rule *keys, const char *path,
                         const char *shared)
{
    const char *before = "| ";
    for (const struct scene_rule *key = keys; key->key; key++)
        if (is_of(key, shared)) {
            fprintf(file, "%s`%s%s%s`", before, path, *path ? "." : "", key->key);
            before = ", ";
        }
    fputs(" | | | ", file);
    print_link(file, shared, shared);
    fputs(" |\n", file);
}

static void print_row(FILE *file, const char *head, const struct scene_rule *key, const char *path)
{
    const char *note = note_of(head, path), *gap = ". ";
    fprintf(file, "| `%s` | ", path);
    print_value(file, key);
    fputs(" | ", file);
    print_default(file, key);
    fprintf(file, " | %s", key->about);
    if (note) {
        fprintf(file, "%s%s", gap, note);
        gap = " ";
    }
    if (key->needs) {
        fputs(gap, file);
        print_needs(file, key);
        gap = " ";
    }
    if (key->section && !map_of(key)) {
        fputs(gap, file);
        print_link(file, "More", key->section);
    }
    fputs(" |\n", file);
}

/* The rows of a map in the section of a head. shared: of its keys that share this section. */
static void print_rows(FILE *file, const char *head, const struct scene_rule *of, const char *path,
                       bool shared)
{
    const char *last = NULL;
    for (const struct scene_rule *key = of->inside; key->key; key++) {
        if (shared ? !is_of(key, head) : key->shared != NULL) {
            if (!shared && !(last && is_of(key, last)))
                print_shared(file, of->inside, path, key->shared);
            last = key->shared;
            continue;
        }
        print_row(file, head, key, page_path_of(path, key).text);
        if (map_of(key) && !key->section)
            print_rows(file, head, map_of(key), path_inside(path, key).text, false);
    }
}

/* ---- Sections ---- */

/* The first key that has a section, or shares it; the map that it stands in; its path. */
struct sectioned {
    const struct scene_rule *key, *of;
    struct path path;
};

static bool find_section(const struct scene_rule *of, const char *path, const char *head,
                         struct sectioned *found)
{
    for (const struct scene_rule *key = of->inside; key->key; key++) {
        *found = (struct sectioned){key, of, page_path_of(path, key)};
        if (is_of(key, head) || (key->section && !strcmp(key->section, head)) ||
            (map_of(key) && find_section(map_of(key), path_inside(path, key).text, head, found)))
            return true;
    }
    return false;
}

/* The table at the end of a section: of the keys that share it, or of those in its key. */
static void print_table(FILE *file, const struct sectioned *found, const char *head)
{
    const bool shared = is_of(found->key, head);
    if (!shared && !map_of(found->key))
        return;
    fputs("\n| key | value | default | meaning |\n|---|---|---|---|\n", file);
    print_rows(file, head, shared ? found->of : map_of(found->key), "", shared);
}

/* The lines of prose.md, with what a section's key is below each head, and its keys at the end. The
 * first section is of the whole scene, which no key names. */
void scene_print_page(FILE *file)
{
    const struct sectioned scene = {.key = &scene_root};
    struct sectioned found = scene;
    const char *head = NULL;
    bool apart = true;
    for (const char *const *line = scene_prose; *line; line++) {
        const bool is_head = **line == '#';
        if (is_head && head)
            print_table(file, &found, head);
        if (**line && !is_note(*line))
            fprintf(file, "%s%s\n", apart ? "\n" : "", *line);
        apart = !**line;
        if (!is_head)
            continue;
        head = strchr(*line, ' ') + 1;
        if (!find_section(&scene_root, "", head, &found))
            found = scene;
        else if (!is_of(found.key, head))
            fprintf(file, "\n`%s`: %s.\n", found.path.text, found.key->about);
    }
    print_table(file, &found, head);
}

/* ---- The list ---- */

static void list_keys(FILE *file, const struct scene_rule *of, const char *path)
{
    for (const struct scene_rule *key = of->inside; key->key; key++) {
        char expected[200];
        fprintf(file, "%s: %s; ", page_path_of(path, key).text,
                scene_rule_expected(key, expected, sizeof expected));
        if (key->fallback)
            fprintf(file, "default %s\n", key->fallback);
        else
            fprintf(file, "%s\n",
                    key->choice     ? "a choice"
                    : key->required ? "required"
                                    : "optional");
        fprintf(file, "    %s\n", key->about);
        if (map_of(key))
            list_keys(file, map_of(key), path_inside(path, key).text);
    }
}

void scene_print_keys(FILE *file)
{
    list_keys(file, &scene_root, "");
}
