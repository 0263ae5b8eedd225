/* The thread sleeps until there is something to write. `busy`, under the lock, says that the thread
 * has the parts. */
#include "cloth/app/run/keeper.h"

#include "cloth/output/output.h"

#include <errno.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

struct keeper {
    struct output_checkpoints *checkpoints;
    struct output_settler *settler;
    char *folder;
    double seconds, next; /* s: between two; when the next one is due */
    struct output_part part[OUTPUT_CHECKPOINT_PARTS];
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t changed;
    bool asked;  /* one is due, and was not taken yet */
    bool busy;   /* one is to be written */
    bool ending; /* the thread is to end */
    bool warned;
};

static double keeper_now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/* ---- The thread ---- */

static void keeper_warn(struct keeper *keeper, const char *why)
{
    const char *last = output_checkpoints_last(keeper->checkpoints);
    if (!keeper->warned)
        fprintf(stderr,
                "duite-cloth: warning: %s; the run goes on, and the last checkpoint is %s (this is "
                "said once)\n",
                why, last ? last : "that of before the run, if there is one");
    keeper->warned = true;
}

/* Frames and rows of probes before it are on the disk first. */
static void write_one(struct keeper *keeper)
{
    struct cloth_error error = {0};
    if (!keeper->part[1].bytes || !keeper->part[2].bytes)
        cloth_fail(&error, CLOTH_E_MEMORY, "no memory for a checkpoint");
    else if (!output_settler_wait(keeper->settler, &error) &&
             !output_probes_sync(keeper->folder, &error))
        output_checkpoints_write(keeper->checkpoints, keeper->part, &error);
    if (error.code)
        keeper_warn(keeper, error.text);
    for (int i = 1; i < OUTPUT_CHECKPOINT_PARTS; i++) {
        free((void *)keeper->part[i].bytes);
        keeper->part[i] = (struct output_part){0};
    }
}

static void *keeper_run(void *context)
{
    struct keeper *keeper = context;
    pthread_mutex_lock(&keeper->lock);
    while (keeper->busy || !keeper->ending) {
        if (!keeper->busy) {
            pthread_cond_wait(&keeper->changed, &keeper->lock);
            continue;
        }
        pthread_mutex_unlock(&keeper->lock);
        write_one(keeper);
        pthread_mutex_lock(&keeper->lock);
        keeper->busy = false;
        pthread_cond_broadcast(&keeper->changed);
    }
    pthread_mutex_unlock(&keeper->lock);
    return NULL;
}

/* ---- For the run ---- */

static int keeper_start(struct keeper *keeper, struct cloth_error *error)
{
    pthread_mutex_init(&keeper->lock, NULL);
    pthread_cond_init(&keeper->changed, NULL);
    const int failed = pthread_create(&keeper->thread, NULL, keeper_run, keeper);
    if (!failed)
        return CLOTH_OK;
    pthread_mutex_destroy(&keeper->lock);
    pthread_cond_destroy(&keeper->changed);
    return cloth_fail(error, CLOTH_E_LIBRARY, "no thread to write checkpoints: %s",
                      strerror(failed));
}

static void keeper_drop(struct keeper *keeper)
{
    output_checkpoints_close(&keeper->checkpoints);
    free(keeper->folder);
    free(keeper);
}

int keeper_open(struct keeper **keeper, const char *folder, double seconds, const char *settings,
                struct output_settler *settler, struct cloth_error *error)
{
    *keeper = NULL;
    struct keeper *made = calloc(1, sizeof *made);
    if (!made)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for checkpoints");
    made->seconds = seconds;
    made->settler = settler;
    made->next = keeper_now() + seconds;
    made->part[0] = (struct output_part){settings, strlen(settings)};
    made->folder = strdup(folder);
    int code = made->folder ? output_checkpoints_open(&made->checkpoints, folder, error)
                            : cloth_fail(error, CLOTH_E_MEMORY, "no memory for checkpoints");
    code = code ? code : keeper_start(made, error);
    if (code)
        keeper_drop(made);
    else
        *keeper = made;
    return code;
}

int keeper_due(struct keeper *keeper)
{
    pthread_mutex_lock(&keeper->lock);
    const bool due = !keeper->asked && !keeper->busy && keeper_now() >= keeper->next;
    keeper->asked = keeper->asked || due;
    pthread_mutex_unlock(&keeper->lock);
    return due;
}

void keeper_take(struct keeper *keeper, struct output_part program, struct output_part flow)
{
    pthread_mutex_lock(&keeper->lock);
    while (keeper->busy)
        pthread_cond_wait(&keeper->changed, &keeper->lock);
    keeper->part[1] = program;
    keeper->part[2] = flow;
    keeper->busy = true;
    keeper->asked = false;
    keeper->next = keeper_now() + keeper->seconds;
    pthread_cond_broadcast(&keeper->changed);
    pthread_mutex_unlock(&keeper->lock);
}

void keeper_close(struct keeper **keeper)
{
    struct keeper *gone = *keeper;
    *keeper = NULL;
    if (!gone)
        return;
    pthread_mutex_lock(&gone->lock);
    gone->ending = true;
    pthread_cond_broadcast(&gone->changed);
    pthread_mutex_unlock(&gone->lock);
    pthread_join(gone->thread, NULL);
    pthread_mutex_destroy(&gone->lock);
    pthread_cond_destroy(&gone->changed);
    keeper_drop(gone);
}
