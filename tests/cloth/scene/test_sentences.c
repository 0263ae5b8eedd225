/* The sentences about scenes that are wrong, or have a key that does nothing, stand in
 * sentences.txt, with the place in the file or the set: this compares. `make golden-sentences`
 * writes the sentences again where they are said in other words, of the same places:
 *
 *     [NAME]           a section: a test of its own, of the scene that is right (scene_file.c)
 *     file NAME TEXT   a file beside the scene
 *     scene TEXT       the section's scene is this text
 *     | LINE           ends the text of the scene or file that is named last
 *     base FROM        and
 *     with TO          the section's scene has TO in place of FROM
 *     changes          cases change the file that is named last in place of the scene
 *     prepare          cases are prepared for their run, too
 *     - FROM           and
 *     + TO             a case: TO in place of FROM, which stays for the next cases
 *     set SET          further settings of the case, as of --set
 *     = SENTENCE       ends a case: reading it fails with this, scene.yaml in front of the place
 *     ~ SENTENCE       ends a case: it is read, with this warning, or several with | between
 *     ok               ends a case: it is read, and draws no warning
 *
 * In texts \n is a line's end, \t a tab, \xHH a byte, and \\ one of these. */
#include "cloth/app/run/phases.h"
#include "cloth/flow/run.h"
#include "tests/cloth/scene/scene_file.h"
#include "tests/support/unit.h"

#include <libgen.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_SETS = 4, MAX_LINE = 8192 };

/* The state of the section that is read. */
struct section {
    char *scene, *file, *base, *from;
    char *changed; /* by the case: the scene, or the file; NULL: not at all */
    char file_name[64];
    bool extends_file, changes_file;
    char set[MAX_SETS][1024];
    uint32_t n_sets;
    bool prepares;
    char said[MAX_LINE];
};

static FILE *open_list(void)
{
    const char *top = getenv("srcdir");
    char path[4096];
    snprintf(path, sizeof path, "%s/tests/cloth/scene/sentences.txt", top ? top : ".");
    return fopen(path, "r");
}

/* Called where check knows of no test: a list that cannot be opened has one section, which says it.
 */
static int count_sections(void)
{
    static char line[MAX_LINE];
    FILE *list = open_list();
    int n = 0;
    while (list && fgets(line, sizeof line, list))
        n += line[0] == '[';
    if (list)
        fclose(list);
    return n ? n : 1;
}

/* The text with its escapes replaced; the caller frees it. */
static char *plain(const char *text)
{
    char *copy = malloc(strlen(text) + 1), *to = copy;
    ck_assert_ptr_nonnull(copy);
    while (*text) {
        if (text[0] != '\\') {
            *to++ = *text++;
        } else if (text[1] == 'x') {
            *to++ = (char)strtol((char[]){text[2], text[3], 0}, NULL, 16);
            text += 4;
        } else {
            *to++ = text[1] == 'n' ? '\n' : text[1] == 't' ? '\t' : text[1];
            text += 2;
        }
    }
    *to = 0;
    return copy;
}

static void replace(char **owned, char *text)
{
    free(*owned);
    *owned = text;
}

static void write_file(const struct section *section, const char *text)
{
    scene_write_file(section->file_name, text, strlen(text));
}

/* The sentence without the folder of the scene, and without its name in front. */
static void keep_sentence(struct section *section, const char *sentence)
{
    char folder[128];
    snprintf(folder, sizeof folder, "%s", scene_path());
    const size_t n = strlen(dirname(folder)) + 1, name = strlen("scene.yaml");
    folder[n - 1] = '/';
    char *to = section->said;
    for (const char *at = sentence; *at;)
        if (!strncmp(at, folder, n))
            at += n + (at == sentence && !strncmp(at + n, "scene.yaml", name) ? name : 0);
        else
            *to++ = *at++;
    *to = 0;
}

