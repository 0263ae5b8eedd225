/* Requests of MPI that are the program's own. They stand apart from those of the communication,
 * since their failures are failures of tasks and break nothing, and since one rank alone has them,
 * too. They are tested under the lock that guards MPI, so they need no more than SERIALIZED. After
 * the loss of a rank they are tested no more: MPI may still write where their tasks' data lie. */
#include "runtime/comm/guests.h"

#include "runtime/base/memory.h"
#include "runtime/base/stack.h"
#include "runtime/comm/internal.h"

#include <sched.h>
#include <stdio.h>
#include <string.h>

void comm_guests_start(struct comm_guests *guests, struct comm *comm, comm_guest_over *over,
                       void *context)
{
    *guests = (struct comm_guests){.comm = comm, .over = over, .context = context};
    atomic_flag_clear(&guests->own);
    guests->lock = comm ? &comm->lock : &guests->own;
}

static void guests_free(struct comm_guest *guest)
{
    for (struct comm_guest *next; guest; guest = next) {
        next = guest->next;
        base_free(guest);
    }
}

void comm_guests_stop(struct comm_guests *guests)
{
    guests_free(BASE_STACK_TAKE(&guests->added));
    guests_free(guests->list);
}

struct comm_guest *comm_guest_new(int n, const MPI_Request *requests)
{
    const size_t statuses = (size_t)n * sizeof(MPI_Status), bytes = (size_t)n * sizeof *requests;
    struct comm_guest *guest = base_alloc(sizeof *guest + statuses + bytes);
    if (!guest)
        return NULL;
    *guest = (struct comm_guest){.n = n, .request = (MPI_Request *)(guest->status + n)};
    memcpy(guest->request, requests, bytes);
    return guest;
}

void comm_guest_add(struct comm_guests *guests, struct comm_guest *guest)
{
    atomic_fetch_add_explicit(&guests->here, 1, memory_order_relaxed);
    BASE_STACK_PUSH(&guests->added, guest, memory_order_release);
}

static bool guests_try_lock(struct comm_guests *guests)
{
    return !atomic_flag_test_and_set_explicit(guests->lock, memory_order_acquire);
}

static void guests_unlock(struct comm_guests *guests)
{
    atomic_flag_clear_explicit(guests->lock, memory_order_release);
}

void comm_guests_hold(struct comm_guests *guests, const void *holder)
{
    while (!guests_try_lock(guests))
        sched_yield();
    atomic_store_explicit(&guests->holder, holder, memory_order_relaxed);
}

void comm_guests_let_go(struct comm_guests *guests)
{
    atomic_store_explicit(&guests->holder, NULL, memory_order_relaxed);
    guests_unlock(guests);
}

/* ---- Tests ---- */

static void guest_fails(struct comm_guest *guest, int request, int mpi)
{
    char text[MPI_MAX_ERROR_STRING] = "";
    int length = 0;
    guest->failed = request;
    if (MPI_Error_string(mpi, text, &length))
        snprintf(text, sizeof text, "error %d of MPI", mpi);
    snprintf(guest->text, sizeof guest->text, "%s", text);
}

/* True if all its requests are over. If MPI fails without telling which one did, it was the first:
 * MPI knows them no more. */
static bool guest_test(struct comm_guest *guest)
{
    int done = 0;
    const int mpi = MPI_Testall(guest->n, guest->request, &done, guest->status);
    if (mpi == MPI_SUCCESS)
        return done;
    if (comm_mpi_class(mpi) != MPI_ERR_IN_STATUS) {
        guest_fails(guest, 1, mpi);
        return true;
    }
    bool over = true; /* MPICH tells of a failure while others are on their way */
    for (int i = 0; i < guest->n; i++) {
        const int error = guest->status[i].MPI_ERROR;
        if (error == MPI_ERR_PENDING)
            over = false;
        else if (error != MPI_SUCCESS && !guest->failed)
            guest_fails(guest, i + 1, error);
    }
    return over;
}

/* Under the lock: returns those that are over. */
static struct comm_guest *guests_test(struct comm_guests *guests)
{
    struct comm_guest *over = NULL, **end = &guests->list;
    while (*end) {
        struct comm_guest *guest = *end;
        if (!guest_test(guest)) {
            end = &guest->next;
            continue;
        }
        *end = guest->next;
        guest->next = over;
        over = guest;
    }
    return over;
}

static void guests_take_added(struct comm_guests *guests)
{
    struct comm_guest *added = BASE_STACK_TAKE(&guests->added), **end = &guests->list;
    BASE_LIST_REVERSE(added);
    while (*end)
        end = &(*end)->next;
    *end = added;
}

bool comm_guests_poll(struct comm_guests *guests, struct worker *worker)
{
    if (comm_is_lost(guests->comm) || !guests_try_lock(guests))
        return false;
    guests_take_added(guests);
    struct comm_guest *over = guests_test(guests);
    guests_unlock(guests);
    const bool any = over != NULL;
    for (struct comm_guest *next; over; over = next) {
        next = over->next;
        atomic_fetch_sub_explicit(&guests->here, 1, memory_order_relaxed);
        guests->over(guests->context, worker, over);
    }
    return any;
}
