/* A file named *.checkpoint is whole, unless the disk lost some of it, which its hash shows. The
 * next checkpoint renames the oldest file and writes over it: it takes no new blocks of the disk,
 * and its bytes get there without an entry in the file system's journal. */
#include "cloth/output/checkpoint.h"

#include "cloth/base/file.h"
#include "cloth/output/files/files.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

static const char MAGIC[8] = "duiteCP", FOLDER[] = "checkpoints";
enum { VERSION = 1, NAME = 64 };
static const uint64_t LAST = UINT64_MAX / 2; /* no run comes from there to the end of numbers */
static const uint64_t ORDER = 0x0102030405060708; /* of bytes */
enum { FOUND = OUTPUT_CHECKPOINTS_KEPT + 2 }; /* the newest; one more of a run that was killed */

struct header {
    char magic[8];
    uint64_t order, version, size; /* size: bytes of the file */
    uint64_t part[OUTPUT_CHECKPOINT_PARTS];
};

struct output_checkpoints {
    struct output_path folder, last; /* last: the path of the newest; empty: none was written */
    uint64_t next;                   /* the number of the next one */
    uint64_t kept[FOUND];            /* numbers, the newest first; 0: none */
};

static size_t padded(size_t n)
{
    return (n + 7) / 8 * 8;
}

/* ---- Names ---- */

#define CHECKPOINT_NAME "%06ju.checkpoint%s" /* the number, and what is behind the name */

/* The number of a file, or 0: no checkpoint has that name, with this behind it. */
static uint64_t checkpoint_number_of(const char *name, const char *behind)
{
    char own[NAME];
    const uint64_t number = strtoull(name, NULL, 10);
    snprintf(own, sizeof own, CHECKPOINT_NAME, (uintmax_t)number, behind);
    return strcmp(name, own) == 0 ? number : 0;
}

static struct output_path checkpoint_path(const char *folder, uint64_t number, const char *behind)
{
    return output_path(folder, CHECKPOINT_NAME, (uintmax_t)number, behind);
}

/* Puts a number among the largest, which descend. */
static void insert(uint64_t *kept, size_t n, uint64_t number)
{
    for (size_t i = 0; i < n; i++)
        if (number > kept[i]) {
            const uint64_t was = kept[i];
            kept[i] = number;
            number = was;
        }
}

/* Finds the n largest numbers. half, all: removes half checkpoints, or whole ones, on the way. */
static int scan(const char *folder, bool half, bool all, size_t n, uint64_t *kept)
{
    DIR *handle = opendir(folder);
    int failed = 0;
    memset(kept, 0, n * sizeof *kept);
    if (!handle)
        return errno == ENOENT ? 0 : -1;
    for (const struct dirent *entry; (entry = readdir(handle));) {
        const uint64_t number = checkpoint_number_of(entry->d_name, "");
        const bool is_half = checkpoint_number_of(entry->d_name, ".part") > 0;
        if ((half && is_half) || (all && number))
            failed = unlinkat(dirfd(handle), entry->d_name, 0) != 0 || failed;
        else if (number)
            insert(kept, n, number);
    }
    const int reason = errno;
    closedir(handle);
    errno = reason;
    return failed ? -1 : 0;
}

/* ---- Writing ---- */

int output_checkpoints_open(struct output_checkpoints **checkpoints, const char *folder,
                            struct cloth_error *error)
{
    struct output_checkpoints *made = *checkpoints = calloc(1, sizeof *made);
    if (!made)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for checkpoints");
    made->folder = output_path(folder, FOLDER);
    const char *path = made->folder.text;
    int code = output_make_folder(path, error);
    if (!code && access(path, W_OK | X_OK) != 0)
        code = output_refuse(error, "write checkpoints into", path);
    if (!code && scan(path, true, false, FOUND, made->kept) != 0)
        code = output_refuse(error, "remove half a checkpoint in", path);
    if (!code && made->kept[0] > LAST)
        code = cloth_fail(error, CLOTH_E_INPUT,
                          "%s/%ju.checkpoint: no number is left for a checkpoint after it; move it "
                          "away",
                          path, (uintmax_t)made->kept[0]);
    made->next = made->kept[0] + 1;
    if (code)
        output_checkpoints_close(checkpoints);
    return code;
}

/* The bytes that go to the file, and their hash so far. */
struct writing {
    int file;
    uint64_t at;
    XXH64_state_t *hash;
};