static void append(char *list, size_t size, const char *warning)
{
    const size_t n = strlen(list);
    snprintf(list + n, size - n, "%s%s", n ? " | " : "", warning);
}

/* Warnings of the scene and of its run, one behind the other. Returns whether there are any. */
static bool join_warnings(const struct model *models, uint32_t n, const struct flow *flow, char *to,
                          size_t size)
{
    to[0] = 0;
    for (uint32_t i = 0; i < (n ? models->n_warnings : 0); i++)
        append(to, size, models->warnings[i]);
    const char *warning = flow ? flow_warning(flow, 0) : NULL;
    for (size_t i = 1; warning; warning = flow_warning(flow, i++))
        append(to, size, warning);
    return to[0];
}

/* Reads the section's scene with the case's change, and prepares its run where the section says so:
 * leaves what is said. Returns how the line begins that says it. */
static const char *read_case(struct section *section)
{
    struct scene_set sets[MAX_SETS];
    struct cloth_error error = {0};
    struct model *models;
    uint32_t n;
    struct flow *flow = NULL;
    static char warnings[MAX_LINE];
    for (uint32_t i = 0; i < section->n_sets; i++)
        sets[i] = (struct scene_set){.text = section->set[i]};
    const char *text = section->scene;
    if (section->changes_file)
        write_file(section, section->changed ? section->changed : section->file);
    else if (section->changed)
        text = section->changed;
    scene_write_file("scene.yaml", text, strlen(text));
    int code = scene_read_phases(&models, &n, scene_path(), section->n_sets, sets, &error);
    for (uint32_t i = 1; i < n && !code; i++)
        code = phases_check(models, models + i, i, &error);
    if (!code && section->prepares)
        code = flow_prepare(&flow, models, 1, &error);
    ck_assert(code == CLOTH_OK || code == CLOTH_E_INPUT);
    const bool warned = join_warnings(models, n, flow, warnings, sizeof warnings);
    keep_sentence(section, code ? error.text : warnings);
    flow_free(flow);
    for (uint32_t i = 0; i < n; i++)
        model_free(models + i);
    free(models);
    replace(&section->changed, NULL);
    section->n_sets = 0;
    return code ? "= " : warned ? "~ " : "ok";
}

/* The text behind the word with which the line begins, or NULL. */
static const char *after(const char *line, const char *word)
{
    const size_t n = strlen(word);
    if (strncmp(line, word, n) != 0 || (line[n] && line[n] != ' '))
        return NULL;
    return line + n + (line[n] == ' ');
}

/* A line behind the text of the scene or the file that is named last. */
static void extend(struct section *section, const char *line)
{
    char **text = section->extends_file ? &section->file : &section->scene, *more = plain(line),
         *longer;
    ck_assert_int_ge(asprintf(&longer, "%s%s\n", *text, more), 0);
    replace(text, longer);
    free(more);
    if (section->extends_file)
        write_file(section, section->file);
}

/* TO in place of FROM: of the case, or of the section's scene. */
static void change(struct section *section, bool of_case, const char *line)
{
    char *to = plain(line), *of = section->changes_file ? section->file : section->scene;
    if (of_case)
        replace(&section->changed,
                scene_changed(section->changed ? section->changed : of, section->from, to));
    else
        replace(&section->scene, scene_changed(section->scene, section->base, to));
    free(to);
}

static void begin_section(struct section *section)
{
    replace(&section->scene, strdup(scene_right));
    section->prepares = section->changes_file = false;
}

