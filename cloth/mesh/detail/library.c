/* Only names are kept: no library is read. */
#include "cloth/mesh/detail/library.h"

#include "cloth/mesh/detail/words.h"

#include <stdlib.h>
#include <string.h>

/* The absolute path of a name of `length` bytes beside `path`; NULL: there is no such file. */
static char *library_find_beside(const char *path, const char *name, size_t length)
{
    const char *slash = strrchr(path, '/');
    const size_t folder = slash && *name != '/' ? (size_t)(slash - path) + 1 : 0;
    char *joined = malloc(folder + length + 1);
    if (!joined)
        return NULL;
    memcpy(joined, path, folder);
    memcpy(joined + folder, name, length);
    joined[folder + length] = 0;
    char *found = realpath(joined, NULL);
    free(joined);
    return found;
}

/* Takes over a path; NULL: the name. A library that comes again at once is the same. */
static int library_add(struct cloth_list *library, char *found, const char *name, size_t length,
                       struct cloth_error *error)
{
    char *text = found ? found : strndup(name, length);
    char **all = library->items;
    if (text && library->n && !strcmp(all[library->n - 1], text)) {
        free(text);
        return CLOTH_OK;
    }
    char **to = text ? cloth_list_add(library, sizeof *to, 1, error) : NULL;
    if (to)
        *to = text;
    else
        free(text);
    return to ? CLOTH_OK : cloth_fail(error, CLOTH_E_MEMORY, "out of memory for a material's file");
}

int mesh_library_line(struct cloth_list *library, const char *path, const char *at,
                      struct cloth_error *error)
{
    const char *first = mesh_word(at), *end = first;
    int code = CLOTH_OK;
    if (!first)
        return CLOTH_OK;
    for (const char *word = first; word; word = mesh_word(end))
        end = mesh_word_end(word);
    char *whole = library_find_beside(path, first, (size_t)(end - first));
    if (whole)
        return library_add(library, whole, NULL, 0, error);
    for (const char *word = first; !code && word; word = mesh_word(end)) {
        end = mesh_word_end(word);
        const size_t length = (size_t)(end - word);
        code = library_add(library, library_find_beside(path, word, length), word, length, error);
    }
    return code;
}
