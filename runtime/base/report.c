/* Standard error may be a pipe that nobody reads: a write to it would block, and with it the
 * monitor and its heartbeats. So a pipe or terminal is opened once more, non-blocking; the flag
 * holds for this opening alone, not for other programs that write there. */
#include "runtime/base/error.h"

#include "runtime/base/clock.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdbool.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

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
