/* The process is there before the run, as a window would be, and is ended after it in any case. Its
 * exit code is the number of the last frame that it got. */
#include "bench/output/viewer.h"

#include "bench/serve.h"
#include "cloth/live/live.h"

#include <errno.h>
#include <netinet/in.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { NONE = 255, PATIENCE = 50 /* tenths of a second */ };

/* One that nobody has now. */
static int find_port(unsigned *port)
{
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    socklen_t size = sizeof address;
    const int file = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const bool found = file >= 0 && !bind(file, (struct sockaddr *)&address, size) &&
                       !getsockname(file, (struct sockaddr *)&address, &size);
    if (file >= 0)
        close(file);
    *port = ntohs(address.sin_port);
    return found ? 0 : serve_fail("no free port");
}

/* In the process. Returns its exit code. */
static int follow(unsigned port, bool stops)
{
    struct live_follower *follower;
    struct cloth_error error = {0};
    char host[40];
    bool waits = true;
    int last = NONE;
    snprintf(host, sizeof host, "127.0.0.1:%u", port);
    int code = live_follow_open(&follower, host, &error);
    while (!code && !(last != NONE && waits)) {
        enum live_news news;
        code = live_follow(follower, 0.1, &news, &error);
        live_follow_state(follower, &waits);
        if (code || news == LIVE_NOTHING)
            continue;
        live_follow_cache(follower);
        last = (int)live_follow_frame(follower);
        waits = false;
        if (stops)
            raise(SIGSTOP);
    }
    return code ? NONE : last;
}

int output_viewer_start(struct output_viewer *viewer, bool stops)
{
    *viewer = (struct output_viewer){.stops = stops};
    if (find_port(&viewer->port))
        return 1;
    viewer->process = fork();
    if (viewer->process == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        _exit(follow(viewer->port, stops));
    }
    return viewer->process < 0 ? serve_fail("no process for the viewer") : 0;
}

/* How it ended within some seconds. */
static int wait_for(const struct output_viewer *viewer)
{
    const struct timespec tenth = {.tv_nsec = 100000000};
    int status = 0;
    for (int i = 0; i < PATIENCE; i++) {
        if (waitpid(viewer->process, &status, WNOHANG | WUNTRACED) == viewer->process)
            return status;
        nanosleep(&tenth, NULL);
    }
    return 0;
}

int output_viewer_end(struct output_viewer *viewer, bool checks, int last)
{
    const int status = checks ? wait_for(viewer) : 0;
    kill(viewer->process, SIGKILL);
    while (waitpid(viewer->process, NULL, 0) < 0 && errno == EINTR)
        continue;
    if (checks && viewer->stops && !WIFSTOPPED(status))
        return serve_fail("wrong answer: the viewer did not stop at a frame");
    if (checks && !viewer->stops && (!WIFEXITED(status) || WEXITSTATUS(status) != last))
        return serve_fail("wrong answer: the viewer did not get the last frame, %d", last);
    return 0;
}
