/* What the graph asks of checking mode and of the communication, which it does not know; and what
 * workers ask of the communication. */
#include "runtime/workers/internal.h"

int work_check_body(struct work_pool *pool, const duite_kernel *kernel, uint64_t number,
                    duite_call *call)
{
    return check_call(pool->setup.check, &(struct check_task){kernel, number}, call);
}

int work_expect(struct work_pool *pool, struct worker *worker, struct data_key key, int from,
                struct data_version *version, struct data_sum *sum, uint32_t packets)
{
    const struct comm_target target = {version, sum, from};
    return comm_expect(pool->setup.comm, worker, key, target, packets);
}

int work_open(struct work_pool *pool, struct plan_channels *channels)
{
    return comm_channels_open(pool->setup.comm, channels);
}

void work_starved(struct work_pool *pool, const char *what)
{
    comm_broke_memory(pool->setup.comm, what);
}

bool work_poll(struct worker *worker)
{
    struct comm *comm = worker->pool->setup.comm;
    if (!comm)
        return false;
    const bool noted = work_note_messages_begin(worker), came = comm_poll(comm, worker);
    work_note_messages_end(worker, noted);
    return came;
}
