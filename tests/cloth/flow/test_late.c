/* Ranks that come late: a balancer may send them tasks that their main program has not come to,
 * which must find there all that bodies need. On two ranks every block that sends needs the late
 * one first; on three some do not. The linker puts the function below in the place of the one that
 * makes the last of it (module.mk). */
#include "tests/cloth/flow/models.h"
#include "tests/support/unit.h"

#include <time.h>

struct flow_state;
void __real_flow_halo_make(struct flow_state *state);
void __wrap_flow_halo_make(struct flow_state *state);

void __wrap_flow_halo_make(struct flow_state *state)
{
    int rank, ranks;
    record_mpi(&rank, &ranks);
    if (rank == ranks - 1)
        nanosleep(&(struct timespec){.tv_nsec = 100000000}, NULL);
    __real_flow_halo_make(state);
}

static uint64_t hash_of(const struct model *model, const char *balance)
{
    struct record record = {.threads = 2, .balance = balance};
    record_fine(&record, model);
    const uint64_t hash = record.report.state_hash;
    record_free(&record);
    return hash;
}

UNIT_LOOP(late_ranks_run_what_they_are_sent, 0, 2)
{
    static const enum model_preconditioner KINDS[] = {MODEL_PLAIN, MODEL_COARSE};
    SETUP(setup_sheet(&setup, 30));
    setup_pin(&setup, 2, (const uint32_t[]){0, 29});
    setup.model.preconditioner = KINDS[_i];
    const uint64_t hash = hash_of(&setup.model, "none");
    for (int i = 0; i < 3; i++)
        ck_assert_uint_eq(hash_of(&setup.model, "scatter"), hash);
}
