/* Written by hand from runtime/trace/format.h, without the code that writes traces. A tick is a
 * nanosecond. */
#include "tests/support/trace_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void *room(void *array, size_t *capacity, size_t n, size_t size)
{
    if (n < *capacity)
        return array;
    *capacity = 2 * n + 16;
    array = realloc(array, *capacity * size);
    if (!array)
        abort();
    return array;
}

void trace_file_word(struct trace_file *file, uint32_t word)
{
    file->word = room(file->word, &file->words_capacity, file->n_words, sizeof *file->word);
    file->word[file->n_words++] = word;
}

static void put_long(struct trace_file *file, uint64_t value)
{
    trace_file_word(file, (uint32_t)value);
    trace_file_word(file, (uint32_t)(value >> 32));
}

void trace_file_object(struct trace_file *file, uint32_t slot, uint64_t bytes)
{
    trace_file_word(file, TRACE_OBJECT);
    trace_file_word(file, slot);
    put_long(file, bytes);
}

void trace_file_begin(struct trace_file *file, uint32_t n_slots)
{
    trace_file_word(file, TRACE_HOMES | n_slots << 8);
    for (uint32_t slot = 1; slot <= n_slots; slot++) {
        trace_file_word(file, slot);
        trace_file_word(file, 0);
    }
    trace_file_word(file, TRACE_ON);
    put_long(file, file->forks);
    for (int i = 0; i < 2; i++)
        put_long(file, 0);
}

static void put_double(struct trace_file *file, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_long(file, bits);
}

void trace_file_hint(struct trace_file *file, uint32_t slot, uint32_t other, double bytes)
{
    trace_file_word(file, TRACE_HINT | 1 << 8);
    trace_file_word(file, slot);
    put_double(file, 1);
    trace_file_word(file, other);
    put_double(file, bytes);
}

void trace_file_event(struct trace_file *file, const struct trace_event *event)
{
    file->event = room(file->event, &file->events_capacity, file->n_events, sizeof *event);
    file->event[file->n_events++] = *event;
}

static uint64_t ticks(double seconds)
{
    return (uint64_t)(1e9 * seconds + 0.5);
}

static void put_event(struct trace_file *file, enum trace_file_kernel kernel, double seconds)
{
    trace_file_event(file, &(struct trace_event){.took = ticks(seconds),
                                                 .number = ++file->forks,
                                                 .kernel = kernel,
                                                 .kind = TRACE_TASK});
}

void trace_file_own(struct trace_file *file, uint32_t type, double seconds)
{
    trace_file_event(
        file, &(struct trace_event){.took = ticks(seconds), .kernel = type, .kind = TRACE_OWN});
}

void trace_file_fork(struct trace_file *file, enum trace_file_kernel kernel, double seconds,
                     int32_t priority, size_t n, const uint32_t *slots)
{
    put_event(file, kernel, seconds);
    trace_file_word(file, TRACE_FORKED | (uint32_t)n << 8);
    trace_file_word(file, kernel);
    trace_file_word(file, UINT32_MAX); /* no rank is named */
    trace_file_word(file, (uint32_t)priority);
    trace_file_word(file, 0);
    for (size_t i = 0; i < n; i++)
        trace_file_word(file, slots[i]);
}

void trace_file_graph(struct trace_file *file, uint32_t n_objects, uint32_t n,
                      const struct trace_file_node *nodes)
{
    trace_file_word(file, TRACE_GRAPH | n_objects << 8);
    trace_file_word(file, 0);
    for (uint32_t slot = 1; slot <= n_objects; slot++)
        trace_file_word(file, slot);
    trace_file_word(file, n);
    for (uint32_t i = 0; i < n; i++) {
        uint32_t cost;
        memcpy(&cost, &nodes[i].cost, sizeof cost);
        trace_file_word(file, nodes[i].kernel == FILE_SET ? UINT32_MAX : nodes[i].kernel);
        trace_file_word(file, nodes[i].n);
        trace_file_word(file, UINT32_MAX); /* no rank is named */
        trace_file_word(file, 0);
        trace_file_word(file, cost);
        for (uint32_t k = 0; k < nodes[i].n; k++)
            trace_file_word(file, nodes[i].place[k]);
    }
}

void trace_file_replay(struct trace_file *file, uint32_t n_objects, uint32_t n,
                       const struct trace_file_node *nodes, uint32_t rounds)
{
    trace_file_word(file, TRACE_REPLAY | n_objects << 8);
    trace_file_word(file, 0);
    trace_file_word(file, 0); /* no flag */
    put_long(file, rounds);
    put_long(file, file->forks);
    for (uint32_t slot = 1; slot <= n_objects; slot++)
        trace_file_word(file, slot);
    for (uint32_t round = 0; round < rounds; round++)
        for (uint32_t i = 0; i < n; i++)
            if (nodes[i].kernel != FILE_SET)
                put_event(file, nodes[i].kernel, nodes[i].seconds);
}

