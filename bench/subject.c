/* A subject is one child process (mpirun, if it has ranks) and one connection to each rank. Its
 * ranks are stopped (SIGSTOP) except while they answer: spinning workers of one runtime must not
 * take the cores from the next. They die with the bench. */
#include "bench/subject.h"

#include "bench/program.h"

#include <errno.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

/* An answer may take the exact solution of a million vertices, on a machine that others use. */
enum { MOST_RANKS = 64, START_SECONDS = 60, ANSWER_SECONDS = 4 * 3600, END_SECONDS = 20 };

struct rank {
    FILE *answers;
    int commands; /* the same socket */
    pid_t pid;
};

struct subject {
    const struct program *program;
    pid_t child;
    unsigned cores;
    unsigned n; /* connected, of as many as there should be */
    struct rank rank[MOST_RANKS];
    char settings[400];
};

bool subject_same(struct subject_shape a, struct subject_shape b)
{
    return !strcmp(a.kind, b.kind) && a.ranks == b.ranks && a.threads == b.threads;
}

const char *subject_missing(const char *kind)
{
    return program_missing(program_find(kind));
}

const char *subject_other(const char *kind)
{
    const struct program *program = program_find(kind);
    return program ? program->other : NULL;
}

const char *subject_settings(const struct subject *subject)
{
    return subject->settings;
}

unsigned subject_cores(void)
{
    cpu_set_t set;
    return sched_getaffinity(0, sizeof set, &set) ? 1 : (unsigned)CPU_COUNT(&set);
}

static int complain(const char *kind, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

static int complain(const char *kind, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    fprintf(stderr, "duite-bench: %s: ", kind);
    vfprintf(stderr, format, list);
    fputc('\n', stderr);
    va_end(list);
    return 1;
}

/* ---- Start ---- */

/* In the child: becomes the program. Its output goes where errors go. */
static void become(const struct subject *subject, struct subject_shape shape, const char *socket)
{
    char number[16];
    const char *argv[16];
    program_environment(subject->program, subject->cores);
    setenv("DUITE_BENCH_SOCKET", socket, 1);
    setenv("DUITE_BENCH_KIND", shape.kind, 1);
    signal(SIGPIPE, SIG_DFL);
    prctl(PR_SET_PDEATHSIG, shape.ranks ? SIGTERM : SIGKILL);
    snprintf(number, sizeof number, "%u", shape.ranks);
    program_command(subject->program, shape.ranks ? number : NULL, argv);
    if (!freopen("/dev/null", "r", stdin) || dup2(STDERR_FILENO, STDOUT_FILENO) < 0)
        _exit(127);
    execvp(argv[0], (char *const *)argv);
    fprintf(stderr, "duite-bench: %s does not start: %s\n", argv[0], strerror(errno));
    _exit(127);
}

static int listen_at(const char *path)
{
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    if (strlen(path) >= sizeof address.sun_path)
        return -1;
    memcpy(address.sun_path, path, strlen(path) + 1);
    int door = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (door >= 0 && !bind(door, (struct sockaddr *)&address, sizeof address) &&
        !listen(door, MOST_RANKS))
        return door;
    if (door >= 0)
        close(door);
    return -1;
}

/* A line that must come within so many seconds. */
static bool receive(FILE *answers, int seconds, char *line, size_t size)
{
    struct pollfd ready = {.fd = fileno(answers), .events = POLLIN};
    if (poll(&ready, 1, 1000 * seconds) != 1 || !fgets(line, (int)size, answers))
        return false;
    line[strcspn(line, "\n")] = '\0';
    return true;
}

/* Keeps its own description of itself, and its settings. */
static void note_settings(struct subject *subject, const char *text)
{
    size_t used = (size_t)snprintf(subject->settings, sizeof subject->settings, "%s", text);
    const char *const *word = program_settings(subject->program, subject->cores);
    for (; *word && used < sizeof subject->settings; word++) {
        const char *name = *word;
        char own[64];
        snprintf(own, sizeof own, "%.*s", (int)strcspn(name, "="), name);
        const char *users = getenv(own);
        used +=
            (size_t)snprintf(subject->settings + used, sizeof subject->settings - used, ", %s%s%s",
                             users ? own : name, users ? "=" : "", users ? users : "");
    }
}

/* The next rank that connects says who it is. */
static bool welcome(struct subject *subject, int door)
{
    char line[500];
    int rank, settings = 0;
    struct ucred peer; /* a process of another namespace is not called here what it calls itself */
    socklen_t size = sizeof peer;
    int socket = accept4(door, NULL, NULL, SOCK_CLOEXEC);
    FILE *answers = socket < 0 ? NULL : fdopen(socket, "r");
    if (!answers)
        return false;
    if (!receive(answers, START_SECONDS, line, sizeof line) ||
        sscanf(line, "hello %d %n", &rank, &settings) < 1 ||
        getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &peer, &size) || peer.pid <= 0) {
        fclose(answers);
        return false;
    }
    subject->rank[subject->n++] = (struct rank){answers, socket, peer.pid};
    if (rank == 0)
        note_settings(subject, line + settings);
    kill(peer.pid, SIGSTOP);
    return true;
}

