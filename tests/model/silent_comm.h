#ifndef TESTS_MODEL_SILENT_COMM_H
#define TESTS_MODEL_SILENT_COMM_H

/* The calls of workers to runtime/comm, silent: nothing travels but messages that the model itself
 * polls for (comm_poll is its own). Included once in a program. */
#include "runtime/workers/workers.h"

bool comm_has_posts(struct comm *comm)
{
    (void)comm;
    return false;
}

bool comm_is_broken(struct comm *comm)
{
    (void)comm;
    return false;
}

void comm_workers_end(struct comm *comm)
{
    (void)comm;
}

void comm_send(struct comm *comm, struct comm_letter *letter)
{
    (void)comm;
    (void)letter;
}

void comm_channel_ready(struct comm *comm, struct worker *worker, struct comm_channel *channel)
{
    (void)comm;
    (void)worker;
    (void)channel;
}

int comm_channels_open(struct comm *comm, struct comm_channel_set *channels)
{
    (void)comm;
    (void)channels;
    return 0;
}

bool comm_awaits(struct comm *comm)
{
    (void)comm;
    return false;
}

void comm_break_memory(struct comm *comm, const char *what)
{
    (void)comm;
    (void)what;
}

void comm_count(struct comm *comm, uint64_t *messages, uint64_t *bytes)
{
    *messages = *bytes = comm != NULL;
}

uint64_t comm_awaited_ticks(const struct comm *comm)
{
    (void)comm;
    return 0;
}

bool comm_guests_poll(struct comm_guests *guests, struct worker *worker)
{
    (void)guests;
    (void)worker;
    return false;
}

struct comm_guest *comm_guest_new(int n, const MPI_Request *requests)
{
    (void)n;
    (void)requests;
    return NULL;
}

void comm_guest_add(struct comm_guests *guests, struct comm_guest *guest)
{
    (void)guests;
    (void)guest;
}

void comm_guests_hold(struct comm_guests *guests, const void *holder)
{
    (void)guests;
    (void)holder;
}

void comm_guests_let_go(struct comm_guests *guests)
{
    (void)guests;
}

int comm_expect(struct comm *comm, struct worker *worker, struct data_key key,
                struct comm_target target, uint32_t packets)
{
    (void)comm;
    (void)worker;
    (void)key;
    (void)target;
    (void)packets;
    return 0;
}

#endif
