/* Equal names are found by a tree, at the end: a file may have as many groups as faces. Files of
 * materials are kept by name only. */
#include "cloth/mesh/detail/obj.h"

#include <search.h>
#include <stdlib.h>
#include <string.h>

struct named {
    char *name;
    uint32_t first, end; /* faces */
    uint32_t group;
};

/* Gives the open entries of a kind their last face. */
static void close_open(struct obj_naming *naming, enum obj_naming_kind kind, uint32_t n_faces)
{
    struct named *entry = naming->entry.items;
    for (size_t i = naming->open[kind]; i < naming->end[kind]; i++)
        entry[i].end = n_faces;
    naming->open[kind] = naming->end[kind] = naming->entry.n;
}

static int add_name(struct obj_naming *naming, const char *from, const char *to, uint32_t n_faces,
                    struct cloth_error *error)
{
    struct named entry = {.name = strndup(from, (size_t)(to - from)), .first = n_faces};
    if (!entry.name)
        return cloth_fail(error, CLOTH_E_MEMORY, "out of memory for a name of faces");
    const int code = cloth_list_put(&naming->entry, &entry, sizeof entry, error);
    if (code)
        free(entry.name);
    return code;
}

int obj_naming_line(struct obj_naming *naming, enum obj_naming_kind kind, const char *at,
                    uint32_t n_faces, struct cloth_error *error)
{
    int code = CLOTH_OK;
    close_open(naming, kind, n_faces);
    for (const char *word, *end; !code && (word = obj_word(at)); at = end) {
        end = obj_word_end(word);
        for (const char *next; kind == OBJ_OBJECTS && (next = obj_word(end));)
            end = obj_word_end(next);
        code = add_name(naming, word, end, n_faces, error);
    }
    naming->end[kind] = naming->entry.n;
    return code;
}

/* Entries without faces are gone. */
static size_t drop_empty(struct named *entry, size_t n)
{
    size_t kept = 0;
    for (size_t i = 0; i < n; i++) {
        if (entry[i].first == entry[i].end)
            free(entry[i].name);
        else
            entry[kept++] = entry[i];
    }
    return kept;
}

static int compare_names(const void *a, const void *b)
{
    return strcmp(((const struct named *)a)->name, ((const struct named *)b)->name);
}

static void keep_entry(void *entry)
{
    (void)entry;
}

/* Numbers the groups in the order in which the file names them first. name: room for n of them. */
static int find_groups(struct named *entry, size_t n, char **name, uint32_t *n_names,
                       struct cloth_error *error)
{
    void *tree = NULL;
    int code = CLOTH_OK;
    for (size_t i = 0; i < n && !code; i++) {
        struct named *const *first = tsearch(&entry[i], &tree, compare_names);
        if (!first)
            code = cloth_fail(error, CLOTH_E_MEMORY, "out of memory for the names of faces");
        else if (*first != &entry[i])
            entry[i].group = (*first)->group;
        else {
            entry[i].group = *n_names;
            name[(*n_names)++] = entry[i].name;
        }
    }
    tdestroy(tree, keep_entry);
    for (size_t i = 0; i < n; i++)
        if (entry[i].name == name[entry[i].group])
            entry[i].name = NULL; /* the mesh has it now */
    return code;
}

int obj_naming_end(struct obj_naming *naming, uint32_t n_faces, char ***name, uint32_t *n_names,
                   struct mesh_group_run **run, uint32_t *n_runs, struct cloth_error *error)
{
    struct named *entry = naming->entry.items;
    for (enum obj_naming_kind kind = OBJ_GROUPS; kind < OBJ_NAMINGS; kind++)
        close_open(naming, kind, n_faces);
    const size_t n = naming->entry.n = drop_empty(entry, naming->entry.n);
    *name = cloth_alloc(n, sizeof **name, error);
    *run = cloth_alloc(n, sizeof **run, error);
    int code = *name && *run ? CLOTH_OK : CLOTH_E_MEMORY;
    if (!code)
        code = find_groups(entry, n, *name, n_names, error);
    for (size_t i = 0; i < n && !code; i++)
        (*run)[(*n_runs)++] =
            (struct mesh_group_run){entry[i].group, entry[i].first, entry[i].end - entry[i].first};
    return code;
}

void obj_naming_free(struct obj_naming *naming)
{
    struct named *entry = naming->entry.items;
    for (size_t i = 0; i < naming->entry.n; i++)
        free(entry[i].name);
    free(naming->entry.items);
    *naming = (struct obj_naming){0};
}

/* ---- Files of materials ---- */

/* The absolute path of a name of `length` bytes beside `path`; NULL: there is no such file. */
static char *library_find_beside(const char *path, const char *name, size_t length)
{
    const char *slash = strrchr(path, '/');
    const int folder = slash && *name != '/' ? (int)(slash - path) + 1 : 0;
    char *joined = NULL;
    if (asprintf(&joined, "%.*s%.*s", folder, path, (int)length, name) < 0)
        return NULL;
    char *found = realpath(joined, NULL);
    free(joined);
    return found;
}

/* Takes over a path or name; NULL: there is no memory for it. One that comes again at once is the
 * same. */
static int library_add(struct cloth_list *library, char *text, struct cloth_error *error)
{
    char *const *all = library->items;
    const bool again = text && library->n && !strcmp(all[library->n - 1], text);
    if (text && !again && !cloth_list_put(library, &text, sizeof text, error))
        return CLOTH_OK;
    free(text);
    return again ? CLOTH_OK
                 : cloth_fail(error, CLOTH_E_MEMORY, "out of memory for a material's file");
}

int obj_library_line(struct cloth_list *library, const char *path, const char *at,
                     struct cloth_error *error)
{
    const char *first = obj_word(at), *end = first;
    int code = CLOTH_OK;
    for (const char *word = first; word; word = obj_word(end))
        end = obj_word_end(word);
    char *whole = first ? library_find_beside(path, first, (size_t)(end - first)) : NULL;
    if (whole)
        return library_add(library, whole, error);
    for (const char *word = first; !code && word; word = obj_word(end)) {
        end = obj_word_end(word);
        const size_t length = (size_t)(end - word);
        char *found = library_find_beside(path, word, length);
        code = library_add(library, found ? found : strndup(word, length), error);
    }
    return code;
}
