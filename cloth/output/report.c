/* The report's text grows in memory. The stream keeps a failure while the text grows, and the write
 * reports it. */
#include "cloth/output/files/files.h"
#include "cloth/output/files/json.h"
#include "cloth/output/output.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct output_report {
    FILE *stream;
    char *text; /* owned by the stream until it is closed, then by us */
    size_t size, n_keys;
    size_t n_outside; /* within a list: keys of the object around it */
    size_t n_items;   /* then: of the list */
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

static FILE *output_report_put_key(struct output_report *report, const char *key)
{
    if (report->n_outside)
        fputs(report->n_keys++ ? ", " : "{", report->stream);
    else
        fputs(report->n_keys++ ? ",\n  " : "{\n  ", report->stream);
    output_json_string(report->stream, key);
    fputs(": ", report->stream);
    return report->stream;
}

void output_report_text(struct output_report *report, const char *key, const char *value)
{
    output_json_string(output_report_put_key(report, key), value);
}

void output_report_number(struct output_report *report, const char *key, double value)
{
    output_json_number(output_report_put_key(report, key), value);
}

void output_report_integer(struct output_report *report, const char *key, uint64_t value)
{
    fprintf(output_report_put_key(report, key), "%ju", (uintmax_t)value);
}

void output_report_null(struct output_report *report, const char *key)
{
    fputs("null", output_report_put_key(report, key));
}

void output_report_list(struct output_report *report, const char *key)
{
    fputs("[", output_report_put_key(report, key));
    report->n_outside = report->n_keys;
    report->n_items = report->n_keys = 0;
}

void output_report_item(struct output_report *report)
{
    fputs(report->n_items++ ? "},\n    " : "\n    ", report->stream);
    report->n_keys = 0;
}

void output_report_list_end(struct output_report *report)
{
    fputs(report->n_items ? "}\n  ]" : "]", report->stream);
    report->n_keys = report->n_outside;
    report->n_outside = 0;
}

static int fill_report(FILE *file, const void *what)
{
    const struct output_report *report = what;
    fwrite(report->text, 1, report->size, file);
    fputs(report->n_keys ? "\n}\n" : "{}\n", file);
    return ferror(file);
}

/* ---- Destination ---- */

/* The one of our own two outputs that the path leads to, as /dev/stdout does; -1: neither. */
static int own_output(const char *path)
{
    struct stat there, here;
    if (stat(path, &there) != 0)
        return -1;
    for (int file = STDOUT_FILENO; file <= STDERR_FILENO; file++)
        if (fstat(file, &here) == 0 && here.st_dev == there.st_dev && here.st_ino == there.st_ino)
            return file;
    return -1;
}

/* Goes on where that output is: earlier text stays, later text follows. */
static int write_own(const struct output_report *report, int file, const char *path,
                     struct cloth_error *error)
{
    fflush(stdout);
    const int copy = dup(file);
    FILE *stream = copy < 0 ? NULL : fdopen(copy, "w");
    if (!stream) {
        const int code = output_fail(error, "write", path);
        if (copy >= 0)
            close(copy);
        return code;
    }
    const int bad = fill_report(stream, report) || fflush(stream) != 0;
    const int code = bad ? output_fail(error, "write", path) : 0;
    fclose(stream);
    return code;
}

/* True if a folder (ended by '/') is `made` or one of its parents. */
static bool within(const char *folder, const char *made)
{
    size_t n = strlen(folder);
    while (n > 1 && folder[n - 1] == '/')
        n--;
    return made && strncmp(folder, made, n) == 0 && (made[n] == '/' || !made[n]);
}

static int check_folder(const char *file, const char *path, const char *made,
                        struct cloth_error *error)
{
    struct output_path folder;
    const char *slash = strrchr(file, '/');
    snprintf(folder.text, sizeof folder.text, "%.*s", slash ? (int)(slash - file) + 1 : 2,
             slash ? file : "./");
    if (access(folder.text, W_OK | X_OK) == 0 || (errno == ENOENT && within(folder.text, made)))
        return 0;
    const char *reason = strerror(errno);
    return strcmp(file, path) == 0
               ? cloth_fail(error, CLOTH_E_INPUT, "cannot write in its folder: %s", reason)
               : cloth_fail(error, CLOTH_E_INPUT,
                            "it is a link to %s; cannot write in the folder of that: %s", file,
                            reason);
}

int output_report_check(const char *path, const char *made, struct cloth_error *error)
{
    struct stat status;
    const bool is_there = stat(path, &status) == 0;
    if (is_there && S_ISDIR(status.st_mode))
        return cloth_fail(error, CLOTH_E_INPUT, "this is a folder; the name of a file is expected");
    if (is_there && (!S_ISREG(status.st_mode) || own_output(path) >= 0)) /* written as it is */
        return access(path, W_OK) == 0
                   ? 0
                   : cloth_fail(error, CLOTH_E_INPUT, "cannot be written: %s", strerror(errno));
    struct output_path end;
    return output_follow(path, &end) == 0
               ? check_folder(end.text, path, made, error)
               : cloth_fail(error, CLOTH_E_INPUT, "cannot follow this link: %s", strerror(errno));
}

int output_report_write(struct output_report *report, const char *path, struct cloth_error *error)
{
    if (fflush(report->stream) != 0 || ferror(report->stream))
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for the report %s", path);
    const int own = own_output(path);
    return own >= 0 ? write_own(report, own, path, error)
                    : output_replace_file(path, fill_report, report, error);
}

void output_report_free(struct output_report *report)
{
    if (!report)
        return;
    fclose(report->stream);
    free(report->text);
    free(report);
}
