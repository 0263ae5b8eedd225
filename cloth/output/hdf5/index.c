/* The index that readers see is a whole text at any moment, also after a run was killed. The kernel
 * may stop a write between two pages, so the visible file is never written. Two files take turns:
 * the hidden one gets the entries that it lacks and the end of the text, then the two exchange
 * names. So an entry costs no copy of those before it. */
#include "cloth/output/hdf5/hdf5.h"

#include "cloth/base/file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/fs.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

struct index {
    const struct output_index_form *form;
    struct output_file shown, hidden; /* size: the bytes of the text that it has */
    struct cloth_list text;           /* bytes: all but its end */
    uint32_t n;                       /* entries */
};

struct output_indexes {
    const char *folder;
    struct index of[OUTPUT_INDEXES];
};

static int index_append(struct index *index, const char *bytes, size_t n, struct cloth_error *error)
{
    char *to = cloth_list_add(&index->text, 1, n, error);
    if (to)
        memcpy(to, bytes, n);
    return to ? CLOTH_OK : CLOTH_E_MEMORY;
}

/* ---- Two files ---- */

/* Makes the hidden file that of the whole text. 0, or -1 with errno set. */
static int write_hidden(struct index *index)
{
    struct output_file *to = &index->hidden;
    const size_t n = index->text.n, end = strlen(index->form->end);
    const char *text = index->text.items;
    if (to->file < 0) {
        to->file = output_open_file(to->path.text, O_WRONLY | O_CREAT | O_TRUNC);
        to->size = 0;
    }
    if (to->file < 0 || output_write_at(to->file, text + to->size, n - to->size, to->size) != 0 ||
        output_write_at(to->file, index->form->end, end, n) != 0 ||
        ftruncate(to->file, (off_t)(n + end)) != 0)
        return -1;
    return output_sync(to->file);
}

/* The two exchange their names. Where a file system cannot do that, the shown one is lost, and the
 * next hidden one begins anew. 0, or -1 with errno set, and the shown one stays. */
static int swap(struct index *index)
{
    const char *shown = index->shown.path.text, *hidden = index->hidden.path.text;
    const int before = index->shown.file;
    const bool is_kept = before >= 0 && syscall(SYS_renameat2, AT_FDCWD, hidden, AT_FDCWD, shown,
                                                RENAME_EXCHANGE) == 0;
    if (!is_kept && rename(hidden, shown) != 0)
        return -1;
    if (!is_kept && before >= 0)
        close(before);
    index->shown.file = index->hidden.file;
    index->hidden.file = is_kept ? before : -1;
    index->hidden.size = index->shown.size;
    index->shown.size = index->text.n;
    return 0;
}

/* ---- The entries of an earlier run ---- */

static const char SEPARATOR[] = ",\n";

static bool starts(const char *text, const char *with)
{
    return strncmp(text, with, strlen(with)) == 0;
}

/* The frame that an entry names; UINT64_MAX: none. */
static uint64_t frame_of(const char *entry)
{
    const char *name = strstr(entry, OUTPUT_HDF5_FRAME);
    return name ? strtoull(name + strlen(OUTPUT_HDF5_FRAME), NULL, 10) : UINT64_MAX;
}

/* Appends the entries of frames below n_frames, which come first in a text, with what begins it. */
static int index_keep(struct index *index, const char *folder, const char *text, uint64_t n_frames,
                      struct cloth_error *error)
{
    const struct output_index_form *form = index->form;
    const char *at = text + strlen(form->begin);
    while (at && starts(at, form->entry) && frame_of(at) < n_frames) {
        const struct output_path path =
            output_path(folder, OUTPUT_HDF5_NAME, (uintmax_t)frame_of(at));
        if (access(path.text, F_OK) != 0)
            return cloth_fail(error, CLOTH_E_INPUT, "%s is gone: %s", path.text, OUTPUT_CHANGED);
        const char *next = strstr(at + 1, form->entry);
        at = next ? next : strstr(at, form->end);
        index->n++;
    }
    const bool more = at && starts(at, form->entry) && frame_of(at) < UINT64_MAX;
    if (!more && (!at || strcmp(at, form->end) != 0))
        return cloth_fail(error, CLOTH_E_INPUT, "%s is not whole: %s", index->shown.path.text,
                          OUTPUT_CHANGED);
    size_t n = (size_t)(at - text), separator = strlen(SEPARATOR);
    if (index->n && memcmp(at - separator, SEPARATOR, separator) == 0)
        n -= separator;
    return index_append(index, text, n, error);
}

