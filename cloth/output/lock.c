/* A lock is a file that its run alone made: O_EXCL holds on network file systems, too, where locks
 * of files often fail. Only the process that made the file *.take may judge a lock to be stale and
 * replace it. A lock that is not empty names its host and process, and, where the system says it,
 * when that began: a later process may have the same number. */
#include "cloth/output/files/files.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct output_lock {
    char *path, *take; /* the lock, and the file that lets its maker replace it */
    size_t number;     /* of `held` */
};

struct holder {
    char host[HOST_NAME_MAX + 1];
    long process;             /* 0: the lock names none */
    unsigned long long start; /* in ticks of the kernel since it began; 0: not known */
};

enum { MAX = 4, TEXT = HOST_NAME_MAX + 128 };
static char *_Atomic held[MAX]; /* paths of the locks of this process, for the signal handler */

/* ---- Signals ---- */

void output_locks_remove(void)
{
    for (int i = 0; i < MAX; i++) {
        const char *path = held[i];
        if (path)
            unlink(path);
    }
}

/* Ends the process as the signal would have without a handler. */
static void end_by(int number)
{
    output_locks_remove();
    signal(number, SIG_DFL);
    raise(number);
}

/* A signal that is ignored, as by nohup, stays so. */
static void catch_ends(void)
{
    static const int numbers[] = {SIGTERM, SIGINT, SIGHUP};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        struct sigaction before, action = {.sa_handler = end_by, .sa_flags = SA_RESTART};
        sigemptyset(&action.sa_mask);
        if (sigaction(numbers[i], NULL, &before) == 0 && before.sa_handler == SIG_DFL)
            sigaction(numbers[i], &action, NULL);
    }
}

/* ---- Owner of a lock ---- */

/* Fields of /proc/PID/stat (man 5 proc). */
struct process {
    char state;
    long threads;
    unsigned long long start;
};

/* Returns false where the system does not say. The name, in parentheses, may have any bytes. */
static bool read_process(long number, struct process *process)
{
    char path[64], text[1024] = "";
    snprintf(path, sizeof path, "/proc/%ld/stat", number);
    FILE *file = fopen(path, "re");
    if (!file)
        return false;
    const size_t n = fread(text, 1, sizeof text - 1, file);
    fclose(file);
    const char *after = n ? strrchr(text, ')') : NULL;
    return after && sscanf(after,
                           ") %c %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s "
                           "%ld %*s %llu",
                           &process->state, &process->threads, &process->start) == 3;
}

static struct holder this_process(void)
{
    struct process process;
    struct holder self = {.process = (long)getpid()};
    if (read_process(self.process, &process))
        self.start = process.start;
    if (gethostname(self.host, sizeof self.host - 1) != 0)
        strcpy(self.host, "unknown");
    return self;
}

/* Returns false where there is no lock. */
static bool read_holder(const char *path, struct holder *holder)
{
    char text[TEXT] = "", format[64];
    *holder = (struct holder){.process = 0};
    const int file = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (file < 0)
        return errno != ENOENT;
    const ssize_t n = read(file, text, sizeof text - 1);
    close(file);
    snprintf(format, sizeof format, "host %%%ds process %%ld", HOST_NAME_MAX);
    if (n <= 0 || sscanf(text, format, holder->host, &holder->process) != 2 || holder->process <= 0)
        holder->process = 0;
    const char *start = strstr(text, "\nstart ");
    if (start)
        holder->start = strtoull(start + strlen("\nstart "), NULL, 10);
    return true;
}

static bool is_same(const struct holder *a, const struct holder *b)
{
    return a->process == b->process && !strcmp(a->host, b->host);
}

/* False for an earlier process with the same number. */
static bool lock_is_ours(const struct holder *holder)
{
    const struct holder self = this_process();
    bool holds = false;
    for (int i = 0; i < MAX; i++)
        holds = holds || held[i];
    return holds && is_same(holder, &self);
}

/* A process that ended keeps its number until its parent waits for it. */
static bool runs(const struct holder *holder)
{
    struct process process;
    if (kill((pid_t)holder->process, 0) != 0 && errno == ESRCH)
        return false;
    if (!read_process(holder->process, &process))
        return true;
    const bool over = (process.state == 'Z' || process.state == 'X') && process.threads <= 1;
    return !over && (!holder->start || holder->start == process.start);
}

static bool is_stale(const struct holder *holder)
{
    const struct holder self = this_process();
    if (!holder->process || strcmp(holder->host, self.host) != 0)
        return false;
    return is_same(holder, &self) || !runs(holder);
}

/* ---- Taking one ---- */

