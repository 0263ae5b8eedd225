/* Draws for the bench "output": pictures of the sheet's last frame, with the renderer of
 * duite-view, and films, by duite-view itself. A context stays open from picture to picture. */
#include "bench/output/folder.h"
#include "bench/serve.h"
#include "cloth/view/show.h"

#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { PATH = 4200 };

/* ---- Pictures ---- */

struct session {
    char folder[PATH];
    struct view_context *context;
    struct output_cache cache;
    struct view_wish wish;
    struct view_show *show; /* NULL: nothing is open */
};

static void end(struct session *session)
{
    if (session->show)
        view_show_undraw(session->show);
    view_show_close(session->show);
    session->show = NULL;
    view_context_close(session->context);
    session->context = NULL;
    output_cache_close(&session->cache);
}

static int begin(struct session *session, struct serve_request *request)
{
    struct cloth_error error = {0};
    if (session->show)
        return 0;
    output_folder(session->folder, sizeof session->folder);
    session->wish = (struct view_wish){.folder = session->folder,
                                       .width = (int)serve_number(request, "width"),
                                       .height = (int)serve_number(request, "height"),
                                       .azimuth = 32,
                                       .elevation = 20,
                                       .zoom = 1};
    int code = output_cache_open(&session->cache, session->folder, &error);
    code = code ? code : view_show_open(&session->show, &session->cache, &session->wish, &error);
    code = code ? code : view_context_open(&session->context, &error);
    if (!code)
        return 0;
    end(session);
    return serve_fail("%s", error.text);
}

/* Mean of all its bytes, 0 .. 255. */
static double brightness(const struct view_picture *picture)
{
    const size_t n = 3 * (size_t)picture->width * (size_t)picture->height;
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += picture->rgb[i];
    return sum / (double)n;
}

static int draw_once(struct session *session, double *seconds, double *bright)
{
    struct view_picture picture = {session->wish.width, session->wish.height, NULL};
    struct cloth_error error = {0};
    const double start = serve_seconds();
    int code = view_show_frame(session->show, session->cache.n_frames - 1, &error);
    code = code ? code : view_show_picture(session->show, &picture, &error);
    *seconds = serve_seconds() - start;
    if (!code)
        *bright = brightness(&picture);
    view_picture_free(&picture);
    return code ? serve_fail("%s", error.text) : 0;
}

/* Shadows take light away, and every picture of a kind is the same. */
static int check(bool shadows, double bright)
{
    static double known[2]; /* 0: there was none yet */
    if (known[shadows] > 0 && (known[shadows] < bright || bright < known[shadows]))
        return serve_fail("wrong answer: another picture than the one before");
    known[shadows] = bright;
    return known[0] > 0 && known[1] > 0 && known[1] >= known[0]
               ? serve_fail("wrong answer: shadows take no light away")
               : 0;
}

/* draw shadows=0|1 width= height=: seconds of reading and drawing a frame, after one that does not
 * count. */
static int draw(void *context, struct serve_request *request, double *value)
{
    struct session *session = context;
    const bool shadows = serve_number(request, "shadows") != 0;
    double bright = 0;
    int code = begin(session, request);
    if (!code)
        session->show->plain = !shadows;
    for (int i = 0; i < 2 && !code; i++)
        code = draw_once(session, value, &bright);
    return code ? code : check(shadows, bright);
}

/* ---- Films ---- */

/* film frames= size=: seconds of duite-view, which encodes by ffmpeg. */
static int film(void *context, struct serve_request *request, double *value)
{
    char folder[PATH], own[PATH], size[20], path[PATH + 20], command[4 * PATH];
    struct stat about = {0};
    (void)context;
    output_folder(folder, sizeof folder);
    serve_word(request, "size", size, sizeof size);
    const ssize_t length = readlink("/proc/self/exe", own, sizeof own - 1);
    own[length < 0 ? 0 : length] = '\0';
    char *slash = strrchr(own, '/');
    if (!slash)
        return serve_fail("this program has no path");
    *slash = '\0';
    snprintf(path, sizeof path, "%s/film.mp4", folder);
    snprintf(command, sizeof command,
             "'%s/../../duite-view' '%s' --mp4 '%s' --frames 1:%u --size %s >&2", own, folder, path,
             (unsigned)serve_number(request, "frames"), size);
    const double start = serve_seconds();
    const int status = system(command);
    *value = serve_seconds() - start;
    if (status || stat(path, &about) || about.st_size < 1000)
        return serve_fail("duite-view makes no film: %.150s", command);
    return unlink(path) ? serve_fail("%s cannot be removed", path) : 0;
}

int main(void)
{
    static const struct serve_run runs[] = {{"draw", draw}, {"film", film}, {0}};
    static struct session session;
    const struct serve_run *const all[] = {runs, NULL};
    const int status = serve("duite-view's drawing by OpenGL without a display", all, &session);
    end(&session);
    return status;
}
