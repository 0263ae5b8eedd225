#ifndef CLOTH_APP_RUN_OPTIONS_H
#define CLOTH_APP_RUN_OPTIONS_H

#include "cloth/scene/scene.h"

#include <duite.h>
#include <stdbool.h>

/* The command line of duite-cloth, read and checked. */
struct simulate_options {
    const char *scene; /* path of the scene file, or the name of a shipped one */
    size_t n_sets;     /* changes to it, in the order given */
    struct scene_set *sets;
    const char *output, *report; /* folder of frames, JSON file; NULL: none */
    const char *restart;     /* the folder of frames of a run to go on with, which is `output`, too;
                              * NULL:     none */
    double checkpoint;       /* s: between two checkpoints; 0: none */
    const char *save_system; /* folder; NULL: none */
    const char *live;        /* address of the live view (live_is_address); NULL: none */
    const char *trace;       /* file; NULL: none */
    uint64_t trace_first, trace_end;         /* steps from .. to the one before */
    const struct duite_scheduler *scheduler; /* never NULL when it runs */
    const struct duite_mapping *mapping;     /* as that */
    const struct duite_balancer *balance;    /* as that */
    const char *scheduler_name, *mapping_name, *balance_name;
    unsigned threads; /* 0: the rank's share of the cores */
    uint64_t seed;
    bool check_intersections; /* of each frame */
    bool quiet;               /* neither progress nor summary */
};

#endif
