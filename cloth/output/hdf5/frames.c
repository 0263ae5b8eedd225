/* Two frames take turns: the caller fills one while the thread writes the other. HDF5 is used by
 * that thread alone once it runs. A frame that cannot be written is left out, and so is nothing
 * else: what was written before stays as it is, and the next one is tried. */
#include "config.h"

#include "cloth/output/hdf5/grid.h"
#include "cloth/output/hdf5/hdf5.h"

#include "cloth/base/memory.h"
#include "cloth/output/files/files.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct output_hdf5 {
    struct output_hdf5_setup setup;
    char *folder, *own; /* of frames; hdf5 in it */
    struct output_grid grid;
    struct output_indexes indexes;
    struct output_bytes bytes; /* the thread's */
    struct output_state flight[OUTPUT_HDF5_FLIGHT];
    uint64_t tried, missing, first_missing; /* the thread's */
    struct cloth_error trouble;             /* of the first one; the thread's */
    bool has_thread;
    pthread_t thread;
    pthread_mutex_t lock; /* of what follows */
    pthread_cond_t change;
    uint64_t given, done; /* frames; number i is in flight[i % OUTPUT_HDF5_FLIGHT] */
    bool ends;
};

const char *output_hdf5_lacks(uint32_t level)
{
#ifdef HAVE_HDF5
    output_image_start();
    return level && !output_image_gzips()
               ? "the HDF5 of this duite cannot compress by gzip; compression: 0 is expected"
               : NULL;
#else
    (void)level;
    return "this duite was built without HDF5; ./bootstrap --full installs it, then build again";
#endif
}

double output_hdf5_bytes(const struct output_hdf5_setup *setup)
{
    enum { LAYOUT = 16384 };
    const double real = setup->is_double ? 8 : 4, points = setup->n_points;
    const double cells = (double)setup->n_triangles + setup->n_edges;
    double bytes = LAYOUT + 3 * real * points + 5 * 8 * cells;
    if (setup->n_triangles && setup->n_edges)
        bytes += 4 * 8 * cells;
    for (int i = 0; i < OUTPUT_FIELDS; i++) {
        const enum output_field is = (enum output_field)i;
        if (setup->wants[i])
            bytes += output_field_width(is) * (output_field_is_whole(is) ? 4 : real) *
                     (output_field_is_of_cells(is) ? cells : points);
    }
    return bytes;
}

/* ---- The thread ---- */

/* Makes a file of the bytes, on the disk. */
static int hdf5_frames_fill(const struct output_hdf5 *frames, const char *path,
                            struct cloth_error *error)
{
    const int file = output_open_file(path, O_WRONLY | O_CREAT | O_TRUNC);
    if (file < 0)
        return output_fail(error, "write", path);
    int code = CLOTH_OK;
    if (output_write_at(file, frames->bytes.data, frames->bytes.n, 0) != 0 ||
        output_sync(file) != 0)
        code = output_fail(error, "write", path);
    if (close(file) != 0 && !code)
        code = output_fail(error, "write", path);
    return code;
}

/* Under another name until it is whole. */
static int hdf5_frames_put_file(const struct output_hdf5 *frames, const char *name,
                                struct cloth_error *error)
{
    char *path = output_path(frames->folder, name, ""),
         *part = output_path(frames->folder, name, ".part");
    int code = path && part
                   ? CLOTH_OK
                   : cloth_fail(error, CLOTH_E_MEMORY, "no memory for the path of a frame");
    if (!code)
        code = hdf5_frames_fill(frames, part, error);
    if (!code && rename(part, path) != 0)
        code = output_fail(error, "write", path);
    if (code && part)
        unlink(part);
    if (!code)
        output_sync_folder(frames->own);
    free(path);
    free(part);
    return code;
}

static int hdf5_frames_write_frame(struct output_hdf5 *frames, struct output_state *state,
                                   struct cloth_error *error)
{
    char name[OUTPUT_HDF5_NAME];
    const struct output_hdf5_setup *setup = &frames->setup;
    output_hdf5_name(name, state->frame);
    if (setup->wants[OUTPUT_STRAIN] || setup->wants[OUTPUT_STRESS])
        setup->derive(setup->context, state);
    int code = output_image(setup, &frames->grid, state, &frames->bytes, error);
    if (!code)
        code = hdf5_frames_put_file(frames, name, error);
    if (!code)
        code = output_indexes_add(&frames->indexes, setup, &frames->grid, name, state->time, error);
    output_sync_folder(frames->folder);
    return code;
}

/* The first one that is missing is said at once. */
static void hdf5_frames_miss(struct output_hdf5 *frames, uint64_t frame,
                             const struct cloth_error *why)
{
    char text[1200];
    if (frames->missing++)
        return;
    frames->first_missing = frame;
    frames->trouble = *why;
    snprintf(text, sizeof text, "%s; the run goes on without HDF5 frame %ju", why->text,
             (uintmax_t)frame);
    frames->setup.warn(text);
}

static void *work(void *context)
{
    struct output_hdf5 *frames = context;
    pthread_mutex_lock(&frames->lock);
    for (;;) {
        while (frames->done == frames->given && !frames->ends)
            pthread_cond_wait(&frames->change, &frames->lock);
        if (frames->done == frames->given)
            break;
        struct output_state *state = frames->flight + frames->done % OUTPUT_HDF5_FLIGHT;
        struct cloth_error why = {0};
        pthread_mutex_unlock(&frames->lock);
        frames->tried++;
        if (hdf5_frames_write_frame(frames, state, &why))
            hdf5_frames_miss(frames, state->frame, &why);
        pthread_mutex_lock(&frames->lock);
        frames->done++;
        pthread_cond_broadcast(&frames->change);
    }
    pthread_mutex_unlock(&frames->lock);
    return NULL;
}

