/* In place of the files that need Assimp. */
#include "cloth/mesh/detail/figure.h"

static int refuse(const char *path, struct cloth_error *error)
{
    return cloth_fail(error, CLOTH_E_LIBRARY,
                      "%s: this duite was built without Assimp, which reads such files: install "
                      "libassimp-dev and build again, or export an OBJ file",
                      path);
}

int mesh_read_figure(struct mesh *mesh, const char *path, bool fans, struct cloth_error *error)
{
    (void)fans;
    *mesh = (struct mesh){0};
    return refuse(path, error);
}

int mesh_read_clip(const char *path, uint32_t n_vertices, const char *clip, double rate,
                   uint32_t *n_frames, double **place, struct cloth_error *error)
{
    (void)n_vertices;
    (void)clip;
    (void)rate;
    *n_frames = 0;
    *place = NULL;
    return refuse(path, error);
}
