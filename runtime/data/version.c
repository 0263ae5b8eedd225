/* The last release sees every access to the bytes: acquire and release on `holds`; a reader that
 * did not wait sees the producer's writes through `waiters`. */
#include "runtime/data/version.h"

#include "runtime/base/pool.h"

static struct data_waiter produced_mark;
#define DATA_PRODUCED (&produced_mark)

struct data_version *data_version_new(void)
{
    struct data_version *version = base_pool_take(sizeof *version);
    if (!version)
        return NULL;
    atomic_init(&version->waiters, NULL);
    atomic_init(&version->holds, 2);
    version->heir = NULL;
    version->packet = NULL;
    version->failure = NULL;
    version->renamed = 0;
    return version;
}

bool data_version_await(struct data_version *version, struct data_waiter *waiter)
{
    struct data_waiter *first = atomic_load_explicit(&version->waiters, memory_order_acquire);
    do {
        if (first == DATA_PRODUCED)
            return false;
        waiter->next = first;
    } while (!atomic_compare_exchange_weak_explicit(&version->waiters, &first, waiter,
                                                    memory_order_acq_rel, memory_order_acquire));
    return true;
}

bool data_version_ready(const struct data_version *version)
{
    return atomic_load_explicit(&version->waiters, memory_order_acquire) == DATA_PRODUCED;
}

struct data_waiter *data_version_produced(struct data_version *version)
{
    return atomic_exchange_explicit(&version->waiters, DATA_PRODUCED, memory_order_acq_rel);
}

struct data_waiter *data_version_release(struct data_version *version)
{
    if (atomic_fetch_sub_explicit(&version->holds, 1, memory_order_acq_rel) != 1)
        return NULL;
    if (version->heir)
        return version->heir;
    if (version->renamed)
        atomic_fetch_sub_explicit(version->rename_bytes,
                                  version->renamed * sizeof(struct data_packet),
                                  memory_order_relaxed);
    data_packet_free(version->packet);
    data_version_free(version);
    return NULL;
}

void data_version_free(struct data_version *version)
{
    base_pool_give(version, sizeof *version);
}