/* Signals are the other threads'. */
static int start_thread(struct output_hdf5 *frames, struct cloth_error *error)
{
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    const int failed = pthread_create(&frames->thread, NULL, work, frames);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    frames->has_thread = !failed;
    return failed ? cloth_fail(error, CLOTH_E_LIBRARY, "no thread to write frames with: %s",
                               strerror(failed))
                  : CLOTH_OK;
}

/* ---- The caller ---- */

static int take_states(struct output_hdf5 *frames, struct cloth_error *error)
{
    const struct output_hdf5_setup *setup = &frames->setup;
    const size_t cells = output_grid_cells(&frames->grid);
    for (int f = 0; f < OUTPUT_HDF5_FLIGHT; f++) {
        struct output_state *state = frames->flight + f;
        state->position = cloth_alloc(setup->n_points, 3 * sizeof *state->position, error);
        for (int i = 0; i < OUTPUT_FIELDS; i++) {
            const enum output_field is = (enum output_field)i;
            const size_t rows = output_field_is_of_cells(is) ? cells : setup->n_points;
            if (setup->wants[i] && output_field_is_whole(is))
                state->number[i] = cloth_alloc(rows, sizeof *state->number[i], error);
            else if (setup->wants[i])
                state->field[i] =
                    cloth_alloc(rows, output_field_width(is) * sizeof *state->field[i], error);
        }
    }
    return error->code;
}

static void hdf5_frames_free(struct output_hdf5 *frames)
{
    for (int f = 0; f < OUTPUT_HDF5_FLIGHT; f++) {
        free(frames->flight[f].position);
        for (int i = 0; i < OUTPUT_FIELDS; i++) {
            free(frames->flight[f].field[i]);
            free(frames->flight[f].number[i]);
        }
    }
    output_grid_free(&frames->grid);
    free(frames->bytes.data);
    free(frames->folder);
    free(frames->own);
    pthread_cond_destroy(&frames->change);
    pthread_mutex_destroy(&frames->lock);
    free(frames);
}

static int open_all(struct output_hdf5 *frames, struct cloth_error *error)
{
    const char *lacks = output_hdf5_lacks(frames->setup.level);
    if (lacks)
        return cloth_fail(error, CLOTH_E_INPUT, "%s", lacks);
    if (!frames->folder || !frames->own)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the frames of HDF5");
    int code = output_grid_make(&frames->grid, &frames->setup, error);
    if (!code)
        code = take_states(frames, error);
    if (!code)
        code = output_indexes_open(&frames->indexes, frames->folder, frames->setup.n_frames, error);
    return code ? code : start_thread(frames, error);
}

int output_hdf5_open(struct output_hdf5 **frames, const struct output_hdf5_setup *setup,
                     struct cloth_error *error)
{
    struct cloth_error own = {0};
    *frames = NULL;
    struct output_hdf5 *made = calloc(1, sizeof *made);
    if (!made)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the frames of HDF5");
    made->setup = *setup;
    made->folder = strdup(setup->folder);
    made->own = output_path(setup->folder, "hdf5", "");
    for (int i = 0; i < OUTPUT_INDEXES; i++)
        made->indexes.of[i] = OUTPUT_INDEX_NONE;
    pthread_mutex_init(&made->lock, NULL);
    pthread_cond_init(&made->change, NULL);
    if (open_all(made, &own)) {
        struct cloth_error ignored = {0};
        output_hdf5_close(&made, &ignored);
        return cloth_fail(error, own.code, "%s", own.text);
    }
    *frames = made;
    return CLOTH_OK;
}

bool output_hdf5_takes(const struct output_hdf5 *frames, uint64_t frame)
{
    return frame % frames->setup.every == 0;
}

struct output_state *output_hdf5_begin(struct output_hdf5 *frames, uint64_t frame, double time)
{
    pthread_mutex_lock(&frames->lock);
    while (frames->given - frames->done >= OUTPUT_HDF5_FLIGHT)
        pthread_cond_wait(&frames->change, &frames->lock);
    struct output_state *state = frames->flight + frames->given % OUTPUT_HDF5_FLIGHT;
    pthread_mutex_unlock(&frames->lock);
    state->frame = frame;
    state->time = time;
    return state;
}

void output_hdf5_end(struct output_hdf5 *frames)
{
    pthread_mutex_lock(&frames->lock);
    frames->given++;
    pthread_cond_broadcast(&frames->change);
    pthread_mutex_unlock(&frames->lock);
}

void output_hdf5_wait(struct output_hdf5 *frames)
{
    pthread_mutex_lock(&frames->lock);
    while (frames->done < frames->given)
        pthread_cond_wait(&frames->change, &frames->lock);
    pthread_mutex_unlock(&frames->lock);
}

int output_hdf5_close(struct output_hdf5 **frames, struct cloth_error *error)
{
    struct output_hdf5 *gone = *frames;
    *frames = NULL;
    if (!gone)
        return CLOTH_OK;
    if (gone->has_thread) {
        pthread_mutex_lock(&gone->lock);
        gone->ends = true;
        pthread_cond_broadcast(&gone->change);
        pthread_mutex_unlock(&gone->lock);
        pthread_join(gone->thread, NULL);
    }
    int code = output_indexes_close(&gone->indexes, error);
    if (gone->missing)
        code = cloth_fail(error, CLOTH_E_IO,
                          "%ju of %ju HDF5 frames were not written, the first is frame %ju: %s",
                          (uintmax_t)gone->missing, (uintmax_t)gone->tried,
                          (uintmax_t)gone->first_missing, gone->trouble.text);
    hdf5_frames_free(gone);
    return code;
}
