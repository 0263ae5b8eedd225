/* summary.csv: a line of names, and a line for each run, written and synchronised when it is over.
 * A last line that was cut off is dropped, and the run made again. about.txt beside it says what is
 * compared, where and by which build. */
#include "tools/compare/compare.h"
#include "tools/compare/program.h"

#include <config.h>

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <mpi.h>
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

/* ---- Where ---- */

static bool begins(const char *line, const char *with)
{
    return !strncmp(line, with, strlen(with));
}

/* The rest of the first line that begins with `with`; blanks and a colon may lie between. */
static void print_line_of(FILE *in, const char *key, const char *with, FILE *out)
{
    char line[LINE];
    bool found = false;
    while (in && !found && fgets(line, sizeof line, in))
        found = begins(line, with);
    const char *rest = found ? line + strlen(with) : "unknown";
    rest += found ? strspn(rest, " \t:") : 0;
    fprintf(out, "%s: %.*s\n", key, (int)strcspn(rest, "\n"), rest);
}

static void print_file_line(const char *key, const char *file, const char *with, FILE *out)
{
    FILE *in = fopen(file, "r");
    print_line_of(in, key, with, out);
    if (in)
        fclose(in);
}

static void print_mpi(FILE *out)
{
    char version[MPI_MAX_LIBRARY_VERSION_STRING] = "unknown";
    int length;
    if (MPI_Get_library_version(version, &length)) /* allowed before MPI_Init */
        *version = 0;
    fprintf(out, "mpi: %.*s\n", (int)strcspn(version, ",\n"), version);
}

/* Prints the revision of the tree that this program was built in, if it is started there. */
static void print_revision(FILE *out)
{
    char build[COMPARE_PROGRAM], command[COMPARE_PROGRAM + LINE];
    snprintf(command, sizeof command,
             "cd '%s' && test -e config.status && git -C '" COMPARE_SOURCE
             "' describe --always --dirty --abbrev=12 2> /dev/null",
             compare_find_program("", build));
    FILE *in = popen(command, "r");
    print_line_of(in, "revision", "", out);
    if (in)
        pclose(in);
}

/* The host and the build, once: what is asked for them takes as long as starting some programs. 1
 * without memory. */
static int describe(struct compare *compare)
{
    struct utsname host;
    size_t size;
    FILE *out = open_memstream(&compare->where, &size);
    if (!out)
        return 1;
    if (!uname(&host))
        fprintf(out, "host: %s, %s %s, %s\n", host.nodename, host.sysname, host.release,
                host.machine);
    fprintf(out, "cores: %ld\n", sysconf(_SC_NPROCESSORS_ONLN));
    print_file_line("processor", "/proc/cpuinfo", "model name", out);
    print_file_line("memory", "/proc/meminfo", "MemTotal", out);
    print_file_line("load", "/proc/loadavg", "", out);
    print_mpi(out);
    fprintf(out, "build: %s, %s, %s\n", PACKAGE_STRING, COMPILER, COMPARE_CFLAGS);
    print_revision(out);
    return fclose(out) != 0;
}

/* ---- What is compared ---- */

