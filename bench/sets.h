#ifndef BENCH_SETS_H
#define BENCH_SETS_H

#include "cloth/scene/scene.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Changes to a scene, in the order in which they are added, with room for their text. */

enum { MOST_SETS = 128, SET_LENGTH = 4400, SETS_LENGTH = 16 * SET_LENGTH };

struct sets {
    size_t n, length;
    struct scene_set set[MOST_SETS];
    char text[SETS_LENGTH];
};

/* An empty text adds nothing. */
__attribute__((format(printf, 2, 3))) static inline void add_set(struct sets *sets,
                                                                 const char *format, ...)
{
    va_list list;
    char *text = sets->text + sets->length;
    va_start(list, format);
    const int length = vsnprintf(text, SET_LENGTH, format, list);
    va_end(list);
    if (length <= 0)
        return;
    sets->length += strlen(text) + 1;
    sets->set[sets->n++].text = text;
}

#endif