void trace_file_wait(struct trace_file *file)
{
    trace_file_word(file, TRACE_WAIT);
    put_long(file, 0);
    put_long(file, 0);
}

void trace_file_forked(struct trace_file *file, double seconds)
{
    trace_file_word(file, TRACE_WAIT);
    put_long(file, (uint64_t)(1e9 * seconds + 0.5));
    put_long(file, (uint64_t)(1e9 * seconds + 0.5));
}

void trace_file_get(struct trace_file *file, uint32_t slot)
{
    trace_file_word(file, TRACE_GET);
    trace_file_word(file, slot);
    trace_file_word(file, UINT32_MAX);
    put_long(file, 0);
    put_long(file, 0);
}

void trace_file_get_begin(struct trace_file *file, uint32_t number, uint32_t slot)
{
    trace_file_word(file, TRACE_GET_BEGIN);
    trace_file_word(file, number);
    trace_file_word(file, slot);
}

void trace_file_get_end(struct trace_file *file, uint32_t number)
{
    trace_file_word(file, TRACE_GET_END);
    trace_file_word(file, number);
    put_long(file, 0);
    put_long(file, 0);
}

static const struct {
    const char *name;
    uint8_t mode[3];
    uint8_t replicated;
} KERNELS[FILE_KERNELS] = {[FILE_W] = {"w", {DUITE_W}, 0},
                           [FILE_RW] = {"rw", {DUITE_RW}, 0},
                           [FILE_R_W] = {"r_w", {DUITE_R, DUITE_W}, 0},
                           [FILE_RR_W] = {"rr_w", {DUITE_R, DUITE_R, DUITE_W}, 0},
                           [FILE_R_CW] = {"r_cw", {DUITE_R, DUITE_CW}, 0},
                           [FILE_RR_RW] = {"rr_rw", {DUITE_R, DUITE_R, DUITE_RW}, 0},
                           [FILE_SAME] = {"same", {DUITE_R, DUITE_W}, 1}};

static void write_kernels(FILE *out)
{
    struct trace_kernel kernel[FILE_KERNELS] = {0};
    char names[64] = "", *name = names;
    for (int i = 0; i < FILE_KERNELS; i++) {
        memcpy(kernel[i].mode, KERNELS[i].mode, sizeof KERNELS[i].mode);
        for (kernel[i].n_modes = 0; kernel[i].n_modes < 3 && KERNELS[i].mode[kernel[i].n_modes];)
            kernel[i].n_modes++;
        kernel[i].replicated = KERNELS[i].replicated;
        name = stpcpy(name, KERNELS[i].name) + 1;
    }
    const struct trace_section head = {TRACE_KERNELS, FILE_KERNELS, sizeof kernel + sizeof names};
    fwrite(&head, sizeof head, 1, out);
    fwrite(kernel, sizeof kernel, 1, out);
    fwrite(names, sizeof names, 1, out);
}

bool trace_file_write(struct trace_file *file, const char *path)
{
    bool fills = file->n_words % 2;
    if (fills)
        trace_file_word(file, TRACE_FILLS);
    const struct trace_section events = {TRACE_EVENTS, 0, file->n_events * sizeof *file->event};
    const struct trace_section words = {TRACE_PROGRAM, fills, 4 * file->n_words};
    struct trace_header header = {.version = TRACE_VERSION,
                                  .order = TRACE_ORDER,
                                  .n_ranks = 1,
                                  .workers = 1,
                                  .whole = 1,
                                  .lost = file->lost,
                                  .run = 1,
                                  .tick = 1e-9,
                                  .end = UINT64_MAX};
    memcpy(header.magic, TRACE_MAGIC, sizeof header.magic);
    FILE *out = fopen(path, "w");
    if (!out)
        return false;
    fwrite(&header, sizeof header, 1, out);
    write_kernels(out);
    fwrite(&events, sizeof events, 1, out);
    fwrite(file->event, sizeof *file->event, file->n_events, out);
    fwrite(&words, sizeof words, 1, out);
    fwrite(file->word, 4, file->n_words, out);
    header.bytes = (uint64_t)ftell(out);
    rewind(out);
    fwrite(&header, sizeof header, 1, out);
    free(file->word);
    free(file->event);
    *file = (struct trace_file){0};
    const bool written = !ferror(out);
    return !fclose(out) && written;
}
