/* Platforms: hosts that are alike, or those of a file, whose lines are read one after the other. A
 * switch is known before anything hangs on it, so the places are a tree. */
#include "tools/predict/platform.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <duite.h>

#include <errno.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_CORES = 1 << 24 }; /* of all hosts together */

struct platform_reader {
    const char *file;
    unsigned long line;
    struct predict_place standard;      /* what a line does not say */
    struct predict_place *host, *inner; /* hosts; switches: `up` is a place among these */
    char **name;                        /* by switch */
    size_t n_hosts, n_switches, hosts_capacity, inner_capacity, names_capacity;
    uint64_t cores;
};

static int platform_wrong(const struct platform_reader *r, const char *word, const char *what)
{
    return base_error(DUITE_E_ARGUMENT, "%s:%lu: %s: %s", r->file, r->line, word, what);
}

/* ---- Words ---- */

enum platform_owner { OF_HOSTS = 1, OF_SWITCHES = 2 };

static const struct {
    const char *word;
    size_t offset;
    enum platform_owner of;
    bool may_be_zero;
} NUMBERS[] = {
    {"latency", offsetof(struct predict_place, latency), OF_HOSTS | OF_SWITCHES, true},
    {"bandwidth", offsetof(struct predict_place, bandwidth), OF_HOSTS | OF_SWITCHES, false},
    {"capacity", offsetof(struct predict_place, capacity), OF_SWITCHES, false},
    {"speed", offsetof(struct predict_place, speed), OF_HOSTS, false}};

/* A whole number from 1 on; 0: it is none. */
static uint32_t platform_whole(const char *word, uint32_t most)
{
    char *end;
    errno = 0;
    const unsigned long value = strtoul(word, &end, 10);
    return *word < '0' || *word > '9' || *end || errno || value > most ? 0 : (uint32_t)value;
}

static int platform_number(const struct platform_reader *r, const char *word, bool may_be_zero,
                           double *number)
{
    char *end;
    *number = strtod(word, &end);
    if (end == word || *end || !isfinite(*number) || *number < 0 || (!may_be_zero && *number == 0))
        return platform_wrong(
            r, word, may_be_zero ? "a number >= 0 is expected" : "a number > 0 is expected");
    return DUITE_OK;
}

static int platform_up(const struct platform_reader *r, const char *name,
                       struct predict_place *place)
{
    for (size_t i = 0; i < r->n_switches; i++)
        if (!strcmp(r->name[i], name)) {
            place->up = (uint32_t)i;
            return DUITE_OK;
        }
    return platform_wrong(r, name, "no line before names this switch");
}

/* A word and its value. */
static int platform_pair(const struct platform_reader *r, const char *word, const char *value,
                         enum platform_owner of, struct predict_place *place)
{
    if (!value)
        return platform_wrong(r, word, "its value is missing");
    if (!strcmp(word, "to"))
        return platform_up(r, value, place);
    if (!strcmp(word, "cores") && of == OF_HOSTS)
        return (place->cores = platform_whole(value, DUITE_MAX_THREADS))
                   ? DUITE_OK
                   : platform_wrong(r, value, "a number of cores from 1 on is expected");
    for (size_t i = 0; i < sizeof NUMBERS / sizeof NUMBERS[0]; i++)
        if (!strcmp(word, NUMBERS[i].word) && NUMBERS[i].of & of)
            return platform_number(r, value, NUMBERS[i].may_be_zero,
                                   (double *)((char *)place + NUMBERS[i].offset));
    return platform_wrong(r, word,
                          of == OF_HOSTS ? "hosts have to, cores, speed, latency and bandwidth"
                                         : "a switch has to, latency, bandwidth and capacity");
}

static int platform_pairs(const struct platform_reader *r, char **rest, enum platform_owner of,
                          struct predict_place *place)
{
    int code = DUITE_OK;
    *place = r->standard;
    for (char *word; !code && (word = strtok_r(NULL, " \t\r\n", rest));)
        code = platform_pair(r, word, strtok_r(NULL, " \t\r\n", rest), of, place);
    return code;
}

/* ---- Lines ---- */

static int platform_hosts(struct platform_reader *r, const char *number, char **rest)
{
    struct predict_place place;
    const uint32_t n = number ? platform_whole(number, MOST_CORES) : 0;
    if (!n)
        return platform_wrong(r, number ? number : "hosts", "a number of hosts is expected");
    const int code = platform_pairs(r, rest, OF_HOSTS, &place);
    if (code)
        return code;
    if (place.up == UINT32_MAX)
        return platform_wrong(r, number, "to what switch do these hosts go? (to NAME)");
    r->cores += (uint64_t)n * place.cores;
    if (r->cores > MOST_CORES)
        return platform_wrong(r, number, "more than 16777216 cores in all");
    if (!BASE_GROW(r->host, r->hosts_capacity, r->n_hosts + n))
        return base_no_memory("a platform");
    for (uint32_t i = 0; i < n; i++)
        r->host[r->n_hosts++] = place;
    return DUITE_OK;
}

static uint32_t platform_depth(const struct platform_reader *r, uint32_t inner)
{
    uint32_t depth = 1;
    for (; r->inner[inner].up != inner; inner = r->inner[inner].up)
        depth++;
    return depth;
}