/* Takes a line that ends no case. */
static void take_line(struct section *section, const char *line)
{
    const char *text;
    int at = 0;
    if (line[0] == '[') {
        begin_section(section);
    } else if ((text = after(line, "file")) &&
               sscanf(text, "%63s %n", section->file_name, &at) == 1) {
        replace(&section->file, plain(text + at));
        write_file(section, section->file);
        section->extends_file = true;
    } else if ((text = after(line, "scene"))) {
        replace(&section->scene, plain(text));
        section->extends_file = false;
    } else if ((text = after(line, "|"))) {
        extend(section, text);
    } else if (after(line, "changes")) {
        section->changes_file = true;
    } else if (after(line, "prepare")) {
        section->prepares = true;
    } else if ((text = after(line, "base"))) {
        replace(&section->base, plain(text));
    } else if ((text = after(line, "with"))) {
        change(section, false, text);
    } else if ((text = after(line, "-"))) {
        replace(&section->from, plain(text));
    } else if ((text = after(line, "+"))) {
        change(section, true, text);
    } else if ((text = after(line, "set"))) {
        ck_assert_uint_lt(section->n_sets, MAX_SETS);
        snprintf(section->set[section->n_sets++], sizeof *section->set, "%s", text);
    } else {
        ck_assert_msg(!line[0] || line[0] == '#', "a line of sentences.txt means nothing: %s",
                      line);
    }
}

static bool ends_case(const char *line)
{
    return after(line, "=") || after(line, "~") || after(line, "ok");
}

/* How long the place is with which a sentence begins: that of the file, and of a file that is named
 * there, or the set. */
static size_t place_of(const char *sentence)
{
    const char *end = sentence;
    const bool set = after(sentence, "--set") != NULL;
    int more = 0;
    for (int i = 0; !set && end && i < 3; i++)
        end = strchr(end + (i > 0), ':');
    if (set)
        end = strstr(sentence, ": ");
    if (end)
        (void)sscanf(end, ": %*[a-z]: %*[a-z.]:%*u%n", &more);
    return end ? (size_t)(end - sentence + more) : 0;
}

/* Reads the case that the line ends. Returns whether its sentence is this one, and says it if not;
 * with a file, whether the place is the same, and writes the sentence. */
static bool check_case(struct section *section, unsigned number, const char *line, FILE *again)
{
    const char *kind = read_case(section), *expected = line[0] == 'o' ? "" : line + 2;
    const bool same_kind = !strncmp(line, kind, 2);
    if (again)
        fprintf(again, "%s%s\n", kind, section->said);
    if (same_kind && (again ? !strncmp(section->said, expected, place_of(expected))
                            : !strcmp(section->said, expected)))
        return true;
    fprintf(stderr, "sentences.txt:%u: not \"%s\", but:\n%s%s\n", number, line, kind,
            section->said);
    return false;
}

enum { ALL = -1 };

/* Reads the section of this number (from 0 on), or ALL; with a file it writes the list again. */
static void read_sections(int wanted, FILE *again)
{
    struct section section = {0};
    static char line[MAX_LINE];
    FILE *list = open_list();
    int at = -1, wrong = 0;
    ck_assert_ptr_nonnull(list);
    for (unsigned number = 1; fgets(line, sizeof line, list); number++) {
        line[strcspn(line, "\n")] = 0;
        at += line[0] == '[';
        if (wanted != ALL && at >= 0 && at != wanted)
            continue;
        if (ends_case(line)) {
            wrong += !check_case(&section, number, line, again);
            continue;
        }
        take_line(&section, line);
        if (again)
            fprintf(again, "%s\n", line);
    }
    ck_assert_int_eq(fclose(list), 0);
    ck_assert_msg(!wrong, "%d cases end otherwise than sentences.txt says", wrong);
    free(section.scene);
    free(section.file);
    free(section.base);
    free(section.from);
}

/* Where the list is written again in place of comparing with it, or NULL. */
static const char *again_path(void)
{
    return getenv("DUITE_SENTENCES");
}

UNIT_LOOP(sections, 0, again_path() ? 0 : count_sections())
{
    read_sections(_i, NULL);
}

UNIT_LOOP(all_are_written, 0, again_path() != NULL)
{
    FILE *again = fopen(again_path(), "w");
    ck_assert_ptr_nonnull(again);
    read_sections(ALL, again);
    ck_assert_int_eq(fclose(again), 0);
}
