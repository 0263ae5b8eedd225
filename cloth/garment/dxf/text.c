/* The text of a DXF file: pairs of lines, a group code and a value. */
#include "cloth/base/file.h"
#include "cloth/base/number.h"
#include "cloth/garment/dxf/dxf.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double MOST = 1e9; /* of coordinates, in any unit */
enum { MOST_BYTES = 1 << 28 };

int dxf_fail(const struct dxf *dxf, size_t at, struct cloth_error *error, const char *format, ...)
{
    char text[400];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    return cloth_fail(error, CLOTH_E_INPUT, "%s:%zu: %s", dxf->path, at, text);
}

#define WRONG(text, ...) dxf_fail((text)->dxf, (text)->line, (text)->error, __VA_ARGS__)

/* The next line without blanks around it; NULL: the file is over. */
static char *next_line(struct dxf_text *text)
{
    char *line = text->next;
    if (!line || !*line)
        return NULL;
    char *end = line + strcspn(line, "\n");
    text->next = *end ? end + 1 : end;
    text->line++;
    while (end > line && strchr(" \t\r", end[-1]))
        end--;
    *end = '\0';
    return line + strspn(line, " \t");
}

int dxf_text_next(struct dxf_text *text)
{
    const char *code = next_line(text);
    char *end;
    text->over = !code || (!*code && !*text->next);
    if (text->over)
        return CLOTH_OK;
    text->code = strtol(code, &end, 10);
    if (end == code || *end)
        return WRONG(text,
                     "'%.40s' is no group code: DXF as text has pairs of lines, a whole number and "
                     "a value",
                     code);
    text->value = next_line(text);
    return text->value ? CLOTH_OK
                       : WRONG(text, "the file ends behind the group code %ld, without a value",
                               text->code);
}

int dxf_text_number(struct dxf_text *text, double *value)
{
    if (cloth_number(text->value, value) && *value >= -MOST && *value <= MOST)
        return CLOTH_OK;
    return WRONG(text, "'%.40s' is no number; group code %ld is a coordinate of at most 1e9",
                 text->value, text->code);
}

int dxf_text_open(struct dxf_text *text, const struct dxf *dxf, struct cloth_error *error)
{
    const char *path = dxf->path;
    size_t n;
    *text = (struct dxf_text){.dxf = dxf, .error = error};
    FILE *file = cloth_file_open(path);
    if (!file)
        return cloth_fail(error, CLOTH_E_IO, "%s: cannot be read: %s", path, cloth_file_why());
    const int code = cloth_file_read(file, MOST_BYTES, &text->bytes, &n);
    if (code == CLOTH_E_INPUT)
        cloth_fail(error, code, "%s: it has more than %d bytes", path, MOST_BYTES);
    else if (code)
        cloth_fail(error, code, "%s: cannot be read: %s", path, strerror(errno));
    fclose(file);
    if (code)
        return code;
    text->next = text->bytes;
    if (!strncmp(text->bytes, "AutoCAD Binary DXF", 18))
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%s: a binary DXF file; one as text (ASCII) is expected", path);
    return memchr(text->bytes, 0, n)
               ? cloth_fail(error, CLOTH_E_INPUT, "%s: it has zero bytes: no DXF as text", path)
               : CLOTH_OK;
}
