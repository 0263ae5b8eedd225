/* A line is whole before anyone sees it, and has no zero byte inside. Work is linear in the size of
 * the file, whatever its lines. */
#include "cloth/mesh/detail/lines.h"

#include "cloth/base/file.h"
#include "cloth/mesh/detail/finish.h"

#include <errno.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK = 1 << 18 };

int mesh_lines_open(struct mesh_lines *lines, const char *path, struct cloth_error *error)
{
    lines->path = path;
    lines->chunk = cloth_alloc(CHUNK, 1, error);
    if (!lines->chunk)
        return CLOTH_E_MEMORY;
    lines->file = cloth_file_open(path);
    if (!lines->file)
        return cloth_fail(error, CLOTH_E_IO, "%s: cannot be opened: %s", mesh_path_shown(path),
                          cloth_file_why());
    return CLOTH_OK;
}

static int refill(struct mesh_lines *lines, struct cloth_error *error)
{
    lines->at = 0;
    lines->end = fread(lines->chunk, 1, CHUNK, lines->file);
    if (lines->end == 0 && ferror(lines->file))
        return cloth_fail(error, CLOTH_E_IO, "%s: cannot be read: %s", mesh_path_shown(lines->path),
                          strerror(errno));
    return CLOTH_OK;
}

static int lines_append(struct mesh_lines *lines, const char *piece, size_t n,
                        struct cloth_error *error)
{
    if (memchr(piece, 0, n))
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%s:%zu: the line has a zero byte; an OBJ file is text",
                          mesh_path_shown(lines->path), lines->next);
    char *to = cloth_list_add(&lines->text, 1, n, error);
    if (!to)
        return CLOTH_E_MEMORY;
    memcpy(to, piece, n);
    return CLOTH_OK;
}

/* Appends one line of the file to the text, without its end; *more: there was one. */
static int lines_take(struct mesh_lines *lines, bool *more, struct cloth_error *error)
{
    bool whole = false;
    *more = false;
    while (!whole) {
        int code = lines->at == lines->end ? refill(lines, error) : CLOTH_OK;
        if (code || lines->end == 0)
            return code;
        if (!*more)
            lines->next++;
        *more = true;
        const char *from = lines->chunk + lines->at;
        const char *stop = memchr(from, '\n', lines->end - lines->at);
        size_t n = stop ? (size_t)(stop - from) : lines->end - lines->at;
        code = lines_append(lines, from, n, error);
        if (code)
            return code;
        whole = stop;
        lines->at += n + (whole ? 1 : 0);
    }
    return CLOTH_OK;
}

static bool lines_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

/* Cuts blanks off the end of the text, not before `first`; whether a `\` was the last of it (then
 * cut off too). */
static bool trim(struct cloth_list *text, size_t first)
{
    const char *at = text->items;
    while (text->n > first && lines_blank(at[text->n - 1]))
        text->n--;
    if (text->n == first || at[text->n - 1] != '\\')
        return false;
    text->n--;
    return true;
}

static bool comment(const struct cloth_list *text)
{
    const char *at = text->items;
    size_t i = 0;
    while (i < text->n && lines_blank(at[i]))
        i++;
    return i < text->n && at[i] == '#';
}

int mesh_lines_next(struct mesh_lines *lines, char **text, struct cloth_error *error)
{
    bool more, goes_on = true;
    *text = NULL;
    lines->text.n = 0;
    lines->line = lines->next + 1;
    for (size_t first = 0; goes_on; first = lines->text.n) {
        int code = lines_take(lines, &more, error);
        if (code)
            return code;
        if (!more && first == 0)
            return CLOTH_OK;
        goes_on = more && trim(&lines->text, first) && !(first == 0 && comment(&lines->text));
        code = goes_on ? lines_append(lines, " ", 1, error) : CLOTH_OK;
        if (code)
            return code;
    }
    char *end = cloth_list_add(&lines->text, 1, 1, error);
    if (!end)
        return CLOTH_E_MEMORY;
    *end = 0;
    *text = lines->text.items;
    return CLOTH_OK;
}

void mesh_lines_close(struct mesh_lines *lines)
{
    if (lines->file)
        fclose(lines->file);
    free(lines->chunk);
    free(lines->text.items);
    *lines = (struct mesh_lines){0};
}
