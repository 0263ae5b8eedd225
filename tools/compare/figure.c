/* A report is flat but for lists at its end, so that the first place of a key is the run's own. */
#include "tools/compare/figure.h"
#include "tools/compare/program.h"

#include <math.h>
#include <regex.h>
#include <stdlib.h>
#include <string.h>

static const char *key_of(const char *what)
{
    return what && !strncmp(what, "key=", 4) ? what + 4 : NULL;
}

const char *figure_wrong(const struct compare *compare, const char *what, char *text, size_t size)
{
    const char *key = key_of(what);
    regex_t regex;
    const int error = key ? 0 : regcomp(&regex, what, REG_EXTENDED);
    if (error) {
        regerror(error, &regex, text, size);
        return text;
    }
    const size_t groups = key ? strlen(key) : regex.re_nsub;
    if (!key)
        regfree(&regex);
    if (!groups || (key && key[strspn(key, PROGRAM_NAME)]))
        snprintf(text, size,
                 key ? "a key has letters, digits and _ only"
                     : "a group in parentheses is expected around what is looked for");
    else if (!key && !compare->program)
        snprintf(text, size, "a regular expression is for a program after --; key=KEY is for all");
    else
        return NULL;
    return text;
}

static bool is_number(const char *text)
{
    char *end;
    const double number = strtod(text, &end);
    return end > text && !*end && isfinite(number);
}

/* Keeps text for the journal and pages: in one field of one line. */
static void keep_text(const char *from, size_t n, char *text, size_t size)
{
    snprintf(text, size, "%.*s", (int)n, from);
    for (char *at = text; *at; at++)
        if (strchr(",\"\n\r", *at))
            *at = ' ';
}

/* The value of "key", without its quotes. */
static bool find_key(const char *report, const char *key, char *text, size_t size)
{
    char quoted[200];
    snprintf(quoted, sizeof quoted, "\"%s\":", key);
    const char *found = report ? strstr(report, quoted) : NULL;
    if (!found)
        return false;
    found += strlen(quoted);
    found += strspn(found, " \"");
    keep_text(found, strcspn(found, "\",\n}"), text, size);
    return true;
}

static double number_of(const char *report, const char *key)
{
    char text[64];
    return find_key(report, key, text, sizeof text) && is_number(text) ? strtod(text, NULL) : NAN;
}

/* `number`: only lines whose group is one count. */
static bool find_in_log(const char *figure, bool number, const char *log, char *text, size_t size)
{
    regex_t regex;
    regmatch_t match[2];
    char *line = NULL, found[64];
    size_t room = 0;
    bool any = false;
    FILE *in = regcomp(&regex, figure, REG_EXTENDED) ? NULL : fopen(log, "r");
    while (in && getline(&line, &room, in) > 0) {
        line[strcspn(line, "\n")] = 0;
        if (regexec(&regex, line, 2, match, 0) || match[1].rm_so < 0)
            continue;
        keep_text(line + match[1].rm_so, (size_t)(match[1].rm_eo - match[1].rm_so), found,
                  sizeof found);
        if (number && !is_number(found))
            continue;
        any = true;
        snprintf(text, size, "%s", found);
    }
    regfree(&regex);
    free(line);
    if (in)
        fclose(in);
    return any;
}

/* To be freed; NULL: there is none. */
static char *read_whole(const char *file)
{
    enum { MOST = 1 << 20 };
    FILE *in = fopen(file, "r");
    char *text = in ? malloc(MOST) : NULL;
    if (text)
        text[fread(text, 1, MOST - 1, in)] = 0;
    if (in)
        fclose(in);
    return text;
}

static double read_seconds(const struct compare *compare, const char *report, const char *log,
                           double seconds)
{
    char text[64];
    const char *key = key_of(compare->figure);
    if (!compare->figure)
        return compare->program ? seconds : number_of(report, "seconds_per_step");
    if (key)
        return number_of(report, key);
    return find_in_log(compare->figure, true, log, text, sizeof text) ? strtod(text, NULL) : NAN;
}

static bool read_result(const struct compare *compare, const char *report, const char *log,
                        struct compare_run *run)
{
    const char *what = compare->same ? compare->same : compare->program ? NULL : "key=state_hash";
    if (!what)
        return true;
    return key_of(what) ? find_key(report, key_of(what), run->result, sizeof run->result)
                        : find_in_log(what, false, log, run->result, sizeof run->result);
}

const char *figure_read(const struct compare *compare, const char *report, const char *log,
                        double seconds, struct compare_run *run, char *text, size_t size)
{
    char *json = read_whole(report);
    run->seconds = read_seconds(compare, json, log, seconds);
    const double busy = number_of(json, "busy_fraction");
    run->reported = isfinite(busy);
    run->bodies = compare->figure    ? NAN
                  : compare->program ? busy * number_of(json, "wall_seconds")
                                     : busy * run->seconds;
    run->stolen = number_of(json, "tasks_stolen");
    run->messages = number_of(json, "messages");
    run->bytes = number_of(json, "bytes_moved");
    run->fine = run->seconds > 0 && read_result(compare, json, log, run);
    const bool found = run->seconds > 0;
    if (!found && key_of(compare->figure))
        snprintf(text, size,
                 json ? "its report has no number above 0 of the key %s"
                      : "it left no report, which has the key %s: it is no program of duite, or "
                        "has not come to duite_stop",
                 key_of(compare->figure));
    else if (!found && compare->figure)
        snprintf(text, size, "--figure finds no number above 0");
    else if (!found)
        snprintf(text, size, "no figures in its report");
    else if (!run->fine)
        snprintf(text, size, "--same finds nothing");
    free(json);
    return run->fine ? NULL : text;
}
