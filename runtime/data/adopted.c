/* All adopted memory of the process stands in one tree, in which no two overlap: memory that two
 * objects had would be written by tasks that know nothing of each other. */
#include "runtime/data/adopted.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <pthread.h>
#include <search.h>
#include <string.h>

char data_nowhere[1];

static pthread_mutex_t tree_lock = PTHREAD_MUTEX_INITIALIZER;
static void *tree; /* struct data_adopted, by place */

/* Those that overlap are equal. */
static int adopted_compare(const void *a, const void *b)
{
    const struct data_adopted *left = a, *right = b;
    const char *from_left = left->packet.elsewhere, *from_right = right->packet.elsewhere;
    if (from_left + left->packet.bytes <= from_right)
        return -1;
    return from_right + right->packet.bytes <= from_left;
}

/* Puts it into the tree. */
static int adopted_enter(const struct data_adopted *adopted)
{
    int code = DUITE_OK;
    pthread_mutex_lock(&tree_lock);
    const struct data_adopted *const *found = tsearch(adopted, &tree, adopted_compare);
    if (!found)
        code = base_no_memory("adopted memory");
    else if (*found != adopted)
        code = base_error(DUITE_E_ARGUMENT,
                          "duite_adopt: %llu bytes at %p overlap %llu bytes at %p, which are "
                          "adopted and not yet given back",
                          (unsigned long long)adopted->packet.bytes, adopted->packet.elsewhere,
                          (unsigned long long)(*found)->packet.bytes, (*found)->packet.elsewhere);
    pthread_mutex_unlock(&tree_lock);
    return code;
}

int data_adopted_new(const struct data_adopted *like, size_t size, struct data_adopted **out)
{
    enum { STRICTEST = 8 }; /* alignment of an element: that of a double */
    void *const values = like->packet.elsewhere;
    if (!values)
        return base_error(DUITE_E_ARGUMENT, "duite_adopt: no memory (NULL)");
    if ((uintptr_t)values % (size < STRICTEST ? size : STRICTEST))
        return base_error(DUITE_E_ARGUMENT,
                          "duite_adopt: memory at %p is not aligned to its elements of %zu bytes",
                          values, size);
    struct data_adopted *adopted = base_alloc(sizeof *adopted);
    if (!adopted)
        return base_no_memory("adopted memory");
    *adopted = *like;
    atomic_init(&adopted->holds, 1);
    const int code = adopted_enter(adopted);
    if (code)
        base_free(adopted);
    else
        *out = adopted;
    return code;
}

/* Without the lock: the program may adopt the memory again at once. */
static void adopted_give_back(struct data_adopted *adopted)
{
    void *const values = adopted->packet.elsewhere, *const user = adopted->user;
    duite_done *const done = adopted->done;
    if (adopted->last)
        memcpy(values, data_payload(adopted->last), adopted->packet.bytes);
    data_packet_free(adopted->last);
    if (adopted->back) {
        adopted->back(adopted);
        return;
    }
    pthread_mutex_lock(&tree_lock);
    tdelete(adopted, &tree, adopted_compare);
    pthread_mutex_unlock(&tree_lock);
    base_free(adopted);
    if (done)
        done(values, user);
}

void data_adopted_rest(struct data_adopted *adopted)
{
    void (*const rested)(void *context) = adopted->rested;
    void *const context = adopted->context;
    if (atomic_fetch_sub_explicit(&adopted->holds, 1, memory_order_acq_rel) == 1)
        adopted_give_back(adopted);
    else
        rested(context); /* others may have given it back by now */
}

void data_adopted_leave(struct data_adopted *adopted, struct data_packet *last)
{
    if (last == &adopted->packet)
        data_adopted_rest(adopted);
    else
        adopted->last = last;
    data_adopted_rest(adopted);
}
