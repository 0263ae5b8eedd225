/* Packets, and the rarer operations on versions. A packet owns its bytes, but for adopted ones; the
 * holder of its only pointer may write them. */
#include "runtime/data/version.h"

#include "runtime/base/memory.h"
#include "runtime/data/adopted.h"

#include <stdio.h>
#include <string.h>

/* ---- Packets ---- */

struct data_packet *data_packet_new(size_t bytes, bool zero)
{
    if (bytes > DATA_MAX_BYTES)
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
    if (packet && packet->lines)
        base_pool_give(packet, packet->lines * sizeof *packet);
    else if (packet && packet->elsewhere)
        data_adopted_rest((struct data_adopted *)packet);
}

struct data_packet *data_packet_copy(struct data_packet *packet)
{
    struct data_packet *copy = data_packet_new(packet->bytes, false);
    if (!copy)
        return NULL;
    copy->key = packet->key;
    copy->kind = packet->kind;
    memcpy(data_payload(copy), data_payload(packet), packet->bytes);
    return copy;
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

/* ---- Versions ---- */

void data_version_poison(struct data_version *version, const struct data_failure *failure)
{
    if (!failure)
        return;
    data_packet_free(data_version_packet(version));
    version->poisoned = true;
    version->failure = failure;
}

void data_version_drop(struct data_version *version)
{
    struct data_packet *packet = data_version_packet(version);
    if (packet && packet->lines == 2) /* most are of one line: of a constant size */
        base_pool_give(packet, 2 * sizeof *packet);
    else
        data_packet_free(packet);
    data_version_free(version);
}

/* ---- Places of failures ---- */

/* The code of a path: an index below 0x80 is one byte; a larger one is its bytes, highest first,
 * behind 0x80 plus their number. An index never begins with a zero byte, so a path is smaller than
 * its continuations. PATH_CUT stands for an index that did not fit. Any index that fits in its
 * place is smaller, and begins with a smaller byte. */
enum { PATH_CUT = 0xff };

static unsigned path_index_bytes(uint64_t index)
{
    unsigned n = 1;
    while (n < 8 && index >> (8 * n))
        n++;
    return n;
}

void data_path_add(struct data_failure *failure, uint64_t index)
{
    unsigned n = index < 0x80 ? 0 : path_index_bytes(index);
    uint32_t at = failure->path_length;
    if (at + 1 + n > sizeof failure->path) {
        if (at < sizeof failure->path)
            failure->path[at] = PATH_CUT;
        failure->path_length = sizeof failure->path; /* nothing may follow what was left out */
        return;
    }
    failure->path[at++] = (uint8_t)(n ? 0x80 + n : index);
    for (unsigned i = n; i-- > 0;)
        failure->path[at++] = (uint8_t)(index >> (8 * i));
    failure->path_length = at;
}

void data_path_print(const struct data_failure *failure, char *text, size_t size)
{
    size_t used = (size_t)snprintf(text, size, "%llu", (unsigned long long)failure->number);
    const uint8_t *at = failure->path, *end = at + sizeof failure->path;
    while (at < end && *at && *at != PATH_CUT && used + 24 < size) {
        unsigned n = *at >= 0x80 ? *at - 0x80u : 0;
        uint64_t index = n ? 0 : *at;
        for (at++; n && at < end; n--)
            index = index << 8 | *at++;
        used += (size_t)snprintf(text + used, size - used, ".%llu", (unsigned long long)index);
    }
    if (at < end && *at)
        snprintf(text + used, size - used, "...");
}