/* The settings that all runs of a comparison share; lists and rounds may grow. */
static void print_specification(const struct compare *compare, FILE *out)
{
    fprintf(out, "compares:");
    for (int d = COMPARE_DIMENSIONS; d < compare->dimensions; d++)
        fprintf(out, " --vary %s", compare->name[d]);
    if (compare->figure)
        fprintf(out, " --figure %s", compare->figure);
    if (compare->same)
        fprintf(out, " --same %s", compare->same);
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

/* Opens a file of the folder; NULL: said on stderr, unless it need not be there (mode "r"). */
static FILE *open_file(const struct compare *compare, const char *name, const char *mode)
{
    char path[LINE];
    snprintf(path, sizeof path, "%s/%s", compare->folder, name);
    FILE *file = fopen(path, mode);
    if (!file && *mode != 'r')
        fprintf(stderr, "duite-compare: %s: %s\n", path, strerror(errno));
    return file;
}

static int cannot_keep(const struct compare *compare)
{
    fprintf(stderr, "duite-compare: %s/summary.csv: %s; what was written before is kept\n",
            compare->folder, strerror(errno));
    return 1;
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

static double number_of(const char *field)
{
    return *field ? strtod(field, NULL) : NAN;
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
    *run = (struct compare_run){.seconds = number_of(figure[0]),
                                .bodies = number_of(figure[1]),
                                .stolen = number_of(figure[2]),
                                .messages = number_of(figure[3]),
                                .bytes = number_of(figure[4]),
                                .done = true,
                                .fine = true};
    snprintf(run->result, sizeof run->result, "%s", figure[5]);
    return true;
}

#define WARNING "warning: "

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

/* A line of about.txt. ours: what begin() would write. */
static void look_at(struct compare *compare, const char *ours, char *line, struct found *found)
{
    if (begins(line, "compares:"))
        found->same = strstr(ours, line);
    const bool other =
        (begins(line, "build: ") || begins(line, "revision: ")) && !strstr(ours, line);
    line[strcspn(line, "\n")] = 0;
    if (other)
        snprintf(found->other, sizeof found->other, "%.*s", LINE - 1, line);
    if (begins(line, WARNING))
        keep_warning(compare, line + strlen(WARNING));
}

static int look_at_about(struct compare *compare, struct found *found)
{
    char line[LINE + COMPARE_COMMAND], *ours = NULL;
    size_t size;
    FILE *memory = open_memstream(&ours, &size), *in = open_file(compare, "about.txt", "r");
    if (memory) {
        print_specification(compare, memory);
        fputs(compare->where, memory);
        fclose(memory);
    }
    while (memory && in && fgets(line, sizeof line, in))
        look_at(compare, ours, line, found);
    if (in)
        fclose(in);
    free(ours);
    return !memory;
}

/* Takes over whole lines. */
static int take_over(struct compare *compare, FILE *in, struct found *found)
{
    char line[LINE + COMPARE_COMMAND];
    size_t taken = 0;
    if (look_at_about(compare, found))
        return 1;
    while (fgets(line, sizeof line, in) && strchr(line, '\n')) {
        found->whole = ftell(in);
        if (*line >= '0' && *line <= '9' && strtoul(line, NULL, 10) >= found->rounds)
            found->rounds = strtoul(line, NULL, 10) + 1;
        line[strcspn(line, "\n")] = 0;
        if (!take_line(compare, line))
            found->same = false;
    }
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
    print_specification(compare, compare->about);
    fprintf(compare->about, "date: %s\n", date);
    fputs(compare->where, compare->about);
    fprintf(compare->journal, "round");
    for (int d = 0; d < compare->dimensions; d++)
        fprintf(compare->journal, ",%s", compare->name[d]);
    fprintf(compare->journal, ",%s,seconds_in_bodies,stolen,messages,bytes,result,status\n",
            compare->figure ? "figure" : "seconds");
}

int compare_journal_open(struct compare *compare)
{
    char text[LINE + 60];
    struct found found = {.whole = 0};
    if (describe(compare))
        return cannot_keep(compare);
    FILE *in = open_file(compare, "summary.csv", "r");
    const int failed = in ? take_over(compare, in, &found) : 0;
    if (in)
        fclose(in);
    if (failed)
        return 1;
    compare->about = open_file(compare, "about.txt", found.whole ? "a" : "w");
    compare->journal =
        compare->about ? open_file(compare, "summary.csv", found.whole ? "a" : "w") : NULL;
    if (!compare->journal)
        return 1;
    if (found.whole && ftruncate(fileno(compare->journal), found.whole))
        return cannot_keep(compare);
    if (!found.whole)
        begin(compare);
    if (fflush(compare->about) || fflush(compare->journal))
        return cannot_keep(compare);
    warn_of_later(compare, &found);
    if (*found.other) {
        snprintf(text, sizeof text, "runs that were there already are of another build: %s",
                 found.other);
        compare_journal_warn(compare, text);
    }
    return 0;
}

static void put_number(FILE *out, double number)
{
    fputc(',', out);
    if (isfinite(number))
        fprintf(out, "%.12g", number);
}

int compare_journal_add(struct compare *compare, const struct compare_config *config, size_t round)
{
    const struct compare_run *run = &config->run[round];
    const double number[] = {run->seconds, run->bodies, run->stolen, run->messages, run->bytes};
    FILE *out = compare->journal;
    fprintf(out, "%zu", round);
    for (int d = 0; d < compare->dimensions; d++)
        fprintf(out, ",%s", config->value[d]);
    for (size_t i = 0; i < sizeof number / sizeof *number; i++)
        put_number(out, run->fine ? number[i] : NAN);
    fprintf(out, ",%s,%s\n", run->fine ? run->result : "", run->fine ? "fine" : "failed");
    return fflush(out) || fsync(fileno(out)) ? cannot_keep(compare) : 0;
}

void compare_journal_warn(struct compare *compare, const char *warning)
{
    if (!warning)
        return;
    fprintf(stderr, "duite-compare: warning: %s\n", warning);
    keep_warning(compare, warning);
    fprintf(compare->about, WARNING "%s\n", warning);
    fflush(compare->about);
}

void compare_journal_close(struct compare *compare)
{
    if (compare->about)
        fclose(compare->about);
    if (compare->journal)
        fclose(compare->journal);
    free(compare->where);
}