static int write_bytes(struct writing *to, const void *bytes, size_t n)
{
    static const char nothing[8];
    const size_t rest = padded(n) - n;
    if (n)
        XXH64_update(to->hash, bytes, n);
    XXH64_update(to->hash, nothing, rest);
    if (output_write_at(to->file, bytes, n, to->at) != 0 ||
        output_write_at(to->file, nothing, rest, to->at + n) != 0)
        return -1;
    to->at += n + rest;
    return 0;
}

static int write_all(struct writing *to, const struct output_part part[OUTPUT_CHECKPOINT_PARTS])
{
    struct header header = {.order = ORDER, .version = VERSION};
    memcpy(header.magic, MAGIC, sizeof header.magic);
    header.size = sizeof header + sizeof(uint64_t);
    for (int i = 0; i < OUTPUT_CHECKPOINT_PARTS; i++) {
        header.part[i] = part[i].n;
        header.size += padded(part[i].n);
    }
    int bad = write_bytes(to, &header, sizeof header);
    for (int i = 0; i < OUTPUT_CHECKPOINT_PARTS && !bad; i++)
        bad = write_bytes(to, part[i].bytes, part[i].n);
    const uint64_t digest = XXH64_digest(to->hash);
    return bad || output_write_at(to->file, &digest, sizeof digest, to->at) != 0 ||
           ftruncate(to->file, (off_t)header.size) != 0 || output_sync(to->file) != 0;
}

/* The file beside its name. Returns 0, or -1 with errno set. */
static int checkpoint_write_file(const char *path,
                                 const struct output_part part[OUTPUT_CHECKPOINT_PARTS])
{
    struct writing to = {.hash = XXH64_createState()};
    if (!to.hash) {
        errno = ENOMEM;
        return -1;
    }
    XXH64_reset(to.hash, 0);
    to.file = output_open_file(path, O_WRONLY | O_CREAT);
    int bad = to.file < 0 || write_all(&to, part), reason = errno;
    if (to.file >= 0 && close(to.file) != 0 && !bad) {
        bad = 1;
        reason = errno;
    }
    XXH64_freeState(to.hash);
    if (bad)
        unlink(path);
    errno = reason;
    return bad ? -1 : 0;
}

/* The next checkpoint takes the room of this one, unless the file has another name, too. A file
 * that cannot be removed stays. */
static void checkpoint_pass_on(const struct output_checkpoints *checkpoints, uint64_t number)
{
    struct stat status;
    const char *folder = checkpoints->folder.text;
    const struct output_path gone = checkpoint_path(folder, number, "");
    const struct output_path next = checkpoint_path(folder, checkpoints->next, ".part");
    if (lstat(gone.text, &status) == 0 &&
        !(S_ISREG(status.st_mode) && status.st_nlink == 1 && rename(gone.text, next.text) == 0))
        unlink(gone.text);
}

/* The newest is complete: older ones go, the oldest first. */
static void checkpoint_keep(struct output_checkpoints *checkpoints)
{
    uint64_t *kept = checkpoints->kept;
    insert(kept, FOUND, checkpoints->next++);
    for (int i = FOUND - 1; i >= OUTPUT_CHECKPOINTS_KEPT; i--) {
        if (kept[i])
            checkpoint_pass_on(checkpoints, kept[i]);
        kept[i] = 0;
    }
}

int output_checkpoints_write(struct output_checkpoints *checkpoints,
                             const struct output_part part[OUTPUT_CHECKPOINT_PARTS],
                             struct cloth_error *error)
{
    const char *folder = checkpoints->folder.text;
    const struct output_path path = checkpoint_path(folder, checkpoints->next, "");
    const struct output_path fresh = checkpoint_path(folder, checkpoints->next, ".part");
    if (checkpoint_write_file(fresh.text, part) != 0 || rename(fresh.text, path.text) != 0)
        return output_fail(error, "write the checkpoint", path.text);
    output_sync_folder(folder);
    checkpoint_keep(checkpoints);
    checkpoints->last = path;
    return CLOTH_OK;
}

const char *output_checkpoints_last(const struct output_checkpoints *checkpoints)
{
    return *checkpoints->last.text ? checkpoints->last.text : NULL;
}

