/* runs.csv: comments that say what is compared, where and by which build; a line of names; and a
 * line for each run, written and synchronised when it is over. A last line that was cut off is
 * dropped, and the run made again. */
#include "tools/compare/compare.h"
#include "tools/compare/program.h"

#include <config.h>

#include <errno.h>
#include <inttypes.h>
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

enum { LINE = 1000 };

static void first_line_of(FILE *out, const char *before, const char *key, const char *command)
{
    char line[LINE] = "";
    FILE *in = popen(command, "r");
    if (in && fgets(line, sizeof line, in))
        line[strcspn(line, "\n")] = 0;
    if (in)
        pclose(in);
    fprintf(out, "%s%s: %s\n", before, key, line[0] ? line : "unknown");
}

void compare_describe(FILE *out, const char *before)
{
    struct utsname host;
    char build[COMPARE_PROGRAM], command[COMPARE_PROGRAM + LINE];
    if (!uname(&host))
        fprintf(out, "%shost: %s, %s %s, %s\n", before, host.nodename, host.sysname, host.release,
                host.machine);
    fprintf(out, "%scores: %ld\n", before, sysconf(_SC_NPROCESSORS_ONLN));
    first_line_of(out, before, "processor",
                  "sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1");
    first_line_of(out, before, "memory", "sed -n 's/^MemTotal: *//p' /proc/meminfo");
    first_line_of(out, before, "load", "cut -d ' ' -f 1-3 /proc/loadavg");
    first_line_of(out, before, "mpi", COMPARE_MPIRUN " --version 2> /dev/null | head -n 1");
    fprintf(out, "%sbuild: %s, %s, %s\n", before, PACKAGE_STRING, COMPILER, COMPARE_CFLAGS);
    snprintf(command, sizeof command,
             "cd '%s' && test -e config.status && git -C '" COMPARE_SOURCE
             "' describe --always --dirty --abbrev=12 2> /dev/null", /* a build folder's alone */
             compare_find_program("", build));
    first_line_of(out, before, "revision", command);
}

/* The settings that all runs of a comparison share; lists and rounds may grow. */
static void print_specification(const struct compare *compare, FILE *out)
{
    fprintf(out, "# compares:");
    for (int d = COMPARE_DIMENSIONS; d < compare->dimensions; d++)
        fprintf(out, " --vary %s", compare->name[d]);
    if (compare->figure)
        fprintf(out, " --figure %s", compare->figure);
    if (compare->program) {
        fprintf(out, " seed=%" PRIu64 " -- ", compare->seed);
        program_print(compare, out);
        fputc('\n', out);
        return;
    }
    for (size_t i = 0; i < compare->sets.n; i++)
        fprintf(out, " --set %s", compare->sets.item[i]);
    fprintf(out, "%s tasks=%s cost=%s bytes=%s steps=%s seed=%" PRIu64 "\n",
            compare->metg ? " --metg" : "", compare->tasks, compare->cost, compare->bytes,
            compare->steps, compare->seed);
}

static void path_of(const struct compare *compare, char *path, size_t size)
{
    snprintf(path, size, "%s/runs.csv", compare->folder);
}

static struct compare_config *find(struct compare *compare, char *const *field)
{
    for (size_t i = 0; i < compare->n; i++) {
        bool same = true;
        for (int d = 0; d < compare->dimensions; d++)
            same = same && !strcmp(compare->config[i].value[d], field[1 + d]);
        if (same)
            return &compare->config[i];
    }
    return NULL;
}

/* A run that failed is made again. False: the run is none of this comparison. */
static bool take_line(struct compare *compare, char *line)
{
    enum { MOST = 1 + COMPARE_ALL_DIMENSIONS + 7 };
    const int fields = MOST - COMPARE_ALL_DIMENSIONS + compare->dimensions;
    char *field[MOST], *rest = line;
    int n = 0;
    while (n < fields && (field[n] = strsep(&rest, ",")))
        n++;
    if (n < fields || *line < '0' || *line > '9')
        return true;
    struct compare_config *config = find(compare, field);
    if (!config)
        return false;
    const size_t round = strtoul(field[0], NULL, 10);
    char **figure = field + 1 + compare->dimensions;
    config->known = true;
    if (round >= compare->rounds || strcmp(figure[6], "fine") != 0)
        return true;
    struct compare_run *run = &config->run[round];
    *run = (struct compare_run){.seconds = strtod(figure[0], NULL),
                                .bodies = *figure[1] ? strtod(figure[1], NULL) : NAN,
                                .stolen = strtod(figure[2], NULL),
                                .messages = strtod(figure[3], NULL),
                                .bytes = strtod(figure[4], NULL),
                                .done = true,
                                .fine = true};
    snprintf(run->hash, sizeof run->hash, "%s", figure[5]);
    return true;
}

#define WARNING "# warning: "

static void keep_warning(struct compare *compare, const char *warning)
{
    const size_t used = strlen(compare->warnings);
    if (!strstr(compare->warnings, warning))
        snprintf(compare->warnings + used, sizeof compare->warnings - used, "%s\n", warning);
}

/* A journal that was there. */
struct found {
    long whole;       /* bytes up to the end of the last whole line */
    bool same;        /* it is this comparison's */
    size_t rounds;    /* that were begun */
    char other[LINE]; /* the build or the revision of it, if it is another one's */
};

static bool begins(const char *line, const char *with)
{
    return !strncmp(line, with, strlen(with));
}