static int wait_for_ranks(struct subject *subject, int door, unsigned n)
{
    struct pollfd ready = {.fd = door, .events = POLLIN};
    for (int quiet = 0; subject->n < n && quiet < 20 * START_SECONDS; quiet++) {
        int came = poll(&ready, 1, 50);
        if (came > 0 && !welcome(subject, door))
            return complain(subject->program->kind, "a rank did not say hello");
        if (came == 0 && waitpid(subject->child, NULL, WNOHANG) == subject->child) {
            subject->child = 0;
            return complain(subject->program->kind, "ended before it was asked anything");
        }
    }
    return subject->n == n ? 0
                           : complain(subject->program->kind, "%u of %u ranks came", subject->n, n);
}

static int start(struct subject *subject, struct subject_shape shape, const char *socket)
{
    int door = listen_at(socket);
    if (door < 0)
        return complain(shape.kind, "no socket at %s: %s", socket, strerror(errno));
    fflush(NULL);
    subject->child = fork();
    if (subject->child == 0)
        become(subject, shape, socket);
    int code = subject->child < 0 ? complain(shape.kind, "no process: %s", strerror(errno))
                                  : wait_for_ranks(subject, door, shape.ranks ? shape.ranks : 1);
    close(door);
    unlink(socket);
    return code;
}

struct subject *subject_start(struct subject_shape shape)
{
    char folder[80], socket[100];
    const char *temporary = getenv("TMPDIR");
    if (!temporary || strlen(temporary) > 50)
        temporary = "/tmp";
    snprintf(folder, sizeof folder, "%s/duite-bench.XXXXXX", temporary);
    struct subject *subject = calloc(1, sizeof *subject);
    if (!subject || shape.ranks > MOST_RANKS || !mkdtemp(folder)) {
        complain(shape.kind, "cannot be started on %u ranks with its socket in %s", shape.ranks,
                 folder);
        free(subject);
        return NULL;
    }
    snprintf(socket, sizeof socket, "%s/socket", folder);
    subject->program = program_find(shape.kind);
    subject->cores = shape.threads * (shape.ranks ? shape.ranks : 1);
    int code = start(subject, shape, socket);
    rmdir(folder);
    if (!code)
        return subject;
    subject_stop(subject);
    return NULL;
}

/* ---- Asking ---- */

static void signal_all(const struct subject *subject, int signal)
{
    for (unsigned i = 0; i < subject->n; i++)
        kill(subject->rank[i].pid, signal);
}

/* One rank's answer: 0 and a number, or 1 and a sentence. */
static int answer(struct rank *rank, double *value, char *why, size_t size)
{
    char line[500];
    if (!receive(rank->answers, ANSWER_SECONDS, line, sizeof line)) {
        snprintf(why, size, "no answer: it ended, or took longer than %d s", ANSWER_SECONDS);
        return 1;
    }
    if (sscanf(line, "ok %lf", value) == 1)
        return 0;
    snprintf(why, size, "%s", !strncmp(line, "failed ", 7) ? line + 7 : line);
    return 1;
}

int subject_ask(struct subject *subject, const char *command, double *value, char *why, size_t size)
{
    int code = 0;
    *value = 0;
    signal_all(subject, SIGCONT);
    for (unsigned i = 0; i < subject->n; i++)
        dprintf(subject->rank[i].commands, "%s\n", command);
    for (unsigned i = 0; i < subject->n && !code; i++) {
        double one = 0;
        code = answer(&subject->rank[i], &one, why, size);
        if (!code && one > *value)
            *value = one;
    }
    signal_all(subject, SIGSTOP);
    return code;
}

/* ---- End ---- */

/* True if the child ended within so many seconds; *status is not 0 if it did not end well. */
static bool ended(struct subject *subject, int seconds, int *status)
{
    for (int i = 0; i < 100 * seconds && subject->child > 0; i++) {
        if (waitpid(subject->child, status, WNOHANG) == subject->child)
            subject->child = 0;
        else
            usleep(10000);
    }
    return subject->child <= 0;
}

int subject_stop(struct subject *subject)
{
    int status = 0;
    if (!subject)
        return 0;
    signal_all(subject, SIGCONT);
    for (unsigned i = 0; i < subject->n; i++)
        fclose(subject->rank[i].answers);
    if (!ended(subject, END_SECONDS, &status)) {
        kill(subject->child, SIGTERM);
        if (!ended(subject, END_SECONDS, &status)) {
            signal_all(subject, SIGKILL);
            kill(subject->child, SIGKILL);
            ended(subject, END_SECONDS, &status);
        }
    }
    if (status)
        complain(subject->program->kind, "did not end well (%s %d)",
                 WIFSIGNALED(status) ? "signal" : "status",
                 WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status));
    free(subject);
    return status != 0;
}
