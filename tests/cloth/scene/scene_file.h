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

/* Reads a text that is right with sets, KEY=VALUE each; fails the test if it is not. The caller
 * frees the model. */
struct model scene_read_right(const char *text, size_t n_sets, const char *const *sets);
/* The scene that is right, with a set. */
struct model scene_read_set(const char *set);
/* The scene that is right, with the first `from` replaced by `to`. */
struct model scene_read_changed(const char *from, const char *to);

/* Writes a further file beside it. */
void scene_write_file(const char *name, const char *bytes, size_t size);

/* The path of "scene.yaml", as errors name it. */
const char *scene_path(void);

#endif
