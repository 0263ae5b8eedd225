#ifndef DUITE_BASE_LOOKOUT_H
#define DUITE_BASE_LOOKOUT_H

#include <pthread.h>
#include <stdbool.h>

/* A thread that looks at something now and then, asleep in between; it takes no signals. */
struct base_lookout {
    void (*look)(void *context);
    void *context;
    double seconds; /* between two looks */
    bool made, started, stop;
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t wake;
};

/* `what` it is, for the sentence: "the thread that watches". On failure base_lookout_stop is due
 * all the same, unless all of it is zero. Errors: memory, DUITE_E_SYSTEM. */
int base_lookout_start(struct base_lookout *lookout, const char *what, double seconds,
                       void (*look)(void *context), void *context);

/* Looks no more; one that is under way is over. A lookout that is all zero is fine. */
void base_lookout_stop(struct base_lookout *lookout);

#endif
