/* The chart goes under another name until it is whole, so that its path never holds half of it. */
#include "config.h"

#include "cloth/app/view/trace.h"

#include "tools/trace/read.h"

#include <duite.h>
#include <errno.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

typedef int chart_write(const struct trace_run *run, const struct chart_options *options,
                        FILE *file);

static int trace_write_to(const struct trace_run *run, const struct chart_options *options,
                          chart_write *write, const char *name, const char *path,
                          struct cloth_error *error)
{
    FILE *file = fopen(name, "wbe");
    if (!file)
        return cloth_fail(error, CLOTH_E_IO, "cannot write %s: %s", path, strerror(errno));
    const int code = write(run, options, file);
    errno = 0;
    bool whole = !ferror(file) && !fflush(file);
    int reason = errno;
    if (fclose(file) && whole) {
        whole = false;
        reason = errno;
    }
    if (code)
        return cloth_fail(error, code == DUITE_E_ARGUMENT ? CLOTH_E_INPUT : CLOTH_E_LIBRARY, "%s",
                          duite_message());
    return whole ? 0 : cloth_fail(error, CLOTH_E_IO, "cannot write %s: %s", path, strerror(reason));
}

static int trace_write(const struct trace_run *run, const struct chart_options *options,
                       chart_write *write, const char *path, struct cloth_error *error)
{
    struct stat status;
    char *part = NULL;
    if (stat(path, &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode))
        return trace_write_to(run, options, write, path, path, error); /* a pipe or a device */
    if (asprintf(&part, "%s.part", path) < 0)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory to write %s", path);
    int code = trace_write_to(run, options, write, part, path, error);
    if (!code && rename(part, path) != 0)
        code = cloth_fail(error, CLOTH_E_IO, "cannot write %s: %s", path, strerror(errno));
    if (code)
        unlink(part);
    free(part);
    return code;
}

int view_trace(const char *trace, const struct chart_options *options, const char *svg,
               const char *png, struct cloth_error *error)
{
    struct trace_run *run;
    int code = trace_read(&run, trace, false);
    if (code)
        return cloth_fail(error, CLOTH_E_INPUT, "%s", duite_message());
    if (svg)
        code = trace_write(run, options, chart_write_svg, svg, error);
    if (png && !code)
        code = trace_write(run, options, chart_write_png, png, error);
    trace_run_free(run);
    return code;
}
