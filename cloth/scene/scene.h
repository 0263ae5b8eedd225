#ifndef CLOTH_SCENE_SCENE_H
#define CLOTH_SCENE_SCENE_H

#include "cloth/model/model.h"

#include <stdio.h>

/* A change to the document: "time.h=0.002", "cloths[0].mesh.grid.nx=40". The key is a path, the
 * value is YAML. */
struct scene_set {
    const char *text;   /* KEY=VALUE */
    const char *option; /* how errors name it, such as "--end 3"; NULL: "--set " and the text */
};

/* Reads a scene file (YAML, schema 1, docs/scene.md) into a model, after applying the sets to the
 * document. Mesh files are looked up relative to the scene's folder. Unknown keys and impossible
 * values are CLOTH_E_INPUT errors "file:line:column: the fault; the allowed values"; the error
 * names the option instead if a set gave the value. The model belongs to the caller (model_free),
 * also after an error. Local. */
int scene_read(struct model *model, const char *path, size_t n_sets, const struct scene_set *sets,
               struct cloth_error *error);

/* Reads the models of all phases of a scene, one where it has none; scene_read has the first. A
 * model has the document with the sets of its phase and of those before it, then the caller's.
 * Garments and figures that phases share are made once. Errors of a later phase end with its name.
 * *models: n, each to be freed by model_free, then the array; also after an error. Local. */
int scene_read_phases(struct model **models, uint32_t *n, const char *path, size_t n_sets,
                      const struct scene_set *sets, struct cloth_error *error);

/* Prints every key of a scene with its kind, unit, range and default, one a line. Local. */
void scene_print_keys(FILE *file);

/* The same in Markdown, with what each key does in full and with examples: the page docs/scene.md
 * without its opening. Local. */
void scene_print_page(FILE *file);

#endif
