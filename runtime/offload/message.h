#ifndef DUITE_OFFLOAD_MESSAGE_H
#define DUITE_OFFLOAD_MESSAGE_H

#include "runtime/offload/offload.h"
#include "runtime/task/internal.h"

/* The message of an offloaded task and that of its result; shared by send.c and receive.c.
 * Everything after the first table begins on a cache line of its own.
 *
 * The way there is a packet of kind DATA_OFFLOADED; key.slot is the rank it comes from, key.number
 * its name there, a number. It has an offload_message, an offload_param for each parameter,
 * the arguments, and the values that the body reads.
 *
 * The way back is a DATA_RESULT (key.number: that name). MESSAGE_RAN, the body ran: it has an
 * offload_left for each parameter, then the values that the body wrote, then those that its
 * children left. MESSAGE_FAILED_BELOW: the first failure among the task and its descendants
 * follows. MESSAGE_FAILED: the body's own failure is the last; if the body did not run, it is all
 * there is. */
struct offload_message {
    uint64_t number; /* of the main program's task that it is or descends from */
    uint64_t index;  /* in its scope */
    uint64_t round;  /* of the replay that forked it */
    uint32_t kernel, n, block;
    int32_t priority;
    float cost;
    uint32_t path_length; /* its place below `number`: see data_failure */
    uint8_t path[sizeof((struct data_failure *)0)->path];
};

struct offload_param {
    uint64_t bytes, max; /* that travel; elements there may be */
    uint32_t type, sized;
};

/* The part of a parameter that follows: its value; nothing, if it was only read or no child
 * contributed; or its failure. */
enum offload_what { LEFT_VALUE, LEFT_NOTHING, LEFT_POISON };
struct offload_left {
    uint64_t bytes;
    uint64_t what;
};

enum { MESSAGE_FAILED = 1, MESSAGE_FAILED_BELOW = 2, MESSAGE_RAN = 4 }; /* packet->pieces */

static inline size_t message_lines(size_t bytes)
{
    return (bytes + 63) / 64 * 64;
}

/* The bytes of a value that is read, 0 for others. Each has an address of its own, even if it is
 * empty. */
static inline size_t message_value(uint32_t declared, size_t bytes)
{
    return data_order_reads(task_immediate((duite_mode)declared)) ? message_lines(bytes ? bytes : 1)
                                                                  : 0;
}

/* Room for the value that the body, or its children, leave of a parameter; or for the failure in
 * place of the children's. */
static inline size_t message_room(uint32_t declared, const struct offload_param *param)
{
    const bool left = task_immediate((duite_mode)declared) != DUITE_R;
    const size_t bytes = left ? param->max * data_type_size((duite_type)param->type) : 0;
    return declared > DUITE_RP && bytes < sizeof(struct data_failure) ? sizeof(struct data_failure)
                                                                      : bytes;
}

/* The place of the arguments. */
static inline size_t message_args_at(size_t n)
{
    return message_lines(sizeof(struct offload_message) + n * sizeof(struct offload_param));
}

/* The place of the values of a result. */
static inline size_t message_values_at(size_t n)
{
    return message_lines(n * sizeof(struct offload_left));
}

/* Copies bytes to a place in a packet's payload, and clears the rest of the last line; returns the
 * place behind them. */
size_t offload_message_put(struct data_packet *packet, size_t at, const void *from, size_t bytes);

/* A task of another rank. */
struct offload_task {
    struct task_scope above;   /* first: the top of its reference order; the failures of its subtree
                                   end up here */
    struct data_failure place; /* where it stands at home: number and path */
    struct data_packet *message; /* the one that came; the body reads there */
    struct data_packet *result;  /* the one that goes; the body writes there */
    struct task *task;
    struct task_scope *inner; /* of its children, or NULL; gone once they are over */
    const struct data_failure *failure;
    bool ran; /* its body was called */
    struct comm_letter send;
};

#endif
