/* A file of weights has one number a line, in the order of the vertices, and nothing else but
 * comments (#) and empty lines. */
#include "cloth/mesh/detail/finish.h"
#include "cloth/mesh/detail/obj.h"

struct weights {
    struct obj_lines lines;
    locale_t c; /* numbers have points, whatever the program's locale */
    uint32_t n, found;
    double *weight; /* n */
    struct cloth_error *error;
};

#define WEIGHTS_FAIL(w, format, ...)                                                               \
    cloth_fail((w)->error, CLOTH_E_INPUT, "%s:%zu: " format, mesh_path_shown((w)->lines.path),     \
               (w)->lines.line, __VA_ARGS__)

static int take_line(struct weights *w, const char *text)
{
    const char *word = obj_word(text);
    double weight;
    if (!word)
        return CLOTH_OK;
    if (w->found == w->n)
        return WEIGHTS_FAIL(w, "a weight after the last one: the mesh has %u vertices", w->n);
    if (!obj_word_number(word, w->c, &weight) || !(weight >= 0 && weight <= 1))
        return WEIGHTS_FAIL(w, "'%s' is no weight; a number from 0 to 1 is expected",
                            obj_word_quote(word).text);
    if (obj_word(obj_word_end(word)))
        return WEIGHTS_FAIL(w,
                            "a second word, '%s', follows the weight; one number a line is "
                            "expected",
                            obj_word_quote(obj_word(obj_word_end(word))).text);
    w->weight[w->found++] = weight;
    return CLOTH_OK;
}

static int take_lines(struct weights *w)
{
    const char *text = "";
    int code = obj_lines_open(&w->lines, w->lines.path, w->error);
    while (!code && text) {
        code = obj_lines_next(&w->lines, &text, w->error);
        if (!code && text)
            code = take_line(w, text);
    }
    if (code || w->found == w->n)
        return code;
    return WEIGHTS_FAIL(w,
                        "the file ends after %u weights, but the mesh has %u vertices; a line "
                        "for each is expected",
                        w->found, w->n);
}

int mesh_read_weights(const char *path, uint32_t n_vertices, double *weight,
                      struct cloth_error *error)
{
    struct weights w = {.lines = {.path = path},
                        .c = newlocale(LC_ALL_MASK, "C", (locale_t)0),
                        .n = n_vertices,
                        .weight = weight,
                        .error = error};
    if (!w.c)
        return cloth_fail(error, CLOTH_E_MEMORY, "out of memory for the C locale");
    const int code = take_lines(&w);
    obj_lines_close(&w.lines);
    freelocale(w.c);
    return code;
}
