/* What is not done with every task. */
#include "runtime/data/version.h"

#include "runtime/base/pool.h"

struct data_waiter data_produced_mark;

void data_version_poison(struct data_version *version, const struct data_failure *failure)
{
    if (!failure)
        return;
    data_packet_free(data_version_packet(version));
    version->poisoned = true;
    version->failure = failure;
}

struct data_waiter *data_version_end(struct data_version *version)
{
    if (!version->renamed && version->heir)
        return version->heir;
    if (version->renamed)
        atomic_fetch_sub_explicit(version->rename_bytes,
                                  data_packet_memory(data_version_room(version)),
                                  memory_order_relaxed);
    data_packet_free(data_version_packet(version));
    data_version_free(version);
    return NULL;
}
