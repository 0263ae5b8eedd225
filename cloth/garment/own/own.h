#ifndef CLOTH_GARMENT_OWN_OWN_H
#define CLOTH_GARMENT_OWN_OWN_H

#include "cloth/garment/pattern.h"

/* The project's own garments: patterns made from measures. Panels stand flat around a body that
 * faces +z, with its feet at y = 0, its middle at x = z = 0, and its arms hanging at 45 degrees.
 * Measures are in metres, but of those that are ratios. */

enum { GARMENT_MEASURES = 12 };

struct garment_measure {
    const char *name;      /* NULL: the table's end */
    double fallback, step; /* of size M, and how much more from one size to the next */
    double least, most;
    const char *about; /* for the table of measures */
};

struct draw;
struct garment_own {
    const char *name, *about;
    const struct garment_measure *measure;
    void (*draw)(struct draw *draw, const double *value); /* own.c alone calls it */
};

/* The garment or size of a name; NULL or -1: there is none. The words are all names. */
const struct garment_own *garment_own_find(const char *name);
int garment_size_find(const char *name);
extern const char garment_own_words[], garment_size_words[];

/* The measures of a size, in the order of the table: GARMENT_MEASURES values, 0 after the last. */
void garment_own_size(const struct garment_own *own, int size, double *value);

/* The number of a measure of that name, -1: there is none. */
int garment_own_measure(const struct garment_own *own, const char *name);

/* Fills a pattern from measures. It passes garment_pattern_check, and belongs to the caller
 * (garment_pattern_free), also after an error. Errors: CLOTH_E_INPUT for a measure out of its
 * range, or measures that cannot be together, with names, values and what is possible;
 * CLOTH_E_MEMORY. Local. */
int garment_own_make(struct garment_pattern *pattern, const struct garment_own *own,
                     const double *value, struct cloth_error *error);

#endif
