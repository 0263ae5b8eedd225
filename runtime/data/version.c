/* What is not done with every task. */
#include "runtime/data/version.h"

#include "runtime/base/pool.h"

struct data_waiter data_produced_mark;

struct data_waiter *data_version_end(struct data_version *version)
{
    if (!version->renamed && version->heir)
        return version->heir;
    if (version->renamed)
        atomic_fetch_sub_explicit(version->rename_bytes,
                                  data_packet_memory(data_version_room(version)),
                                  memory_order_relaxed);
    data_packet_free(version->packet);
    data_version_free(version);
    return NULL;
}
