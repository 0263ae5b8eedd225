/* The index that readers see is a whole text at any moment, also after a run was killed. The kernel
 * may stop a write between two pages, so the visible file is never written. Two files take turns:
 * the hidden one gets the entries that it lacks and the end of the text, then the two change names.
 * So an entry costs no copy of those before it. */
#include "cloth/output/hdf5/hdf5.h"

#include "cloth/base/file.h"
#include "cloth/output/files/cut.h"
#include "cloth/output/files/files.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

bool output_index_is_ours(const char *path, const char *begin)
{
    char bytes[256];
    const size_t n = strlen(begin);
    FILE *file = cloth_file_open(path);
    const bool is =
        file && n <= sizeof bytes && fread(bytes, 1, n, file) == n && memcmp(bytes, begin, n) == 0;
    if (file)
        fclose(file);
    return is;
}

/* ---- Two files ---- */

static int hdf5_index_append(struct output_bytes *text, const char *bytes, size_t n)
{
    if (n > text->room - text->n) {
        const size_t room = 2 * (text->n + n);
        unsigned char *data = realloc(text->data, room);
        if (!data)
            return -1;
        text->data = data;
        text->room = room;
    }
    memcpy(text->data + text->n, bytes, n);
    text->n += n;
    return 0;
}

/* Makes the hidden file that of the whole text. 0, or -1 with errno set. */
static int write_hidden(struct output_index *index)
{
    struct output_index_file *file = &index->hidden;
    const size_t n = index->text.n, end = strlen(index->form->end);
    if (file->file < 0) {
        file->file = output_open_file(index->hidden_path, O_WRONLY | O_CREAT | O_TRUNC);
        file->n = 0;
    }
    if (file->file < 0 ||
        output_write_at(file->file, index->text.data + file->n, n - file->n, file->n) != 0 ||
        output_write_at(file->file, index->form->end, end, n) != 0 ||
        ftruncate(file->file, (off_t)(n + end)) != 0)
        return -1;
    return output_sync(file->file);
}

/* The two change names. Where a file system gives a file one name only, the shown one is lost, and
 * the next hidden one begins anew. 0, or -1 with errno set, and the shown one stays. */
static int swap(struct output_index *index)
{
    struct output_index_file before = index->shown;
    const bool is_kept = link(index->path, index->spare_path) == 0;
    if (rename(index->hidden_path, index->path) != 0) {
        const int reason = errno;
        if (is_kept)
            unlink(index->spare_path);
        errno = reason;
        return -1;
    }
    if (!(is_kept && rename(index->spare_path, index->hidden_path) == 0) && before.file >= 0) {
        close(before.file);
        before.file = -1;
    }
    index->shown = (struct output_index_file){.file = index->hidden.file, .n = index->text.n};
    index->hidden = before;
    return 0;
}

/* ---- The entries of an earlier run ---- */

static const char SEPARATOR[] = ",\n";

static bool starts(const char *text, const char *with)
{
    return strncmp(text, with, strlen(with)) == 0;
}

/* The frame that an entry names; UINT64_MAX: none. */
static uint64_t hdf5_index_frame_of(const char *entry)
{
    const char *name = strstr(entry, OUTPUT_HDF5_FRAME);
    return name ? strtoull(name + strlen(OUTPUT_HDF5_FRAME), NULL, 10) : UINT64_MAX;
}

static int hdf5_index_check_frame(const char *folder, uint64_t frame, struct cloth_error *error)
{
    char name[OUTPUT_HDF5_NAME];
    output_hdf5_name(name, frame);
    char *path = output_path(folder, name, "");
    int code = path ? CLOTH_OK : cloth_fail(error, CLOTH_E_MEMORY, "no memory for a path");
    if (!code && access(path, F_OK) != 0)
        code = cloth_fail(error, CLOTH_E_INPUT, "%s is gone: %s", path, OUTPUT_CHANGED);
    free(path);
    return code;
}

