/* Strict both ways: what is written is valid JSON whatever the text, and what is read is exactly
 * what was asked for. */
#include "cloth/output/files/json.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Bytes of the UTF-8 character at `text`, 0 if it is none (overlong forms, surrogates and the range
 * above U+10FFFF are none). A byte of zero ends every sequence early. */
static int utf8_length(const unsigned char *text)
{
    int n = text[0] < 0x80                       ? 1
            : text[0] >= 0xc2 && text[0] <= 0xdf ? 2
            : (text[0] & 0xf0) == 0xe0           ? 3
            : text[0] >= 0xf0 && text[0] <= 0xf4 ? 4
                                                 : 0;
    for (int i = 1; i < n; i++)
        if ((text[i] & 0xc0) != 0x80)
            return 0;
    bool overlong = (text[0] == 0xe0 && text[1] < 0xa0) || (text[0] == 0xf0 && text[1] < 0x90);
    bool outside = (text[0] == 0xed && text[1] > 0x9f) || (text[0] == 0xf4 && text[1] > 0x8f);
    return overlong || outside ? 0 : n;
}

static void put_ascii(FILE *file, unsigned char c)
{
    if (c == '"' || c == '\\')
        fprintf(file, "\\%c", c);
    else if (c == '\n')
        fputs("\\n", file);
    else if (c == '\t')
        fputs("\\t", file);
    else if (c < 0x20 || c == 0x7f)
        fprintf(file, "\\u%04x", c);
    else
        fputc(c, file);
}

void output_json_string(FILE *file, const char *text)
{
    const unsigned char *c = (const unsigned char *)text;
    fputc('"', file);
    while (*c) {
        int n = utf8_length(c);
        if (n == 0)
            fputs("\\ufffd", file);
        else if (n == 1)
            put_ascii(file, *c);
        else
            fwrite(c, 1, (size_t)n, file);
        c += n ? n : 1;
    }
    fputc('"', file);
}

void output_json_number(FILE *file, double value)
{
    if (isfinite(value))
        fprintf(file, "%.17g", value);
    else
        fputs("null", file);
}

void output_json_put_numbers(FILE *file, size_t n, const double *value)
{
    for (size_t i = 0; i < n; i++) {
        fputs(n == 1 ? "" : i ? ", " : "[", file);
        output_json_number(file, value[i]);
    }
    fputs(n == 1 ? "" : "]", file);
}

/* ---- Reading ---- */

void output_json_fail(struct output_json *json, const char *what)
{
    if (json->failed)
        return;
    json->failed = true;
    size_t line = 1;
    for (const char *c = json->text; c < json->next; c++)
        line += *c == '\n';
    cloth_fail(json->error, CLOTH_E_INPUT, "%s:%zu: expected %s", json->path, line, what);
}

static void skip_space(struct output_json *json)
{
    json->next += strspn(json->next, " \t\r\n");
}

bool output_json_take(struct output_json *json, char c)
{
    skip_space(json);
    if (json->failed || *json->next != c)
        return false;
    json->next += c != '\0';
    return true;
}

bool output_json_expect(struct output_json *json, char c)
{
    if (output_json_take(json, c))
        return true;
    char what[] = {'\'', c, '\'', '\0'};
    output_json_fail(json, c ? what : "the end of the file");
    return false;
}

bool output_json_word(struct output_json *json, const char *word)
{
    skip_space(json);
    size_t n = strlen(word);
    if (json->failed || json->next[0] != '"' || strncmp(json->next + 1, word, n) != 0 ||
        json->next[n + 1] != '"')
        return false;
    json->next += n + 2;
    return true;
}

bool output_json_key(struct output_json *json, const char *name)
{
    return output_json_word(json, name) && output_json_expect(json, ':');
}

void output_json_expect_key(struct output_json *json, const char *name)
{
    char what[40];
    snprintf(what, sizeof what, "\"%s\"", name);
    if (!output_json_key(json, name))
        output_json_fail(json, what);
}

bool output_json_item(struct output_json *json, size_t i)
{
    if (i == 0)
        return output_json_expect(json, '[') && !output_json_take(json, ']');
    if (output_json_take(json, ','))
        return true;
    output_json_expect(json, ']');
    return false;
}

double output_json_double(struct output_json *json)
{
    skip_space(json);
    if (json->failed)
        return 0;
    char *end = NULL;
    double value = strtod(json->next, &end);
    /* strtod knows more than JSON: names of infinities, hexadecimals, a leading plus. */
    size_t shape = strspn(json->next, "+-.0123456789eE");
    if (end == json->next || (size_t)(end - json->next) != shape || *json->next == '+' ||
        !isfinite(value)) {
        output_json_fail(json, "a number");
        return 0;
    }
    json->next = end;
    return value;
}

void output_json_numbers(struct output_json *json, size_t n, double *value)
{
    if (n == 1) {
        *value = output_json_double(json);
        return;
    }
    output_json_expect(json, '[');
    for (size_t i = 0; i < n; i++) {
        if (i)
            output_json_expect(json, ',');
        value[i] = output_json_double(json);
    }
    output_json_expect(json, ']');
}
