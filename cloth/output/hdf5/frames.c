/* Two frames take turns: the caller fills one while the settler writes the other. A frame that
 * cannot be written is left out, and so is nothing else: what was written before stays as it is,
 * and the next one is tried. */
#include "cloth/output/hdf5/hdf5.h"

#include <stdlib.h>
#include <unistd.h>

struct output_hdf5 {
    struct output_hdf5_setup setup;
    struct output_grid grid;
    struct output_indexes *indexes;
    struct output_member member;
    struct output_state flight[OUTPUT_HDF5_FLIGHT];
    uint32_t given; /* frames; number i is in flight[i % OUTPUT_HDF5_FLIGHT] */
    /* the settler's */
    uint32_t done, missing;
    uint64_t first_missing;
    struct cloth_error trouble; /* of the first one */
    struct cloth_list bytes;    /* of a file */
};

double output_hdf5_bytes(const struct output_hdf5_setup *setup)
{
    enum { LAYOUT = 16384 };
    const double real = setup->is_double ? 8 : 4, points = setup->n_points;
    const double cells = (double)setup->n_triangles + setup->n_edges;
    double bytes = LAYOUT + 3 * real * points + 5 * 8 * cells;
    if (setup->n_triangles && setup->n_edges)
        bytes += 4 * 8 * cells;
    for (int i = 0; i < OUTPUT_FIELDS; i++) {
        const struct output_field_form *form = output_fields + i;
        if (setup->wants[i])
            bytes +=
                form->width * (form->is_whole ? 4 : real) * (form->is_of_cells ? cells : points);
    }
    return bytes;
}

/* ---- The settler ---- */

static int fill_bytes(FILE *file, const void *what)
{
    const struct cloth_list *bytes = what;
    return fwrite(bytes->items, 1, bytes->n, file) != bytes->n;
}

/* Under another name until it is whole. */
static int put_file(const struct output_hdf5 *frames, const char *name, struct cloth_error *error)
{
    const struct output_path path = output_path(frames->setup.folder, "%s", name);
    const struct output_path part = output_path(frames->setup.folder, "%s.part", name);
    int code = output_write_file(part.text, fill_bytes, &frames->bytes, error);
    if (!code && rename(part.text, path.text) != 0) {
        code = output_fail(error, "write", path.text);
        unlink(part.text);
    }
    output_sync_folder(output_path(frames->setup.folder, "hdf5").text);
    return code;
}

static int hdf5_frames_write_frame(struct output_hdf5 *frames, struct output_state *state,
                                   struct cloth_error *error)
{
    char name[48];
    const struct output_hdf5_setup *setup = &frames->setup;
    snprintf(name, sizeof name, OUTPUT_HDF5_NAME, (uintmax_t)state->frame);
    if (setup->wants[OUTPUT_STRAIN] || setup->wants[OUTPUT_STRESS])
        setup->derive(setup->context, state);
    int code = output_image(setup, &frames->grid, state, &frames->bytes, error);
    if (!code)
        code = put_file(frames, name, error);
    if (!code)
        code = output_indexes_add(frames->indexes, setup, &frames->grid, name, state->time, error);
    output_sync_folder(frames->setup.folder);
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

/* Writes the first n frames. Missing ones are no failure of the settler: the run goes on. */
static int hdf5_settle(void *context, uint32_t n, struct cloth_error *error)
{
    struct output_hdf5 *frames = context;
    (void)error;
    for (; frames->done < n; frames->done++) {
        struct output_state *state = frames->flight + frames->done % OUTPUT_HDF5_FLIGHT;
        struct cloth_error why = {0};
        if (hdf5_frames_write_frame(frames, state, &why))
            hdf5_frames_miss(frames, state->frame, &why);
    }
    return CLOTH_OK;
}

/* ---- The caller ---- */

static int take_states(struct output_hdf5 *frames, struct cloth_error *error)
{
    const struct output_hdf5_setup *setup = &frames->setup;
    for (int f = 0; f < OUTPUT_HDF5_FLIGHT; f++) {
        struct output_state *state = frames->flight + f;
        state->position = cloth_alloc(setup->n_points, 3 * sizeof *state->position, error);
        for (int i = 0; i < OUTPUT_FIELDS; i++) {
            const size_t rows = output_grid_rows(&frames->grid, i);
            if (setup->wants[i] && output_fields[i].is_whole)
                state->number[i] = cloth_alloc(rows, sizeof *state->number[i], error);
            else if (setup->wants[i])
                state->field[i] =
                    cloth_alloc(rows, output_fields[i].width * sizeof *state->field[i], error);
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
    free(frames->bytes.items);
    free(frames);
}

static int open_all(struct output_hdf5 *frames, struct cloth_error *error)
{
    const char *lacks = output_hdf5_lacks(frames->setup.level);
    if (lacks)
        return cloth_fail(error, CLOTH_E_INPUT, "%s", lacks);
    int code = output_grid_make(&frames->grid, &frames->setup, error);
    if (!code)
        code = take_states(frames, error);
    return code ? code
                : output_indexes_open(&frames->indexes, frames->setup.folder,
                                      frames->setup.n_frames, error);
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
    made->member = (struct output_member){.settle = hdf5_settle, .context = made};
    if (open_all(made, &own)) {
        output_hdf5_close(&made, NULL);
        return cloth_fail(error, own.code, "%s", own.text);
    }
    output_member_add(&made->member, setup->settler, 0);
    *frames = made;
    return CLOTH_OK;
}

bool output_hdf5_takes(const struct output_hdf5 *frames, uint64_t frame)
{
    return frame % frames->setup.every == 0;
}

/* Waits for the first n frames. A settler that failed writes nothing more: then the caller does. */
static void hdf5_await(struct output_hdf5 *frames, uint32_t n)
{
    if (!output_member_wait(&frames->member, n))
        hdf5_settle(frames, n, NULL);
}

struct output_state *output_hdf5_begin(struct output_hdf5 *frames, uint64_t frame, double time)
{
    if (frames->given >= OUTPUT_HDF5_FLIGHT)
        hdf5_await(frames, frames->given - OUTPUT_HDF5_FLIGHT + 1);
    struct output_state *state = frames->flight + frames->given % OUTPUT_HDF5_FLIGHT;
    state->frame = frame;
    state->time = time;
    return state;
}

void output_hdf5_end(struct output_hdf5 *frames)
{
    output_member_wrote(&frames->member, ++frames->given, NULL);
}

void output_hdf5_wait(struct output_hdf5 *frames)
{
    hdf5_await(frames, frames->given);
}

int output_hdf5_close(struct output_hdf5 **frames, struct cloth_error *error)
{
    struct output_hdf5 *gone = *frames;
    *frames = NULL;
    if (!gone)
        return CLOTH_OK;
    hdf5_settle(gone, gone->given, NULL);
    int code = output_indexes_close(&gone->indexes, error);
    if (gone->missing)
        code = cloth_fail(
            error, CLOTH_E_IO, "%u of %u HDF5 frames were not written, the first is frame %ju: %s",
            gone->missing, gone->done, (uintmax_t)gone->first_missing, gone->trouble.text);
    hdf5_frames_free(gone);
    return code;
}
