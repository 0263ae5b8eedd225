/* The file is built in memory as one flat object and written at the end. */
#include "bench/report.h"

#include <config.h>

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>
#include <time.h>
#include <unistd.h>

#ifdef __clang__
#define COMPILER __VERSION__
#else
#define COMPILER "gcc " __VERSION__
#endif

int report_start(struct report *report, bool json)
{
    *report = (struct report){0};
    if (!json)
        return 0;
    report->json = open_memstream(&report->text, &report->size);
    if (report->json)
        fputs("{\n  \"schema\": 1", report->json);
    else
        fprintf(stderr, "duite-bench: out of memory\n");
    return !report->json;
}

static void write_string(FILE *file, const char *text)
{
    fputc('"', file);
    for (; *text; text++)
        if (*text == '"' || *text == '\\')
            fprintf(file, "\\%c", *text);
        else if ((unsigned char)*text < 0x20)
            fprintf(file, "\\u%04x", (unsigned)*text);
        else
            fputc(*text, file);
    fputc('"', file);
}

static void write_number(FILE *file, const char *key, const char *suffix, double value)
{
    if (!file)
        return;
    fprintf(file, ",\n  \"%s%s\": ", key, suffix);
    if (isfinite(value))
        fprintf(file, "%.10g", value);
    else
        fputs("null", file);
}

void report_text(struct report *report, const char *key, const char *value)
{
    printf("# %s: %s\n", key, value);
    if (!report->json)
        return;
    fprintf(report->json, ",\n  \"%s\": ", key);
    write_string(report->json, value);
}

void report_number(struct report *report, const char *key, double value)
{
    printf("# %s: %.10g\n", key, value);
    write_number(report->json, key, "", value);
}

/* Four digits, without an exponent for what is large. */
static const char *digits(double value, char *text, size_t size)
{
    snprintf(text, size, fabs(value) >= 1000 ? "%.0f" : "%.4g", value);
    return text;
}

static void report_target(struct report *report, const struct measure_metric *metric)
{
    static const char *const verdicts[] = {"pass", "miss", "not measured"};
    if (!metric->target)
        return;
    printf(", target %s %g: %s", metric->target->least ? ">=" : "<=", metric->target->bound,
           verdicts[measure_verdict(metric)]);
    write_number(report->json, metric->name, "_target", metric->target->bound);
}

/* Why it has no median. */
static const char *why_none(const struct measure_metric *metric)
{
    if (metric->missing)
        return metric->missing;
    return metric->none ? metric->none : "not found within the sizes tried";
}

void report_metric(struct report *report, const struct measure_metric *metric)
{
    char median[32], low[32], high[32];
    if (isfinite(metric->median))
        printf("%s: %s %s [%s .. %s]", metric->name, digits(metric->median, median, sizeof median),
               metric->unit, digits(metric->low, low, sizeof low),
               digits(metric->high, high, sizeof high));
    else
        printf("%s: %s", metric->name, why_none(metric));
    write_number(report->json, metric->name, "", metric->median);
    write_number(report->json, metric->name, "_low", metric->low);
    write_number(report->json, metric->name, "_high", metric->high);
    report_target(report, metric);
    putchar('\n');
    fflush(stdout);
}

/* ---- The host ---- */

static void processor(char *name, size_t size)
{
    char line[300];
    FILE *file = fopen("/proc/cpuinfo", "r");
    snprintf(name, size, "unknown");
    while (file && fgets(line, sizeof line, file))
        if (!strncmp(line, "model name", 10) && strchr(line, ':')) {
            line[strcspn(line, "\n")] = '\0';
            snprintf(name, size, "%s", strchr(line, ':') + 2);
            break;
        }
    if (file)
        fclose(file);
}

static void warn(struct report *report, const char *key, const char *warning)
{
    if (!warning)
        return;
    report_text(report, key, warning);
    fprintf(stderr, "duite-bench: warning: %s\n", warning);
}

void report_host(struct report *report)
{
    char text[400], date[40] = "";
    struct utsname system = {0};
    time_t now = time(NULL);
    struct tm when;
    uname(&system);
    if (gmtime_r(&now, &when))
        strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%SZ", &when);
    report_text(report, "date", date);
    report_text(report, "duite", PACKAGE_VERSION);
    processor(text, sizeof text);
    report_text(report, "host_processor", text);
    report_number(report, "host_cores", subject_cores());
    report_number(report, "host_memory_bytes",
                  (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE));
    snprintf(text, sizeof text, "%s %s %s", system.sysname, system.release, system.machine);
    report_text(report, "host_system", text);
    report_text(report, "compiler", COMPILER);
    report_text(report, "compiler_flags", BENCH_CFLAGS);
    load_begin(&report->load);
    if (isfinite(report->load.average))
        report_number(report, "host_load", report->load.average);
    warn(report, "warning_load",
         load_warn_average(report->load.average, report->load.cores, text, sizeof text));
}

void report_others(struct report *report)
{
    char text[200];
    const double others = load_others(&report->load);
    if (isfinite(others))
        report_number(report, "host_others_cores", others);
    warn(report, "warning_others", load_warn_others(others, report->load.cores, text, sizeof text));
}

/* ---- The end ---- */

static int write_file(const char *path, const char *text)
{
    char *temporary = NULL;
    if (asprintf(&temporary, "%s.new", path) < 0)
        return 1;
    FILE *file = fopen(temporary, "w");
    int code = !file || fputs(text, file) < 0;
    if (file && fclose(file))
        code = 1;
    if (!code && rename(temporary, path))
        code = 1;
    if (code) {
        fprintf(stderr, "duite-bench: %s cannot be written: %s\n", path, strerror(errno));
        unlink(temporary);
    }
    free(temporary);
    return code;
}

int report_finish(struct report *report, const char *path)
{
    int code = 0;
    if (!report->json)
        return 0;
    fputs("\n}\n", report->json);
    if (fclose(report->json)) {
        fprintf(stderr, "duite-bench: out of memory\n");
        code = 1;
    }
    if (!code && path)
        code = write_file(path, report->text);
    free(report->text);
    return code;
}
