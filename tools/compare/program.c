/* Braces around anything but a name, or behind a $, are the program's own. */
#include "tools/compare/program.h"

#include <stdlib.h>
#include <string.h>

/* ---- Lists ---- */

/* The length of the {name} at `at`, a place in a word; 0: none is there. */
static size_t length_of_name(const char *word, const char *at)
{
    const size_t n = *at == '{' && !(at > word && at[-1] == '$') ? strspn(at + 1, PROGRAM_NAME) : 0;
    return n && at[n + 1] == '}' ? n + 2 : 0;
}

static bool is_named(const struct compare *compare, int dimension, const char *at, size_t length)
{
    const char *name = compare->name[dimension];
    return strlen(name) == length - 2 && !strncmp(name, at + 1, length - 2);
}

/* The dimension of a {name}; -1: no list of this name was given. */
static int find_dimension(const struct compare *compare, const char *at, size_t length)
{
    for (int d = SUBJECT + 1; d < compare->dimensions; d++)
        if (is_named(compare, d, at, length) && *compare->list[d].item[0])
            return d;
    return -1;
}

const char *program_word_wrong(const struct compare *compare, const char *word, char *text,
                               size_t size)
{
    for (const char *at = word; *at; at++) {
        const size_t length = length_of_name(word, at);
        if (!length || find_dimension(compare, at, length) >= 0)
            continue;
        snprintf(text, size,
                 "%.*s in %s: no list of this name was given; --grain, --ranks and their like, and "
                 "--vary give some",
                 (int)length, at, word);
        return text;
    }
    return NULL;
}

bool program_names(const struct compare *compare, int dimension)
{
    for (char *const *word = compare->program; *word; word++)
        for (const char *at = *word; *at; at++) {
            const size_t length = length_of_name(*word, at);
            if (length && is_named(compare, dimension, at, length))
                return true;
        }
    return false;
}

char *program_fill(const struct compare *compare, const struct compare_config *config,
                   const char *word)
{
    char *filled = NULL;
    size_t size;
    FILE *memory = open_memstream(&filled, &size);
    if (!memory)
        return NULL;
    for (const char *at = word; *at;) {
        const size_t length = length_of_name(word, at);
        if (length)
            fputs(config->value[find_dimension(compare, at, length)], memory);
        else
            fputc(*at, memory);
        at += length ? length : 1;
    }
    fclose(memory);
    return filled;
}

void program_environment(const struct compare *compare, const struct compare_config *config)
{
    static const struct {
        int dimension;
        const char *variable;
    } variables[] = {{SCHEDULER, "DUITE_SCHEDULER"}, {MAPPING, "DUITE_MAPPING"},
                     {BALANCE, "DUITE_BALANCE"},     {THREADS, "DUITE_THREADS"},
                     {THREADS, "OMP_NUM_THREADS"},   {THREADS, "STARPU_NCPU"}};
    for (size_t i = 0; i < sizeof variables / sizeof *variables && compare->program; i++)
        if (*config->value[variables[i].dimension])
            setenv(variables[i].variable, config->value[variables[i].dimension], 1);
    for (int d = COMPARE_DIMENSIONS; d < compare->dimensions; d++)
        setenv(compare->name[d], config->value[d], 1);
}

/* ---- The command ---- */

/* A newline would end the line that it stands in. */
void program_print(const struct compare *compare, FILE *out)
{
    for (char *const *word = compare->program; *word; word++) {
        if (word != compare->program)
            fputc(' ', out);
        for (const char *at = *word; *at; at++)
            fputc(*at == '\n' ? ' ' : *at, out);
    }
}
