/* An error keeps the first failure only: the code that notices first knows most about it. */
#include "cloth/base/error.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A message may be too long, for example with a path of thousands of letters. Then it loses its
 * middle: its begin says where it happened, its end says why and what to do. whole: longer than
 * size. */
static void cut_middle(const char *whole, char *text, size_t size)
{
    static const char gap[] = " ... ";
    const size_t length = strlen(whole);
    size_t head = size / 4, tail = length - (size - head - sizeof gap);
    while (head > 0 && (whole[head] & 0xc0) == 0x80) /* within a letter of UTF-8 */
        head--;
    while ((whole[tail] & 0xc0) == 0x80)
        tail++;
    snprintf(text, size, "%.*s%s%s", (int)head, whole, gap, whole + tail);
}

static void print(char *text, size_t size, const char *format, va_list list)
{
    char *whole = NULL;
    if (vasprintf(&whole, format, list) < 0)
        snprintf(text, size, "out of memory for what went wrong: %s", format);
    else if (strlen(whole) < size)
        memcpy(text, whole, strlen(whole) + 1);
    else
        cut_middle(whole, text, size);
    free(whole);
}

int cloth_fail(struct cloth_error *error, int code, const char *format, ...)
{
    if (!error)
        return code;
    if (error->code)
        return error->code;
    va_list list;
    va_start(list, format);
    print(error->text, sizeof error->text, format, list);
    va_end(list);
    error->code = code;
    return code;
}

void cloth_text_add(char *text, size_t size, const char *format, ...)
{
    const size_t used = strlen(text);
    va_list list;
    va_start(list, format);
    vsnprintf(text + used, size - used, format, list);
    va_end(list);
}
