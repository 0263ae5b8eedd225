/* The report's text grows in memory; a failure while it grows is remembered by the stream and told
 * by the write. */
#include "cloth/output/files/files.h"
#include "cloth/output/files/json.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct output_report {
    FILE *stream;
    char *text; /* owned by the stream until it is closed, then by us */
    size_t size, n_keys;
};

int output_report_new(struct output_report **report, struct cloth_error *error)
{
    *report = NULL;
    struct output_report *made = calloc(1, sizeof *made);
    if (!made || !(made->stream = open_memstream(&made->text, &made->size))) {
        free(made);
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the report");
    }
    *report = made;
    return 0;
}

static FILE *put_key(struct output_report *report, const char *key)
{
    fputs(report->n_keys++ ? ",\n  " : "{\n  ", report->stream);
    output_json_string(report->stream, key);
    fputs(": ", report->stream);
    return report->stream;
}

void output_report_text(struct output_report *report, const char *key, const char *value)
{
    output_json_string(put_key(report, key), value);
}

void output_report_number(struct output_report *report, const char *key, double value)
{
    output_json_number(put_key(report, key), value);
}

void output_report_integer(struct output_report *report, const char *key, uint64_t value)
{
    fprintf(put_key(report, key), "%ju", (uintmax_t)value);
}

void output_report_null(struct output_report *report, const char *key)
{
    fputs("null", put_key(report, key));
}

static int fill_report(FILE *file, const void *what)
{
    const struct output_report *report = what;
    fwrite(report->text, 1, report->size, file);
    fputs(report->n_keys ? "\n}\n" : "{}\n", file);
    return ferror(file);
}

/* Beside its final name, then renamed, so that the path never holds half a report. */
static int write_renamed(const struct output_report *report, const char *path,
                         struct cloth_error *error)
{
    char *part = NULL;
    if (asprintf(&part, "%s.part", path) < 0)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory to write %s", path);
    int code = output_write_file(part, fill_report, report, error);
    if (!code && rename(part, path) != 0) {
        code = output_fail(error, "write", path);
        unlink(part);
    }
    free(part);
    return code;
}

int output_report_write(struct output_report *report, const char *path, struct cloth_error *error)
{
    if (fflush(report->stream) != 0 || ferror(report->stream))
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the report %s", path);
    struct stat status;
    bool exists = stat(path, &status) == 0;
    /* A pipe or a terminal has to be written as it is: renaming would replace it. */
    if (exists && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode))
        return output_write_file(path, fill_report, report, error);
    char *target = exists ? realpath(path, NULL) : NULL; /* keeps a link a link */
    int code = write_renamed(report, target ? target : path, error);
    free(target);
    return code;
}

void output_report_free(struct output_report *report)
{
    if (!report)
        return;
    fclose(report->stream);
    free(report->text);
    free(report);
}
