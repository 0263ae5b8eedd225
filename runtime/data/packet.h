#ifndef DUITE_DATA_PACKET_H
#define DUITE_DATA_PACKET_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#pragma GCC visibility push(hidden) /* called directly: no other library can replace them */

/* The bytes of one version of an object, with room for a message header in front of them, so that
 * they are sent and received where they lie. The program's own memory has none: its header lies
 * elsewhere (adopted.h). */
enum data_packet_kind {
    DATA_VALUE = 1,
    DATA_PIECES,
    DATA_POISON,
    DATA_OFFLOADED, /* a task to be run here */
    DATA_RESULT,    /* the results of such a task */
};

/* Names a version on all ranks: the object and how many writes it had. */
struct data_key {
    uint32_t slot, generation;
    uint64_t number;
};

struct data_packet {
    struct data_key key;
    uint64_t bytes; /* of the payload that follows, and is sent */
    uint32_t kind;
    uint32_t pieces;          /* DATA_PIECES: how many */
    struct data_packet *next; /* for whoever holds it; means nothing to the receiver */
    uint64_t lines;           /* of memory, this one among them; 0: it is a scope's, see task_cell,
                                 or adopted; means nothing to the receiver, as does: */
    void *elsewhere;          /* the payload, if it does not follow: adopted memory */
    uint64_t unused;
};
_Static_assert(sizeof(struct data_packet) == 64, "a header takes one cache line");

/* Packets are allocated and sent in whole cache lines: the int counts of MPI then reach far beyond
 * 2 GiB. */
#define DATA_MAX_BYTES ((size_t)1 << 36)
static inline size_t data_packet_lines(size_t bytes)
{
    return 1 + (bytes + 63) / 64;
}

/* A packet for so many bytes, payload zeroed or not; NULL without memory. */
struct data_packet *data_packet_new(size_t bytes, bool zero);
void data_packet_free(struct data_packet *packet); /* NULL is fine */

/* A packet was received with its header, into memory for just its bytes. */
static inline void data_packet_came(struct data_packet *packet)
{
    packet->lines = data_packet_lines(packet->bytes);
    packet->elsewhere = NULL;
}

/* A copy in which the payload follows, to be sent as one message; NULL without memory. */
struct data_packet *data_packet_copy(struct data_packet *packet);

/* Returns the packet, or a replacement, with memory for so many bytes. `keep`: its payload is kept.
 * NULL without memory: then the packet was freed. */
struct data_packet *data_packet_room(struct data_packet *packet, size_t bytes, bool keep);

/* Sets the number of the packet's bytes, for which it has room. */
void data_packet_resize(struct data_packet *packet, size_t bytes);

static inline void *data_payload(struct data_packet *packet)
{
    return packet->elsewhere ? packet->elsewhere : packet + 1;
}

#pragma GCC visibility pop

#endif
