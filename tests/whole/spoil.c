/* spoil FILE WHAT: changes one thing in a checkpoint, whose length and hash fit again. So a restart
 * sees what only its own checks keep away.
 * spoil FILE as OTHER: whether two checkpoints have the same state, whatever their reports say. */
#include "cloth/flow/checkpoint/checkpoint.h"
#include "cloth/flow/contact/contact.h"
#include "cloth/output/checkpoint.h"
#include "tests/fuzz/fit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

struct opened {
    unsigned char *phases, *flow; /* the second and the third part */
    size_t n_phases, n_flow;
    struct flow_saved *saved;
    struct flow_saved_arrays arrays;
};

/* The payload of the first object that begins as a list with contacts does. NULL: none does. */
static struct flow_list *find_list(const struct opened *of)
{
    for (size_t at = of->saved->main_bytes; at + sizeof(uint64_t) < of->n_flow;) {
        uint64_t bytes;
        memcpy(&bytes, of->flow + at, sizeof bytes);
        struct flow_list *list = (void *)(of->flow + at + sizeof bytes);
        const size_t contacts = flow_list_bytes(1, sizeof(struct flow_contact));
        if (bytes > contacts && list->n && list->n < 1000 &&
            flow_list_bytes(list->n, sizeof(struct flow_contact)) < bytes)
            return list;
        at += sizeof bytes + (bytes + 7) / 8 * 8;
    }
    return NULL;
}

/* Rows of the first block: those of its places, which come first. */
static uint32_t rows_of_first(const struct opened *of)
{
    uint64_t bytes;
    memcpy(&bytes, of->flow + of->saved->main_bytes, sizeof bytes);
    return (uint32_t)(bytes / sizeof(phys_vec));
}

/* The first corner in the first block comes to lie in the row after its last one. */
static bool spoil_corner(const struct opened *of, struct flow_tie_corners *at)
{
    uint32_t k = 0;
    while (k < at->n && at->block[k] > 0)
        k++;
    if (k == at->n)
        return false;
    at->row[k] = rows_of_first(of);
    return true;
}

/* Spoils the first contact. */
static bool spoil_contact(const struct opened *of, const char *what)
{
    struct flow_list *list = find_list(of);
    if (!list)
        return false;
    struct flow_contact *contact = (void *)(list + 1);
    if (!strcmp(what, "point"))
        contact->point[0] = UINT32_MAX;
    else if (!strcmp(what, "row"))
        contact->at.row[0] = 1u << 30;
    else if (!strcmp(what, "next"))
        return spoil_corner(of, &contact->at);
    else if (!strcmp(what, "corners"))
        contact->at.n = 77;
    else if (!strcmp(what, "index"))
        ((uint32_t *)(void *)(contact + list->n))[1] = 1u << 30;
    else
        return false;
    return true;
}

static bool spoil_main(const struct opened *of, const char *what)
{
    struct flow_saved *saved = of->saved;
    if (!strcmp(what, "length"))
        saved->lasting.grid.length = 0;
    else if (!strcmp(what, "time"))
        saved->lasting.grid.now = UINT64_MAX;
    else if (!strcmp(what, "flag"))
        *(unsigned char *)&saved->lasting.over = 7;
    else if (!strcmp(what, "frames"))
        saved->lasting.certain.next = UINT64_MAX;
    else if (!strcmp(what, "ties"))
        saved->has_ties = !saved->has_ties;
    else if (!strcmp(what, "other") && saved->n_others)
        of->arrays.tied.other[0] = saved->n_blocks;
    else if (!strcmp(what, "side") && saved->n_meetings)
        ((struct flow_saved_side *)of->arrays.side)->side[1] = 1u << 30;
    else if (!strcmp(what, "room") && saved->n_meetings)
        for (uint32_t i = 0; i < saved->n_meetings; i++)
            ((struct flow_saved_side *)of->arrays.side)[i].room = 0;
    else if (!strcmp(what, "kept") && saved->n_kept)
        *(uint32_t *)of->arrays.kept = UINT32_MAX;
    else
        return false;
    saved->main_bytes = flow_saved_main_bytes(saved);
    return true;
}

