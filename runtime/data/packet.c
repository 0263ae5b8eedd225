/* A packet owns its bytes; whoever holds the packet's only pointer may write them. */
#include "runtime/data/packet.h"

#include "runtime/base/pool.h"

#include <string.h>

struct data_packet *data_packet_new(size_t bytes, bool zero)
{
    if (bytes > DATA_MOST_BYTES)
        return NULL;
    size_t lines = data_packet_lines(bytes);
    struct data_packet *packet = base_pool_take(lines * sizeof *packet);
    if (!packet)
        return NULL;
    memset(packet, 0, sizeof *packet);
    packet->bytes = bytes;
    packet->lines = lines;
    if (zero)
        memset(packet + 1, 0, (lines - 1) * sizeof *packet);
    else if (lines > 1) /* the last line is sent whole */
        memset(packet + lines - 1, 0, sizeof *packet);
    return packet;
}

void data_packet_free(struct data_packet *packet)
{
    if (packet)
        base_pool_give(packet, packet->lines * sizeof *packet);
}

struct data_packet *data_packet_room(struct data_packet *packet, size_t bytes, bool keep)
{
    if (packet->lines >= data_packet_lines(bytes))
        return packet;
    struct data_packet *larger = data_packet_new(bytes, false);
    if (larger && keep) {
        memcpy(data_payload(larger), data_payload(packet), packet->bytes);
        larger->bytes = packet->bytes;
    }
    data_packet_free(packet);
    return larger;
}

void data_packet_resize(struct data_packet *packet, size_t bytes)
{
    size_t whole = (data_packet_lines(bytes) - 1) * sizeof *packet;
    packet->bytes = bytes;
    memset((char *)data_payload(packet) + bytes, 0,
           whole - bytes); /* the last line is sent whole */
}
