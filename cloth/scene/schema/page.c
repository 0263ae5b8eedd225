/* The list of all keys, and their page in Markdown, behind its opening (opening.md): a table for
 * each map that has a section. Maps without one are rows of the table around them. A section that
 * several keys have is printed at the first of them; the others link to it. */
#include "cloth/scene/scene.h"
#include "cloth/scene/schema/rules.h"

#include <ctype.h>
#include <stdbool.h>
#include <string.h>

enum { MOST_SECTIONS = 64 };

struct page {
    FILE *file;
    const struct scene_section *printed[MOST_SECTIONS];
    size_t n_printed;
};

/* The map whose keys stand behind a rule: itself, or what its list or names are of; NULL: none. */
static const struct scene_rule *map_of(const struct scene_rule *rule)
{
    while (rule->type == SCENE_LIST || rule->type == SCENE_NAMED)
        rule = rule->inside;
    return rule->type == SCENE_MAP || rule->type == SCENE_ONE_OF ? rule : NULL;
}

/* ---- Words ---- */

/* A link to a section, by the target that Markdown gives its head. */
static void print_link(FILE *file, const char *text, const struct scene_section *section)
{
    fprintf(file, "[%s](#", text);
    for (const char *c = section->head; *c; c++)
        if (isalnum((unsigned char)*c) || *c == '-' || *c == '_' || *c == ' ')
            fputc(*c == ' ' ? '-' : tolower((unsigned char)*c), file);
    fputc(')', file);
}

/* What a key with other keys takes. */
static void print_map(FILE *file, const struct scene_rule *key)
{
    const char *kind = key->type == SCENE_LIST    ? "list of maps"
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
    static const char *const dropped[] = {"a finite ", "a "};
    char expected[300];
    const char *text = scene_rule_expected(key, expected, sizeof expected);
    for (size_t i = 0; i < sizeof dropped / sizeof *dropped; i++)
        if (!strncmp(text, dropped[i], strlen(dropped[i]))) {
            text += strlen(dropped[i]);
            break;
        }
    fputs(text, file);
}

/* What a key takes: a kind and its unit. */
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

static void print_default(FILE *file, const struct scene_rule *of, const struct scene_rule *key)
{
    if (key->fallback)
        fprintf(file, "`%s`", key->fallback);
    else
        fputs(of->type == SCENE_ONE_OF || key->choice ? "one of these"
              : key->required                         ? "required"
                                                      : "",
              file);
}

static void print_needs(FILE *file, const struct scene_rule *key)
{
    const char *end = strstr(key->needs, ": ");
    fputs(key->more ? " " : ". ", file);
    if (end)
        fprintf(file, "*%.*s needs %s.*", (int)(end - key->needs), key->needs, end + 2);
    else
        fprintf(file, "*Needs %s.*", key->needs);
}

static void print_row(FILE *file, const struct scene_rule *of, const struct scene_rule *key,
                      const char *path)
{
    fprintf(file, "| `%s` | ", path);
    print_value(file, key);
    fputs(" | ", file);
    print_default(file, of, key);
    fprintf(file, " | %s%s%s", key->about, key->more ? ". " : "", key->more ? key->more : "");
    if (key->needs)
        print_needs(file, key);
    if (key->section && !map_of(key)) {
        fputs(key->more || key->needs ? " " : ". ", file);
        print_link(file, "More", key->section);
    }
    fputs(" |\n", file);
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

/* One row for all keys of a map that share a section. */
static void print_shared(FILE *file, const struct scene_rule *keys, const char *path,
                         const struct scene_section *shared)
{
    const char *before = "| ";
    for (const struct scene_rule *key = keys; key->key; key++)
        if (key->shared == shared) {
            fprintf(file, "%s`%s%s%s`", before, path, *path ? "." : "", key->key);
            before = ", ";
        }
    fputs(" | | | ", file);
    print_link(file, shared->head, shared);
    fputs(" |\n", file);
}

/* The rows of a map; shared: the section whose keys are rows themselves. */
static void print_rows(FILE *file, const struct scene_rule *of, const char *path,
                       const struct scene_section *rows)
{
    const struct scene_section *shared = NULL;
    for (const struct scene_rule *key = of->inside; key->key; key++) {
        if (rows ? key->shared != rows : key->shared != NULL) {
            if (!rows && key->shared != shared)
                print_shared(file, of->inside, path, key->shared);
            shared = key->shared;
            continue;
        }
        print_row(file, of, key, page_path_of(path, key).text);
        if (map_of(key) && !key->section)
            print_rows(file, map_of(key), path_inside(path, key).text, NULL);
    }
}

static void print_table(FILE *file, const struct scene_rule *of, const struct scene_section *rows)
{
    fputs("\n| key | value | default | meaning |\n|---|---|---|---|\n", file);
    print_rows(file, of, "", rows);
}

/* ---- Sections ---- */

static void print_sections(struct page *page, const struct scene_rule *of, const char *path,
                           int level);

static bool is_printed(struct page *page, const struct scene_section *section)
{
    for (size_t i = 0; i < page->n_printed; i++)
        if (page->printed[i] == section)
            return true;
    if (page->n_printed < MOST_SECTIONS)
        page->printed[page->n_printed++] = section;
    return false;
}

static void print_head(FILE *file, const struct scene_section *section, int level)
{
    fprintf(file, "\n%.*s %s\n", level, "######", section->head);
}

static void print_text(FILE *file, const struct scene_section *section)
{
    if (section->text)
        fprintf(file, "\n%s\n", section->text);
    if (section->example)
        fprintf(file, "\n```yaml\n%s```\n", section->example);
}

/* The section of a key of the map at a path, with the table of its keys. */
static void print_section(struct page *page, const struct scene_rule *key, const char *path,
                          int level)
{
    if (is_printed(page, key->section))
        return;
    print_head(page->file, key->section, level);
    fprintf(page->file, "\n`%s`: %s.\n", page_path_of(path, key).text, key->about);
    print_text(page->file, key->section);
    if (!map_of(key))
        return;
    print_table(page->file, map_of(key), NULL);
    print_sections(page, map_of(key), path_inside(path, key).text, level + 1);
}

/* A section that keys of several maps share: these keys of one of them. */
static void print_shared_section(struct page *page, const struct scene_rule *of,
                                 const struct scene_section *shared, int level)
{
    if (is_printed(page, shared))
        return;
    print_head(page->file, shared, level);
    print_text(page->file, shared);
    print_table(page->file, of, shared);
}

static void print_sections(struct page *page, const struct scene_rule *of, const char *path,
                           int level)
{
    for (const struct scene_rule *key = of->inside; key->key; key++) {
        if (key->shared)
            print_shared_section(page, of, key->shared, level);
        if (key->section)
            print_section(page, key, path, level);
        else if (map_of(key))
            print_sections(page, map_of(key), path_inside(path, key).text, level);
    }
}

void scene_print_page(FILE *file)
{
    struct page page = {.file = file};
    fputs("\n## Keys\n", file);
    print_table(file, &scene_root, NULL);
    print_sections(&page, &scene_root, "", 2);
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
                    of->type == SCENE_ONE_OF || key->choice ? "a choice"
                    : key->required                         ? "required"
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