/* Spoils places in the first object of the first block, or the word for how a phase ended. */
static bool spoil_rest(const struct opened *of, const char *what)
{
    unsigned char *first = of->flow + of->saved->main_bytes;
    const double none = NAN;
    const uint64_t much = UINT64_MAX - 2;
    if (!strcmp(what, "size")) {
        memcpy(first, &much, sizeof much);
    } else if (!strcmp(what, "place")) {
        memcpy(first + sizeof much, &none, sizeof none);
    } else if (!strcmp(what, "word")) {
        unsigned char *word = memmem(of->phases, of->n_phases, "end\0\0\0\0\0", 8);
        if (word)
            memset(word, 'x', 16);
        return word;
    } else {
        return false;
    }
    return true;
}

static bool write_back(const struct output_checkpoint *checkpoint, const char *path)
{
    const struct output_part *last = checkpoint->part + OUTPUT_CHECKPOINT_PARTS - 1;
    const unsigned char *end = (const unsigned char *)last->bytes + (last->n + 7) / 8 * 8;
    const size_t n = (size_t)(end + sizeof(uint64_t) - checkpoint->bytes);
    FILE *file = fopen(path, "wb");
    fit_checkpoint(checkpoint->bytes, n);
    const bool whole = file && fwrite(checkpoint->bytes, 1, n, file) == n;
    return file && fclose(file) == 0 && whole;
}

/* Says which byte of the state is the first that differs. */
static int compare(const char *const path[2])
{
    struct output_checkpoint checkpoint[2] = {0};
    struct cloth_error error = {0};
    const unsigned char *bytes[2];
    size_t n[2], i = 0;
    for (int k = 0; k < 2; k++) {
        if (output_checkpoint_read(checkpoint + k, path[k], &error)) {
            fprintf(stderr, "%s\n", error.text);
            return 99;
        }
        bytes[k] = checkpoint[k].part[2].bytes;
        n[k] = checkpoint[k].part[2].n;
        memset(&((struct flow_saved *)(void *)bytes[k])->report, 0, sizeof(struct flow_report));
    }
    while (i < n[0] && i < n[1] && bytes[0][i] == bytes[1][i])
        i++;
    const bool same = i == n[0] && i == n[1];
    fprintf(stderr, "%zu of %zu and %zu bytes are the same\n", i, n[0], n[1]);
    output_checkpoint_free(checkpoint);
    output_checkpoint_free(checkpoint + 1);
    return same ? 0 : 1;
}

int main(int argc, char **argv)
{
    struct output_checkpoint checkpoint;
    struct cloth_error error = {0};
    if (argc == 4 && !strcmp(argv[2], "as"))
        return compare((const char *const[2]){argv[1], argv[3]});
    if (argc != 3 || output_checkpoint_read(&checkpoint, argv[1], &error)) {
        fprintf(stderr, "usage: spoil CHECKPOINT WHAT: %s\n", error.text);
        return 99;
    }
    struct opened of = {.phases = (unsigned char *)checkpoint.part[1].bytes,
                        .n_phases = checkpoint.part[1].n,
                        .flow = (unsigned char *)checkpoint.part[2].bytes,
                        .n_flow = checkpoint.part[2].n};
    of.saved = (void *)of.flow;
    of.arrays = flow_saved_arrays(of.saved, of.flow);
    const bool spoilt =
        spoil_main(&of, argv[2]) || spoil_contact(&of, argv[2]) || spoil_rest(&of, argv[2]);
    const bool written = spoilt && write_back(&checkpoint, argv[1]);
    output_checkpoint_free(&checkpoint);
    fprintf(stderr, "%s: %s\n", argv[2], written ? "spoilt" : "not there");
    return written ? 0 : 99;
}