/* ours: what begin() would write. */
static void look_at(struct compare *compare, const char *ours, char *line, struct found *found)
{
    if (begins(line, "# compares:"))
        found->same = strstr(ours, line);
    const bool other =
        (begins(line, "# build: ") || begins(line, "# revision: ")) && !strstr(ours, line);
    line[strcspn(line, "\n")] = 0;
    if (other)
        snprintf(found->other, sizeof found->other, "%.*s", LINE - 1, line + strlen("# "));
    if (begins(line, WARNING))
        keep_warning(compare, line + strlen(WARNING));
    if (*line >= '0' && *line <= '9' && strtoul(line, NULL, 10) >= found->rounds)
        found->rounds = strtoul(line, NULL, 10) + 1;
    if (!take_line(compare, line))
        found->same = false;
}

/* Takes over whole lines. */
static int take_over(struct compare *compare, FILE *in, struct found *found)
{
    char line[LINE + COMPARE_COMMAND], *ours = NULL;
    size_t size, taken = 0;
    FILE *memory = open_memstream(&ours, &size);
    if (!memory)
        return 1;
    print_specification(compare, memory);
    compare_describe(memory, "# ");
    fclose(memory);
    while (fgets(line, sizeof line, in) && strchr(line, '\n')) {
        found->whole = ftell(in);
        look_at(compare, ours, line, found);
    }
    free(ours);
    for (size_t i = 0; i < compare->n; i++)
        for (size_t r = 0; r < compare->rounds; r++)
            taken += compare->config[i].run[r].done;
    if (found->whole && !found->same)
        fprintf(
            stderr,
            "duite-compare: %s has another comparison: lists and rounds may grow, all else stays; "
            "choose another --output\n",
            compare->folder);
    else if (taken)
        printf("%zu runs are there already\n", taken);
    return found->whole && !found->same;
}

/* Members without a run, although a second round was begun, were not there before. */
static void warn_of_later(struct compare *compare, const struct found *found)
{
    const struct compare_config *first = NULL;
    char *text = NULL;
    size_t n = 0, size;
    for (size_t i = compare->n; i-- > 0;)
        if (found->rounds > 1 && !compare->config[i].known) {
            first = &compare->config[i];
            n++;
        }
    FILE *memory = first ? open_memstream(&text, &size) : NULL;
    if (!memory)
        return;
    compare_print_member(compare, first, memory);
    if (n > 1)
        fprintf(memory, " and %zu others", n - 1);
    fputs(" joined later: their runs are not in turns with the others', so that their ratios have "
          "what the machine did in between",
          memory);
    fclose(memory);
    compare_journal_warn(compare, text);
    free(text);
}

static void begin(struct compare *compare)
{
    char date[40];
    time_t now = time(NULL);
    strftime(date, sizeof date, "%Y-%m-%d %H:%M:%S UTC", gmtime(&now));
    print_specification(compare, compare->journal);
    fprintf(compare->journal, "# date: %s\n", date);
    compare_describe(compare->journal, "# ");
    fprintf(compare->journal, "round");
    for (int d = 0; d < compare->dimensions; d++)
        fprintf(compare->journal, ",%s", compare->name[d]);
    fprintf(compare->journal, ",%s,seconds_in_bodies,stolen,messages,bytes,hash,status\n",
            compare->figure ? "figure" : "seconds");
}

int compare_journal_open(struct compare *compare)
{
    char path[LINE], text[LINE + 60];
    struct found found = {.whole = 0};
    path_of(compare, path, sizeof path);
    FILE *in = fopen(path, "r");
    int failed = in ? take_over(compare, in, &found) : 0;
    if (in)
        fclose(in);
    if (failed)
        return 1;
    compare->journal = fopen(path, found.whole ? "r+" : "w");
    if (compare->journal && found.whole &&
        (ftruncate(fileno(compare->journal), found.whole) || fseek(compare->journal, 0, SEEK_END)))
        failed = 1;
    if (compare->journal && !found.whole)
        begin(compare);
    if (!compare->journal || failed || fflush(compare->journal)) {
        fprintf(stderr, "duite-compare: %s: %s\n", path, strerror(errno));
        return 1;
    }
    warn_of_later(compare, &found);
    if (*found.other) {
        snprintf(text, sizeof text, "runs that were there already are of another build: %s",
                 found.other);
        compare_journal_warn(compare, text);
    }
    return 0;
}

int compare_journal_add(struct compare *compare, const struct compare_config *config, size_t round)
{
    const struct compare_run *run = &config->run[round];
    FILE *out = compare->journal;
    fprintf(out, "%zu", round);
    for (int d = 0; d < compare->dimensions; d++)
        fprintf(out, ",%s", config->value[d]);
    if (run->fine && compare->program)
        fprintf(out, ",%.9g,,,,,,fine\n", run->seconds);
    else if (run->fine)
        fprintf(out, ",%.9g,%.9g,%.0f,%.0f,%.0f,%s,fine\n", run->seconds, run->bodies, run->stolen,
                run->messages, run->bytes, run->hash);
    else
        fputs(",,,,,,,failed\n", out);
    if (!fflush(out) && !fsync(fileno(out)))
        return 0;
    fprintf(stderr, "duite-compare: %s/runs.csv: %s; what was written before is kept\n",
            compare->folder, strerror(errno));
    return 1;
}

void compare_journal_warn(struct compare *compare, const char *warning)
{
    if (!warning)
        return;
    fprintf(stderr, "duite-compare: warning: %s\n", warning);
    keep_warning(compare, warning);
    fprintf(compare->journal, WARNING "%s\n", warning);
}

void compare_journal_close(struct compare *compare)
{
    if (compare->journal)
        fclose(compare->journal);
}
