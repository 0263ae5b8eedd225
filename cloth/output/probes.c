/* The file holds a header and whole rows: a row is written at once, behind those before it, and one
 * that fails is taken away again. Rows are in the system's hands when output_probes_row returns, so
 * they outlive the process; they are brought to the disk when the file is closed. */
#include "cloth/output/files/cut.h"
#include "cloth/output/files/files.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char NAME[] = "probes.csv", OURS[] = "step,time [s],";

struct output_probes {
    char *path;
    int file;      /* -1: none */
    uint64_t size; /* bytes of the header and whole rows */
    char *line;    /* room for a row */
    size_t n;      /* numbers of a row, besides step and time */
};

enum { NUMBER = 26 }; /* bytes of a number, at most, with its comma */

/* True if an existing file begins like ours. */
static bool output_probes_is_ours(const char *path)
{
    char start[sizeof OURS] = "";
    const int file = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (file < 0)
        return false;
    const ssize_t n = read(file, start, sizeof start - 1);
    close(file);
    return n == (ssize_t)sizeof start - 1 && !memcmp(start, OURS, sizeof start - 1);
}

/* A table of the user's must not be taken for one of an earlier run. */
static int output_probes_remove_old(const char *path, bool replaced, struct cloth_error *error)
{
    struct stat status;
    if (lstat(path, &status) != 0)
        return 0;
    if (output_probes_is_ours(path))
        return unlink(path) == 0 ? 0 : output_refuse(error, "replace", path);
    if (!replaced)
        return 0;
    return cloth_fail(error, CLOTH_E_INPUT,
                      "%s would be replaced, but is no table of probes; give another folder, or "
                      "move the file away",
                      path);
}

int output_probes_forget(const char *folder, struct cloth_error *error)
{
    char *path = output_path(folder, NAME, "");
    if (!path)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the path of %s", NAME);
    const int code = output_probes_remove_old(path, false, error);
    free(path);
    return code;
}

static size_t count_columns(const char *header)
{
    size_t n = 1;
    for (; *header; header++)
        n += *header == ',';
    return n;
}

static int output_probes_start(struct output_probes *probes, const char *header,
                               struct cloth_error *error)
{
    const size_t size = strlen(header);
    int code = output_probes_remove_old(probes->path, true, error);
    if (code)
        return code;
    probes->file = open(probes->path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (probes->file < 0)
        return output_refuse(error, "write", probes->path);
    if (output_write_at(probes->file, header, size, 0) != 0 ||
        output_write_at(probes->file, "\n", 1, size) != 0)
        return output_fail(error, "write the header of", probes->path);
    probes->size = size + 1;
    return 0;
}

/* Behind the rows of an earlier run that stay. */
static int output_probes_go_on(struct output_probes *probes, const char *header, uint64_t n_rows,
                               struct cloth_error *error)
{
    probes->file = open(probes->path, O_RDWR | O_CLOEXEC);
    if (probes->file < 0)
        return output_refuse(error, "go on with", probes->path);
    const int code = output_cut_header(probes->file, probes->path, header, error);
    return code ? code
                : output_cut_lines(probes->file, probes->path, 1 + n_rows, &probes->size, error);
}

int output_probes_open(struct output_probes **probes, const char *folder, const char *header,
                       const uint64_t *n_rows, struct cloth_error *error)
{
    *probes = NULL;
    struct output_probes *made = calloc(1, sizeof *made);
    if (!made)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the probes of %s", folder);
    made->file = -1;
    made->n = count_columns(header) - 2;
    made->path = output_path(folder, NAME, "");
    made->line = malloc(NUMBER * (made->n + 3));
    int code = made->path && made->line
                   ? output_make_folder(folder, error)
                   : cloth_fail(error, CLOTH_E_MEMORY, "no memory for the probes of %s", folder);
    if (!code)
        code = n_rows ? output_probes_go_on(made, header, *n_rows, error)
                      : output_probes_start(made, header, error);
    if (code) {
        struct cloth_error ignored = {0};
        output_probes_close(&made, &ignored);
        return code;
    }
    *probes = made;
    return 0;
}

/* A number that is not finite leaves its field empty. */
static char *put_number(char *to, double value)
{
    *to++ = ',';
    return isfinite(value) ? to + snprintf(to, NUMBER - 1, "%.17g", value) : to;
}

int output_probes_row(void *context, uint64_t step, double time, size_t n, const double *values,
                      struct cloth_error *error)
{
    struct output_probes *probes = context;
    if (n != probes->n)
        return cloth_fail(error, CLOTH_E_RUN, "%s: a row of %zu numbers came where %zu are due",
                          probes->path, n, probes->n);
    int code = output_check_same(probes->file, probes->path, error);
    if (code)
        return code;
    char *end = probes->line + snprintf(probes->line, NUMBER, "%ju", (uintmax_t)step);
    end = put_number(end, time);
    for (size_t i = 0; i < n; i++)
        end = put_number(end, values[i]);
    *end++ = '\n';
    const size_t size = (size_t)(end - probes->line);
    if (output_write_at(probes->file, probes->line, size, probes->size) == 0) {
        probes->size += size;
        return 0;
    }
    code = output_fail(error, "write a row to", probes->path);
    if (ftruncate(probes->file, (off_t)probes->size) != 0)
        return code; /* the first error is the one that matters */
    return code;
}

int output_probes_sync(const char *folder, struct cloth_error *error)
{
    char *path = output_path(folder, NAME, "");
    if (!path)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the path of %s", NAME);
    const int file = output_open_file(path, O_RDONLY | O_NONBLOCK);
    const int code = file >= 0 && output_sync(file) != 0 ? output_fail(error, "write", path) : 0;
    if (file >= 0)
        close(file);
    free(path);
    return code;
}

int output_probes_close(struct output_probes **probes, struct cloth_error *error)
{
    struct output_probes *gone = *probes;
    *probes = NULL;
    if (!gone)
        return 0;
    int code = 0;
    if (gone->file >= 0 && output_sync(gone->file) != 0)
        code = output_fail(error, "write", gone->path);
    if (gone->file >= 0 && close(gone->file) != 0)
        code = output_fail(error, "close", gone->path);
    free(gone->path);
    free(gone->line);
    free(gone);
    return code;
}
