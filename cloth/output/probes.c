/* The file holds a header and whole rows: a row is written at once, behind those before it. Rows
 * are in the system's hands when output_probes_row returns, so they outlive the process; they are
 * brought to the disk when the file is closed. */
#include "cloth/output/files/files.h"
#include "cloth/output/output.h"

#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char NAME[] = "probes.csv", OURS[] = "step,time [s],";

struct output_probes {
    struct output_file table;
    char *line; /* room for a row */
    size_t n;   /* numbers of a row, besides step and time */
};

enum { NUMBER = 26 }; /* bytes of a number, at most, with its comma */

int output_probes_forget(const char *folder, struct cloth_error *error)
{
    return output_remove_old(output_path(folder, NAME).text, OURS, strlen(OURS), NULL, error);
}

/* A table of the user's must not be taken for one of an earlier run. */
static int probes_start(struct output_file *table, const char *header, struct cloth_error *error)
{
    int code = output_remove_old(table->path.text, OURS, strlen(OURS),
                                 "would be replaced, but is no table of probes", error);
    code = code ? code : output_file_open(table, O_WRONLY | O_CREAT | O_EXCL, "write", error);
    return code ? code
                : output_file_append(table, header, strlen(header), "write the header of", error);
}

/* Behind the rows of an earlier run that stay. */
static int probes_go_on(struct output_file *table, const char *header, uint64_t n_rows,
                        struct cloth_error *error)
{
    const int code = output_file_open(table, O_RDWR, "go on with", error);
    if (code)
        return code;
    return output_begins(table->path.text, header, strlen(header))
               ? output_file_keep_lines(table, 1 + n_rows, error)
               : cloth_fail(error, CLOTH_E_INPUT, "%s has other columns: %s", table->path.text,
                            OUTPUT_CHANGED);
}

static size_t count_columns(const char *header)
{
    size_t n = 1;
    for (; *header; header++)
        n += *header == ',';
    return n;
}

int output_probes_open(struct output_probes **probes, const char *folder, const char *header,
                       const uint64_t *n_rows, struct cloth_error *error)
{
    struct output_probes *made = *probes = calloc(1, sizeof *made);
    if (!made)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the probes of %s", folder);
    made->table = output_file(folder, NAME);
    made->n = count_columns(header) - 2;
    made->line = malloc(NUMBER * (made->n + 3));
    char *first = NULL; /* the header, as a line */
    int code = made->line && asprintf(&first, "%s\n", header) >= 0
                   ? output_make_folder(folder, error)
                   : cloth_fail(error, CLOTH_E_MEMORY, "no memory for the probes of %s", folder);
    if (!code)
        code = n_rows ? probes_go_on(&made->table, first, *n_rows, error)
                      : probes_start(&made->table, first, error);
    free(first);
    if (code)
        output_probes_close(probes, error);
    return code;
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
                          probes->table.path.text, n, probes->n);
    char *end = probes->line + snprintf(probes->line, NUMBER, "%ju", (uintmax_t)step);
    end = put_number(end, time);
    for (size_t i = 0; i < n; i++)
        end = put_number(end, values[i]);
    *end++ = '\n';
    return output_file_append(&probes->table, probes->line, (size_t)(end - probes->line),
                              "write a row to", error);
}

int output_probes_sync(const char *folder, struct cloth_error *error)
{
    const struct output_path path = output_path(folder, NAME);
    const int file = output_open_file(path.text, O_RDONLY | O_NONBLOCK);
    const int code =
        file >= 0 && output_sync(file) != 0 ? output_fail(error, "write", path.text) : 0;
    if (file >= 0)
        close(file);
    return code;
}

int output_probes_close(struct output_probes **probes, struct cloth_error *error)
{
    struct output_probes *gone = *probes;
    *probes = NULL;
    if (!gone)
        return 0;
    int code = 0;
    if (gone->table.file >= 0 && output_sync(gone->table.file) != 0)
        code = output_fail(error, "write", gone->table.path.text);
    const int closed = output_file_close(&gone->table, error);
    free(gone->line);
    free(gone);
    return code ? code : closed;
}
