/* The message of the last failed call, one a thread: written by the failing call, read by
 * duite_message(). */
#include "runtime/base/error.h"

#include "runtime/base/clock.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

static _Thread_local char message[1024];

/* A message that is too long, say by a path, loses its middle; the reason is at its end. */
static void message_cut_middle(const char *whole)
{
    enum { HEAD = sizeof message / 4, GAP = 6, TAIL = sizeof message - HEAD - GAP };
    snprintf(message, sizeof message, "%.*s ... %s", (int)HEAD, whole,
             whole + strlen(whole) - TAIL);
}

/* The arguments may point into the previous message, so the new one is written elsewhere first. */
int base_error(int code, const char *format, ...)
{
    char *whole = NULL;
    va_list list;
    va_start(list, format);
    if (vasprintf(&whole, format, list) < 0)
        snprintf(message, sizeof message, "out of memory for the message of an error");
    else if (strlen(whole) < sizeof message)
        memcpy(message, whole, strlen(whole) + 1);
    else
        message_cut_middle(whole);
    free(whole);
    va_end(list);
    return code;
}

int base_no_memory(const char *what)
{
    return base_error(DUITE_E_MEMORY, "out of memory for %s", what);
}

const char *duite_message(void)
{
    return message;
}

static const char *const TEXTS[] = {
    [DUITE_OK] = "success",
    [-DUITE_E_ARGUMENT] = "bad argument",
    [-DUITE_E_MEMORY] = "out of memory",
    [-DUITE_E_OBJECT] = "no such object",
    [-DUITE_E_KERNEL] = "bad kernel",
    [-DUITE_E_ACCESS] = "accesses do not fit the kernel",
    [-DUITE_E_MPI] = "MPI failed",
    [-DUITE_E_DIFFERENT] = "ranks run different programs",
    [-DUITE_E_STATE] = "call not allowed here",
    [-DUITE_E_NOT_FREED] = "objects or graphs were not freed",
    [-DUITE_E_CHECK] = "a body does not keep to what its kernel declares",
    [-DUITE_E_SYSTEM] = "the operating system refused",
    [-DUITE_E_RIGHT] = "a right the task does not hold",
    [-DUITE_E_LAW] = "law does not fit",
    [-DUITE_E_SIZE] = "size out of bounds",
    [-DUITE_E_LOST] = "a rank is lost",
    [-DUITE_E_DEPTH] = "bodies that wait are nested too deeply for the stack",
    [-DUITE_E_BINDING] = "an object does not fit the one it is bound to",
};

const char *duite_code_text(int code)
{
    if (code > 0)
        return "error of the program";
    const size_t i = -(size_t)code;
    return i < sizeof TEXTS / sizeof *TEXTS && TEXTS[i] ? TEXTS[i] : "unknown code";
}

/* ---- Reports ---- */

/* Standard error may be a pipe that nobody reads: a write to it would block, and with it the
 * monitor and its heartbeats. So a pipe or terminal is opened once more, non-blocking; the flag
 * holds for this opening alone, not for other programs that write there. */
#define REPORT_SECONDS 0.05 /* the longest wait of a report for room */

/* A descriptor of standard error that does not block; -1: there is none. */
static int report_open(const struct stat *file)
{
    if (!S_ISFIFO(file->st_mode) && !S_ISCHR(file->st_mode))
        return -1;
    return open("/proc/self/fd/2", O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
}

/* As write. Files do not block; without a descriptor of its own it may block. */
static ssize_t report_write(int own, bool socket, const char *text, size_t length)
{
    if (socket)
        return send(STDERR_FILENO, text, length, MSG_DONTWAIT | MSG_NOSIGNAL);
    return write(own < 0 ? STDERR_FILENO : own, text, length);
}

void base_report(const char *text)
{
    struct stat file;
    if (fstat(STDERR_FILENO, &file))
        return;
    const int own = report_open(&file);
    const double until = base_seconds() + REPORT_SECONDS;
    for (size_t left = strlen(text); left;) {
        const ssize_t n = report_write(own, S_ISSOCK(file.st_mode), text, left);
        if (n > 0) {
            text += n;
            left -= (size_t)n;
        } else if (n < 0 && errno == EAGAIN && base_seconds() < until) {
            poll(&(struct pollfd){.fd = STDERR_FILENO, .events = POLLOUT}, 1, 10);
        } else if (n == 0 || errno != EINTR) {
            break;
        }
    }
    if (own >= 0)
        close(own);
}
