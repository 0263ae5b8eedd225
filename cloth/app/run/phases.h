#ifndef CLOTH_APP_RUN_PHASES_H
#define CLOTH_APP_RUN_PHASES_H

#include "cloth/flow/run.h"
#include "cloth/scene/scene.h"

/* The phases of a scene: runs one after the other, each from the positions and velocities where the
 * one before ended. A scene without phases is one of them. All begins as zero; on other ranks than
 * 0 the models stay so. */

/* The results of a phase; checkpoints have them as they are. */
struct phase_done {
    uint64_t steps;
    double cg_iterations_mean; /* a step; NaN: of an explicit phase */
    double simulated_seconds, wall_seconds;
    double end;     /* s: its time.end in the scene */
    char ended[16]; /* a word for the report; empty: it did not begin, is not over, or failed */
};

struct phases {
    uint32_t n, now; /* at least 1; the one that is next, or runs */
    bool named;      /* the scene has phases */
    struct model *models;
    struct phase_done *done;
    double (*end)[6];         /* rank 0, of several: of each vertex, as model_cloth.start has it */
    uint32_t n_vertices;      /* rank 0: of all cloths; meshes are forgotten when a phase runs */
    uint64_t first_frame;     /* of the run, that is made */
    double until;             /* s, of all of them, on rank 0: all is over then, or before */
    bool keeps_start;         /* where the phase of now started is kept, too, for checkpoints: */
    double (*start)[6];       /* then: alike; NULL in the first one */
    struct flow_report total; /* of those that are over, as phases_add says */
};

/* On rank 0: reads the models of all phases and compares the parts that phases share. Errors:
 * CLOTH_E_INPUT with the place of the phase; CLOTH_E_MEMORY. Local. */
int phases_read(struct phases *phases, const char *path, size_t n_sets,
                const struct scene_set *sets, struct cloth_error *error);

/* Compares the model of a phase, by its number from 0, with the first one. One folder holds the
 * frames of all phases, so they share cloths, vertices and triangles, obstacles and their shapes,
 * frames a second, columns of probes, and forces of contact. Error: CLOTH_E_INPUT, which names the
 * phase and the difference. Local. */
int phases_check(const struct model *first, const struct model *model, uint32_t phase,
                 struct cloth_error *error);

/* The settings of all phases, to be freed: the version, then lines `key: value`, and `file PATH:
 * its hash`, each with its phase before it. NULL: no memory, or a file cannot be read. */
char *phases_settings(const struct phases *phases, struct cloth_error *error);
/* Fails with the first line of the settings that differs from those in the file `path`, n bytes.
 * Error: CLOTH_E_INPUT, CLOTH_E_MEMORY. */
int phases_compare(const char *path, const char *now, const void *was, size_t n,
                   struct cloth_error *error);

/* Sends the number of phases, the next one, and the results of earlier ones from rank 0 to all.
 * Error: CLOTH_E_MEMORY. Collective; it is not agreed on errors yet. */
int phases_share(struct phases *phases, struct cloth_error *error);

/* The model of the next phase; NULL if the scene could not be read. */
static inline struct model *phases_model(const struct phases *phases)
{
    return phases->models ? phases->models + phases->now : NULL;
}
/* The name of a phase; NULL: it has none, and on other ranks than 0. */
static inline const char *phases_label(const struct phases *phases, uint32_t phase)
{
    const struct model *model = phases->models ? phases->models + phase : NULL;
    return model && model->n_phases ? model->phases[phase].name : NULL;
}
static inline bool phases_is_last(const struct phases *phases)
{
    return phases->now + 1 == phases->n;
}
/* Ends all phases with a frame (UINT64_MAX: with the last of the scene), whose number counts from
 * 0. Error: CLOTH_E_INPUT, there is no such frame, or `first` is none. On rank 0. Local. */
int phases_end_with(struct phases *phases, uint64_t first, uint64_t last,
                    struct cloth_error *error);
/* s: how long a phase is at most that begins at a time, whole steps; 0: it does not begin. */
double phases_seconds(const struct phases *phases, uint32_t phase, double begin);
/* Before the next phase, whose model gets that end. On rank 0. Local. */
void phases_begin(struct phases *phases);
/* True if none begins after those that are done. Collective. */
bool phases_are_over(const struct phases *phases);

/* The state that the next phase starts from. The same on all ranks. */
struct flow_before phases_before(const struct phases *phases);

/* Goes on to the next phase, whose cloths start where the last one ended, on rank 0. Error:
 * CLOTH_E_MEMORY. Local. */
int phases_next(struct phases *phases, struct cloth_error *error);

/* Numbers of where a phase starts. The cloths of the phase of now, a later one, start there, as
 * when the phase before it ended. Error: CLOTH_E_MEMORY. On rank 0. Local. */
size_t phases_numbers(const struct phases *phases);
int phases_start(struct phases *phases, const double *numbers, struct cloth_error *error);

/* Makes all cloths of a model start there: by vertex of all cloths, as model_cloth.start has it.
 * Error: CLOTH_E_MEMORY. Local. */
int phases_start_at(struct model *model, double (*from)[6], struct cloth_error *error);

/* Adds the report of the phase that is over. Counts and seconds are added; peaks are the largest;
 * energies, the hash and other final values are those of this phase. Local. */
void phases_add(struct phases *phases, const struct flow_report *report);

/* Puts the name of the phase that runs before an error, if the scene has phases. */
void phases_name(const struct phases *phases, struct cloth_error *error);

void phases_free(struct phases *phases);

#endif
