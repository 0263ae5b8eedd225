#ifndef DUITE_TRACE_FORMAT_H
#define DUITE_TRACE_FORMAT_H

#include <duite.h>

#include <stdint.h>

/* Trace files, version 3; readers refuse every other version. A run on n ranks leaves n files: FILE
 * of rank 0, and FILE.1, FILE.2, ... of the others; those of one run have the same `run`.
 *
 * A file is a header, rewritten when the trace ends, and sections up to header.bytes, each a
 * trace_section and so many bytes behind it, a multiple of 8. All numbers are of the byte order and
 * the sizes of the host that wrote them; header.order tells a reader with others. A section is
 * written whole or taken back: if the disk is full the file ends with the last whole one, and
 * header.lost counts the rest. */

#define TRACE_MAGIC "duitetrc"
enum { TRACE_VERSION = 3 };
#define TRACE_ORDER UINT32_C(0x01020304)

struct trace_header {
    char magic[8];
    uint32_t version, order;
    uint32_t rank, n_ranks;
    uint32_t workers; /* of this rank; worker 0 is the main thread */
    uint32_t whole;   /* 0: the run did not come to its end, and bytes and lost mean nothing */
    uint64_t bytes;   /* of the file */
    uint64_t lost;    /* events and words of the program that are missing */
    uint64_t run;     /* a number drawn by rank 0 */
    uint64_t epoch;   /* ticks of this rank's clock at its start */
    double tick;      /* seconds of a tick */
    int64_t began;    /* seconds since 1970 */
    double latency;   /* seconds of the shortest message there or back that rank 0 saw; 0: none */
    uint64_t first, end; /* steps to record: first .. end - 1 */
};

/* The content of a section. */
enum trace_section_kind {
    TRACE_KERNELS = 1, /* `worker` of them: a trace_kernel each, then their names, ended by 0; again
                          with all of them when the program adds one */
    TRACE_EVENTS,      /* trace_event, of one worker, in the order of their ends */
    TRACE_PROGRAM,     /* 32-bit words, see below; rank 0 only; `worker` 1: the last one fills */
    TRACE_CLOCK,       /* trace_clock: one at the start, one at the end */
    TRACE_COUNTERS,    /* trace_counters, of one worker; when the trace ends */
};

struct trace_section {
    uint32_t kind, worker;
    uint64_t bytes; /* behind this head */
};

/* Modes of the first parameters; duite_mode of all further ones, 0: there are none. */
struct trace_kernel {
    uint8_t mode[DUITE_MAX_ACCESS];
    uint8_t variadic, replicated, fixed, n_modes; /* n_modes: how many first ones */
    uint32_t unused;
};

/* An event of a worker. Times are ticks of its rank's clock. */
enum trace_kind {
    TRACE_TASK = 1, /* a body; kernel, number */
    TRACE_OWN,      /* a task of the runtime's own; kernel: its place among task_type */
    TRACE_IDLE,     /* without a task; within: of that, messages were awaited */
    TRACE_STEAL,    /* of a task; kernel: from which worker */
    TRACE_SEND,     /* number: bytes; kernel: to which rank */
    TRACE_RECEIVE,  /* number: bytes (of a recorded graph's message: at most); kernel: from whom */
    TRACE_DELEGATE, /* number: of the task; kernel: to which rank */
    TRACE_MIGRATE,  /* number: objects that moved; took: how long all of it took */
    TRACE_STEP,     /* number: the step that begins */
    TRACE_FLUSH,    /* events were written; number: bytes */
    TRACE_MESSAGES, /* a worker that was not idle polled, sent or received messages */
    TRACE_KINDS
};

/* Flags of a TASK. */
enum {
    TRACE_NESTED = 1,    /* a descendant of the main program's task with this number */
    TRACE_OFFLOADED = 2, /* of another rank's program, delegated to this one */
    TRACE_CHAINED = 4,   /* ran inline: directly after the one that made it ready */
};

struct trace_event {
    uint64_t begin, took;
    uint64_t within; /* TASK, OWN: of `took`, other tasks, messages and idling inside of it */
    uint64_t number; /* of tasks: place in the fork order of the main program, from 1 */
    uint32_t kernel; /* place in the list of kernels */
    uint8_t kind, flags;
    uint16_t unused;
};

/* The clock of rank 0, in seconds since its epoch, is this one's minus `ahead`, within `bound`,
 * when this one says `at`: half of the shortest of several round trips. */
struct trace_clock {
    double at, ahead, bound;
};

/* A worker's counts from start to end, over all steps: numbers of tasks, and ticks. */
struct trace_counters {
    uint64_t tasks, stolen, chained, delegated, busy, idle;
    uint64_t messages, bytes; /* of the rank; worker 0 */
};

/* ---- The program ----
 *
 * The calls of the main program, the same on every rank. An entry begins with its kind in the
 * lowest 8 bits of a word and a count n in the others. Objects are named by slots: a slot means the
 * object that was made in it last. 64-bit numbers are two words, the low one first. Objects, homes
 * and graphs are always there; all others only while steps are recorded. */
enum trace_call {
    TRACE_FILLS,     /* no entry: the last word of a section that fills its 64 bits */
    TRACE_OBJECT,    /* slot; bytes (64 bits) */
    TRACE_FREE = 3,  /* slot; the number before stays unused */
    TRACE_HINT,      /* slot; weight (double); n neighbours: slot; weight (double) */
    TRACE_COLOCATE,  /* slot; its leader's */
    TRACE_HOMES,     /* n: slot; home: by the mapping, of all that had none, or by migration */
    TRACE_ON,        /* number of the last fork (64 bits); step (64); ticks (64) */
    TRACE_OFF,       /* the same */
    TRACE_FORK,      /* n slots; kernel before them */
    TRACE_FORKED,    /* the same, between both: rank or -1; priority; cost (float) */
    TRACE_SET,       /* slot */
    TRACE_GET,       /* slot; rank or -1: all; ticks from .. to (64 bits each) */
    TRACE_WAIT,      /* ticks from .. to (64 bits each) */
    TRACE_GRAPH,     /* name; n objects: slot; see below */
    TRACE_REPLAY,    /* name; flag's slot or 0; rounds at most (64); number of the last fork before
                        (64); n objects of the graph: slot bound to it */
    TRACE_GET_BEGIN, /* number of the get; slot */
    TRACE_GET_END,   /* number of the get, whose begin may be missing; ticks from .. to (64 bits
                        each) */
    TRACE_CALLS
};

/* TRACE_GRAPH goes on with the number of its forks and sets. Each of these is: kernel or -1 (set);
 * n; rank or -1; priority; cost (float); n places among the graph's objects. */

#endif