/* Appends the entries of frames below n_frames, which come first in a text, with what begins it. */
static int hdf5_index_keep(struct output_index *index, const char *folder, const char *text,
                           uint64_t n_frames, struct cloth_error *error)
{
    const struct output_index_form *form = index->form;
    const char *at = text + strlen(form->begin);
    while (at && starts(at, form->entry) && hdf5_index_frame_of(at) < n_frames) {
        if (hdf5_index_check_frame(folder, hdf5_index_frame_of(at), error))
            return error->code;
        const char *next = strstr(at + 1, form->entry);
        at = next ? next : strstr(at, form->end);
        index->n++;
    }
    const bool more = at && starts(at, form->entry) && hdf5_index_frame_of(at) < UINT64_MAX;
    if (!more && (!at || strcmp(at, form->end) != 0))
        return cloth_fail(error, CLOTH_E_INPUT, "%s is not whole: %s", index->path, OUTPUT_CHANGED);
    size_t n = (size_t)(at - text), separator = strlen(SEPARATOR);
    if (index->n && memcmp(at - separator, SEPARATOR, separator) == 0)
        n -= separator;
    return hdf5_index_append(&index->text, text, n) == 0
               ? CLOTH_OK
               : cloth_fail(error, CLOTH_E_MEMORY, "no memory for an index of frames");
}

/* From the index that is there. */
static int keep_entries(struct output_index *index, const char *folder, uint64_t n_frames,
                        struct cloth_error *error)
{
    char *text = NULL;
    size_t room = 0;
    FILE *file = cloth_file_open(index->path);
    int code = CLOTH_OK;
    if (!file || getdelim(&text, &room, 0, file) < 0 || ferror(file))
        code = cloth_fail(error, CLOTH_E_INPUT, "cannot go on with %s: %s", index->path,
                          cloth_file_why());
    if (file)
        fclose(file);
    code = code ? code : hdf5_index_keep(index, folder, text, n_frames, error);
    free(text);
    return code;
}

/* ---- An index ---- */

static int begin_index(struct output_index *index, const char *folder, const uint64_t *n_frames,
                       struct cloth_error *error)
{
    const char *begin = index->form->begin;
    int code = CLOTH_OK;
    if (!index->path || !index->hidden_path || !index->spare_path)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for an index of frames");
    if (n_frames && access(index->path, F_OK) == 0)
        code = keep_entries(index, folder, *n_frames, error);
    else if (hdf5_index_append(&index->text, begin, strlen(begin)) != 0)
        code = cloth_fail(error, CLOTH_E_MEMORY, "no memory for an index of frames");
    if (!code && (write_hidden(index) != 0 || swap(index) != 0))
        code = output_refuse(error, "write", index->path);
    return code;
}

int output_index_open(struct output_index *index, const char *folder,
                      const struct output_index_form *form, const uint64_t *n_frames,
                      struct cloth_error *error)
{
    char *hidden = output_path(folder, "hdf5", "");
    *index = OUTPUT_INDEX_NONE;
    index->form = form;
    index->path = output_path(folder, form->name, "");
    if (hidden) {
        index->hidden_path = output_path(hidden, form->name, OUTPUT_INDEX_HIDDEN);
        index->spare_path = output_path(hidden, form->name, OUTPUT_INDEX_SPARE);
    }
    free(hidden);
    return begin_index(index, folder, n_frames, error);
}

int output_index_add(struct output_index *index, const char *entry, size_t n,
                     struct cloth_error *error)
{
    const size_t before = index->text.n;
    const char *comma = index->n && index->form->end[0] == ']' ? SEPARATOR : "";
    int code = output_check_same(index->shown.file, index->path, error);
    if (!code && (hdf5_index_append(&index->text, comma, strlen(comma)) != 0 ||
                  hdf5_index_append(&index->text, entry, n) != 0 || write_hidden(index) != 0 ||
                  swap(index) != 0))
        code = output_fail(error, "write", index->path);
    if (code)
        index->text.n = before;
    else
        index->n++;
    return code;
}

int output_index_close(struct output_index *index, struct cloth_error *error)
{
    const bool is_open = index->shown.file >= 0;
    int code = CLOTH_OK;
    if (is_open && close(index->shown.file) != 0)
        code = output_fail(error, "close", index->path);
    if (index->hidden.file >= 0)
        close(index->hidden.file);
    if (is_open || index->hidden.file >= 0) /* one of an earlier run may have that name, unopened */
        unlink(index->hidden_path);
    free(index->path);
    free(index->hidden_path);
    free(index->spare_path);
    free(index->text.data);
    *index = OUTPUT_INDEX_NONE;
    return code;
}
