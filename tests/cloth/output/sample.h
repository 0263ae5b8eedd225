#ifndef TESTS_CLOTH_OUTPUT_SAMPLE_H
#define TESTS_CLOTH_OUTPUT_SAMPLE_H

#include "cloth/output/output.h"

#include <sys/stat.h>

/* Two small cloths, a folder to write them to, and positions that tell frame and run apart. */

enum { SAMPLE_POINTS = 12 + 4 };

/* The test's own: one a program. */
extern struct sample {
    char folder[64]; /* of the test's own */
    char frames[80]; /* a folder in it that is not there yet */
    struct mesh mesh[2];
    const struct mesh *meshes[2];
    struct output_setup setup;
    bool settles; /* sample_run has a settler */
} sample;

/* A grid of 4 x 3 with uv, and a quadrilateral without; one plane. */
void sample_make(void);
/* Removes the folder with all in it. */
void sample_free(void);
/* `SAMPLE_POINTS` x 3 positions of a frame, exact as floats. */
void sample_positions(unsigned run, uint64_t frame, double *position);
/* A path in the test's folder, of printf's format; one of some buffers that take turns. */
__attribute__((format(printf, 1, 2))) const char *sample_at(const char *format, ...);
/* The file in the frames folder, likewise. */
const char *sample_path(const char *name);
/* True if something is at the path; its properties. */
bool sample_has(const char *path);
struct stat sample_stat(const char *path);
/* Reads up to size bytes of a file and ends them with '\0'; returns their number. */
size_t sample_read(const char *path, char *bytes, size_t size);
void sample_write(const char *path, const char *bytes, size_t size);
/* Puts bytes at a place of a file that is there; -1: behind its end. */
void sample_put(const char *path, long at, const char *bytes, size_t size);
/* Opens the folder, writes n frames of a run, closes. */
void sample_run(unsigned run, uint64_t n);

#endif
