#ifndef TESTS_SUPPORT_TRACE_FILE_H
#define TESTS_SUPPORT_TRACE_FILE_H

#include "runtime/trace/format.h"

#include <duite.h>
#include <stdbool.h>
#include <stddef.h>

/* A trace of one rank that never ran: tasks and seconds as a test wants them. */
struct trace_file {
    uint32_t *word;
    size_t n_words, words_capacity;
    struct trace_event *event;
    size_t n_events, events_capacity;
    uint64_t forks;
    uint64_t lost;
};

/* Kernels of it: the modes of their parameters. */
enum trace_file_kernel {
    FILE_W,
    FILE_RW,
    FILE_R_W,
    FILE_RR_W,
    FILE_R_CW,
    FILE_SAME,
    FILE_RR_RW,
    FILE_KERNELS,
    FILE_SET /* of a recorded graph: no kernel, a duite_set */
};

/* An object of `slot` (from 1 on), at home where the mapping wants it. */
void trace_file_object(struct trace_file *file, uint32_t slot, uint64_t bytes);
/* The bytes that the object exchanges with another one; before trace_file_begin. */
void trace_file_hint(struct trace_file *file, uint32_t slot, uint32_t other, double bytes);
/* All objects up to a slot have homes from now on; then steps are recorded, behind as many forks as
 * `forks` says. */
void trace_file_begin(struct trace_file *file, uint32_t n_slots);
/* A task of so many seconds. */
void trace_file_fork(struct trace_file *file, enum trace_file_kernel kernel, double seconds,
                     int32_t priority, size_t n, const uint32_t *slots);
/* A recorded graph on the objects 1 .. n_objects (places from 0), and so many rounds of it. */
struct trace_file_node {
    enum trace_file_kernel kernel;
    double seconds;
    float cost; /* that its fork says; 0: it does not */
    uint32_t n, place[3];
};
void trace_file_graph(struct trace_file *file, uint32_t n_objects, uint32_t n,
                      const struct trace_file_node *nodes);
void trace_file_replay(struct trace_file *file, uint32_t n_objects, uint32_t n,
                       const struct trace_file_node *nodes, uint32_t rounds);
/* One of the runtime's own tasks: by its number among those. */
void trace_file_own(struct trace_file *file, uint32_t type, double seconds);
/* Any event, behind those that are there. */
void trace_file_event(struct trace_file *file, const struct trace_event *event);
/* The main program waits for all, or for an object; until then it forked for so many seconds. */
void trace_file_wait(struct trace_file *file);
void trace_file_forked(struct trace_file *file, double seconds);
void trace_file_get(struct trace_file *file, uint32_t slot);
/* The same in two calls, of the get of this number. */
void trace_file_get_begin(struct trace_file *file, uint32_t number, uint32_t slot);
void trace_file_get_end(struct trace_file *file, uint32_t number);
void trace_file_word(struct trace_file *file, uint32_t word);
/* Writes it, and frees all. False: it could not. */
bool trace_file_write(struct trace_file *file, const char *path);

#endif
