/* The film's path never holds half a film. ffmpeg ends when its input does; it is waited for
 * whatever fails. */
#include "cloth/view/film.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

struct view_film {
    const char *path;
    char *part, *target; /* the name while it is written; the same as ffmpeg takes it */
    FILE *said;          /* ffmpeg's standard error */
    int pipe;            /* -1: closed */
    pid_t ffmpeg;
    bool started, ended;     /* ffmpeg; where it ended, it has been waited for */
    bool piped;              /* SIGPIPE is ignored, */
    struct sigaction before; /* and was handled so before */
};

/* Adds the last line that ffmpeg printed. */
static int fail_as_said(struct view_film *film, struct cloth_error *error)
{
    char line[300], last[300] = "";
    rewind(film->said);
    while (fgets(line, sizeof line, film->said)) {
        line[strcspn(line, "\r\n")] = '\0';
        if (*line)
            memcpy(last, line, sizeof last);
    }
    return cloth_fail(error, CLOTH_E_IO, "cannot write %s: ffmpeg failed%s%s", film->path,
                      *last ? ": " : "", last);
}

/* Starts ffmpeg with the reading end of a pipe as its input. */
static int spawn(struct view_film *film, char *const *command, const int ends[2])
{
    posix_spawn_file_actions_t actions;
    int trouble = posix_spawn_file_actions_init(&actions);
    if (trouble)
        return trouble;
    trouble = posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
    if (!trouble)
        trouble = posix_spawn_file_actions_adddup2(&actions, fileno(film->said), STDERR_FILENO);
    if (!trouble)
        trouble = posix_spawnp(&film->ffmpeg, command[0], &actions, NULL, command, environ);
    film->started = !trouble;
    posix_spawn_file_actions_destroy(&actions);
    return trouble;
}

static int film_start(struct view_film *film, const char *size, const char *rate,
                      struct cloth_error *error)
{
    char *const command[] = {"ffmpeg",     "-nostdin",
                             "-loglevel",  "error",
                             "-f",         "rawvideo",
                             "-pix_fmt",   "rgb24",
                             "-s:v",       (char *)(uintptr_t)size,
                             "-framerate", (char *)(uintptr_t)rate,
                             "-i",         "pipe:0",
                             "-c:v",       "libx264",
                             "-preset",    "fast",
                             "-crf",       "18",
                             "-pix_fmt",   "yuv420p",
                             "-movflags",  "+faststart",
                             "-f",         "mp4",
                             "-y",         film->target,
                             NULL};
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
        return cloth_fail(error, CLOTH_E_IO, "no pipe to ffmpeg: %s", strerror(errno));
    const int trouble = spawn(film, command, ends);
    close(ends[0]);
    film->pipe = ends[1];
    if (trouble == ENOENT)
        return cloth_fail(error, CLOTH_E_LIBRARY,
                          "films need the program ffmpeg, which is not there: install ffmpeg "
                          "(Debian's name)");
    return trouble ? cloth_fail(error, CLOTH_E_IO, "cannot start ffmpeg: %s", strerror(trouble))
                   : 0;
}

/* If ffmpeg stops early, the write fails and no signal ends the process. */
static void ignore_pipe(struct view_film *film)
{
    const struct sigaction ignore = {.sa_handler = SIG_IGN};
    film->piped = sigaction(SIGPIPE, &ignore, &film->before) == 0;
}

int view_film_open(struct view_film **film, const char *path, int width, int height, double fps,
                   struct cloth_error *error)
{
    *film = NULL;
    if (width % 2 || height % 2)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "a film needs an even width and height, not %d x %d", width, height);
    struct view_film *made = *film = calloc(1, sizeof *made);
    if (!made)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for a film");
    char size[40], rate[40];
    snprintf(size, sizeof size, "%dx%d", width, height);
    snprintf(rate, sizeof rate, "%.17g", fps);
    made->path = path;
    made->pipe = -1;
    if (asprintf(&made->part, "%s.part", path) < 0)
        made->part = NULL;
    if (asprintf(&made->target, "file:%s.part", path) < 0)
        made->target = NULL;
    made->said = tmpfile();
    if (!made->part || !made->target)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for a film");
    if (!made->said)
        return cloth_fail(error, CLOTH_E_IO, "no temporary file for a film: %s", strerror(errno));
    ignore_pipe(made);
    return film_start(made, size, rate, error);
}

/* Ends ffmpeg's input, and ffmpeg. */
static int end_ffmpeg(struct view_film *film, struct cloth_error *error)
{
    int status = 0;
    if (film->pipe >= 0)
        close(film->pipe);
    film->pipe = -1;
    if (!film->started || film->ended)
        return 0;
    film->ended = true;
    while (waitpid(film->ffmpeg, &status, 0) < 0)
        if (errno != EINTR)
            return cloth_fail(error, CLOTH_E_IO, "ffmpeg is lost: %s", strerror(errno));
    return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? 0 : fail_as_said(film, error);
}

/* A pipe that breaks is ffmpeg that ended: it says why. */
static int film_fail_to_write(struct view_film *film, struct cloth_error *error)
{
    const char *reason = strerror(errno);
    const int code = end_ffmpeg(film, error);
    return code ? code
                : cloth_fail(error, CLOTH_E_IO, "cannot write %s: ffmpeg ended early: %s",
                             film->path, reason);
}

int view_film_add(struct view_film *film, const struct view_picture *picture,
                  struct cloth_error *error)
{
    const size_t n = (size_t)3 * (size_t)picture->width * (size_t)picture->height;
    for (size_t done = 0; done < n;) {
        const ssize_t some = write(film->pipe, picture->rgb + done, n - done);
        if (some < 0 && errno != EINTR)
            return film_fail_to_write(film, error);
        done += some > 0 ? (size_t)some : 0;
    }
    return 0;
}

int view_film_close(struct view_film **film, bool whole, struct cloth_error *error)
{
    struct view_film *gone = *film;
    *film = NULL;
    if (!gone)
        return 0;
    /* A caller that gives up the film keeps its own error. */
    struct cloth_error unheard = {0};
    int code = end_ffmpeg(gone, whole ? error : &unheard);
    code = whole ? code : 0;
    whole = whole && !code && gone->started;
    if (whole && rename(gone->part, gone->path) != 0)
        code = cloth_fail(error, CLOTH_E_IO, "cannot write %s: %s", gone->path, strerror(errno));
    if (gone->started && (code || !whole))
        unlink(gone->part);
    if (gone->piped)
        sigaction(SIGPIPE, &gone->before, NULL);
    if (gone->said)
        fclose(gone->said);
    free(gone->part);
    free(gone->target);
    free(gone);
    return code;
}
