/* An entry lives while its target waits for packets or its packets wait for a target, never both.
 */
#include "runtime/base/clock.h"
#include "runtime/base/memory.h"
#include "runtime/comm/internal.h"

#define HASH_NONFATAL_OOM          1
#define uthash_nonfatal_oom(entry) ((entry)->lost = true)
#include <uthash.h>

struct comm_arrival {
    struct data_key key;
    struct comm_target target;
    uint32_t wanted;             /* packets still to come; 0: no target yet */
    bool lost;                   /* the table had no memory for it */
    struct data_packet *packets; /* came early */
    UT_hash_handle hh;
};

/* ---- The gauge ---- */

uint64_t comm_awaited_ticks(const struct comm *comm)
{
    uint64_t clock = atomic_load_explicit(&comm->arrivals.gauge.clock, memory_order_relaxed);
    return clock & 1 ? clock - 1 + base_ticks() : clock;
}

/* Adds `messages`, which may be negative, to those awaited. Under the lock. */
static void gauge_add(struct comm_gauge *gauge, int64_t messages)
{
    uint64_t before = gauge->awaited;
    gauge->awaited += (uint64_t)messages;
    if (!before == !gauge->awaited)
        return;
    uint64_t clock = atomic_load_explicit(&gauge->clock, memory_order_relaxed);
    clock = before ? clock - 1 + base_ticks() : clock - base_ticks();
    clock = (clock & ~UINT64_C(1)) | (gauge->awaited > 0);
    atomic_store_explicit(&gauge->clock, clock, memory_order_relaxed);
}

/* ---- The table ---- */

void comm_arrivals_start(struct comm_arrivals *arrivals)
{
    pthread_mutex_init(&arrivals->lock, NULL);
    arrivals->closed = false;
    atomic_init(&arrivals->refused, 0);
    arrivals->gauge.awaited = 0;
    atomic_init(&arrivals->gauge.clock, 0);
    arrivals->table = NULL;
}

static void arrival_free_packets(struct data_packet *packet)
{
    while (packet) {
        struct data_packet *next = packet->next;
        data_packet_free(packet);
        packet = next;
    }
}

void comm_arrivals_stop(struct comm_arrivals *arrivals)
{
    struct comm_arrival *arrival, *next;
    HASH_ITER(hh, arrivals->table, arrival, next)
    {
        HASH_DEL(arrivals->table, arrival);
        arrival_free_packets(arrival->packets);
        base_pool_give(arrival, sizeof *arrival);
    }
    pthread_mutex_destroy(&arrivals->lock);
}

static struct comm_arrival *arrival_find(struct comm_arrivals *arrivals, struct data_key key)
{
    struct comm_arrival *arrival;
    HASH_FIND(hh, arrivals->table, &key, sizeof key, arrival);
    return arrival;
}

static void arrival_drop(struct comm_arrivals *arrivals, struct comm_arrival *arrival)
{
    HASH_DEL(arrivals->table, arrival);
    base_pool_give(arrival, sizeof *arrival);
}

/* A new entry in the table, or NULL. */
static struct comm_arrival *arrival_add(struct comm_arrivals *arrivals, struct data_key key)
{
    struct comm_arrival *arrival = base_pool_take(sizeof *arrival);
    if (!arrival)
        return NULL;
    *arrival = (struct comm_arrival){.key = key};
    HASH_ADD(hh, arrivals->table, key, sizeof key, arrival);
    if (!arrival->lost)
        return arrival;
    base_pool_give(arrival, sizeof *arrival);
    return NULL;
}

/* So many more packets are still to come, or fewer. */
static void arrival_await(struct comm_arrivals *arrivals, struct comm_arrival *arrival,
                          int64_t packets)
{
    arrival->wanted += (uint32_t)packets;
    if (!arrival->target.result)
        gauge_add(&arrivals->gauge, packets);
}

bool comm_arrivals_expect(struct comm_arrivals *arrivals, struct data_key key,
                          struct comm_target target, uint32_t packets, struct data_packet **early)
{
    *early = NULL;
    pthread_mutex_lock(&arrivals->lock);
    struct comm_arrival *arrival = arrival_find(arrivals, key);
    if (arrival) {
        *early = arrival->packets;
        arrival->packets = NULL;
        for (const struct data_packet *packet = *early; packet; packet = packet->next)
            packets--;
        if (!packets)
            arrival_drop(arrivals, arrival);
    } else if (!arrivals->closed) {
        arrival = arrival_add(arrivals, key);
    }
    bool kept = arrival != NULL;
    if (kept && packets) {
        arrival->target = target;
        arrival_await(arrivals, arrival, packets);
    }
    pthread_mutex_unlock(&arrivals->lock);
    return kept;
}

enum comm_take comm_arrivals_take(struct comm_arrivals *arrivals, struct data_packet *packet,
                                  struct comm_target *target)
{
    enum comm_take take = COMM_LOST;
    pthread_mutex_lock(&arrivals->lock);
    struct comm_arrival *arrival = arrival_find(arrivals, packet->key);
    if (!arrival && packet->kind == DATA_RESULT) {
        take = COMM_REFUSED;
        atomic_fetch_add(&arrivals->refused, !arrivals->closed);
    } else if (!arrival && !arrivals->closed) {
        arrival = arrival_add(arrivals, packet->key);
    }
    if (arrival && arrival->wanted) {
        take = COMM_WANTED;
        *target = arrival->target;
        arrival_await(arrivals, arrival, -1);
        if (!arrival->wanted)
            arrival_drop(arrivals, arrival);
    } else if (arrival) {
        take = COMM_KEPT;
        packet->next = arrival->packets;
        arrival->packets = packet;
    }
    pthread_mutex_unlock(&arrivals->lock);
    return take;
}

void comm_arrivals_also(struct comm_arrivals *arrivals, int messages)
{
    if (!messages)
        return;
    pthread_mutex_lock(&arrivals->lock);
    gauge_add(&arrivals->gauge, messages);
    pthread_mutex_unlock(&arrivals->lock);
}

void comm_arrivals_look(struct comm_arrivals *arrivals,
                        void (*awaited)(void *context, const struct data_key *key,
                                        const struct comm_target *target, uint32_t packets),
                        void *context)
{
    pthread_mutex_lock(&arrivals->lock);
    for (const struct comm_arrival *arrival = arrivals->table; arrival; arrival = arrival->hh.next)
        if (arrival->wanted)
            awaited(context, &arrival->key, &arrival->target, arrival->wanted);
    pthread_mutex_unlock(&arrivals->lock);
}

bool comm_arrivals_close(struct comm_arrivals *arrivals, struct comm_target *target)
{
    struct comm_arrival *arrival, *next;
    bool found = false;
    pthread_mutex_lock(&arrivals->lock);
    arrivals->closed = true;
    HASH_ITER(hh, arrivals->table, arrival, next)
    {
        found = arrival->wanted > 0;
        if (found) {
            *target = arrival->target;
            arrival_await(arrivals, arrival, -1);
        }
        if (!arrival->wanted) {
            arrival_free_packets(arrival->packets);
            arrival_drop(arrivals, arrival);
        }
        if (found)
            break;
    }
    pthread_mutex_unlock(&arrivals->lock);
    return found;
}