/* From the index that is there. */
static int keep_entries(struct index *index, const char *folder, uint64_t n_frames,
                        struct cloth_error *error)
{
    size_t size;
    unsigned char *text = output_read_file(index->shown.path.text, &size);
    const int code = text ? index_keep(index, folder, (const char *)text, n_frames, error)
                          : cloth_fail(error, CLOTH_E_INPUT, "cannot go on with %s: %s",
                                       index->shown.path.text, cloth_file_why());
    free(text);
    return code;
}

/* ---- An index ---- */

static bool is_ours(const struct index *index)
{
    return output_begins(index->shown.path.text, index->form->begin, strlen(index->form->begin));
}

/* Begins a new one, or goes on with one that is there, with its entries of frames below *n_frames.
 */
static int index_open(struct index *index, const char *folder, const uint64_t *n_frames,
                      struct cloth_error *error)
{
    const char *path = index->shown.path.text, *begin = index->form->begin;
    int code = n_frames && access(path, F_OK) == 0
                   ? keep_entries(index, folder, *n_frames, error)
                   : index_append(index, begin, strlen(begin), error);
    if (!code && (write_hidden(index) != 0 || swap(index) != 0))
        code = output_refuse(error, "write", path);
    return code;
}

/* An entry that fails leaves the others. */
static int index_add(struct index *index, const char *entry, struct cloth_error *error)
{
    const size_t before = index->text.n;
    const char *comma = index->n && index->form->end[0] == ']' ? SEPARATOR : "";
    int code = output_file_check(&index->shown, error);
    code = code ? code : index_append(index, comma, strlen(comma), error);
    code = code ? code : index_append(index, entry, strlen(entry), error);
    if (!code && (write_hidden(index) != 0 || swap(index) != 0))
        code = output_fail(error, "write", index->shown.path.text);
    if (code)
        index->text.n = before;
    else
        index->n++;
    return code;
}

static int index_close(struct index *index, struct cloth_error *error)
{
    /* an earlier run's hidden file, which was not opened, stays */
    const bool is_open = index->shown.file >= 0 || index->hidden.file >= 0;
    const int code = output_file_close(&index->shown, error);
    output_file_close(&index->hidden, NULL);
    if (is_open)
        unlink(index->hidden.path.text);
    free(index->text.items);
    return code;
}

/* ---- Files that an earlier run left ---- */

/* True if a file of the folder hdf5 has a frame's name; *frame: its number, UINT64_MAX if it was
 * under way. */
static bool is_frame(const char *name, uint64_t *frame)
{
    static const char BEGIN[] = "frame-";
    if (strncmp(name, BEGIN, sizeof BEGIN - 1) != 0)
        return false;
    name += sizeof BEGIN - 1;
    const size_t digits = strspn(name, "0123456789");
    const bool half = strcmp(name + digits, ".vtkhdf.part") == 0;
    *frame = half ? UINT64_MAX : strtoull(name, NULL, 10);
    return digits >= 6 && (half || strcmp(name + digits, ".vtkhdf") == 0);
}

/* Removes frames from a number on, and those under way. *stay: whether there are frames before. */
static int remove_frames(const char *folder, uint64_t from, bool *stay, struct cloth_error *error)
{
    const struct output_path frames = output_path(folder, "hdf5");
    DIR *all = opendir(frames.text);
    int code = CLOTH_OK;
    *stay = false;
    for (struct dirent *entry; all && !code && (entry = readdir(all));) {
        uint64_t frame;
        const struct output_path path = output_path(frames.text, "%s", entry->d_name);
        if (!is_frame(entry->d_name, &frame))
            continue;
        if (frame < from)
            *stay = true;
        else if (unlink(path.text) != 0)
            code = output_refuse(error, "replace", path.text);
    }
    if (all)
        closedir(all);
    return code;
}

static int remove_file(const char *path, struct cloth_error *error)
{
    return unlink(path) == 0 || errno == ENOENT ? CLOTH_OK : output_refuse(error, "replace", path);
}

/* One that is there is ours; if it has to be, it is. */
static int check_indexes(const struct output_indexes *indexes, bool have_to,
                         struct cloth_error *error)
{
    for (int i = 0; i < OUTPUT_INDEXES; i++) {
        const char *path = indexes->of[i].shown.path.text;
        const bool is_there = access(path, F_OK) == 0;
        if (!is_there && have_to)
            return cloth_fail(error, CLOTH_E_INPUT, "%s is gone: %s", path, OUTPUT_CHANGED);
        if (is_there && !is_ours(indexes->of + i))
            return cloth_fail(error, CLOTH_E_INPUT,
                              "%s is in the way, and is no index of frames of an earlier run; give "
                              "another folder, or move the file away",
                              path);
    }
    return CLOTH_OK;
}

