/* Nothing here changes the line or depends on the program's locale. */
#include "cloth/mesh/detail/words.h"

#include "cloth/mesh/detail/finish.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool detail_words_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

const char *mesh_word(const char *at)
{
    while (detail_words_blank(*at))
        at++;
    return *at && *at != '#' ? at : NULL;
}

const char *mesh_word_end(const char *word)
{
    while (*word && !detail_words_blank(*word))
        word++;
    return word;
}

const char *mesh_word_after(const char *line, const char *keyword)
{
    const char *word = mesh_word(line);
    size_t length = strlen(keyword);
    if (!word || strncmp(word, keyword, length) != 0 || mesh_word_end(word) != word + length)
        return NULL;
    return word + length;
}

bool mesh_word_number(const char *word, locale_t c, double *number)
{
    char *end;
    *number = strtod_l(word, &end, c);
    if (end == word || (*end && !detail_words_blank(*end)) || !isfinite(*number))
        return false;
    return !memchr(word, 'x', (size_t)(end - word)) && !memchr(word, 'X', (size_t)(end - word));
}

/* Reads a whole number and moves on behind it; false if there is none. */
static bool detail_words_whole_number(const char **at, long long *number)
{
    const long long max = (long long)MESH_MAX + 1;
    const char *p = *at;
    bool negative = *p == '-';
    if (*p == '-' || *p == '+')
        p++;
    if (*p < '0' || *p > '9')
        return false;
    long long n = 0;
    for (; *p >= '0' && *p <= '9'; p++)
        n = n >= max ? max : n * 10 + (*p - '0');
    n = n > max ? max : n;
    *number = negative ? -n : n;
    *at = p;
    return true;
}

bool mesh_word_corner(const char *word, struct mesh_corner *corner)
{
    const char *at = word;
    *corner = (struct mesh_corner){0};
    if (!detail_words_whole_number(&at, &corner->v))
        return false;
    if (*at == '/') {
        at++;
        if (*at != '/' && *at && !detail_words_blank(*at) &&
            !detail_words_whole_number(&at, &corner->vt))
            return false;
        if (*at == '/') {
            at++;
            if (*at && !detail_words_blank(*at) && !detail_words_whole_number(&at, &corner->vn))
                return false;
        }
    }
    return !*at || detail_words_blank(*at);
}

struct mesh_quote mesh_word_quote(const char *word)
{
    struct mesh_quote quote = {""};
    size_t length = (size_t)(mesh_word_end(word) - word), max = sizeof quote.text - 4;
    for (size_t i = 0; i < length && i < max; i++)
        quote.text[i] = word[i] > ' ' && word[i] < 127 ? word[i] : '?';
    if (length > max)
        memcpy(quote.text + max, "...", 4);
    return quote;
}
