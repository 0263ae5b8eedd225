#ifndef TESTS_RUNTIME_NESTED_PROGRAM_H
#define TESTS_RUNTIME_NESTED_PROGRAM_H

/* Random trees of tasks that fork: made from a seed, interpreted in the reference order alone (a
 * body, then its children one after the other with all their descendants; a wait closes a segment),
 * run on the runtime, compared bit for bit. The interpreter shares with the runtime nothing but the
 * arithmetic of the bodies. */

#include <duite.h>
#include <duite_policy.h>

#include <stdbool.h>
#include <stdint.h>

enum {
    NEST_MAX_PARAMS = 3,
    NEST_MAX_OBJECTS = 12, /* a task's parameters and what it makes */
    NEST_MAX_ACTIONS = 20,
    NEST_MAX_TASKS = 120,
    NEST_MAX_COUNT = 4,
    NEST_LAWS = 4, /* sum, min, max, and one of the program's */
    NEST_SIGNATURES = 1 + 8 + 64 + 512,
    NEST_KERNELS = NEST_LAWS * NEST_SIGNATURES
};

enum nest_kind {
    NEST_NEW,
    NEST_FREE,
    NEST_SET,
    NEST_CONTRIBUTE, /* the task itself, to a parameter under cwp */
    NEST_FORK,
    NEST_GET,
    NEST_WAIT,
    NEST_REPLAY /* main program: the next `count` actions, forks and sets, `max` times: from a
                   graph, or forked again and again */
};

/* What a task does, one thing after the other; objects by their place in its table. */
struct nest_action {
    enum nest_kind kind;
    unsigned object[NEST_MAX_PARAMS];
    unsigned task; /* fork: which */
    duite_type type;
    size_t count, max; /* of the object, or (count) of what is set; they differ if it is sized */
    bool sized;
    int32_t priority; /* fork */
    bool forked;      /* replay: the rounds are forked, so that they may be recognised */
    uint64_t seed;    /* set; 0: zeros, as many as there can be. Contribute */
};

struct nest_task {
    unsigned n, n_actions;
    duite_mode mode[NEST_MAX_PARAMS];
    bool sized[NEST_MAX_PARAMS];
    unsigned law;  /* by which it contributes */
    uint64_t seed; /* of its arithmetic */
    int fails;     /* the code it returns */
    struct nest_action action[NEST_MAX_ACTIONS];
};

/* Task 0 is the main program. */
struct nest_program {
    uint64_t seed;
    unsigned n_tasks;
    struct nest_task task[NEST_MAX_TASKS];
};

/* What the main program is told by each of its gets and waits, in order. */
struct nest_answer {
    int code;
    size_t bytes; /* get */
    unsigned char value[NEST_MAX_COUNT * 8];
};

struct nest_answers {
    struct nest_answer of[NEST_MAX_ACTIONS]; /* of the main program's actions */
    int runs[NEST_MAX_TASKS];
};

void nest_make(struct nest_program *program, uint64_t seed);
void nest_print(const struct nest_program *program);

/* False without memory. */
bool nest_interpret(const struct nest_program *program, struct nest_answers *answers);

/* The kernel for such parameters: nest_kernels has all, numbered like this. */
unsigned nest_kernel(const struct nest_task *task);

/* The arithmetic of a body. What it read so far is `digest`; parameters without data are skipped.
 */
size_t nest_size(duite_type type);
uint64_t nest_mix(uint64_t digest, const void *bytes, size_t n);
uint64_t nest_read(const struct nest_task *task, const duite_param *param);
/* How many elements it leaves of parameter i, which it writes. */
size_t nest_count(const struct nest_task *task, const duite_param *param, unsigned i,
                  uint64_t digest);
void nest_write(const struct nest_task *task, const duite_param *param, uint64_t digest);
void nest_values(duite_type type, size_t count, uint64_t seed, void *values);
/* Law number 3: neither associative nor commutative. */
void nest_law(void *left, const void *right, size_t count, duite_type type);

#endif
