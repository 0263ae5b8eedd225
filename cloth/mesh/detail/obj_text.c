/* A line is whole before anyone sees it, and has no zero byte inside. Work is linear in the size of
 * the file, whatever its lines, and does not depend on the program's locale. */
#include "cloth/base/file.h"
#include "cloth/mesh/detail/finish.h"
#include "cloth/mesh/detail/obj.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char BLANKS[] = " \t\r\v\f";

int obj_lines_open(struct obj_lines *lines, const char *path, struct cloth_error *error)
{
    lines->path = path;
    lines->file = cloth_file_open(path);
    return lines->file ? CLOTH_OK
                       : cloth_fail(error, CLOTH_E_IO, "%s: cannot be opened: %s",
                                    mesh_path_shown(path), cloth_file_why());
}

/* Reads one line of the file. *n: its length without its end; *more: there was one. */
static int read_raw(struct obj_lines *lines, size_t *n, bool *more, struct cloth_error *error)
{
    errno = 0;
    const ssize_t length = getline(&lines->raw, &lines->room, lines->file);
    *n = length > 0 ? (size_t)length : 0;
    *more = length > 0;
    if (ferror(lines->file))
        return cloth_fail(error, CLOTH_E_IO, "%s: cannot be read: %s", mesh_path_shown(lines->path),
                          strerror(errno));
    if (!*more)
        return errno == ENOMEM ? cloth_fail(error, CLOTH_E_MEMORY, "out of memory for a line of %s",
                                            mesh_path_shown(lines->path))
                               : CLOTH_OK;
    lines->next++;
    *n -= lines->raw[*n - 1] == '\n';
    if (memchr(lines->raw, 0, *n))
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%s:%zu: the line has a zero byte; a text file is expected",
                          mesh_path_shown(lines->path), lines->next);
    return CLOTH_OK;
}

/* Cuts blanks off the end of n bytes; whether a `\` was the last of them (then cut off too). */
static bool trim(const char *raw, size_t *n)
{
    while (*n && memchr(BLANKS, raw[*n - 1], sizeof BLANKS - 1))
        --*n;
    const bool goes_on = *n && raw[*n - 1] == '\\';
    *n -= goes_on;
    return goes_on;
}

int obj_lines_next(struct obj_lines *lines, const char **text, struct cloth_error *error)
{
    bool more, goes_on = true;
    *text = NULL;
    lines->text.n = 0;
    lines->line = lines->next + 1;
    while (goes_on) {
        size_t n;
        const int code = read_raw(lines, &n, &more, error);
        if (code || (!more && !lines->text.n))
            return code;
        const bool comment = !lines->text.n && lines->raw[strspn(lines->raw, BLANKS)] == '#';
        goes_on = trim(lines->raw, &n) && !comment;
        lines->raw[n] = goes_on ? ' ' : 0;
        char *to = cloth_list_add(&lines->text, 1, n + 1, error);
        if (!to)
            return CLOTH_E_MEMORY;
        memcpy(to, lines->raw, n + 1);
    }
    *text = lines->text.items;
    return CLOTH_OK;
}

void obj_lines_close(struct obj_lines *lines)
{
    if (lines->file)
        fclose(lines->file);
    free(lines->raw);
    free(lines->text.items);
    *lines = (struct obj_lines){0};
}

/* ---- Words ---- */

const char *obj_word(const char *at)
{
    at += strspn(at, BLANKS);
    return *at && *at != '#' ? at : NULL;
}

const char *obj_word_end(const char *word)
{
    return word + strcspn(word, BLANKS);
}

const char *obj_word_after(const char *line, const char *keyword)
{
    const char *word = obj_word(line);
    const size_t length = strlen(keyword);
    if (!word || strncmp(word, keyword, length) != 0 || obj_word_end(word) != word + length)
        return NULL;
    return word + length;
}

bool obj_word_number(const char *word, locale_t c, double *number)
{
    char *end;
    *number = strtod_l(word, &end, c);
    if (end == word || end != obj_word_end(word) || !isfinite(*number))
        return false;
    return !memchr(word, 'x', (size_t)(end - word)) && !memchr(word, 'X', (size_t)(end - word));
}

/* Reads a whole number and moves on behind it; false if there is none. */
static bool read_whole(const char **at, long long *number)
{
    const long long max = (long long)MESH_MAX + 1;
    if (!isdigit((unsigned char)(*at)[**at == '-' || **at == '+'])) /* strtoll skips blanks */
        return false;
    char *end;
    const long long n = strtoll(*at, &end, 10);
    *number = n > max ? max : n < -max ? -max : n;
    *at = end;
    return true;
}

bool obj_word_corner(const char *word, long long corner[3])
{
    const char *at = word, *end = obj_word_end(word);
    for (int i = 0; i < 3; i++) {
        corner[i] = 0;
        if (i > 0 && *at != '/')
            continue;
        at += i > 0;
        if ((i == 0 || (at != end && *at != '/')) && !read_whole(&at, &corner[i]))
            return false;
    }
    return at == end;
}

struct obj_quote obj_word_quote(const char *word)
{
    struct obj_quote quote = {""};
    size_t length = (size_t)(obj_word_end(word) - word), max = sizeof quote.text - 4;
    for (size_t i = 0; i < length && i < max; i++)
        quote.text[i] = word[i] > ' ' && word[i] < 127 ? word[i] : '?';
    if (length > max)
        memcpy(quote.text + max, "...", 4);
    return quote;
}
