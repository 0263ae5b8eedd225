#ifndef BENCH_SETS_H
#define BENCH_SETS_H

#include "cloth/scene/scene.h"

#include <stdarg.h>
#include <stdio.h>

/* Changes to a scene, in the order in which they are added, with room for their text. */

enum { MOST_SETS = 16, SET_LENGTH = 4400 };

struct sets {
    size_t n;
    struct scene_set set[MOST_SETS];
    char text[MOST_SETS][SET_LENGTH];
};

/* An empty text adds nothing. */
__attribute__((format(printf, 2, 3))) static inline void add_set(struct sets *sets,
                                                                 const char *format, ...)
{
    va_list list;
    va_start(list, format);
    vsnprintf(sets->text[sets->n], SET_LENGTH, format, list);
    va_end(list);
    if (!*sets->text[sets->n])
        return;
    sets->set[sets->n].text = sets->text[sets->n];
    sets->n++;
}

#endif