static int write_lock(const char *path)
{
    char text[TEXT];
    const struct holder self = this_process();
    const int file = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0)
        return -1;
    int n = snprintf(text, sizeof text, "host %s\nprocess %ld\n", self.host, self.process);
    if (self.start)
        n += snprintf(text + n, sizeof text - (size_t)n, "start %llu\n", self.start);
    int bad = output_write_at(file, text, (size_t)n, 0) != 0 || output_sync(file) != 0;
    int reason = errno;
    if (close(file) != 0 && !bad) {
        bad = 1;
        reason = errno;
    }
    if (!bad)
        return 0;
    unlink(path);
    errno = reason == EEXIST ? EIO : reason;
    return -1;
}

static int lock_refuse(const char *folder, const char *path, const struct holder *holder,
                       struct cloth_error *error)
{
    if (!holder->process)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%s: another run writes into this folder, or died as it began to: %s "
                          "names no process; give another folder, or, if no run uses this one, "
                          "remove that file",
                          folder, path);
    return cloth_fail(error, CLOTH_E_INPUT,
                      "%s: another run writes into this folder, process %ld on host %s; give "
                      "another folder, or wait for the end of that run; if it has died, remove %s",
                      folder, holder->process, holder->host, path);
}

/* While `take` is ours no other process replaces the lock. */
static int replace(const struct output_lock *lock, const char *folder, struct cloth_error *note,
                   struct cloth_error *error)
{
    struct holder holder;
    if (read_holder(lock->path, &holder)) {
        if (!is_stale(&holder))
            return lock_refuse(folder, lock->path, &holder, error);
        cloth_fail(note, CLOTH_E_IO,
                   "%s: process %ld of this host left %s and runs no more; this run has the "
                   "folder now",
                   folder, holder.process, lock->path);
        if (unlink(lock->path) != 0)
            return output_refuse(error, "remove", lock->path);
    }
    if (write_lock(lock->path) == 0)
        return CLOTH_OK;
    if (errno != EEXIST)
        return output_refuse(error, "write", lock->path);
    read_holder(lock->path, &holder);
    return lock_refuse(folder, lock->path, &holder, error);
}

static int lock_take(const struct output_lock *lock, const char *folder, struct cloth_error *note,
                     struct cloth_error *error)
{
    struct holder holder;
    if (write_lock(lock->path) == 0)
        return CLOTH_OK;
    if (errno != EEXIST)
        return output_refuse(error, "write", lock->path);
    const bool locked = read_holder(lock->path, &holder);
    if (locked && lock_is_ours(&holder))
        return CLOTH_OK;
    if (locked && !is_stale(&holder))
        return lock_refuse(folder, lock->path, &holder, error);
    if (write_lock(lock->take) != 0) {
        if (errno != EEXIST)
            return output_refuse(error, "write", lock->take);
        read_holder(lock->take, &holder);
        return lock_refuse(folder, lock->take, &holder, error);
    }
    const int code = replace(lock, folder, note, error);
    unlink(lock->take);
    return code;
}

/* ---- For the run ---- */

static int lock_make(struct output_lock *lock, const char *folder, struct cloth_error *error)
{
    lock->path = output_path(folder, "duite.lock", "");
    lock->take = output_path(folder, "duite.lock", ".take");
    if (lock->path && lock->take)
        return output_make_folder(folder, error);
    return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the lock of %s", folder);
}

static void free_lock(struct output_lock *lock)
{
    free(lock->path);
    free(lock->take);
    free(lock);
}

/* A signal leaves a lock that is not noted, as SIGKILL does. */
static void note_held(struct output_lock *lock)
{
    for (lock->number = 0; lock->number < MAX && held[lock->number];)
        lock->number++;
    if (lock->number < MAX)
        held[lock->number] = lock->path;
}

int output_lock_take(struct output_lock **lock, const char *folder, struct cloth_error *note,
                     struct cloth_error *error)
{
    *lock = NULL;
    struct output_lock *made = calloc(1, sizeof *made);
    if (!made)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the lock of %s", folder);
    catch_ends();
    int code = lock_make(made, folder, error);
    code = code ? code : lock_take(made, folder, note, error);
    if (code) {
        free_lock(made);
        return code;
    }
    note_held(made);
    *lock = made;
    return CLOTH_OK;
}

void output_lock_free(struct output_lock **lock)
{
    struct output_lock *gone = *lock;
    struct holder holder;
    const struct holder self = this_process();
    *lock = NULL;
    if (!gone)
        return;
    if (gone->number < MAX)
        held[gone->number] = NULL;
    if (read_holder(gone->path, &holder) && is_same(&holder, &self))
        unlink(gone->path); /* else somebody removed it, and another run may have the folder */
    free_lock(gone);
}