/* Removes what an earlier run left, but for the frames below *n_frames; NULL: all. Indexes are
 * looked at before one is removed; they go first, so that none names what is not there. */
static int clear(const struct output_indexes *indexes, const uint64_t *n_frames,
                 struct cloth_error *error)
{
    bool stay = false;
    int code = n_frames ? remove_frames(indexes->folder, UINT64_MAX, &stay, error) : CLOTH_OK;
    code = code ? code : check_indexes(indexes, stay, error);
    for (int i = 0; i < OUTPUT_INDEXES && !code; i++) {
        const struct index *index = indexes->of + i;
        code = n_frames ? CLOTH_OK : remove_file(index->shown.path.text, error);
        code = code ? code : remove_file(index->hidden.path.text, error);
    }
    if (code || n_frames)
        return code;
    code = remove_frames(indexes->folder, 0, &stay, error);
    if (!code)
        rmdir(output_path(indexes->folder, "hdf5").text); /* unless it has other files, too */
    return code;
}

/* ---- Both indexes ---- */

/* Names them; none is open. */
static int indexes_make(struct output_indexes **indexes, const char *folder,
                        struct cloth_error *error)
{
    struct output_indexes *made = *indexes = cloth_alloc(1, sizeof *made, error);
    if (!made)
        return CLOTH_E_MEMORY;
    for (int i = 0; i < OUTPUT_INDEXES; i++) {
        struct index *index = made->of + i;
        index->form = output_index_forms + i;
        index->shown = output_file(folder, index->form->name);
        index->hidden = (struct output_file){
            .path = output_path(folder, "hdf5/%s.part", index->form->name), .file = -1};
    }
    made->folder = folder;
    return CLOTH_OK;
}

static int indexes_open(struct output_indexes *indexes, const uint64_t *n_frames,
                        struct cloth_error *error)
{
    const char *folder = indexes->folder;
    bool stay;
    int code = clear(indexes, n_frames, error);
    if (!code)
        code = output_make_folder(output_path(folder, "hdf5").text, error);
    for (int i = 0; i < OUTPUT_INDEXES && !code; i++)
        code = index_open(indexes->of + i, folder, n_frames, error);
    if (!code && n_frames)
        code = remove_frames(folder, *n_frames, &stay, error);
    return code;
}

int output_indexes_open(struct output_indexes **indexes, const char *folder,
                        const uint64_t *n_frames, struct cloth_error *error)
{
    const int code = indexes_make(indexes, folder, error);
    return code ? code : indexes_open(*indexes, n_frames, error);
}

int output_indexes_add(struct output_indexes *indexes, const struct output_hdf5_setup *setup,
                       const struct output_grid *grid, const char *frame, double time,
                       struct cloth_error *error)
{
    int code = CLOTH_OK;
    for (int i = 0; i < OUTPUT_INDEXES; i++) {
        char *entry = output_index_entry(i, setup, grid, frame, time);
        const int failed =
            entry ? index_add(indexes->of + i, entry, error)
                  : cloth_fail(error, CLOTH_E_MEMORY, "no memory for the index of frames");
        code = code ? code : failed;
        free(entry);
    }
    return code;
}

int output_indexes_close(struct output_indexes **indexes, struct cloth_error *error)
{
    struct output_indexes *gone = *indexes;
    int code = CLOTH_OK;
    *indexes = NULL;
    for (int i = 0; gone && i < OUTPUT_INDEXES; i++) {
        const int failed = index_close(gone->of + i, error);
        code = code ? code : failed;
    }
    free(gone);
    return code;
}

/* Another file than an index of ours stays: nobody asked for it to go. */
int output_hdf5_forget(const char *folder, const uint64_t *n_frames, struct cloth_error *error)
{
    struct output_indexes *indexes;
    int code = indexes_make(&indexes, folder, error);
    bool ours = !code;
    for (int i = 0; i < OUTPUT_INDEXES && ours; i++)
        ours = is_ours(indexes->of + i);
    if (ours)
        code = n_frames ? indexes_open(indexes, n_frames, error) : clear(indexes, NULL, error);
    const int closed = output_indexes_close(&indexes, error);
    return code ? code : closed;
}