static int platform_switch(struct platform_reader *r, const char *name, char **rest)
{
    struct predict_place place, other;
    if (!name)
        return platform_wrong(r, "switch", "its name is missing");
    if (!platform_up(r, name, &other))
        return platform_wrong(r, name, "two switches have this name");
    const int code = platform_pairs(r, rest, OF_SWITCHES, &place);
    if (code)
        return code;
    if (place.up == UINT32_MAX && r->n_switches)
        return platform_wrong(r, name, "only the first switch is the top: to NAME is expected");
    if (place.up == UINT32_MAX)
        place.up = 0;
    else if (platform_depth(r, place.up) == PREDICT_MOST_SWITCHES)
        return platform_wrong(r, name, "more than 6 switches one above the other");
    if (!BASE_GROW(r->inner, r->inner_capacity, r->n_switches + 1) ||
        !BASE_GROW(r->name, r->names_capacity, r->n_switches + 1) ||
        !(r->name[r->n_switches] = strdup(name)))
        return base_no_memory("a platform");
    r->inner[r->n_switches++] = place;
    return DUITE_OK;
}

static int platform_line(struct platform_reader *r, char *line)
{
    char *rest;
    line[strcspn(line, "#")] = 0;
    const char *word = strtok_r(line, " \t\r\n", &rest);
    if (!word)
        return DUITE_OK;
    const char *second = strtok_r(NULL, " \t\r\n", &rest);
    if (!strcmp(word, "hosts"))
        return platform_hosts(r, second, &rest);
    if (!strcmp(word, "switch"))
        return platform_switch(r, second, &rest);
    return platform_wrong(r, word, "a line begins with switch or hosts");
}

/* ---- All of it ---- */

static int platform_lines(struct platform_reader *r)
{
    FILE *file = fopen(r->file, "r");
    char *line = NULL;
    size_t room = 0;
    if (!file)
        return base_error(DUITE_E_SYSTEM, "%s cannot be read: %s", r->file, strerror(errno));
    int code = DUITE_OK;
    while (!code && getline(&line, &room, file) >= 0) {
        r->line++;
        code = platform_line(r, line);
    }
    if (!code && ferror(file))
        code = base_error(DUITE_E_SYSTEM, "%s cannot be read: %s", r->file, strerror(errno));
    fclose(file);
    free(line);
    return code;
}

static int platform_join(const struct platform_reader *r, struct predict_platform *platform)
{
    if (!r->n_hosts)
        return base_error(DUITE_E_ARGUMENT, "%s: no hosts", r->file);
    platform->n_hosts = (uint32_t)r->n_hosts;
    platform->n_places = (uint32_t)(r->n_hosts + r->n_switches);
    platform->place = base_alloc(platform->n_places * sizeof *platform->place);
    if (!platform->place)
        return base_no_memory("a platform");
    memcpy(platform->place, r->host, r->n_hosts * sizeof *r->host);
    memcpy(platform->place + r->n_hosts, r->inner, r->n_switches * sizeof *r->inner);
    for (uint32_t i = 0; i < platform->n_places; i++)
        platform->place[i].up += platform->n_hosts;
    return DUITE_OK;
}

int predict_platform_read(struct predict_platform *platform, const char *file, uint32_t cores)
{
    struct platform_reader r = {.file = file,
                                .standard = {.up = UINT32_MAX,
                                             .cores = cores,
                                             .speed = 1,
                                             .bandwidth = INFINITY,
                                             .capacity = INFINITY}};
    *platform = (struct predict_platform){0};
    int code = platform_lines(&r);
    if (!code)
        code = platform_join(&r, platform);
    for (size_t i = 0; i < r.n_switches; i++)
        free(r.name[i]);
    free(r.name);
    free(r.host);
    free(r.inner);
    return code;
}

bool predict_platform_flat(struct predict_platform *platform, uint32_t hosts,
                           const struct predict_place *host, double capacity)
{
    *platform = (struct predict_platform){.n_hosts = hosts, .n_places = hosts + 1};
    platform->place = base_alloc(platform->n_places * sizeof *platform->place);
    for (uint32_t i = 0; i <= hosts && platform->place; i++) {
        platform->place[i] = *host;
        platform->place[i].up = hosts;
        platform->place[i].latency *= 0.5;
    }
    if (platform->place)
        platform->place[hosts].capacity = capacity;
    return platform->place;
}

void predict_platform_free(struct predict_platform *platform)
{
    base_free(platform->place);
}

/* ---- Sums ---- */

uint32_t predict_platform_cores(const struct predict_platform *platform)
{
    uint32_t n = 0;
    for (uint32_t h = 0; h < platform->n_hosts; h++)
        n += platform->place[h].cores;
    return n;
}

double predict_platform_latency(const struct predict_platform *platform)
{
    double longest = 0;
    for (uint32_t h = 0; h < platform->n_hosts; h++) {
        double latency = 0;
        for (uint32_t i = h; platform->place[i].up != i; i = platform->place[i].up)
            latency += platform->place[i].latency;
        longest = fmax(longest, latency);
    }
    return 2 * longest;
}

double predict_platform_bandwidth(const struct predict_platform *platform)
{
    double least = INFINITY;
    for (uint32_t h = 0; h < platform->n_hosts; h++)
        least = fmin(least, platform->place[h].bandwidth);
    return least;
}
