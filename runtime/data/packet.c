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
    if (zero)
        memset(packet + 1, 0, (lines - 1) * sizeof *packet);
    else if (lines > 1) /* the last line is sent whole */
        memset(packet + lines - 1, 0, sizeof *packet);
    return packet;
}

void data_packet_free(struct data_packet *packet)
{
    if (packet)
        base_pool_give(packet, data_packet_lines(packet->bytes) * sizeof *packet);
}
