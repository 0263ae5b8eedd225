/* A lock is a file that its run alone made: O_EXCL holds on network file systems, too, where locks
 * of files often fail. Only the process that made the file *.take may judge a lock to be stale and
 * replace it. A lock that is not empty names its host and process, and, where the system says it,
 * when that began: a later process may have the same number. */
#include "cloth/output/files/files.h"
#include "cloth/output/output.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct output_lock {
    struct output_path path;
    atomic_bool is_held;
};

enum { LOCKS = 4, TEXT = HOST_NAME_MAX + 128 };
static struct output_lock locks[LOCKS]; /* of this process, for the signal handler */

struct holder {
    char host[HOST_NAME_MAX + 1];
    long process;             /* 0: the lock names none */
    unsigned long long start; /* in ticks of the kernel since it began; 0: not known */
};

/* ---- Signals ---- */

void output_locks_remove(void)
{
    for (int i = 0; i < LOCKS; i++)
        if (locks[i].is_held)
            unlink(locks[i].path.text);
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
    for (int i = 0; i < LOCKS; i++)
        holds = holds || locks[i].is_held;
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

/* Says whose the lock at a path is. */
static int lock_refuse(const char *folder, const char *path, struct cloth_error *error)
{
    struct holder holder;
    read_holder(path, &holder);
    if (!holder.process)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%s: another run writes into this folder, or died as it began to: %s "
                          "names no process; give another folder, or, if no run uses this one, "
                          "remove that file",
                          folder, path);
    return cloth_fail(error, CLOTH_E_INPUT,
                      "%s: another run writes into this folder, process %ld on host %s; give "
                      "another folder, or wait for the end of that run; if it has died, remove %s",
                      folder, holder.process, holder.host, path);
}

/* Where no other file may be. */
static int write_first(const char *folder, const char *path, struct cloth_error *error)
{
    if (write_lock(path) == 0)
        return CLOTH_OK;
    return errno == EEXIST ? lock_refuse(folder, path, error) : output_refuse(error, "write", path);
}

/* While `take` is ours no other process replaces the lock. */
static int replace(const char *path, const char *folder, struct cloth_error *note,
                   struct cloth_error *error)
{
    struct holder holder;
    if (read_holder(path, &holder)) {
        if (!is_stale(&holder))
            return lock_refuse(folder, path, error);
        cloth_fail(note, CLOTH_E_IO,
                   "%s: process %ld of this host left %s and runs no more; this run has the "
                   "folder now",
                   folder, holder.process, path);
        if (unlink(path) != 0)
            return output_refuse(error, "remove", path);
    }
    return write_first(folder, path, error);
}

static int lock_take(const char *path, const char *folder, struct cloth_error *note,
                     struct cloth_error *error)
{
    struct holder holder;
    const struct output_path take = output_path(folder, "duite.lock.take");
    if (write_lock(path) == 0)
        return CLOTH_OK;
    if (errno != EEXIST)
        return output_refuse(error, "write", path);
    const bool locked = read_holder(path, &holder);
    if (locked && lock_is_ours(&holder))
        return CLOTH_OK;
    if (locked && !is_stale(&holder))
        return lock_refuse(folder, path, error);
    if (write_first(folder, take.text, error))
        return error->code;
    const int code = replace(path, folder, note, error);
    unlink(take.text);
    return code;
}

/* ---- For the run ---- */

int output_lock_take(struct output_lock **lock, const char *folder, struct cloth_error *note,
                     struct cloth_error *error)
{
    struct output_lock *made = locks;
    *lock = NULL;
    while (made < locks + LOCKS && made->is_held)
        made++;
    if (made == locks + LOCKS)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the lock of %s", folder);
    made->path = output_path(folder, "duite.lock");
    catch_ends();
    int code = output_make_folder(folder, error);
    code = code ? code : lock_take(made->path.text, folder, note, error);
    if (code)
        return code;
    made->is_held = true;
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
    gone->is_held = false;
    if (read_holder(gone->path.text, &holder) && is_same(&holder, &self))
        unlink(gone->path.text); /* else somebody removed it, and another run may have the folder */
}
