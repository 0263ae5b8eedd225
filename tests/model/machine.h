#ifndef TESTS_MODEL_MACHINE_H
#define TESTS_MODEL_MACHINE_H

#include "tests/model/explore.h"

/* Between the machine, which runs the threads, and the search, which says who goes next. An actor
 * is a thread, or the part of a thread's buffer that holds its stores to one place: that one's step
 * brings the oldest of them to memory. */
enum { MACHINE_ACTORS = 64, MACHINE_STEPS = 640 };

enum machine_kind {
    MACHINE_BEGIN,
    MACHINE_LOAD,
    MACHINE_AWAIT,
    MACHINE_TIMED,
    MACHINE_FENCE,
    MACHINE_EXCHANGE,
    MACHINE_ADD,
    MACHINE_COMPARE,
    MACHINE_FLUSH
};

/* An actor's next step, or one that was done. */
struct machine_step {
    enum machine_kind kind;
    struct explore_place place;
    unsigned actor, thread;
    bool drained; /* needs the thread's buffer empty */
    bool timed;   /* AWAIT: of a timed wait whose time is never up again */
    bool release; /* FLUSH: needs the earlier stores in memory */
    bool writes;
    unsigned number; /* FLUSH: of the store among the thread's */
    int origin;      /* the step of another actor that made this one possible, or -1 */
    uint64_t operand, expected, result;
};

unsigned machine_actors(void);
bool machine_ready(unsigned actor);
/* The actor's next step. */
void machine_peek(unsigned actor, struct machine_step *step);

enum machine_end { MACHINE_OVER, MACHINE_ALIVE, MACHINE_STUCK, MACHINE_WRONG, MACHINE_CUT };

/* One execution of a case. MACHINE_ALIVE: a thread would go on after its timed wait; _CUT: the
 * search ended it; _WRONG: a check failed; _STUCK: threads sleep for ever. */
enum machine_end machine_run(const struct explore_case *small, struct explore_plant plant);
const char *machine_wrong(void);
bool machine_planted(void); /* whether the plant changed anything in the last execution */

/* ---- For the operations, called by the running thread ---- */

/* Does one step, when its turn comes; returns what was there before. */
uint64_t machine_step(struct machine_step next);
/* Puts a store into the buffer. */
void machine_store(struct explore_place place, uint64_t value, bool release);
bool machine_buffers(void); /* whether stores are in the thread's buffer */
/* True if its timed wait may run out. */
bool machine_time_left(void);
/* Threads are numbered from 0; -1 is nobody: the case's start or end. gone is 1 once it is over. */
int machine_create(void *(*start)(void *), void *argument);
int machine_self(void);
uint64_t *machine_gone(int thread);
/* The change of the plant, if it is here. */
enum explore_change machine_change(const char *function, const char *what);

/* ---- The search ---- */

/* The actor of the next step, which is the index-th; -1 ends the execution. */
int search_next(int current, int *index);
/* The value that the step read, or wrote, for readers of the schedule. */
void search_result(int index, uint64_t result);

#endif
