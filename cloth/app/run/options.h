#ifndef CLOTH_APP_RUN_OPTIONS_H
#define CLOTH_APP_RUN_OPTIONS_H

#include "cloth/scene/scene.h"

#include <duite.h>
#include <stdbool.h>
#include <stdio.h>

/* The command line of duite-cloth, read and checked. */
struct simulate_options {
    const char *scene; /* path of the scene file, or the name of a shipped one */
    size_t n_sets;     /* changes to it, in the order given */
    struct scene_set *sets;
    const char *output, *report; /* folder of frames, JSON file; NULL: none */
    const char *restart; /* the folder of frames of a run to go on with, which is `output`, too;
                          * NULL: none */
    double checkpoint;   /* s: between two checkpoints; 0: none */
    uint64_t first_frame, last_frame; /* that are made; UINT64_MAX: up to the end of the scene */
    const char *save_system;          /* folder; NULL: none */
    const char *live;                 /* address of the live view (live_is_address); NULL: none */
    duite_options runtime;            /* policies are never NULL when it runs */
    const char *scheduler_name, *mapping_name, *balance_name;
    bool check_intersections; /* of each frame */
    bool check;               /* only says what the run would take */
    bool quiet;               /* neither progress nor summary */
};

/* Reads A:B, where A or B may be left out: digits, A <= B. An end that is left out stays. Pure. */
bool options_range(const char *text, uint64_t *first, uint64_t *last);

/* Sets the defaults of options: the environment, else the built-in values. environment_check looks
 * for errors after the options, which may replace a value. Local. */
void environment_begin(struct simulate_options *run);

/* Error: CLOTH_E_INPUT, which names the variable. Local. */
int environment_check(const struct simulate_options *run, struct cloth_error *error);

/* A help_filter of argp: replaces SCHEDULERS, MAPPINGS and BALANCERS in a text by the names of the
 * policies. Local. */
char *environment_help(int key, const char *text, void *input);

/* The scenes that make install puts into share/duite/scenes. Local. */

/* The path of the shipped scene of this file name, or gallery/NAME, to be freed. NULL: the name has
 * another folder, a file of this name is here, or no shipped scene has it. */
char *shipped_scene(const char *name);

/* Prints a line for each: its file name and its first line's text. Returns how many there are. */
size_t shipped_print(FILE *file);

#endif
