#ifndef TESTS_CLOTH_GARMENT_TOOLS_H
#define TESTS_CLOTH_GARMENT_TOOLS_H

#include "cloth/garment/garment.h"
#include "cloth/scene/pattern.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Reads patterns/NAME.json, or ends the case. */
static inline struct garment_pattern read_pattern(const char *name)
{
    struct garment_pattern pattern;
    const char *top = getenv("srcdir");
    char path[4096];
    snprintf(path, sizeof path, "%s/tests/cloth/garment/patterns/%s.json", top ? top : ".", name);
    UNIT_FINE(scene_read_pattern(&pattern, path, NULL, &error));
    return pattern;
}

static inline void make_garment(struct garment *garment, const struct garment_pattern *pattern,
                                double edge, uint32_t vertices)
{
    const struct garment_fineness fineness = {edge, vertices};
    UNIT_FINE(garment_make(garment, pattern, &fineness, &error));
}

static inline double distance_of(const double *a, const double *b, int n)
{
    double sum = 0;
    for (int k = 0; k < n; k++)
        sum += (a[k] - b[k]) * (a[k] - b[k]);
    return sqrt(sum);
}

#endif
