#ifndef TESTS_CLOTH_SCENE_SCENE_FILE_H
#define TESTS_CLOTH_SCENE_SCENE_FILE_H

#include "cloth/scene/scene.h"

/* Scenes for tests: a small one that is right, and changes of its text. */

/* The scene that is right; its lines are counted by the tests, so it keeps them. */
extern const char *const scene_right;

/* A copy of a text with the first `from` replaced by `to`; fails the test if `from` is not there.
 * The caller frees it. */
char *scene_changed(const char *text, const char *from, const char *to);

/* Writes a text as "scene.yaml" into a folder of this process and reads it. Returns what scene_read
 * does. */
int scene_read_text(struct model *model, const char *text, size_t n_sets,
                    const struct scene_set *sets, struct cloth_error *error);

/* Reads a text that is right; fails the test if it is not. The caller frees the model. */
struct model scene_read_right(const char *text, size_t n_sets, const struct scene_set *sets);
/* The scene that is right, with a set. */
struct model scene_read_set(const char *set);
/* The scene that is right, with the first `from` replaced by `to`. */
struct model scene_read_changed(const char *from, const char *to);

/* Writes a further file beside it. */
void scene_write_file(const char *name, const char *bytes, size_t size);

/* The path of "scene.yaml", as errors name it. */
const char *scene_path(void);

/* A change of the scene that is right, and the error that it must give. */
struct scene_wrong {
    const char *from, *to; /* the change of the file; NULL: none */
    const char *set;       /* NULL: none */
    const char *error;     /* after the path of the file, or all of it when there is a set */
};

/* Fails the test unless reading the text, with the set if there is one, gives this error; one that
 * ends with "..." says how it begins, so a list of keys may grow. */
void scene_expect_error(const char *text, const char *set, const char *error);
void scene_expect_errors(const struct scene_wrong *wrong, size_t n);

#define EXPECT(...)                                                                                \
    do {                                                                                           \
        static const struct scene_wrong all[] = {__VA_ARGS__};                                     \
        scene_expect_errors(all, sizeof all / sizeof all[0]);                                      \
    } while (0)

#endif
