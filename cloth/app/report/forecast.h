#ifndef CLOTH_APP_REPORT_FORECAST_H
#define CLOTH_APP_REPORT_FORECAST_H

#include "cloth/app/report/summary.h"
#include "cloth/app/run/outputs_room.h"

#include <stdatomic.h>

/* A forecast of a run by its first steps, on rank 0. forecast.c says which runs its intervals were
 * compared with. Local functions. */
struct forecast {
    struct outputs_extent extent;
    double begun;     /* s of the clock: the end of the first step; 0: before */
    atomic_bool over; /* there were steps enough; any thread may ask */
    double edge;      /* m: mean length of the triangles' edges of all cloths; 0: there are none */
    double seconds[3], memory[3]; /* likely, least, most: s of the clock; bytes, of any rank */
};

/* While the first phase has its meshes. */
void forecast_begin(struct forecast *forecast, const struct phases *phases);
/* trial: of the first steps; its model has no meshes any more. */
void forecast_end(struct forecast *forecast, const struct summary *trial);
/* A table for people, with what is slow and what to do. */
void forecast_print(FILE *file, const struct forecast *forecast, const struct summary *trial);
/* The same numbers as flat JSON. Errors as of output_report_write. */
int forecast_write(const struct forecast *forecast, const char *path, struct cloth_error *error);

#endif