void output_checkpoints_close(struct output_checkpoints **checkpoints)
{
    struct output_checkpoints *gone = *checkpoints;
    *checkpoints = NULL;
    if (gone)
        unlink(checkpoint_path(gone->folder.text, gone->next, ".part").text);
    free(gone);
}

int output_checkpoints_forget(const char *folder, struct cloth_error *error)
{
    uint64_t none[1];
    const struct output_path path = output_path(folder, FOLDER);
    if (scan(path.text, true, true, 1, none) != 0)
        return output_refuse(error, "remove the checkpoints of an earlier run in", path.text);
    rmdir(path.text); /* unless somebody else has files there */
    return CLOTH_OK;
}

/* ---- Reading ---- */

static int damaged(struct cloth_error *error, const char *path, const char *how)
{
    return cloth_fail(error, CLOTH_E_IO, "%s is damaged: %s", path, how);
}

static int checkpoint_check(const char *path, const unsigned char *bytes, size_t n,
                            struct cloth_error *error)
{
    struct header header;
    uint64_t digest, size = sizeof header + sizeof digest;
    if (n < sizeof header || memcmp(bytes, MAGIC, sizeof MAGIC) != 0)
        return cloth_fail(error, CLOTH_E_IO, "%s is no checkpoint of duite-cloth", path);
    memcpy(&header, bytes, sizeof header);
    if (header.order != ORDER || header.version != VERSION)
        return cloth_fail(
            error, CLOTH_E_INPUT,
            "%s is a checkpoint of another version of duite-cloth, or of another kind "
            "of processor: go on with the one that wrote it",
            path);
    for (int i = 0; i < OUTPUT_CHECKPOINT_PARTS; i++) {
        if (header.part[i] > n)
            return damaged(error, path, "a part of it is larger than the file");
        size += padded(header.part[i]);
    }
    if (header.size != n || size != n)
        return damaged(error, path, n < header.size ? "it is cut off" : "it has another length");
    memcpy(&digest, bytes + n - sizeof digest, sizeof digest);
    return XXH64(bytes, n - sizeof digest, 0) == digest
               ? CLOTH_OK
               : damaged(error, path, "its hash is another one");
}

int output_checkpoint_read(struct output_checkpoint *checkpoint, const char *path,
                           struct cloth_error *error)
{
    struct header header;
    size_t n = 0, at = sizeof header;
    *checkpoint = (struct output_checkpoint){.path = strdup(path)};
    if (!checkpoint->path)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the path of a checkpoint");
    checkpoint->bytes = output_read_file(path, &n);
    const int code = checkpoint->bytes
                         ? checkpoint_check(path, checkpoint->bytes, n, error)
                         : cloth_fail(error, errno == ENOMEM ? CLOTH_E_MEMORY : CLOTH_E_IO,
                                      "cannot read %s: %s", path, cloth_file_why());
    if (code) {
        output_checkpoint_free(checkpoint);
        return code;
    }
    memcpy(&header, checkpoint->bytes, sizeof header);
    for (int i = 0; i < OUTPUT_CHECKPOINT_PARTS; i++) {
        checkpoint->part[i] = (struct output_part){checkpoint->bytes + at, header.part[i]};
        at += padded(header.part[i]);
    }
    return CLOTH_OK;
}

int output_checkpoint_newest(struct output_checkpoint *checkpoint, const char *folder,
                             struct cloth_error *note, struct cloth_error *error)
{
    enum { TRIED = 64 };
    uint64_t number[TRIED];
    const struct output_path within = output_path(folder, FOLDER);
    const char *path = within.text;
    if (scan(path, false, false, TRIED, number) != 0)
        return output_refuse(error, "read", path);
    if (!number[0])
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%s holds no checkpoint: a run writes them with --checkpoint SECONDS",
                          path);
    for (int i = 0; i < TRIED && number[i]; i++) {
        struct cloth_error why = {0};
        const int code =
            output_checkpoint_read(checkpoint, checkpoint_path(path, number[i], "").text, &why);
        if (code && code != CLOTH_E_IO)
            *error = why;
        if (code != CLOTH_E_IO)
            return code;
        if (!note->code)
            *note = why;
    }
    return cloth_fail(error, CLOTH_E_INPUT, "%s holds no checkpoint that is whole: %s", path,
                      note->text);
}

void output_checkpoint_free(struct output_checkpoint *checkpoint)
{
    free(checkpoint->path);
    free(checkpoint->bytes);
    *checkpoint = (struct output_checkpoint){0};
}
