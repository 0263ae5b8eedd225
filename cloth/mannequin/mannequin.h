#ifndef CLOTH_MANNEQUIN_MANNEQUIN_H
#define CLOTH_MANNEQUIN_MANNEQUIN_H

#include "cloth/base/error.h"
#include "cloth/mesh/mesh.h"

#include <stdint.h>

/* A figure that garments are put on: the mesh of a standing person without a face, its arms held
 * aside at 45 degrees. Metres; +y is up, it faces +z, stands on y = 0, and its left and right are
 * mirror images at x = 0. Every bit is the same with any compiler and processor: all is made of
 * + - * / and sqrt. Local functions. */

enum mannequin_girth {
    MANNEQUIN_NECK,
    MANNEQUIN_CHEST,
    MANNEQUIN_WAIST,
    MANNEQUIN_HIP,
    MANNEQUIN_THIGH,
    MANNEQUIN_KNEE,
    MANNEQUIN_CALF,
    MANNEQUIN_ANKLE,
    MANNEQUIN_UPPER_ARM,
    MANNEQUIN_ELBOW,
    MANNEQUIN_WRIST,
    MANNEQUIN_GIRTHS
};

/* A girth that can be asked for. All is that of a figure of MANNEQUIN_HEIGHT; for another height it
 * is multiplied by height / MANNEQUIN_HEIGHT. */
struct mannequin_measure {
    const char *name;    /* "upper_arm" */
    double girth;        /* m: where none is asked for */
    double least, most;  /* m */
    double at;           /* m: height of the level section; of an arm along it, from the shoulder */
    const char *section; /* where it is taken: "the level section at 1.28 m" */
};
extern const struct mannequin_measure mannequin_measures[MANNEQUIN_GIRTHS];

#define MANNEQUIN_HEIGHT       1.75 /* m */
#define MANNEQUIN_LEAST_HEIGHT 1.0
#define MANNEQUIN_MOST_HEIGHT  2.3
#define MANNEQUIN_EDGE         0.02 /* m */
#define MANNEQUIN_LEAST_EDGE   0.008
#define MANNEQUIN_MOST_EDGE    0.025

/* The measures of a figure. 0: MANNEQUIN_HEIGHT, MANNEQUIN_EDGE, the measure's own girth. */
struct mannequin {
    double height;                  /* m */
    double edge;                    /* m: of its triangles; thin parts have shorter ones, to half */
    double girth[MANNEQUIN_GIRTHS]; /* m */
};

/* Makes the mesh: one closed manifold surface of the genus 0, triangles counterclockwise as seen
 * from outside. It has the height exactly, and each girth within 0.5 %. girth, unless NULL: those
 * of the mesh, m. rig, unless NULL: of the mesh, to be freed. Errors: CLOTH_E_INPUT for values out
 * of range, and for girths that do not go together; they name the measure. CLOTH_E_MEMORY. After an
 * error the mesh is empty. */
struct mannequin_rig;
int mannequin_make(struct mesh *mesh, struct mannequin_rig *rig, const struct mannequin *mannequin,
                   double girth[MANNEQUIN_GIRTHS], struct cloth_error *error);

/* Replaces 0 by defaults; checks ranges and ratios of measures. Errors: CLOTH_E_INPUT, with the
 * measure's name. */
int mannequin_complete(struct mannequin *mannequin, struct cloth_error *error);

/* The number of a measure's name; MANNEQUIN_GIRTHS: there is none. */
uint32_t mannequin_find(const char *name);

#endif
