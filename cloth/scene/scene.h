#ifndef CLOTH_SCENE_SCENE_H
#define CLOTH_SCENE_SCENE_H

#include "cloth/flow/model.h"

/* Reads a scene file (YAML, schema 1) into a model, after applying `--set` texts ("time.h=0.002", "cloths[0].mesh.grid.nx=40")
 * to the document. Mesh files are looked up relative to the scene's folder. Unknown keys and impossible values
 * are CLOTH_E_INPUT errors "file:line:column: what is wrong; what is allowed"; where the value came by --set the error
 * names the option instead. The model belongs to the caller (model_free), also after an error. Local: every rank reads the
 * same file, the same result and the same error everywhere. */
int scene_read(struct model *model, const char *path, size_t n_sets, const char *const *sets,
               struct cloth_error *error);

#endif
